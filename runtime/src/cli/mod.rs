//! The command line: options, and what each command does with them. `sunbake::console` is the rest.

mod args;
mod compare;
mod demo;
mod draw;
mod files;
mod frame;
mod frames;
mod no_display;
mod no_effect;
mod place;
mod values;
mod when;

use args::{Args, Command};
use std::process::ExitCode;
use sunbake::console;

/// What `sunplay` alone prints.
const BASICS: &str = "\
sunplay plays sunbake's maps back at any time of the day.

  sunplay demo                                    bake our own scene and see its day, beside truth
  sunplay frame baked --at 17:30 -o evening.png   one picture
  sunplay frames baked --count 12 -o day          a day: pictures, a contact sheet, an animation
  sunplay compare baked -o report                 what the bake loses, and what live shadows cost
  sunplay frame --help                            every option
";

/// Runs the command that the process was started with.
pub fn run() -> ExitCode {
    no_display::answer_that_there_is_none();
    console::Command::Sunplay.run(BASICS, |args: Args| match args.command {
        Command::Frame(args) => frame::run(&args),
        Command::Frames(args) => frames::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Demo(args) => demo::run(&args),
    })
}
