//! Starting a command, and turning its end into an exit code.

use super::remedies::with_remedy;
use super::{Failure, print, tell};
use crate::BakeError;
use clap::Parser;
use clap::error::ErrorKind;
use std::panic::AssertUnwindSafe;
use std::process::ExitCode;

/// One of the two commands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Command {
    /// Bakes.
    Sunbake,
    /// Plays back.
    Sunplay,
}

impl Command {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sunbake => "sunbake",
            Self::Sunplay => "sunplay",
        }
    }

    /// Parses the options that the process was started with, works, and says what went wrong. Without options it prints
    /// `basics`.
    pub fn run<Options: Parser>(self, basics: &str, work: impl FnOnce(Options) -> Result<(), Failure>) -> ExitCode {
        if std::env::args_os().len() < 2 {
            return self.report(|| print(basics));
        }
        match parse() {
            Ok(options) => self.report(|| work(options)),
            Err(error) => self.explain::<Options>(&error),
        }
    }

    /// Works, and turns the end into an exit code. A panic is a defect of ours, and is said to be one.
    fn report(self, work: impl FnOnce() -> Result<(), Failure>) -> ExitCode {
        match std::panic::catch_unwind(AssertUnwindSafe(work)) {
            Ok(Ok(())) => ExitCode::SUCCESS,
            Ok(Err(Failure { code, message, remedy })) => {
                tell(&format!("{}: {}", self.name(), with_remedy(message, remedy.as_ref(), self)));
                ExitCode::from(code)
            }
            Err(_) => {
                let name = self.name();
                tell(&format!("{name}: this is a defect in {name}: report it with the message above and the scene"));
                ExitCode::from(4)
            }
        }
    }

    /// Prints what clap found. Help and version are no failure.
    fn explain<Options: Parser>(self, error: &clap::Error) -> ExitCode {
        if !error.use_stderr() || error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
            // If even this cannot be printed, there is nobody to tell.
            let _ = error.print();
            return ExitCode::from(u8::from(error.use_stderr()));
        }
        let given = std::env::args().nth(1).unwrap_or_default();
        let is_known = Options::command().find_subcommand(&given).is_some();
        let help = if is_known { format!("{} {given}", self.name()) } else { self.name().to_owned() };
        tell(&format!("{}: {}; `{help} --help` tells more", self.name(), mistake(&error.to_string())));
        ExitCode::from(1)
    }
}

/// Reads the options that the process was started with. Negative numbers are values, so that it is said which are
/// allowed.
fn parse<Options: Parser>() -> Result<Options, clap::Error> {
    let negative = |arg: clap::Arg| {
        let takes_value = !arg.is_positional() && arg.get_action().takes_values();
        if takes_value { arg.allow_negative_numbers(true) } else { arg }
    };
    let mut command = Options::command().mut_subcommands(|command| command.mut_args(negative));
    let mut matches = command.try_get_matches_from_mut(std::env::args_os())?;
    Options::from_arg_matches_mut(&mut matches).map_err(|error| error.format(&mut command))
}

/// What is wrong with a command line, in one line: what clap says without its usage, and the standard library's words
/// for numbers in plainer ones.
fn mistake(text: &str) -> String {
    let is_told = |part: &&str| !["Usage:", "For more information"].iter().any(|start| part.starts_with(start));
    let parts = text.split("\n\n").map(str::trim).filter(is_told).filter(|part| !part.is_empty());
    let line = |part: &str| {
        let part = part.trim_start_matches("error: ").trim_start_matches("tip: ");
        part.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let text = parts.map(line).collect::<Vec<_>>().join("; ");
    let plainer = [
        ("invalid digit found in string", "it is not a whole number"),
        ("cannot parse integer from empty string", "it is empty"),
        ("number too large to fit in target type", "it is too large"),
        ("number too small to fit in target type", "it is too small"),
    ];
    plainer.into_iter().fold(text, |text, (from, to)| text.replace(from, to))
}

/// Sets the number of threads of everything that is done without a thread pool of its own; 0 is one per core.
pub fn set_threads(threads: usize) -> Result<(), Failure> {
    if threads == 0 {
        return Ok(());
    }
    let pool = crate::bake::of_threads(threads)?.build_global();
    Ok(pool.map_err(|error| BakeError::Threads { threads, reason: error.to_string() })?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_end_has_its_exit_code() {
        let text = |code: ExitCode| format!("{code:?}");
        let report = |work: fn() -> Result<(), Failure>| text(Command::Sunbake.report(work));
        assert_eq!(report(|| Ok(())), text(ExitCode::SUCCESS));
        assert_eq!(report(|| Err(Failure::usage("no"))), text(ExitCode::from(1)));
        assert_eq!(report(|| Err(Failure::io("no"))), text(ExitCode::from(2)));
        assert_eq!(report(|| panic!("a defect")), text(ExitCode::from(4)));
    }

    #[test]
    fn a_mistake_is_told_in_one_line_with_the_tip() {
        let text = "error: unexpected argument '--forse' found\n\n  tip: a similar argument exists: '--force'\n\n\
                    Usage: sunbake bake --force <SCENE>\n\nFor more information, try '--help'.\n";
        assert_eq!(mistake(text), "unexpected argument '--forse' found; a similar argument exists: '--force'");
        let number = "a".parse::<u32>().unwrap_err();
        let text = format!("error: invalid value 'a' for '--size <N>': {number}\n");
        assert_eq!(mistake(&text), "invalid value 'a' for '--size <N>': it is not a whole number");
    }
}
