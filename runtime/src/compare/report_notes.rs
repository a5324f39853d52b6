//! What a report says of the scene, of the machine and of its own numbers.

use super::inputs::ComparisonInputs;
use super::report::{MachineEntry, SceneEntry};
use super::{Playback, TechniqueSpec};
use crate::gpu::Gpu;
use std::path::Path;
use sunbake::maps::Bits;
use sunbake::report::Machine;
use sunbake::scene::Alpha;

const NO_ADAPTER: &str = "No GPU adapter drew: only what the CPU can draw was compared, and times are those of a CPU \
                          from call to picture.";
const SOFTWARE_ADAPTER: &str = "The adapter is a software GPU, which runs on the CPU. Its errors are close to a real \
                                GPU's; its times are not, and even their order may differ there.";
const EIGHT_BITS: &str = "Times of 8 bits are those of 16 bits, rounded again.";
const WHOLE_CARDS: &str = "Shadow volumes ignore alpha masks, so a leaf casts the shadow of its whole card: part of \
                           their error is that.";
const HARD: &str = "Techniques that take the sun for a point draw no penumbras. Against the sun's disc they have \
                    errors there however well they work. Their error against truth of the sun's centre stands beside.";
const TIMES: &str = "Times are of a sun that moves: shadow maps and silhouettes are computed again for each frame; \
                     under a sun that stands still they would be kept. All techniques but rays draw the same depths \
                     and surfaces. A ray's time is the CPU's, once it is known which surface each pixel shows. Only \
                     visibility is drawn, not the lit picture.";

/// The scene, and the sets of it.
pub(super) fn scene_entry(inputs: &ComparisonInputs) -> SceneEntry {
    SceneEntry {
        name: name_of(&inputs.source),
        sha256: inputs.source_sha256.clone(),
        triangles: inputs.stage.scene.triangle_count() as u64,
        sets: inputs.sets.iter().map(|set| set.entry.clone()).collect(),
    }
}

/// The name of a file or a folder, also where the path is `.` or `..`.
fn name_of(source: &Path) -> String {
    let whole = source.canonicalize().unwrap_or_else(|_| source.to_owned());
    whole.file_name().map_or_else(|| source.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// This machine, and what draws on it. 0 threads are one per core.
pub(super) fn machine(threads: usize, gpu: Option<&Gpu>) -> MachineEntry {
    let Machine { cpu, cores, threads, os } = Machine::here(threads);
    MachineEntry {
        cpu,
        cores: cores as u64,
        threads: threads as u64,
        os,
        adapter: gpu.map(|gpu| gpu.name.clone()),
        is_software: gpu.is_some_and(|gpu| gpu.is_software),
    }
}

/// Why some of the numbers are worth less than they look.
pub(super) fn warnings(gpu: Option<&Gpu>) -> Vec<String> {
    match gpu {
        None => vec![NO_ADAPTER.into()],
        Some(gpu) if gpu.is_software => vec![SOFTWARE_ADAPTER.into()],
        Some(_) => Vec::new(),
    }
}

/// How to read the numbers.
pub(super) fn notes(inputs: &ComparisonInputs) -> Vec<String> {
    let has = |is: fn(&TechniqueSpec) -> bool| inputs.techniques.iter().any(is);
    let has_eight_bits = has(|one| matches!(one, TechniqueSpec::Baked(Playback { bits: Bits::Eight, .. })));
    let has_sixteen_bits = inputs.sets.iter().any(|set| set.entry.bits == 16);
    let has_volumes = has(|one| matches!(one, TechniqueSpec::Volumes(_)));
    let materials = &inputs.stage.scene.materials;
    let has_alpha_mask = materials.iter().any(|material| matches!(material.alpha, Alpha::Mask { .. }));
    let notes = [
        (has_eight_bits && has_sixteen_bits).then_some(EIGHT_BITS),
        (has_volumes && has_alpha_mask).then_some(WHOLE_CARDS),
        has(TechniqueSpec::is_hard).then_some(HARD),
        Some(TIMES),
    ];
    notes.into_iter().flatten().map(str::to_owned).collect()
}
