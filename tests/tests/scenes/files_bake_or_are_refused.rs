//! The command bakes every file at draft quality, or refuses it: no panic, no hang, at most 4 GiB of memory. What it
//! writes says all that the file says, and passes the Khronos validator. A table says what each file came to. Unless at
//! full size, pages have a quarter of the texels. Needs `ulimit`, so it runs on Unix alone.

use crate::{is_full, scene_files};
use libtest_mimic::Trial;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Mutex;
use std::time::{Duration, Instant};
use sunbake_tests::needs::{Need, gas_station, shared, trial, validator_folder, workspace};
use sunbake_tests::{built_program, gltf_diff};

/// Seconds of processor time that a file may take: osrf_city, the largest, takes 116 on an AMD EPYC server, and a hang
/// takes all.
const CPU_S: u64 = 300;
/// The same at full size.
const CPU_FULL_S: u64 = 1500;
/// Longest that a file may take by the clock, for what waits without working.
const PATIENCE: Duration = Duration::from_secs(600);
/// Address space that a bake gets, in KiB.
const MEMORY_KIB: u64 = 4 << 20;

/// What a file came to.
struct Row {
    file: String,
    code: Option<i32>,
    first_line: String,
    seconds: f64,
    peak_mib: u64,
    set: PathBuf,
}

impl std::fmt::Display for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Self { file, code, first_line, seconds, peak_mib, .. } = self;
        let code = code.map_or("-".into(), |c| c.to_string());
        let line: String = first_line.chars().take(150).collect();
        write!(f, "{code:>4} {seconds:>7.2} s {peak_mib:>5} MiB  {file:<72} {line}")
    }
}

/// The files below a folder, the largest first, so that no long one starts last.
fn largest_first(folder: &Path) -> Vec<PathBuf> {
    let mut files = scene_files(folder);
    files.sort_by_key(|path| std::cmp::Reverse(path.metadata().map_or(0, |m| m.len())));
    files
}

fn bake(file: &Path, root: &Path, target: PathBuf) -> Row {
    let (cpu_s, quality) = match is_full() {
        true => (CPU_FULL_S, "--ao-rays 16"),
        false => (CPU_S, "--ao-rays 4 --size 256"),
    };
    let script = format!(
        "ulimit -v {MEMORY_KIB}; ulimit -t {cpu_s}; exec \"$0\" bake \"$1\" -o \"$2\" --preset draft {quality} \
         --ao-vertices _AO --threads 1 --json"
    );
    let stderr = target.with_extension("stderr");
    let mut command = Command::new("sh");
    command.args(["-c", &script]).arg(built_program("sunbake")).arg(file).arg(&target).stdout(Stdio::null());
    command.stderr(std::fs::File::create(&stderr).expect("a file"));
    let started = Instant::now();
    let mut child = command.spawn().expect("the command starts");
    let mut peak_mib = 0;
    let status = loop {
        peak_mib = peak_mib.max(peak_of(&child));
        if let Some(status) = child.try_wait().expect("a child") {
            break Some(status);
        }
        if started.elapsed() > PATIENCE {
            child.kill().and_then(|()| child.wait()).expect("it can be ended");
            break None;
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let text = String::from_utf8_lossy(&std::fs::read(&stderr).expect("stderr")).into_owned();
    let first_line = text.lines().next().unwrap_or_default();
    Row {
        file: file.strip_prefix(root).unwrap_or(file).display().to_string(),
        code: status.and_then(|s| s.code()),
        first_line: first_line.replace(&format!("{}/", root.display()), ""),
        seconds: started.elapsed().as_secs_f64(),
        peak_mib,
        set: target,
    }
}

/// Peak resident memory of a process so far, where the system tells.
fn peak_of(child: &Child) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|l| l.split_whitespace().next()?.parse::<u64>().ok()).unwrap_or(0) >> 10
}

/// Bakes files two at a time; rows come in the order of the files' names.
fn bake_all(files: &[PathBuf], root: &Path, sets: &Path) -> Vec<Row> {
    let (queue, rows) = (Mutex::new(files.iter().enumerate()), Mutex::new(Vec::new()));
    let next = || queue.lock().unwrap().next();
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some((index, file)) = next() {
                    let row = bake(file, root, sets.join(index.to_string()));
                    rows.lock().unwrap().push(row);
                }
            });
        }
    });
    let mut rows = rows.into_inner().unwrap();
    rows.sort_by(|a, b| a.file.cmp(&b.file));
    rows
}

/// Prints the table, and checks what must hold of every row. Gives how many rows have which exit code.
fn check(rows: &[Row]) -> BTreeMap<i32, usize> {
    rows.iter().for_each(|row| println!("{row}"));
    let mut counts = BTreeMap::new();
    for row in rows {
        let code = row.code.unwrap_or_else(|| panic!("neither in time nor in memory: {row}"));
        *counts.entry(code).or_default() += 1;
        match code {
            0 => assert!(row.first_line.is_empty() || row.first_line.starts_with("warning: "), "{row}"),
            2 | 3 => assert!(row.first_line.starts_with("sunbake: "), "{row}"),
            _ => panic!("a panic or worse: {row}"),
        }
        assert_eq!(row.set.exists(), code == 0, "{row}");
    }
    println!("exit codes: {counts:?}");
    counts
}

/// What the validator says of a file.
#[derive(serde::Deserialize)]
#[serde(rename_all = "camelCase")]
struct Verdict {
    warnings: u64,
    error_codes: BTreeSet<String>,
    messages: Vec<String>,
}

/// Every scene.glb and vertices.glb that was written says all that the scene's own file says, and has no errors for the
/// Khronos validator that the scene's own file has not. Its warnings are printed.
pub fn is_kept(baked: &[(PathBuf, PathBuf)]) {
    let files = |(source, set): &(PathBuf, PathBuf)| [source.clone(), set.join("scene.glb"), set.join("vertices.glb")];
    let files: Vec<PathBuf> = baked.iter().flat_map(files).filter(|file| file.exists()).collect();
    let verdicts = validate(&files);
    let mut failed = Vec::new();
    for (source, set) in baked {
        let known = &verdicts[source].error_codes;
        for (name, occlusion) in [("scene.glb", true), ("vertices.glb", false)] {
            let file = set.join(name);
            let Some(verdict) = verdicts.get(&file) else { continue };
            let new: Vec<_> = verdict.error_codes.difference(known).filter(|&code| code != DEAD_LINK).collect();
            if verdict.warnings > 0 || !new.is_empty() {
                println!("{}: {name} {:?}", source.display(), verdict.messages);
            }
            let lost = gltf_diff::lost(source, &file, gltf_diff::Allowed { occlusion });
            if !new.is_empty() || !lost.is_empty() {
                failed.push(format!("{}: {name}: new errors {new:?}, lost {lost:#?}", source.display()));
            }
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    println!("{} files keep what they were made of, and pass the Khronos validator", files.len() - baked.len());
}

/// A picture in a file that a bake does not open, because it lies outside the scene's folder: its link stays as it was,
/// and the bake says so.
const DEAD_LINK: &str = "IO_ERROR";

fn validate(files: &[PathBuf]) -> BTreeMap<PathBuf, Verdict> {
    let mut command = Command::new("node");
    command.arg(workspace().join("tests/validate.mjs")).arg(validator_folder()).args(files);
    let output = command.output().expect("node runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("text");
    let verdicts = text.lines().map(|line| serde_json::from_str(line).expect("a verdict"));
    let verdicts: BTreeMap<PathBuf, Verdict> = files.iter().cloned().zip(verdicts).collect();
    assert_eq!(verdicts.len(), files.len());
    verdicts
}

fn baked_of(rows: &[Row], root: &Path) -> Vec<(PathBuf, PathBuf)> {
    let baked = rows.iter().filter(|row| row.code == Some(0));
    baked.map(|row| (root.join(&row.file), row.set.clone())).collect()
}

/// Test files of the Khronos validator that can be read, and draw nothing. The others are refused for what they test.
const EMPTY: usize = 337;

fn validator_files_are_refused(folder: &Path) {
    let files = largest_first(folder);
    assert_eq!(files.len(), 372);
    let sets = tempfile::tempdir().unwrap();
    let rows = bake_all(&files, folder, sets.path());
    let counts = check(&rows);
    assert_eq!(counts, BTreeMap::from([(3, 372)]), "none of them draws a triangle");
    let empty = rows.iter().filter(|row| row.first_line.contains("draws no triangles")).count();
    println!("{empty} of them are understood, and draw no triangles");
    assert_eq!(empty, EMPTY);
}

fn shared_scenes_bake_or_are_refused(folder: &Path) {
    let sets = tempfile::tempdir().unwrap();
    let rows = bake_all(&largest_first(folder), folder, sets.path());
    let counts = check(&rows);
    is_kept(&baked_of(&rows, folder));
    let refused: Vec<_> = rows.iter().filter(|row| row.code != Some(0)).map(|row| row.file.as_str()).collect();
    assert_eq!(
        refused,
        ["truck_town/original/town_model.gltf", "two_cylinder_engine/2CylinderEngine.gltf"],
        "{counts:?}"
    );
}

fn our_gas_station_bakes() {
    let file = gas_station();
    let sets = tempfile::tempdir().unwrap();
    let rows = bake_all(std::slice::from_ref(&file), file.parent().unwrap(), sets.path());
    assert_eq!(check(&rows), BTreeMap::from([(0, 1)]));
    is_kept(&baked_of(&rows, file.parent().unwrap()));
}

/// The cases from the field: files that people reported, in small.
fn cases_bake_or_are_refused() {
    let folder = workspace().join("tests/cases");
    let sets = tempfile::tempdir().unwrap();
    let rows = bake_all(&largest_first(&folder), &folder, sets.path());
    let counts = check(&rows);
    is_kept(&baked_of(&rows, &folder));
    let refused: Vec<_> = rows.iter().filter(|row| row.code != Some(0)).map(|row| row.file.as_str()).collect();
    assert_eq!(refused, ["03_parent_uri/models/base.gltf"], "its base colour lies outside its folder: {counts:?}");
}

pub fn trials() -> Vec<Trial> {
    let corpus = "corpora/gltf_validator_test";
    vec![
        trial("validator_files_are_refused", vec![Need::shared(corpus)], move || {
            validator_files_are_refused(&shared(corpus));
        }),
        trial("shared_scenes_bake_or_are_refused", vec![Need::shared("scenes"), Need::validator()], || {
            shared_scenes_bake_or_are_refused(&shared("scenes"));
        }),
        trial("cases_bake_or_are_refused", vec![Need::validator()], cases_bake_or_are_refused),
        trial("our_gas_station_bakes", vec![Need::validator()], our_gas_station_bakes),
    ]
}
