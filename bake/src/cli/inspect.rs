//! `sunbake inspect`.

use super::args::InspectArgs;
use super::summary;
use sunbake::console::{Failure, print, print_json};
use sunbake::disk::read::read;

/// Prints a set's manifest, whole or in words. The textures are read too, so that a broken set does not pass.
pub fn run(args: &InspectArgs) -> Result<(), Failure> {
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
