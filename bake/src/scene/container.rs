//! The container of a scene file: GLB chunks or plain JSON, told apart by their first bytes.
//!
//! Based on: Khronos Group, *glTF 2.0 Specification*, section 4 (GLB file format). More lenient in three ways: trailing
//! bytes, unknown chunks and a byte order mark are ignored.

use super::{LoadError, limits::MemoryBudget};
use crate::disk::read::MANIFEST_FILE;
use serde_json::Value;
use std::{fs::File, io::Read, ops::Range, path::Path};

/// The parts of a scene file.
pub(super) struct Container {
    /// The JSON chunk of a GLB, or the whole of a `.gltf`.
    pub json: Value,
    /// Where in the file the binary chunk is, if there is one.
    pub binary: Option<Range<usize>>,
}

/// Reads a regular file completely, if it fits into the budget.
pub(super) fn read_file(path: &Path, budget: &MemoryBudget, advice: &str) -> Result<Vec<u8>, LoadError> {
    let fail = |cause: std::io::Error| LoadError::read(path, &cause, advice);
    let meta = std::fs::metadata(path).map_err(fail)?;
    if !meta.is_file() {
        let cause = if meta.is_dir() { "it is a folder" } else { "it is not a regular file" };
        let is_set = meta.is_dir() && path.join(MANIFEST_FILE).is_file();
        let advice = if is_set { "it holds a baked set: give the scene that it was baked of" } else { advice };
        return Err(LoadError::read(path, &cause, advice));
    }
    budget.take(meta.len(), 1, || format!("{}", path.display()))?;
    let mut bytes = Vec::new();
    File::open(path).map_err(fail)?.take(meta.len()).read_to_end(&mut bytes).map_err(fail)?;
    Ok(bytes)
}

impl Container {
    /// Splits a file into its parts and parses the JSON.
    pub fn parse(path: &Path, bytes: &[u8], budget: &MemoryBudget) -> Result<Self, LoadError> {
        let (json, binary) = match bytes {
            [] => return Err(not_gltf(path, "it is empty")),
            [b'g', b'l', b'T', b'F', rest @ ..] => split_chunks(path, rest)?,
            _ => (bytes, None),
        };
        let json = json.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(json);
        budget.take(json.len() as u64, JSON_BYTES_PER_CHARACTER, || "its JSON".into())?;
        let json = parse_json(path, json)?;
        check_version(path, &json)?;
        Ok(Self { json, binary })
    }
}

/// A parsed value takes several times the memory of its text: `0,` is two characters and 32 bytes.
const JSON_BYTES_PER_CHARACTER: u64 = 16;

fn not_gltf(path: &Path, cause: impl Into<String>) -> LoadError {
    LoadError::NotGltf { path: path.to_owned(), cause: cause.into() }
}

fn truncated(path: &Path, cause: impl Into<String>) -> LoadError {
    LoadError::Truncated { path: path.to_owned(), cause: cause.into() }
}

/// Splits off the first 32-bit little-endian word.
fn word<'a>(bytes: &'a [u8]) -> Option<(u32, &'a [u8])> {
    let (head, tail): (&'a [u8; 4], &'a [u8]) = bytes.split_first_chunk()?;
    Some((u32::from_le_bytes(*head), tail))
}

/// Length of the letters that a GLB begins with.
const MAGIC_BYTES: usize = 4;

/// `rest` is the file after its first four bytes. Gives the JSON, and where in the file the binary chunk is.
fn split_chunks<'a>(path: &Path, rest: &'a [u8]) -> Result<(&'a [u8], Option<Range<usize>>), LoadError> {
    let file_bytes = rest.len() + MAGIC_BYTES;
    let cut = || truncated(path, format!("it ends within its header, after {file_bytes} bytes"));
    let (version, rest) = word(rest).ok_or_else(cut)?;
    if version != 2 {
        return Err(wrong_version(path, version.to_string()));
    }
    let (length, mut rest) = word(rest).ok_or_else(cut)?;
    let found = rest.len() as u64 + 12;
    if u64::from(length) > found {
        return Err(truncated(path, format!("its header declares {length} bytes and there are {found}")));
    }
    let (kind, json) = chunk(path, &mut rest)?.ok_or_else(|| truncated(path, "it has a header and no chunks"))?;
    if kind != *b"JSON" {
        return Err(truncated(path, format!("its first chunk is \"{}\" instead of JSON", kind.escape_ascii())));
    }
    while let Some((kind, data)) = chunk(path, &mut rest)? {
        if kind == *b"BIN\0" {
            let end = file_bytes - rest.len();
            return Ok((json, Some(end - data.len()..end)));
        }
    }
    Ok((json, None))
}

/// A chunk's type and its data.
type Chunk<'a> = ([u8; 4], &'a [u8]);

/// Splits off the next chunk. Fewer than eight bytes are padding.
fn chunk<'a>(path: &Path, rest: &mut &'a [u8]) -> Result<Option<Chunk<'a>>, LoadError> {
    let Some((length, after)) = word(rest) else { return Ok(None) };
    let Some((kind, after)) = word(after) else { return Ok(None) };
    let Some((data, tail)) = after.split_at_checked(length as usize) else {
        return Err(truncated(path, format!("a chunk declares {length} bytes and {} follow", after.len())));
    };
    *rest = tail;
    Ok(Some((kind.to_le_bytes(), data)))
}

fn parse_json(path: &Path, json: &[u8]) -> Result<Value, LoadError> {
    // The chunk is padded with spaces; some exporters use zeros.
    let json = json.trim_ascii();
    let json = json.iter().rposition(|&b| b != 0).map_or(&[][..], |last| json.get(..=last).unwrap_or(json));
    if json.first() != Some(&b'{') {
        return Err(not_gltf(path, "it begins neither with the letters glTF nor with a JSON object"));
    }
    let parsed = serde_json::from_slice(json).map_err(|error| LoadError::Json {
        path: path.to_owned(),
        line: error.line(),
        column: error.column(),
        cause: strip_position(&error.to_string()),
    });
    parsed.map(integers_from_floats)
}

/// Turns floats without a fraction into integers, since `24.0` is a valid index in JSON. The parser has bounded the
/// depth.
fn integers_from_floats(value: Value) -> Value {
    match value {
        Value::Number(number) => match number.as_f64().filter(|x| number.is_f64() && x.fract() == 0.0) {
            Some(x) if (1.0..1e15).contains(&x) || x.to_bits() == 0 => Value::from(x as u64),
            _ => Value::Number(number),
        },
        Value::Array(list) => list.into_iter().map(integers_from_floats).collect(),
        Value::Object(map) => map.into_iter().map(|(key, value)| (key, integers_from_floats(value))).collect(),
        other => other,
    }
}

/// Removes the position at the end of serde_json's messages, since our own message states it.
pub(super) fn strip_position(message: &str) -> String {
    message.split(" at line ").next().unwrap_or(message).to_owned()
}

fn wrong_version(path: &Path, version: String) -> LoadError {
    let advice = match version.starts_with('1') {
        true => "convert it: npx gltf-pipeline -i IN -o OUT.glb",
        false => "export it as glTF 2.0",
    };
    LoadError::Version { path: path.to_owned(), version, advice }
}

/// A later minor version is read as 2.0 unless the file says that it must not be.
fn check_version(path: &Path, json: &Value) -> Result<(), LoadError> {
    let asset = json.get("asset");
    let text = |key| asset.and_then(|asset| asset.get(key)).and_then(Value::as_str);
    let newer = |version: &&str| !version.starts_with("2.");
    match text("minVersion").filter(|&v| v != "2.0").or(text("version").filter(newer)) {
        Some(version) => Err(wrong_version(path, version.to_owned())),
        None => Ok(()),
    }
}
