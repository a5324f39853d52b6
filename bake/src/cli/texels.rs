//! `sunbake texels`: covered texels as JSON lines, for checking a bake with another ray tracer.

use super::args::TexelsArgs;
use sunbake::console::{Failure, print};
use sunbake::disk::read::read;
use sunbake::texels::draw;

/// Prints `--count` texels drawn by `--seed`.
pub fn run(args: &TexelsArgs) -> Result<(), Failure> {
    let set = read(&args.set)?;
    let texels = draw(&set, args.count as usize, args.seed).map_err(sunbake::BakeError::from)?;
    let mut lines = String::new();
    for texel in &texels {
        lines += &serde_json::to_string(texel).map_err(|e| Failure::io(e.to_string()))?;
        lines.push('\n');
    }
    print(&lines)
}
