//! Tests that need what a machine may lack: shared scenes, a browser, a validator.
//!
//! Such tests live in a binary with a harness of its own (`tests/scenes`, `tests/browser`). Where something is absent
//! the harness lists the test as ignored, so that the runner's summary counts it as skipped. Run all the same, it
//! fails and says what is absent: it never passes.

use libtest_mimic::Trial;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Something that a test needs and a machine may lack.
pub struct Need {
    is_there: bool,
    /// Whether a test without it fails instead of being skipped.
    is_required: bool,
    advice: String,
}

impl Need {
    /// A file or folder of the shared folder, such as `scenes/pc_house/house.glb`. With `SUNBAKE_REQUIRE_SCENES=1`, a
    /// test without it fails.
    pub fn shared(name: &str) -> Self {
        let path = shared(name);
        Self {
            is_there: path.exists(),
            is_required: is_set("SUNBAKE_REQUIRE_SCENES"),
            advice: format!("{} is not there: SUNBAKE_SHARED names the folder of shared scenes", path.display()),
        }
    }

    /// A browser. With `SUNBAKE_REQUIRE_TOOLS=1`, a test without it fails.
    pub fn browser() -> Self {
        let names = crate::browser::names();
        Self::tool(names.iter().any(|name| answers(name)), &format!("none of {names:?} is installed"))
    }

    /// The Khronos glTF validator, with the `node` that runs it. With `SUNBAKE_REQUIRE_TOOLS=1`, a test without it
    /// fails.
    pub fn validator() -> Self {
        let package = validator_folder().join("node_modules/gltf-validator");
        let is_there = package.is_dir() && answers("node".as_ref());
        Self::tool(is_there, &format!("node, or {}, is not installed", package.display()))
    }

    /// The stock viewer, and a browser that runs it. With `SUNBAKE_REQUIRE_TOOLS=1`, a test without it fails.
    pub fn viewer() -> Self {
        let package = viewer_folder().join("node_modules/three");
        Self::tool(package.is_dir(), &format!("{} is not installed", package.display()))
    }

    fn tool(is_there: bool, absent: &str) -> Self {
        let advice = format!("{absent}: tests/setup installs it where it can");
        Self { is_there, is_required: is_set("SUNBAKE_REQUIRE_TOOLS"), advice }
    }
}

/// A test that is skipped, or fails, where something that it needs is absent.
pub fn trial(name: &str, needs: Vec<Need>, run: impl FnOnce() + Send + 'static) -> Trial {
    let absent: Vec<Need> = needs.into_iter().filter(|need| !need.is_there).collect();
    if absent.is_empty() {
        return Trial::test(name, move || {
            run();
            Ok(())
        });
    }
    let is_required = absent.iter().any(|need| need.is_required);
    let advice: Vec<String> = absent.into_iter().map(|need| need.advice).collect();
    Trial::test(name, move || Err(advice.join("\n").into())).with_ignored_flag(!is_required)
}

/// A test of one shared scene, such as `pc_house/house.glb`. It is named for the claim and the scene's file.
pub fn of_scene(claim: &str, scene: &str, run: impl FnOnce(&Path) + Send + 'static) -> Trial {
    let name = format!("scenes/{scene}");
    let file = shared(&name);
    trial(&name_of(claim, &file), vec![Need::shared(&name)], move || run(&file))
}

/// The same of our own scene, which is part of the repository.
pub fn of_gas_station(claim: &str, run: impl FnOnce(&Path) + Send + 'static) -> Trial {
    let file = gas_station();
    trial(&name_of(claim, &file), Vec::new(), move || run(&file))
}

fn name_of(claim: &str, scene: &Path) -> String {
    format!("{claim}::{}", scene.file_stem().unwrap_or_default().to_string_lossy())
}

/// Our own scene.
pub fn gas_station() -> PathBuf {
    workspace().join("assets/gas_station.glb")
}

/// A path in the shared folder, whether it is there or not: below `SUNBAKE_SHARED`, or below `shared` beside the
/// repository.
pub fn shared(name: &str) -> PathBuf {
    let beside = || workspace().join("../shared");
    std::env::var_os("SUNBAKE_SHARED").map_or_else(beside, PathBuf::from).join(name)
}

/// Where `tests/setup` installs the Khronos glTF validator.
pub fn validator_folder() -> PathBuf {
    workspace().join("target/gltf-validator")
}

/// Where `tests/setup` installs three.js, the stock viewer.
pub fn viewer_folder() -> PathBuf {
    workspace().join("target/viewer")
}

/// The repository's root.
pub fn workspace() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Whether an environment variable is set to something other than nothing or 0.
pub fn is_set(variable: &str) -> bool {
    std::env::var_os(variable).is_some_and(|value| !value.is_empty() && value != "0")
}

/// Whether a program answers to `--version`.
pub(crate) fn answers(name: &std::ffi::OsStr) -> bool {
    let mut command = Command::new(name);
    command.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn absent(is_required: bool) -> Need {
        Need { is_there: false, is_required, advice: "it is not there".into() }
    }

    fn outcome(needs: Vec<Need>, more: &[&str]) -> libtest_mimic::Conclusion {
        let arguments = libtest_mimic::Arguments::from_iter([&["test", "--quiet"], more].concat());
        libtest_mimic::run(&arguments, vec![trial("a test", needs, || ())])
    }

    #[test]
    fn what_is_absent_is_skipped_and_never_passes() {
        let present = Need { is_there: true, is_required: false, advice: String::new() };
        let found = outcome(vec![present], &[]);
        assert_eq!((found.num_passed, found.num_ignored, found.num_failed), (1, 0, 0));
        let found = outcome(vec![absent(false)], &[]);
        assert_eq!((found.num_passed, found.num_ignored, found.num_failed), (0, 1, 0));
        let found = outcome(vec![absent(false)], &["--ignored"]);
        assert_eq!((found.num_passed, found.num_ignored, found.num_failed), (0, 0, 1));
        let found = outcome(vec![absent(true)], &[]);
        assert_eq!((found.num_passed, found.num_ignored, found.num_failed), (0, 0, 1));
    }
}
