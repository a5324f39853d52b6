//! Buffers and images that a scene names: inside the file, in a data URI, or in a file below the scene's own folder.
//!
//! Scenes are not trusted: nothing outside their folder is opened. URLs, absolute paths, and paths that leave the
//! folder by `..` or by a symbolic link are refused.

use super::{
    LoadError, LoadLimits,
    container::read_file,
    document::{self, Document, place},
    limits::MemoryBudget,
};
use sha2::{Digest, Sha256};
use std::{
    ops::Range,
    path::{Path, PathBuf},
    sync::Arc,
};

/// Reads the data that URIs name, and hashes the files among it.
pub(super) struct Fetcher<'a> {
    folder: PathBuf,
    budget: &'a MemoryBudget,
    hasher: Sha256,
}

impl<'a> Fetcher<'a> {
    /// `bytes` are the scene file's.
    pub fn new(scene: &Path, bytes: &[u8], budget: &'a MemoryBudget) -> Self {
        let folder = scene.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Self { folder: folder.to_owned(), budget, hasher: Sha256::new_with_prefix(bytes) }
    }

    /// The bytes that a URI stands for.
    pub fn fetch(&mut self, place: &str, uri: &str) -> Result<Vec<u8>, LoadError> {
        if let Some(data) = uri.strip_prefix("data:") {
            self.budget.take(data.len() as u64, 1, || place.to_owned())?;
            return decode_data_uri(data).map_err(|problem| LoadError::structure(place, problem));
        }
        let path = self.resolve(place, uri)?;
        let advice = format!("{place} names it: put it back, or export the scene as one .glb");
        let bytes = read_file(&path, self.budget, &advice)?;
        self.hasher.update(&bytes);
        Ok(bytes)
    }

    /// Reads a file for the hash only.
    pub fn hash_only(&mut self, place: &str, uri: &str) -> Result<(), LoadError> {
        if uri.starts_with("data:") {
            return Ok(());
        }
        let path = self.resolve(place, uri)?;
        let temporary = MemoryBudget::new(&LoadLimits { max_memory_bytes: self.budget.left() });
        self.hasher.update(read_file(&path, &temporary, "put it back beside the scene")?);
        Ok(())
    }

    /// SHA-256 of everything fetched so far, in lower-case hex.
    pub fn into_sha256(self) -> String {
        hex(self.hasher)
    }

    fn resolve(&self, place: &str, uri: &str) -> Result<PathBuf, LoadError> {
        let short = || uri.chars().take(200).collect();
        let refuse = |reason| LoadError::Outside { place: place.to_owned(), uri: short(), reason };
        let relative = percent_decoded(uri).replace('\\', "/");
        if has_scheme(&relative) {
            return Err(refuse("a URL or an absolute path, and sunbake opens only files in the scene's own folder"));
        }
        if climbs_out(&relative) {
            return Err(refuse("which lies outside the scene's own folder"));
        }
        let path = self.folder.join(&relative);
        match (path.canonicalize(), self.folder.canonicalize()) {
            (Ok(real), Ok(folder)) if !real.starts_with(&folder) => {
                Err(refuse("a symbolic link that leads outside the scene's own folder"))
            }
            _ => Ok(path),
        }
    }
}

/// A URL (`http:`, `file:`), a drive (`C:`), an absolute path, or a path with a zero byte.
fn has_scheme(path: &str) -> bool {
    let scheme = path.split(['/', '?', '#']).next().unwrap_or_default();
    path.starts_with('/') || scheme.contains(':') || path.contains('\0')
}

fn climbs_out(path: &str) -> bool {
    let mut depth = 0i64;
    path.split('/').any(|part| {
        depth += match part {
            "" | "." => 0,
            ".." => -1,
            _ => 1,
        };
        depth < 0
    })
}

fn hex_digit(byte: u8) -> Option<u8> {
    char::from(byte).to_digit(16).map(|digit| digit as u8)
}

/// `%20` becomes a space; an invalid escape is kept as text.
fn percent_decoded(text: &str) -> String {
    String::from_utf8(percent_decoded_bytes(text.as_bytes())).unwrap_or_else(|_| text.to_owned())
}

fn percent_decoded_bytes(mut rest: &[u8]) -> Vec<u8> {
    let mut out = Vec::with_capacity(rest.len());
    while let [first, tail @ ..] = rest {
        rest = tail;
        match (first, tail) {
            (b'%', [high, low, after @ ..]) => match (hex_digit(*high), hex_digit(*low)) {
                (Some(high), Some(low)) => {
                    out.push(high << 4 | low);
                    rest = after;
                }
                _ => out.push(b'%'),
            },
            _ => out.push(*first),
        }
    }
    out
}

/// `data` is the URI after `data:`.
fn decode_data_uri(data: &str) -> Result<Vec<u8>, String> {
    let (head, body) = data.split_once(',').ok_or("its data URI has no comma")?;
    match head.ends_with(";base64") {
        true => decode_base64(body),
        false => Ok(percent_decoded_bytes(body.as_bytes())),
    }
}

/// RFC 4648, both alphabets; white space and padding are skipped.
fn decode_base64(text: &str) -> Result<Vec<u8>, String> {
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut count) = (0u32, 0u32);
    for (at, byte) in text.bytes().enumerate() {
        let digit = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            b'=' | b' ' | b'\t' | b'\r' | b'\n' => continue,
            _ => return Err(format!("its data URI has a wrong base64 character at {at}")),
        };
        bits = bits << 6 | u32::from(digit);
        count += 6;
        if count >= 8 {
            count -= 8;
            out.push((bits >> count) as u8);
        }
    }
    Ok(out)
}

/// All buffers. One that cannot be read is an error only if something needs it.
pub(super) struct Buffers {
    buffers: Vec<Result<BufferBytes, LoadError>>,
}

/// A buffer's bytes: a part of the scene's own file, which is kept once, or read from elsewhere.
enum BufferBytes {
    Part(Arc<Vec<u8>>, Range<usize>),
    Own(Vec<u8>),
}

impl BufferBytes {
    fn bytes(&self) -> &[u8] {
        match self {
            Self::Part(file, range) => file.get(range.clone()).unwrap_or(&[]),
            Self::Own(bytes) => bytes,
        }
    }
}

impl Buffers {
    /// Reads every buffer. `binary` is where in the file the binary chunk is.
    pub fn read(doc: &Document, file: &Arc<Vec<u8>>, binary: Option<&Range<usize>>, fetcher: &mut Fetcher) -> Self {
        let count = doc.count::<document::JsonBuffer>();
        let chunk = |index| binary.filter(|_| index == 0).map(|range| (Arc::clone(file), range.clone()));
        Self { buffers: (0..count).map(|index| read_buffer(doc, index, chunk(index), fetcher)).collect() }
    }

    /// A single buffer.
    pub fn of_one(bytes: Vec<u8>) -> Self {
        Self { buffers: vec![Ok(BufferBytes::Own(bytes))] }
    }

    /// The bytes of a buffer; `None` if it could not be read.
    pub fn get(&self, index: usize) -> Option<&[u8]> {
        self.buffers.get(index)?.as_ref().ok().map(BufferBytes::bytes)
    }

    /// The bytes of a buffer view, and its stride if it states one.
    pub fn view(&self, doc: &Document, index: usize) -> Result<(&[u8], Option<u64>), LoadError> {
        let view: document::JsonBufferView = doc.get(index)?;
        let place = || place::<document::JsonBufferView>(index);
        let buffer = self.buffers.get(view.buffer).ok_or_else(|| {
            LoadError::structure(place(), format!("it lies in buffers[{}], which does not exist", view.buffer))
        })?;
        let buffer = buffer.as_ref().map_err(|error| super::refuse::missing_buffer(&view, error))?.bytes();
        let end = view.byte_offset.saturating_add(view.byte_length);
        let bytes = buffer.get(view.byte_offset as usize..end as usize).ok_or_else(|| {
            let problem = format!("it ends at byte {end} of buffers[{}], which has {}", view.buffer, buffer.len());
            LoadError::structure(place(), problem)
        })?;
        Ok((bytes, view.byte_stride))
    }
}

fn read_buffer(
    doc: &Document,
    index: usize,
    chunk: Option<(Arc<Vec<u8>>, Range<usize>)>,
    fetcher: &mut Fetcher,
) -> Result<BufferBytes, LoadError> {
    let buffer: document::JsonBuffer = doc.get(index)?;
    let place = place::<document::JsonBuffer>(index);
    match (buffer.uri, chunk) {
        (Some(uri), _) => fetcher.fetch(&place, &uri).map(BufferBytes::Own),
        (None, Some((file, range))) => Ok(BufferBytes::Part(file, range)),
        (None, None) => Err(LoadError::structure(place, "it has no uri, and the file has no binary chunk for it")),
    }
}

/// SHA-256 in lower-case hex: equals [`crate::scene::Source::sha256`] of a scene that is a single file.
pub fn sha256(bytes: &[u8]) -> String {
    hex(Sha256::new_with_prefix(bytes))
}

fn hex(hasher: Sha256) -> String {
    hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
