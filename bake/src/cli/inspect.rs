//! `sunbake inspect` of a set.

use super::args::InspectArgs;
use super::{inspect_scene, summary};
use sunbake::console::{Failure, print, print_json};
use sunbake::disk::read::read;

/// Prints a set's manifest, whole or in words; the textures are read too, so that a broken set does not pass. Of a
/// scene, what it has to name.
pub fn run(args: &InspectArgs) -> Result<(), Failure> {
    if args.set.is_file() {
        return inspect_scene::run(&args.set, args.json);
    }
    let manifest = read(&args.set)?.manifest;
    if args.json {
        return print_json(&manifest);
    }
    let heading = format!("{}: baked from {} by {}\n", args.set.display(), manifest.source.file, manifest.generator);
    print(
        &(heading
            + &summary::of(&manifest)
            + &summary::step_seconds(&manifest.stats.seconds)
            + &summary::effects(&manifest.effects)),
    )
}
