//! Passes of a frame.

use super::super::batch::Batch;
use super::super::renderer::Output;
use super::super::scene::depth_key;
use super::super::stopwatch::Phase;
use super::super::target::{depths_drawn_into, drawn_into};
use super::MapRenderer;
use super::needs::MapNeeds;
use super::programs::{ProgramKey, Sun, caster_key};
use super::targets::{Mask, blur_group, blur_layout};
use crate::shadow_maps::{MapProjection, Variant};

impl MapRenderer<'_> {
    /// What casts on anything.
    pub(super) fn casters(&self) -> impl Iterator<Item = &Batch> {
        let casts = self.shadow_scene.ground.casts;
        self.scene.batches.iter().chain(&self.scene.hidden).filter(move |batch| casts || !batch.key.is_ground)
    }

    /// What casts on the ground.
    pub(super) fn casters_on_ground(&self) -> impl Iterator<Item = &Batch> {
        self.scene.batches.iter().chain(&self.scene.hidden).filter(|batch| !batch.key.is_ground)
    }

    /// Draws the maps, unless those that are there serve, and pictures of what casts.
    pub(super) fn shadow_passes(&mut self, encoder: &mut wgpu::CommandEncoder, maps: &[MapProjection]) {
        self.report.maps = maps.len();
        self.report.texels_m = maps.iter().map(|map| map.texel_m(map.middle_m())).collect();
        if self.settings.variant == Variant::Planar {
            let size = self.flat.as_ref().map_or([1; 2], |flat| flat.size);
            self.mask_pass(encoder, size);
            return;
        }
        if self.settings.means.cache && self.drawn == maps {
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

    fn map_pass(&mut self, encoder: &mut wgpu::CommandEncoder, index: usize) {
        let Some(depths) = &self.depths else { return };
        self.report.passes += 1;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow map"),
            depth_stencil_attachment: Some(depths_drawn_into(&depths.layers[index], wgpu::LoadOp::Clear(1.0))),
            timestamp_writes: self.stopwatch.as_mut().and_then(|stopwatch| stopwatch.time(Phase::Maps)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        pass.set_bind_group(1, self.bindings.view(index), &[]);
        for batch in self.casters() {
            self.scene.draw_depth(&mut pass, batch, &self.programs[&ProgramKey::Map(caster_key(&batch.key))]);
        }
    }

    /// A picture of what casts on the ground, on the first map's place or laid flat.
    fn mask_pass(&mut self, encoder: &mut wgpu::CommandEncoder, size: [u32; 2]) {
        let mask = self.mask.as_ref().map(|[mask, _]| mask).or(self.flat.as_ref());
        let Some(mask) = mask.filter(|mask| mask.size == size) else { return };
        self.report.passes += 1;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("what casts"),
            color_attachments: &[Some(drawn_into(&mask.view, wgpu::LoadOp::Clear(wgpu::Color::WHITE)))],
            timestamp_writes: self.stopwatch.as_mut().and_then(|stopwatch| stopwatch.time(Phase::Maps)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        pass.set_bind_group(1, self.bindings.view(0), &[]);
        for batch in self.casters_on_ground() {
            self.scene.draw_depth(&mut pass, batch, &self.programs[&ProgramKey::Mask(caster_key(&batch.key))]);
        }
    }

    /// From the mask across into its fellow, and back down.
    fn blur_passes(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let Some([mask, fellow]) = &self.mask else { return };
        let layout = blur_layout(self.gpu);
        let passes: [(&Mask, &Mask, bool); 2] = [(mask, fellow, false), (fellow, mask, true)];
        for (from, into, is_down) in passes {
            self.report.passes += 1;
            let group = blur_group(self.gpu, &layout, from);
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("blur"),
                color_attachments: &[Some(drawn_into(&into.view, wgpu::LoadOp::Clear(wgpu::Color::WHITE)))],
                timestamp_writes: self.stopwatch.as_mut().and_then(|stopwatch| stopwatch.time(Phase::Maps)),
                ..Default::default()
            });
            pass.set_pipeline(&self.programs[&ProgramKey::Blur { is_down }].pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    pub(super) fn depth_pass(&mut self, encoder: &mut wgpu::CommandEncoder, output: Output) {
        self.report.passes += 1;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("depth"),
            depth_stencil_attachment: Some(self.targets[&output].depth_attachment(wgpu::LoadOp::Clear(0.0))),
            timestamp_writes: self.stopwatch.as_mut().and_then(|stopwatch| stopwatch.time(Phase::Depth)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        for batch in &self.scene.batches {
            self.scene.draw_depth(&mut pass, batch, &self.programs[&ProgramKey::Depth(depth_key(&batch.key))]);
        }
    }

    pub(super) fn surface_pass(&mut self, encoder: &mut wgpu::CommandEncoder, output: Output, needs: &MapNeeds) {
        self.report.passes += 1;
        let clear = wgpu::LoadOp::Clear(output.background());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("surfaces"),
            color_attachments: &[Some(self.targets[&output].picture_attachment(clear))],
            depth_stencil_attachment: Some(self.targets[&output].depth_attachment(wgpu::LoadOp::Load)),
            timestamp_writes: self.stopwatch.as_mut().and_then(|stopwatch| stopwatch.time(Phase::Light)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        for batch in &self.scene.batches {
            let key = needs.surface_program_key(&self.scene.needs, &batch.key);
            if let ProgramKey::Surface(_, Sun::Maps | Sun::Mask | Sun::Flat, _) = key {
                pass.set_bind_group(3, self.read_group.as_ref().map(|(group, _)| group), &[]);
            }
            match output {
                Output::Visibility => self.scene.draw_without_page(&mut pass, batch, &self.programs[&key]),
                Output::Lit | Output::LampVisibility => {
                    self.scene.draw_surface(&mut pass, batch, &self.programs[&key]);
                }
            }
        }
        if let Some(sky) = self.programs.get(&ProgramKey::Sky).filter(|_| output == Output::Lit) {
            pass.set_pipeline(&sky.pipeline);
            pass.draw(0..3, 0..1);
        }
    }
}
