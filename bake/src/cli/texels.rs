//! `sunbake texels`: covered texels as JSON lines, for checking a bake with another ray tracer.

use super::args::TexelsArgs;
use super::exit::Failure;
use std::io::{BufWriter, Write};
use sunbake::disk::read::read;
use sunbake::texels::draw;

/// Prints `--count` texels drawn by `--seed`.
pub fn run(args: &TexelsArgs) -> Result<(), Failure> {
    let set = read(&args.set)?;
    let texels = draw(&set, args.count, args.seed).map_err(sunbake::BakeError::from)?;
    let mut out = BufWriter::new(std::io::stdout().lock());
    let print = |texels: &[sunbake::texels::Texel], out: &mut dyn Write| -> std::io::Result<()> {
        for texel in texels {
            serde_json::to_writer(&mut *out, texel)?;
            out.write_all(b"\n")?;
        }
        out.flush()
    };
    match print(&texels, &mut out) {
        // A reader that has seen enough is no failure.
        Err(e) if e.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(|e| Failure::io(format!("cannot print texels: {e}"))),
    }
}
