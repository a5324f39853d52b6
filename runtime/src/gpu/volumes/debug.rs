//! Pictures of the volumes themselves, drawn over a picture's depths.

use super::VolumeRenderer;
use super::lights::light_index;
use crate::View;
use crate::gpu::device::GpuError;
use crate::gpu::frame::{Output, readback};
use crate::light::Moment;
use glam::Vec3;
use sunbake_shaders::VolumeUse;

/// Colour of volumes that hold the surface.
const WARM: Vec3 = Vec3::new(1.0, 0.36, 0.04);
/// Colour of volumes that one looks through.
const COLD: Vec3 = Vec3::new(0.04, 0.22, 0.85);
/// Weight of a face one looks through, against a volume that holds the surface.
const SEE_THROUGH_WEIGHT: f32 = 0.08;
/// Brightness of the picture beneath the volumes.
const PICTURE_BRIGHTNESS: f32 = 0.8;
/// How much of the picture is covered where many faces are: 1 - exp(-this).
const FACE_COVERAGE: f32 = 1.1;

impl VolumeRenderer<'_> {
    /// The lit picture with the sun's volumes shown, or the lamp's where it alone shines. Warm: more faces turn to
    /// the eye than away, so that the surface lies in a volume. Cold: one looks through volumes and out of them. Each
    /// further face counts less.
    pub fn debug_picture(&mut self, view: &View, moment: &Moment) -> Result<Vec<Vec3>, GpuError> {
        let lit = self.lit(view, moment)?;
        let faces = readback::colors(&self.over_faces(view, moment, Output::Lit, VolumeUse::Visualize)?);
        let mut totals: Vec<f32> = faces.iter().map(|faces| faces.x + faces.z).filter(|&n| n > 0.0).collect();
        totals.sort_by(f32::total_cmp);
        let many = totals.get(totals.len() * 3 / 4).copied().unwrap_or(1.0);
        let mix = |(lit, faces): (&Vec3, &Vec3)| {
            let total = faces.x + faces.z;
            let entered = (faces.x - faces.z).max(0.0);
            let tint = COLD.lerp(WARM, entered / (entered + SEE_THROUGH_WEIGHT * total).max(1.0));
            (*lit * PICTURE_BRIGHTNESS).lerp(tint, 1.0 - (-FACE_COVERAGE * total / many).exp())
        };
        Ok(lit.iter().zip(&faces).map(mix).collect())
    }

    /// How many prisms hold each pixel's surface, counted without a stencil.
    pub fn counts(&mut self, view: &View, moment: &Moment, of_lamp: bool) -> Result<Vec<f32>, GpuError> {
        let output = visibility_of(of_lamp);
        self.draw(view, moment, output)?;
        self.over_faces(view, moment, output, VolumeUse::Count)
    }

    /// How many faces cover each pixel, in front of its surface and behind it.
    pub fn fill(&mut self, view: &View, moment: &Moment, of_lamp: bool) -> Result<Vec<f32>, GpuError> {
        let output = visibility_of(of_lamp);
        self.draw(view, moment, output)?;
        self.over_faces(view, moment, output, VolumeUse::Fill)
    }

    /// Depths of the surfaces of the last picture of visibility along the camera's axis, in metres; infinite where
    /// there is none.
    pub fn depths_m(&self, view: &View, of_lamp: bool) -> Result<Vec<f32>, GpuError> {
        let Some(depth) = self.targets.last_depth(visibility_of(of_lamp)) else { return Ok(Vec::new()) };
        let stored = self.gpu.checked("reading depths", || readback::read_depths(self.gpu, depth))??;
        Ok(stored.iter().map(|depth| view.near_m() / depth).collect())
    }

    /// Sums over the faces of the volumes of the light that an output shows, in place of the picture that has been
    /// drawn.
    fn over_faces(
        &mut self,
        view: &View,
        moment: &Moment,
        output: Output,
        of: VolumeUse,
    ) -> Result<Vec<f32>, GpuError> {
        let gpu = self.gpu;
        let picture = self.targets.picture(gpu, output, view.size)?;
        gpu.check_blendable(picture.target().format, "add faces up in pictures of 32 bits")?;
        let depth = self.targets.depth(gpu, output, view.size)?;
        let lights = self.lights(moment, output);
        let Some(light) = lights.first() else {
            return Ok(vec![0.0; view.pixel_count() * output.channels() as usize]);
        };
        gpu.checked("drawing volumes", || {
            // Of several suns only the last one's volumes are kept.
            self.extrude(&light.light)?;
            let mut encoder = gpu.encoder();
            self.scene.frame.write(gpu, &mut encoder, view, &light.moment);
            let light_index = light_index(&light.light);
            let (plan, draws) = self.frame_plan(view, &light.light);
            self.prepare_faces(light_index, &draws, of, picture.target().format);
            self.face_pass(&mut encoder, picture.target(), &depth, light_index, &plan, &draws, of);
            readback::read(gpu, &picture, output.channels(), encoder)
        })?
    }
}

fn visibility_of(of_lamp: bool) -> Output {
    if of_lamp { Output::LampVisibility } else { Output::Visibility }
}
