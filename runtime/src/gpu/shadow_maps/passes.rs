//! Passes that draw shadow maps and masks.

use super::MapRenderer;
use super::bindings::{blur_group, blur_layout};
use super::programs::{MapProgram, caster_key};
use super::textures::{CasterMask, MASK_FORMAT};
use crate::gpu::frame::{Batch, Phase, PictureTarget, Program, begin_color_pass, begin_depth_pass};
use crate::shadow_maps::{MapProjection, Variant};

impl MapRenderer<'_> {
    /// Batches that cast: all, or all but the ground.
    fn casters(&self) -> impl Iterator<Item = &Batch> {
        let casts = self.shadow_scene.ground.casts;
        self.all_casters().filter(move |batch| casts || !batch.key.is_ground)
    }

    /// Casters on the ground.
    fn casters_on_ground(&self) -> impl Iterator<Item = &Batch> {
        self.all_casters().filter(|batch| !batch.key.is_ground)
    }

    /// Batches that light does not pass.
    fn all_casters(&self) -> impl Iterator<Item = &Batch> {
        self.scene.batches.iter().chain(&self.scene.hidden).filter(|batch| !batch.key.is_passed)
    }

    /// Draws the maps and masks, unless those of the last frame serve.
    pub(super) fn shadow_passes(&mut self, encoder: &mut wgpu::CommandEncoder, maps: &[MapProjection]) {
        self.report.maps = maps.len();
        self.report.texels_m = maps.iter().map(|map| map.texel_m(map.middle_m())).collect();
        if self.settings.variant == Variant::Planar {
            let size = self.flat.as_ref().map_or([1; 2], |flat| flat.size);
            self.mask_pass(encoder, size);
            return;
        }
        if self.settings.optimizations.cache && self.drawn == maps {
            return;
        }
        self.report.drawn = maps.len();
        for index in 0..maps.len() {
            self.map_pass(encoder, index);
        }
        if self.reads.has_mask {
            self.mask_pass(encoder, [self.settings.size_texels; 2]);
            self.blur_passes(encoder);
        }
        self.drawn = maps.to_vec();
    }

    /// Programs that draw maps and masks do not depend on the picture's format.
    fn shadow_program(&self, key: MapProgram) -> &Program {
        self.programs.get(&key, MASK_FORMAT)
    }

    fn map_pass(&self, encoder: &mut wgpu::CommandEncoder, index: usize) {
        let Some(maps) = &self.maps else { return };
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &maps.layers[index],
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        };
        let mut pass = begin_depth_pass(encoder, "shadow map", depth, &self.clock, Phase::Maps);
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        pass.set_bind_group(1, self.bindings.matrix_group(index), &[]);
        for batch in self.casters() {
            self.scene.draw_depth(&mut pass, batch, self.shadow_program(MapProgram::Map(caster_key(&batch.key))));
        }
    }

    /// A mask of casters on the ground: as the sun sees it, or projected flat onto the ground as the camera sees it.
    fn mask_pass(&self, encoder: &mut wgpu::CommandEncoder, size: [u32; 2]) {
        let mask = self.mask.as_ref().map(|[mask, _]| mask).or(self.flat.as_ref());
        let Some(mask) = mask.filter(|mask| mask.size == size) else { return };
        let mut pass = begin_color_pass(encoder, "mask", cleared(mask), None, &self.clock, Phase::Maps);
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        pass.set_bind_group(1, self.bindings.matrix_group(0), &[]);
        for batch in self.casters_on_ground() {
            self.scene.draw_depth(&mut pass, batch, self.shadow_program(MapProgram::Mask(caster_key(&batch.key))));
        }
    }

    /// Blurs across, from the mask into its pair, and down, back into the mask.
    fn blur_passes(&self, encoder: &mut wgpu::CommandEncoder) {
        let Some([mask, pair]) = &self.mask else { return };
        let layout = blur_layout(self.gpu);
        let passes: [(&CasterMask, &CasterMask, bool); 2] = [(mask, pair, false), (pair, mask, true)];
        for (from, into, is_down) in passes {
            let group = blur_group(self.gpu, &layout, from);
            let mut pass = begin_color_pass(encoder, "blur", cleared(into), None, &self.clock, Phase::Maps);
            pass.set_pipeline(&self.shadow_program(MapProgram::Blur { is_down }).pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}

/// A mask in which nothing casts.
fn cleared(mask: &CasterMask) -> wgpu::RenderPassColorAttachment<'_> {
    PictureTarget { view: &mask.view, format: MASK_FORMAT }.attachment(wgpu::LoadOp::Clear(wgpu::Color::WHITE))
}
