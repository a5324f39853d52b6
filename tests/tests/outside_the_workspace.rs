//! The libraries serve a crate outside the workspace that takes none of their default features: it bakes a box in
//! memory, and draws it into a texture of its own device. Needs a GPU adapter, and fails without one.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use sunbake_tests::needs::workspace;
use sunbake_tests::stderr;

/// Copies the crate of `tests/outside` into a folder, and points it at this workspace.
fn copy_crate(folder: &Path) {
    let workspace = workspace().canonicalize().expect("the workspace is there");
    let template = workspace.join("tests/outside");
    let manifest = std::fs::read_to_string(template.join("Cargo.toml.in")).expect("the template has a manifest");
    let manifest = manifest.replace("@WORKSPACE@", &workspace.display().to_string().replace('\\', "/"));
    std::fs::write(folder.join("Cargo.toml"), manifest).expect("a folder to write in");
    std::fs::create_dir(folder.join("src")).expect("a folder to write in");
    let files = [
        (template.join("src/main.rs"), "src/main.rs"),
        (template.join("box.gltf"), "box.gltf"),
        // The same versions of all that both depend on.
        (workspace.join("Cargo.lock"), "Cargo.lock"),
    ];
    for (from, to) in files {
        std::fs::copy(&from, folder.join(to)).unwrap_or_else(|error| panic!("{}: {error}", from.display()));
    }
}

#[test]
fn a_crate_outside_bakes_in_memory_and_draws_with_its_own_device() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    copy_crate(folder.path());
    let target = workspace().canonicalize().expect("the workspace is there").join("target/outside");
    let output = Command::new(env!("CARGO"))
        .args(["run", "--quiet", "--offline"])
        .current_dir(folder.path())
        // Kept between runs, so that only the first takes more than seconds.
        .env("CARGO_TARGET_DIR", target)
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", stderr(&output));
    let text = String::from_utf8_lossy(&output.stdout);
    let line = |line: &str| line.split_once(": ").and_then(|(name, code)| Some((name.to_owned(), code.parse().ok()?)));
    let codes: BTreeMap<String, u32> = text.lines().filter_map(line).collect();
    let [shadow, sunny, far] = ["shadow", "sunny side", "far away"].map(|name| codes[name]);
    assert!(shadow > 0 && 3 * shadow < 2 * sunny, "the box casts no shadow: {codes:?}");
    assert!(sunny.abs_diff(far) <= 4, "the sunny floor is uneven: {codes:?}");
}
