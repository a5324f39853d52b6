//! What is drawn of the volumes for a view.

use super::extruded::{CountedRun, Extruded};
use crate::volumes::{FramePlan, Part, VolumeOptimizations};
use std::ops::Range;
use sunbake_shaders::{VolumeCorners, VolumeUse};

/// One draw call over faces of volumes.
#[derive(Debug, Clone)]
pub struct FaceDraw {
    /// Which part, where the vertex shader finds silhouettes; else walls, or what is spared.
    pub part: Part,
    /// Vertices, or indices where the CPU listed them.
    pub corners: Range<u32>,
    /// Instances: as many walls as an edge may need where the vertex shader finds silhouettes, else 1.
    pub instances: u32,
}

impl FaceDraw {
    /// Whether it is drawn for this. Only counts spare.
    pub fn serves(&self, of: VolumeUse) -> bool {
        of == VolumeUse::Stencil || self.part != Part::Spared
    }
}

/// Draw calls of each run.
pub struct VolumeDraws {
    /// For each run, what is counted in front of the surface, and what behind it.
    pub runs: Vec<[Vec<FaceDraw>; 2]>,
}

impl VolumeDraws {
    /// The draws of a plan.
    pub fn new(extruded: &Extruded, plan: &FramePlan, optimizations: VolumeOptimizations) -> Self {
        let of_run = |run| [true, false].map(|is_z_pass| draws(extruded, run, plan, is_z_pass, optimizations));
        let runs = match plan.draws_anything() {
            true => extruded.runs.iter().map(of_run).collect(),
            false => Vec::new(),
        };
        Self { runs }
    }

    /// All draws, and whether each is counted in front of the surface.
    pub fn all(&self) -> impl Iterator<Item = (&FaceDraw, bool)> {
        self.runs.iter().flat_map(|[in_front, behind]| {
            in_front.iter().map(|draw| (draw, true)).chain(behind.iter().map(|draw| (draw, false)))
        })
    }

    /// Number of triangles, all instances counted.
    pub fn triangles(&self) -> usize {
        self.all().map(|(draw, _)| draw.corners.len() * draw.instances as usize).sum::<usize>() / 3
    }
}

fn draws(
    extruded: &Extruded,
    run: &CountedRun,
    plan: &FramePlan,
    is_z_pass: bool,
    optimizations: VolumeOptimizations,
) -> Vec<FaceDraw> {
    let draw = |part, instances| move |corners| FaceDraw { part, corners, instances };
    let all_of = |parts: &[Part]| plan.ranges(&run.parts, is_z_pass, parts, |_| true).into_iter();
    // What is spared is taken from the whole count of its run, which has the whole caster if it can.
    let spared = all_of(&[Part::Spared]).map(draw(Part::Spared, 1));
    if extruded.kind.1 == VolumeCorners::Indexed {
        return all_of(&Part::FACES).map(draw(Part::Walls, 1)).chain(spared).collect();
    }
    let walls = |doubles: bool| {
        let is_wanted = |caster| extruded.may_double(caster, optimizations) == doubles;
        let ranges = plan.ranges(&run.parts, is_z_pass, &[Part::Walls], is_wanted);
        ranges.into_iter().map(draw(Part::Walls, 1 + u32::from(doubles)))
    };
    let caps = [Part::Caps, Part::DarkCaps].into_iter().flat_map(|part| all_of(&[part]).map(draw(part, 1)));
    walls(false).chain(walls(true)).chain(caps).chain(spared).collect()
}
