//! The passes that all renderers have: depths, and surfaces.

use super::pass_clock::{PassClock, Phase};
use super::program::Program;
use super::target::{DepthBuffer, PictureTarget};
use super::{Batch, BatchKey, Output, SceneOnGpu, depth_key};

/// What the passes of a frame draw into, and what counts and times them.
pub struct FrameTarget<'a> {
    /// Lit scene, or visibility of one light.
    pub output: Output,
    /// The colour target of the frame's passes.
    pub picture: PictureTarget<'a>,
    /// The depth buffer of the frame's passes.
    pub depth: DepthBuffer,
    /// Counts and times passes.
    pub clock: &'a PassClock,
}

impl FrameTarget<'_> {
    /// Finds the nearest surfaces. A stencil is cleared on the way.
    pub fn depth_pass<'p>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &SceneOnGpu,
        program: impl Fn(&BatchKey) -> &'p Program,
    ) {
        let mut pass = begin_depth_pass(encoder, "depth", self.depth.cleared(), self.clock, Phase::Depth);
        pass.set_bind_group(0, &scene.frame.group, &[]);
        for batch in scene.solid(self.output) {
            scene.draw_depth(&mut pass, batch, program(&depth_key(&batch.key)));
        }
    }

    /// Draws surfaces where depths are equal, the sky where there is one, and then what `finish` draws.
    pub fn surface_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &SceneOnGpu,
        draw: impl Fn(&mut wgpu::RenderPass<'_>, &Batch),
        sky: Option<&Program>,
        finish: impl FnOnce(&mut wgpu::RenderPass<'_>),
    ) {
        let color = self.picture.attachment(wgpu::LoadOp::Clear(self.output.background()));
        let depth = Some(self.depth.read_only());
        let mut pass = begin_color_pass(encoder, "surfaces", color, depth, self.clock, Phase::Light);
        pass.set_bind_group(0, &scene.frame.group, &[]);
        scene.solid(self.output).for_each(|batch| draw(&mut pass, batch));
        if let Some(sky) = sky {
            pass.set_pipeline(&sky.pipeline);
            pass.draw(0..3, 0..1);
        }
        finish(&mut pass);
    }
}

/// Begins a pass that is counted and timed, into depths or a stencil alone.
pub fn begin_depth_pass<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    label: &str,
    depth: wgpu::RenderPassDepthStencilAttachment<'_>,
    clock: &PassClock,
    phase: Phase,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        depth_stencil_attachment: Some(depth),
        timestamp_writes: clock.pass(phase),
        ..Default::default()
    })
}

/// Begins a pass that is counted and timed, into a picture.
pub fn begin_color_pass<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    label: &str,
    color: wgpu::RenderPassColorAttachment<'_>,
    depth: Option<wgpu::RenderPassDepthStencilAttachment<'_>>,
    clock: &PassClock,
    phase: Phase,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(color)],
        depth_stencil_attachment: depth,
        timestamp_writes: clock.pass(phase),
        ..Default::default()
    })
}
