//! Running the command, and a scene to run it on.

use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

pub const SUNBAKE: &str = env!("CARGO_BIN_EXE_sunbake");

/// What a run left.
#[derive(Debug)]
pub struct Run {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Run {
    pub fn of(command: &mut Command) -> Self {
        let Output { status, stdout, stderr } = command.output().expect("the command starts");
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Self { code: status.code().unwrap_or(-1), stdout: text(stdout), stderr: text(stderr) }
    }

    /// The run, if it ended well.
    #[track_caller]
    pub fn ok(self) -> Self {
        assert_eq!(self.code, 0, "{}", self.stderr);
        self
    }

    #[track_caller]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap_or_else(|e| panic!("stdout is no JSON: {e}\n{}", self.stdout))
    }

    /// Checks that it failed with this code and one line on stderr, which holds these words and comes after warnings,
    /// if there are any.
    #[track_caller]
    pub fn fails(&self, name: &str, code: i32, words: &[&str]) {
        let Self { stdout, .. } = self;
        let lines: Vec<&str> = self.stderr.lines().skip_while(|line| line.starts_with("warning: ")).collect();
        let stderr = lines.join("\n");
        assert_eq!(self.code, code, "{name}: {stderr}");
        assert!(stderr.starts_with("sunbake: ") && stderr.lines().count() == 1, "{name}: not one line:\n{stderr}");
        assert!(stdout.is_empty(), "{name}: {stdout}");
        for word in words {
            assert!(stderr.contains(word), "{name}: lacks `{word}`: {stderr}");
        }
    }
}

/// A folder for one test, with a scene in it.
pub struct Desk {
    folder: TempDir,
}

impl Desk {
    pub fn new() -> Self {
        let desk = Self { folder: tempfile::tempdir().expect("a temporary folder") };
        std::fs::create_dir(desk.path("out")).expect("a folder");
        desk.write("floor.glb", &glb(&floor(), &floor_bytes()));
        desk
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: &[u8]) -> PathBuf {
        std::fs::write(self.path(name), bytes).expect("a file");
        self.path(name)
    }

    /// `sunbake` with arguments, in this folder.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(SUNBAKE);
        command.current_dir(self.folder.path()).args(arguments);
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Run {
        Run::of(&mut self.command(arguments))
    }

    /// A small bake of `floor.glb` into `out/set`, with further arguments.
    pub fn bake(&self, more: &[&str]) -> Run {
        self.run(&[&SMALL_BAKE[..], more].concat())
    }

    /// What lies in `out`.
    pub fn left(&self) -> Vec<String> {
        names(&self.path("out"))
    }
}

const SMALL_BAKE: [&str; 9] =
    ["bake", "floor.glb", "-o", "out/set", "--preset=draft", "--size=64", "--engine=rays:16", "--threads", "1"];

/// Names in a folder, hidden ones too, in order.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Two triangles on the ground: accessor 0 the positions, 1 the indices.
pub fn floor() -> Value {
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "buffers": [{ "byteLength": 60 }],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 48, "byteLength": 12 },
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 0, 1] },
            { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" },
        ],
    })
}

/// The buffer of [`floor`].
pub fn floor_bytes() -> Vec<u8> {
    let positions = [[0.0f32, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
    let indices = [0u16, 1, 2, 0, 2, 3];
    let positions = positions.iter().flatten().flat_map(|x| x.to_le_bytes());
    positions.chain(indices.iter().flat_map(|i| i.to_le_bytes())).collect()
}

/// A binary glTF file.
pub fn glb(json: &Value, binary: &[u8]) -> Vec<u8> {
    let mut text = json.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut binary = binary.to_vec();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let word = |n: usize| (n as u32).to_le_bytes();
    let mut out = [b"glTF", &2u32.to_le_bytes()[..], &word(28 + text.len() + binary.len())].concat();
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &binary)] {
        out.extend([&word(chunk.len())[..], kind, chunk].concat());
    }
    out
}

/// Our own scene.
pub fn gas_station() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets/gas_station.glb")
}
