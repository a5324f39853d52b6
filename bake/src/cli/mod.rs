//! The command line: parse, run, print what went wrong, exit.

mod args;
mod bake;
mod cost;
mod exit;
mod inspect;
mod out;
mod summary;
mod terminal;
mod texels;

use args::{Args, Command};
use clap::Parser;
use std::process::ExitCode;

/// What `sunbake` alone prints.
const BASICS: &str = "\
sunbake bakes when every texel of a glTF scene sees the sun.

  sunbake bake scene.glb -o baked --place 48.2,16.4 --date 2026-06-21
  sunbake inspect baked            what a set holds, what it cost, what it lost
  sunbake texels baked --count 9   some of its texels, to check with your own ray tracer
  sunbake cost scene.glb -o report what accuracy costs on a scene and this machine
  sunbake bake --help              every option
";

/// Runs the command that the process was started with.
pub fn run() -> ExitCode {
    if std::env::args_os().len() < 2 {
        return exit::report(|| out::print(BASICS));
    }
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(error) => return exit::usage(&error),
    };
    exit::report(|| match args.command {
        Command::Bake(args) => bake::run(&args),
        Command::Inspect(args) => inspect::run(&args),
        Command::Texels(args) => texels::run(&args),
        Command::Cost(args) => cost::run(&args),
    })
}
