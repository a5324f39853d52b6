//! The passes that only shadow volumes have.

use super::VolumeRenderer;
use super::draws::{FaceDraw, VolumeDraws};
use super::extruded::CountedRun;
use super::lights::FrameLight;
use super::programs::{EARLIER_RUN, FaceKey, VolumeProgram, face_key, hard_key};
use super::record::VolumeTarget;
use crate::gpu::frame::{
    BatchKey, BlendedDraws, DepthBuffer, Output, Phase, PictureTarget, Program, STENCIL_FORMAT, begin_color_pass,
    begin_depth_pass,
};
use crate::volumes::FramePlan;
use sunbake_shaders::VolumeUse;

/// Where a light's pass stands among those of all lights.
#[derive(Debug, Clone, Copy)]
pub struct PassPlace {
    /// Nothing has been drawn into a picture of visibility.
    pub is_first: bool,
    /// No light follows.
    pub is_last: bool,
}

impl VolumeRenderer<'_> {
    /// Counts a light's volumes in the stencil.
    pub(super) fn volume_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        depth: &DepthBuffer,
        light_index: usize,
        plan: &FramePlan,
        draws: &VolumeDraws,
    ) {
        let Some(extruded) = &self.extruded[light_index] else { return };
        // Programs of the stencil do not depend on the picture's format.
        let program = |key: VolumeProgram| self.programs.get(&key, STENCIL_FORMAT);
        let mut pass = begin_depth_pass(encoder, "volumes", depth.with_stencil_cleared(), &self.clock, Phase::Volumes);
        let [left, top, width, height] = plan.scissor;
        pass.set_scissor_rect(left, top, width, height);
        pass.set_stencil_reference(EARLIER_RUN);
        for (i, (run, [in_front, behind])) in extruded.runs.iter().zip(&draws.runs).enumerate() {
            pass.set_bind_group(0, &self.scene.frame.group, &[]);
            for (draws, is_z_pass) in [(in_front, true), (behind, false)] {
                for draw in draws {
                    let key = face_key(extruded, draw, VolumeUse::Stencil, is_z_pass);
                    draw_faces(&mut pass, run, draw, program(VolumeProgram::Faces(key)));
                }
            }
            if i + 1 < extruded.runs.len() {
                pass.set_pipeline(&program(VolumeProgram::MergeRun).pipeline);
                pass.draw(0..3, 0..1);
            }
        }
    }

    /// Adds a light where no volume was counted. The last pass of a picture of visibility draws its background.
    pub(super) fn light_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        into: &VolumeTarget<'_>,
        light: Option<(&FrameLight, bool)>,
        place: PassPlace,
    ) {
        let is_mask = into.output != Output::Lit;
        let load = match is_mask && place.is_first {
            true => wgpu::LoadOp::Clear(wgpu::Color::BLACK),
            false => wgpu::LoadOp::Load,
        };
        let depth = match light {
            // No volumes were counted for this light: those of an earlier one are cleared.
            Some((_, false)) => into.depth.with_stencil_cleared(),
            _ => into.depth.read_only(),
        };
        let color = into.picture.attachment(load);
        let program = |key: VolumeProgram| self.programs.get(&key, into.picture.format);
        let mut pass = begin_color_pass(encoder, "light", color, Some(depth), &self.clock, Phase::Light);
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        if let Some((light, _)) = light {
            let share = f64::from(light.share);
            pass.set_blend_constant(wgpu::Color { r: share, g: share, b: share, a: share });
            for batch in self.scene.solid(into.output) {
                let key = VolumeProgram::Light(light.hard, light.blend, hard_key(&batch.key, into.output));
                self.scene.draw_without_page(&mut pass, batch, program(key), into.output);
            }
        }
        if is_mask && place.is_last {
            pass.set_pipeline(&program(VolumeProgram::Background).pipeline);
            pass.draw(0..3, 0..1);
        }
    }

    /// Draws blended surfaces over what is lit.
    pub(super) fn blended_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        into: &VolumeTarget<'_>,
        blended: &BlendedDraws,
    ) {
        let color = into.picture.attachment(wgpu::LoadOp::Load);
        let depth = Some(into.depth.read_only());
        let mut pass = begin_color_pass(encoder, "blended", color, depth, &self.clock, Phase::Light);
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        let program = |key: &BatchKey| {
            let key = VolumeProgram::Blended(self.scene.surface_key(key, into.output));
            self.programs.get(&key, into.picture.format)
        };
        blended.draw(&mut pass, &self.scene, program, |_, _| {});
    }

    /// Draws faces into the picture.
    #[expect(clippy::too_many_arguments, reason = "a pass needs where, what and how")]
    pub(super) fn face_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        picture: PictureTarget<'_>,
        depth: &DepthBuffer,
        light_index: usize,
        plan: &FramePlan,
        draws: &VolumeDraws,
        of: VolumeUse,
    ) {
        let Some(extruded) = &self.extruded[light_index] else { return };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("faces"),
            color_attachments: &[Some(picture.attachment(wgpu::LoadOp::Clear(wgpu::Color::BLACK)))],
            depth_stencil_attachment: Some(depth.read_only()),
            ..Default::default()
        });
        let [left, top, width, height] = plan.scissor;
        pass.set_scissor_rect(left, top, width, height);
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        for (run, [in_front, behind]) in extruded.runs.iter().zip(&draws.runs) {
            for draw in in_front.iter().chain(behind).filter(|draw| draw.serves(of)) {
                let key: FaceKey = face_key(extruded, draw, of, false);
                let program = self.programs.get(&VolumeProgram::Faces(key), picture.format);
                draw_faces(&mut pass, run, draw, program);
            }
        }
    }
}

fn draw_faces(pass: &mut wgpu::RenderPass<'_>, run: &CountedRun, draw: &FaceDraw, program: &Program) {
    pass.set_pipeline(&program.pipeline);
    pass.set_bind_group(1, &run.group, &[]);
    match &run.indices {
        Some(indices) => {
            pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(draw.corners.clone(), 0, 0..draw.instances);
        }
        None => pass.draw(draw.corners.clone(), 0..draw.instances),
    }
}
