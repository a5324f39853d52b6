//! Writes the sample scene: `make-assets [FILE]`, by default `gas_station.glb` beside this crate's manifest.

#![forbid(unsafe_code)]

use std::process::ExitCode;

const DEFAULT_FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/gas_station.glb");

fn main() -> ExitCode {
    let file = std::env::args_os().nth(1).unwrap_or_else(|| DEFAULT_FILE.into());
    let bytes = sunbake_assets::gas_station();
    match std::fs::write(&file, &bytes) {
        Ok(()) => {
            println!("wrote {} ({} bytes)", file.display(), bytes.len());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("cannot write {}: {error}", file.display());
            ExitCode::FAILURE
        }
    }
}
