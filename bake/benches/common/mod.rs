//! What the benches share: scenes and a day.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use sunbake::sun::{DayOutcome, DayRequest, SunPath, day};

/// Our own scene and those of the shared ones (paths in their folder) that are on this machine; says which are not.
pub fn scenes(shared: &[&str]) -> Vec<PathBuf> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/gas_station.glb");
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    let folder = std::env::var_os("SUNBAKE_SHARED").map_or_else(beside, PathBuf::from).join("scenes");
    let (present, absent): (Vec<_>, Vec<_>) = shared.iter().map(|name| folder.join(name)).partition(|f| f.is_file());
    absent.iter().for_each(|file| println!("not on this machine: {}", file.display()));
    std::iter::once(own).chain(present).collect()
}

/// A long day in the desert.
#[allow(dead_code, reason = "some of the benches need no sun")]
pub fn summer_day() -> DayRequest {
    DayRequest {
        latitude_deg: 35.0,
        longitude_deg: -116.0,
        date: "2026-06-21".parse().expect("a date"),
        utc_offset_h: Some(-7.0),
        north_deg: 0.0,
        window: None,
    }
}

/// The path of the sun over it.
#[allow(dead_code, reason = "some of the benches need no sun")]
pub fn summer_path() -> Result<SunPath, String> {
    match day(&summer_day()).map_err(|e| e.to_string())? {
        DayOutcome::Path(path) => Ok(path),
        DayOutcome::NoSun { .. } => Err("the sun does not rise".into()),
    }
}

/// Options given as `name=value`.
#[allow(dead_code, reason = "some of the benches read their own")]
pub fn given() -> HashMap<String, String> {
    std::env::args().filter_map(|a| a.split_once('=').map(|(k, v)| (k.to_owned(), v.to_owned()))).collect()
}
