//! What all renderers share: a stage's buffers and textures, pipelines, targets, passes and readback.

mod batch;
mod blended;
mod buffers;
mod output;
mod page_textures;
mod pass_clock;
mod passes;
mod program;
mod program_table;
pub mod readback;
mod scene;
mod target;
mod textures;

pub use batch::{Batch, BatchKey, BatchRequest, TextureSet, by_key};
pub use blended::BlendedDraws;
pub use buffers::write_in_order;
pub use output::Output;
pub use page_textures::texture;
pub use pass_clock::{FrameTimes, PassClock, Phase};
pub use passes::{FrameTarget, begin_color_pass, begin_depth_pass};
pub use program::{
    PipelineState, Program, ShaderStages, depth_state, lit_state, sky_program, surface_stages, surface_state,
};
pub use program_table::{ProgramKey, ProgramTable, with_pipelines};
pub use scene::{SceneOnGpu, depth_key};
pub use target::{DEPTH_FORMAT, DepthBuffer, OwnTargets, PictureTarget, STENCIL_FORMAT};
pub use textures::TextureImage;
