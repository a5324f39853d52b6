//! `sunplay`: plays baked sets back.

mod cli;

fn main() -> std::process::ExitCode {
    cli::run()
}
