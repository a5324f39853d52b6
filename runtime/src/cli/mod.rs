//! The command line: parse, run, print what went wrong, exit.

mod args;
mod compare;
mod demo;
mod draw;
mod exit;
mod files;
mod frame;
mod frames;
mod out;
mod place;
mod terminal;
mod when;

use args::{Args, Command};
use clap::Parser;
use std::process::ExitCode;

/// What `sunplay` alone prints.
const BASICS: &str = "\
sunplay plays sunbake's maps back at any time of the day.

  sunplay demo                                    bake our own scene and see its day, beside truth
  sunplay frame baked --at 17:30 -o evening.png   one picture
  sunplay frames baked --count 12 -o day          a day: pictures, a contact sheet, an animation
  sunplay compare baked -o report                 what the bake loses, and what live shadows cost
  sunplay frame --help                            every option";

/// Runs the command that the process was started with.
pub fn run() -> ExitCode {
    if std::env::args_os().len() < 2 {
        println!("{BASICS}");
        return ExitCode::SUCCESS;
    }
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(error) => return exit::usage(&error),
    };
    exit::report(|| match args.command {
        Command::Frame(args) => frame::run(&args),
        Command::Frames(args) => frames::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Demo(args) => demo::run(&args),
    })
}
