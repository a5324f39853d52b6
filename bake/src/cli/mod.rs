//! The command line: options, and what each command does with them. `sunbake::console` is the rest.

mod args;
mod bake;
mod cost;
mod inspect;
mod inspect_scene;
mod summary;
mod texels;
mod values;

use args::{Args, Command};
use std::process::ExitCode;
use sunbake::console;

/// What `sunbake` alone prints.
const BASICS: &str = "\
sunbake bakes when every texel of a glTF scene sees the sun.

  sunbake bake scene.glb -o baked --place 48.2,16.4 --date 2026-06-21
  sunbake inspect baked            what a set holds, what it cost, what it lost
  sunbake inspect scene.glb        what a scene has to name, for --leave-out, --no-cast and --density
  sunbake texels baked --count 9   some of its texels, to check with your own ray tracer
  sunbake cost scene.glb -o report what accuracy costs on a scene and this machine
  sunbake bake --help              every option
";

/// Runs the command that the process was started with.
pub fn run() -> ExitCode {
    console::Command::Sunbake.run(BASICS, |args: Args| match args.command {
        Command::Bake(args) => bake::run(&args),
        Command::Inspect(args) => inspect::run(&args),
        Command::Texels(args) => texels::run(&args),
        Command::Cost(args) => cost::run(&args),
    })
}
