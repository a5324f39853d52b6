//! Help, standard output and error, exit codes of ordinary use.

use super::tools::{Desk, Run};
use std::process::Stdio;

#[test]
fn without_arguments_it_prints_a_few_lines() {
    let run = Desk::new().run(&[]).ok();
    assert!((5..=8).contains(&run.stdout.lines().count()) && run.stderr.is_empty(), "{}", run.stdout);
}

#[test]
fn help_comes_in_two_lengths() {
    let desk = Desk::new();
    for command in ["bake", "texels", "cost"] {
        let [short, long] = ["-h", "--help"].map(|flag| desk.run(&[command, flag]).ok().stdout);
        assert!(short.lines().count() * 3 < long.lines().count() * 2, "{command}: {short}\n{long}");
    }
    let help = desk.run(&["bake", "-h"]).ok().stdout;
    for flag in ["--output", "--force", "--place", "--date", "--window", "--preset", "--size", "--engine", "--json"] {
        assert!(help.contains(flag), "{flag}: {help}");
    }
}

#[test]
fn an_invalid_command_line_exits_with_1_and_prints_one_line() {
    let desk = Desk::new();
    for arguments in
        [&["frobnicate"][..], &["bake"], &["bake", "floor.glb"], &["bake", "floor.glb", "-o", "x", "--fast"]]
    {
        desk.run(arguments).fails(&arguments.join(" "), 1, &["--help` tells more"]);
    }
}

#[test]
fn with_json_nothing_else_is_on_stdout() {
    let desk = Desk::new();
    let baked = desk.bake(&["--json"]).ok();
    assert_eq!(baked.json()["format"], "sunbake");
    assert!(baked.stderr.is_empty(), "no progress but on a terminal: {}", baked.stderr);
    assert_eq!(desk.run(&["inspect", "out/set", "--json"]).ok().json(), baked.json());
    let texels = desk.run(&["texels", "out/set", "--count", "5"]).ok().stdout;
    assert_eq!(texels.lines().count(), 5);
    assert!(texels.lines().all(|line| serde_json::from_str::<serde_json::Value>(line).is_ok()));
    let effects = desk.run(&["bake", "floor.glb", "--explain", "--json"]).ok().json();
    assert_eq!(effects[0]["effect"], "sun-intervals");
}

#[test]
fn explain_bakes_nothing() {
    let desk = Desk::new();
    let run = desk.bake(&["--explain"]).ok();
    assert!(run.stdout.contains("not baked") && run.stdout.contains("sun-intervals"), "{}", run.stdout);
    assert!(desk.left().is_empty());
}

#[test]
fn quiet_prints_no_warnings() {
    let run = Desk::new().bake(&["-q", "--place", "80,0", "--date", "2026-12-21"]).ok();
    assert_eq!((run.stdout.as_str(), run.stderr.as_str()), ("", ""));
}

#[test]
fn only_intervals_bakes_a_set() {
    let desk = Desk::new();
    desk.bake(&["--only", "intervals"]).ok();
    assert_eq!(desk.left(), ["set"]);
}

#[test]
fn the_requested_engine_bakes() {
    let desk = Desk::new();
    let asked = ["bake", "floor.glb", "-o", "out/bisected", "--preset=draft", "--size=64", "--json"];
    let run = desk.run(&[&asked[..], &["--engine=bisect:8", "--edge-seconds=2"]].concat()).ok();
    assert_eq!(run.json()["stats"]["engine"], "bisect:8 --edge-seconds 2");
    assert_eq!(desk.bake(&["--json"]).ok().json()["stats"]["engine"], "rays:16");
}

#[test]
fn the_same_seed_draws_the_same_texels() {
    let desk = Desk::new();
    desk.bake(&[]).ok();
    let draw = |seed| desk.run(&["texels", "out/set", "--count", "9", "--seed", seed]).ok().stdout;
    assert_eq!(draw("1"), draw("1"));
    assert_ne!(draw("1"), draw("2"));
}

#[test]
fn a_closed_pipe_is_no_failure() {
    let desk = Desk::new();
    desk.bake(&[]).ok();
    for arguments in
        [&["texels", "out/set", "--count", "100000"][..], &["inspect", "out/set"], &["bake", "--help"], &[]]
    {
        let mut child = desk.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && stderr.is_empty(), "{arguments:?}: {stderr}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_result_that_cannot_be_printed_is_a_failure() {
    let desk = Desk::new();
    desk.bake(&[]).ok();
    let full = || std::fs::File::create("/dev/full").expect("a full device");
    let run = Run::of(desk.command(&["inspect", "out/set"]).stdout(full()));
    run.fails("a full disk", 2, &["cannot print", "stdout"]);
}

/// O1.
#[test]
fn a_set_is_replaced_only_by_force() {
    let desk = Desk::new();
    desk.bake(&[]).ok();
    desk.bake(&[]).fails("again", 2, &["out/set exists", "--force"]);
    let manifest = desk.bake(&["--force", "--bits", "16", "--json"]).ok().json();
    assert_eq!(desk.run(&["inspect", "out/set", "--json"]).ok().json(), manifest);
    assert_eq!(desk.left(), ["set"]);
}

#[test]
fn a_set_may_be_written_into_the_current_folder() {
    let desk = Desk::new();
    std::fs::create_dir(desk.path("here")).unwrap();
    let mut command =
        desk.command(&["bake", "../floor.glb", "-o", ".", "--preset=draft", "--size=64", "--engine=rays:4"]);
    Run::of(command.current_dir(desk.path("here"))).ok();
    desk.run(&["inspect", "here"]).ok();
}
