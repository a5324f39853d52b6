//! A bake that is killed leaves the old set or none. One that is interrupted or terminated also removes its own files.
#![cfg(unix)]

use super::tools::Desk;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Starts a bake that takes minutes, and waits until it has begun to write.
fn begin(desk: &Desk) -> Child {
    let arguments =
        ["bake", "floor.glb", "-o", "out/set", "--force", "--size=2048", "--engine=rays:4096", "--threads=1"];
    let child = desk.command(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let is_partial = |name: &String| name.ends_with(".sunbake-partial");
    let deadline = Instant::now() + Duration::from_secs(30);
    while !desk.left().iter().any(is_partial) {
        assert!(Instant::now() < deadline, "nothing was begun");
        std::thread::sleep(Duration::from_millis(10));
    }
    // Somewhere within the tracing.
    std::thread::sleep(Duration::from_millis(400));
    child
}

fn send(child: &Child, signal: &str) {
    let sent = Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

/// O1.
#[test]
fn a_killed_bake_leaves_the_old_set_whole() {
    let desk = Desk::new();
    let old = desk.bake(&["--json"]).ok().json();
    let mut child = begin(&desk);
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(desk.run(&["inspect", "out/set", "--json"]).ok().json(), old);
    for name in desk.left().iter().filter(|name| *name != "set") {
        let code = desk.run(&["inspect", &format!("out/{name}")]).code;
        assert_ne!(code, 0, "{name} reads as a set");
    }
}

/// O1.
#[test]
fn an_interrupted_bake_takes_back_what_it_made() {
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let desk = Desk::new();
        let child = begin(&desk);
        let sent = Instant::now();
        send(&child, signal);
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{signal}: {stderr}");
        assert_eq!(stderr, "sunbake: stopped before the end; nothing was written\n");
        assert!(sent.elapsed() < Duration::from_secs(20), "{signal}: {:?}", sent.elapsed());
        assert!(desk.left().is_empty(), "{:?}", desk.left());
    }
}
