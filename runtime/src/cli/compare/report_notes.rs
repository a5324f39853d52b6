//! What a report says of the scene, of the machine and of itself.

use super::args::CompareArgs;
use super::inputs::ComparisonInputs;
use std::path::Path;
use sunbake::maps::Bits;
use sunbake::report::Machine;
use sunbake::scene::Alpha;
use sunbake_runtime::compare::report::{MachineEntry, SceneEntry};
use sunbake_runtime::compare::{Playback, TechniqueSpec};
use sunbake_runtime::gpu::Gpu;

/// The scene, and the sets of it.
pub fn scene_entry(args: &CompareArgs, inputs: &ComparisonInputs) -> SceneEntry {
    SceneEntry {
        name: name_of(&args.source),
        sha256: inputs.source_sha256.clone(),
        triangles: inputs.stage.scene.triangle_count() as u64,
        sets: inputs.sets.iter().map(|set| set.entry.clone()).collect(),
    }
}

/// What a file or a folder is called, also where it is named by dots.
fn name_of(source: &Path) -> String {
    let whole = source.canonicalize().unwrap_or_else(|_| source.to_owned());
    whole.file_name().map_or_else(|| source.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// This machine, and what draws on it.
pub fn machine(args: &CompareArgs, gpu: Option<&Gpu>) -> MachineEntry {
    let Machine { cpu, cores, threads, os } = Machine::here(args.threads);
    MachineEntry {
        cpu,
        cores: cores as u64,
        threads: threads as u64,
        os,
        adapter: gpu.map(|gpu| gpu.name.clone()),
        is_software: gpu.is_some_and(|gpu| gpu.is_software),
    }
}

/// What makes the numbers worth less than they look.
pub fn warnings(gpu: Option<&Gpu>) -> Vec<String> {
    let warning = match gpu {
        None => {
            "No GPU adapter drew: only what the CPU can draw was compared, and times are those of a CPU from call to picture."
        }
        Some(gpu) if gpu.is_software => {
            "The adapter is a CPU that plays a GPU. Errors come near a GPU's; times do not, and even their order may differ there."
        }
        Some(_) => return Vec::new(),
    };
    vec![warning.into()]
}

/// How to read the numbers.
pub fn notes(inputs: &ComparisonInputs) -> Vec<String> {
    let has = |is: fn(&TechniqueSpec) -> bool| inputs.techniques.iter().any(is);
    let has_alpha_mask =
        inputs.stage.scene.materials.iter().any(|material| matches!(material.alpha, Alpha::Cut { .. }));
    let mut notes = Vec::new();
    if has(|one| matches!(one, TechniqueSpec::Baked(Playback { bits: Bits::Eight, .. }))) {
        let are_made = inputs.sets.iter().any(|set| set.entry.bits == 16);
        notes.extend(are_made.then(|| "Times of 8 bits are those of 16 bits, rounded again.".to_owned()));
    }
    if has(|one| matches!(one, TechniqueSpec::Volumes(_))) && has_alpha_mask {
        notes.push(
            "Shadow volumes cast whole cards where leaves are cut out of them: part of their error is that.".into(),
        );
    }
    if has(TechniqueSpec::is_hard) {
        notes.push(
            "What takes the sun for a point has no penumbras: held against the disc it errs there however well it works. How far \
             it is from truth of the sun's centre stands beside it."
                .into(),
        );
    }
    notes.push(
        "Times are of a sun that moves: shadow maps and silhouettes are found anew for each frame, as they are not where it \
         stands still. All but rays draw the same depths and surfaces; a ray's time is the CPU's, once it is known what each pixel \
         shows. Visibility alone is drawn, not the lit picture."
            .into(),
    );
    notes
}
