//! Passes of a frame.

use super::super::renderer::Output;
use super::super::scene::depth_key;
use super::super::stopwatch::Phase;
use super::super::target::drawn_into;
use super::buffers::{DrawCall, Draws, Run};
use super::programs::{KEPT, ProgramKey, hard_key, volume_key};
use super::{Shining, VolumeRenderer};
use crate::volumes::FramePlan;
use sunbake_shaders::VolumeUse;

/// Where in a frame a light's pass stands.
#[derive(Debug, Clone, Copy)]
pub struct Ends {
    /// Nothing has been drawn into the picture.
    pub is_first: bool,
    /// Nothing will be.
    pub is_last: bool,
}

impl VolumeRenderer<'_> {
    /// Depths of surfaces; the stencil is cleared on the way.
    pub(super) fn depth_pass(&mut self, encoder: &mut wgpu::CommandEncoder, output: Output) {
        self.report.passes += 1;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("depth"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.targets[&output].depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
            }),
            timestamp_writes: self.stopwatch.as_mut().and_then(|stopwatch| stopwatch.time(Phase::Depth)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        for batch in &self.scene.batches {
            self.scene.draw_depth(&mut pass, batch, &self.programs[&ProgramKey::Depth(depth_key(&batch.key))]);
        }
    }

    /// What comes from all around, what glows, and what is behind.
    pub(super) fn around_pass(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.report.passes += 1;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("all around"),
            color_attachments: &[Some(drawn_into(
                &self.targets[&Output::Lit].view,
                wgpu::LoadOp::Clear(wgpu::Color::BLACK),
            ))],
            depth_stencil_attachment: Some(untouched(&self.targets[&Output::Lit].depth)),
            timestamp_writes: self.stopwatch.as_mut().and_then(|stopwatch| stopwatch.time(Phase::Light)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        for batch in &self.scene.batches {
            let program = &self.programs[&ProgramKey::Around(self.scene.surface_key(&batch.key))];
            self.scene.draw_surface(&mut pass, batch, program);
        }
        pass.set_pipeline(&self.programs[&ProgramKey::Sky].pipeline);
        pass.draw(0..3, 0..1);
    }

    /// Counts a light's volumes in the stencil.
    pub(super) fn volume_pass(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        output: Output,
        slot: usize,
        plan: &FramePlan,
        draws: &Draws,
    ) {
        let Some(extruded) = &self.extruded[slot] else { return };
        self.report.passes += 1;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("volumes"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.targets[&output].depth,
                depth_ops: None,
                stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
            }),
            timestamp_writes: self.stopwatch.as_mut().and_then(|stopwatch| stopwatch.time(Phase::Volumes)),
            ..Default::default()
        });
        let [left, top, width, height] = plan.scissor;
        pass.set_scissor_rect(left, top, width, height);
        pass.set_stencil_reference(KEPT);
        for (i, (run, draws)) in extruded.runs.iter().zip(&draws.runs).enumerate() {
            pass.set_bind_group(0, &self.scene.frame.group, &[]);
            for (draw, is_z_pass) in [(&draws[0], true), (&draws[1], false)] {
                for draw in draw {
                    let key = volume_key(extruded, draw.part, VolumeUse::Stencil, is_z_pass);
                    self.draw_faces(&mut pass, run, draw, ProgramKey::Volume(key));
                }
            }
            if i + 1 < extruded.runs.len() {
                pass.set_pipeline(&self.programs[&ProgramKey::Keep].pipeline);
                pass.draw(0..3, 0..1);
            }
        }
    }

    fn draw_faces(&self, pass: &mut wgpu::RenderPass<'_>, run: &Run, draw: &DrawCall, key: ProgramKey) {
        pass.set_pipeline(&self.programs[&key].pipeline);
        pass.set_bind_group(1, &run.group, &[]);
        match &run.indices {
            Some(indices) => {
                pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(draw.corners.clone(), 0, 0..draw.instances);
            }
            None => pass.draw(draw.corners.clone(), 0..draw.instances),
        }
    }

    /// What a light adds where nothing was counted, and in the last pass of a picture of visibility what is behind it.
    pub(super) fn light_pass(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        output: Output,
        shining: Option<(&Shining, bool)>,
        ends: Ends,
    ) {
        self.report.passes += 1;
        let is_mask = output != Output::Lit;
        let load = match is_mask && ends.is_first {
            true => wgpu::LoadOp::Clear(wgpu::Color::BLACK),
            false => wgpu::LoadOp::Load,
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("light"),
            color_attachments: &[Some(drawn_into(&self.targets[&output].view, load))],
            depth_stencil_attachment: Some(match shining {
                // Nothing was counted for this light: what an earlier one left is in the way.
                Some((_, false)) => cleared(&self.targets[&output].depth),
                _ => untouched(&self.targets[&output].depth),
            }),
            timestamp_writes: self.stopwatch.as_mut().and_then(|stopwatch| stopwatch.time(Phase::Light)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        if let Some((shining, _)) = shining {
            let share = f64::from(shining.share);
            pass.set_blend_constant(wgpu::Color { r: share, g: share, b: share, a: share });
            for batch in &self.scene.batches {
                let key = ProgramKey::Light(shining.hard, shining.added, hard_key(&batch.key));
                self.scene.draw_without_page(&mut pass, batch, &self.programs[&key]);
            }
        }
        if is_mask && ends.is_last {
            pass.set_pipeline(&self.programs[&ProgramKey::Background].pipeline);
            pass.draw(0..3, 0..1);
        }
    }

    /// Draws faces into the picture.
    pub(super) fn face_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        output: Output,
        slot: usize,
        plan: &FramePlan,
        draws: &Draws,
        of: VolumeUse,
    ) {
        let Some(extruded) = &self.extruded[slot] else { return };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("faces"),
            color_attachments: &[Some(drawn_into(
                &self.targets[&output].view,
                wgpu::LoadOp::Clear(wgpu::Color::BLACK),
            ))],
            depth_stencil_attachment: Some(untouched(&self.targets[&output].depth)),
            ..Default::default()
        });
        let [left, top, width, height] = plan.scissor;
        pass.set_scissor_rect(left, top, width, height);
        pass.set_bind_group(0, &self.scene.frame.group, &[]);
        for (run, [before, behind]) in extruded.runs.iter().zip(&draws.runs) {
            for draw in before.iter().chain(behind) {
                let key = volume_key(extruded, draw.part, of, false);
                self.draw_faces(&mut pass, run, draw, ProgramKey::Volume(key));
            }
        }
    }
}

/// Depth and stencil that are only read.
fn untouched(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops: None, stencil_ops: None }
}

/// Depth that is only read, and a stencil in which nothing is counted.
fn cleared(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    let stencil_ops = Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store });
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops: None, stencil_ops }
}
