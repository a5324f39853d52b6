//! Why a scene is not loaded. Every message says what is wrong, where in the file, and what to do next.

use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a scene was not loaded.
#[derive(Debug, Clone, Error)]
pub enum LoadError {
    /// The scene, or a file that it names, cannot be read from disk.
    #[error("cannot read {path}: {cause}; {advice}", path = .path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The operating system's message.
        cause: String,
        /// What to do next.
        advice: String,
    },
    /// The file is not glTF.
    #[error(
        "{path} is not a glTF scene: {cause}; \
         export the scene as glTF 2.0 (.glb or .gltf), for example from Blender",
        path = .path.display()
    )]
    NotGltf {
        /// The file.
        path: PathBuf,
        /// What was found instead of a glTF scene.
        cause: String,
    },
    /// The file is cut off, or its lengths contradict each other.
    #[error("{path} is damaged: {cause}; copy or export it again", path = .path.display())]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Which length was declared and which was found.
        cause: String,
    },
    /// A version of glTF that is not 2.
    #[error("{path} is glTF {version}, and only glTF 2 is supported; {advice}", path = .path.display())]
    Version {
        /// The file.
        path: PathBuf,
        /// The version that the file states.
        version: String,
        /// How to get a file of version 2, as a sentence.
        advice: &'static str,
    },
    /// The JSON does not parse.
    #[error(
        "{path}: its JSON is wrong at line {line}, column {column}: {cause}; export it again or repair it there",
        path = .path.display()
    )]
    Json {
        /// The file.
        path: PathBuf,
        /// Line within the JSON, from 1.
        line: usize,
        /// Column within the line, from 1.
        column: usize,
        /// What the parser says.
        cause: String,
    },
    /// The JSON parses but contradicts itself or the format.
    #[error(
        "{place}: {problem}; export the scene again, or check it with the Khronos validator: \
         https://github.khronos.org/glTF-Validator"
    )]
    Structure {
        /// Where in the file, and what refers to it: `accessors[12] (POSITION of meshes[3] primitive 0)`.
        place: String,
        /// What is wrong there.
        problem: String,
    },
    /// The file requires an extension that sunbake does not read.
    #[error("the scene requires the extension {extension}, which sunbake does not read; {advice}")]
    Extension {
        /// Name of the extension.
        extension: String,
        /// How to get a file without it, as a sentence.
        advice: String,
    },
    /// The scene names a file that sunbake will not open.
    #[error(
        "{place} names \"{uri}\", {reason}; put the file beside the scene and name it by a relative path, \
         or pack everything into one .glb"
    )]
    Outside {
        /// Where in the file.
        place: String,
        /// The URI that the file names.
        uri: String,
        /// Why it is not opened, to be read after the URI.
        reason: &'static str,
    },
    /// More memory would be needed than is allowed.
    #[error(
        "{what} needs {} more, but only {} of the {} allowed are left",
        size(*needed_bytes), size(*left_bytes), size(*limit_bytes)
    )]
    TooLarge {
        /// What would need it.
        what: String,
        /// How much it would need.
        needed_bytes: u64,
        /// How much of the limit is left.
        left_bytes: u64,
        /// Bytes that loading may take in all.
        limit_bytes: u64,
    },
    /// An image that an alpha mask needs cannot be used.
    #[error(
        "{place} has an alpha mask in {image}, which cannot be used: {cause}; its shadow would be wrong, \
         so replace the image by a PNG, or set the material's alphaMode to OPAQUE"
    )]
    AlphaImage {
        /// Where in the file the material is.
        place: String,
        /// Where in the file the image is.
        image: String,
        /// Why the image cannot be used.
        cause: String,
    },
    /// What the file's extras ask of sunbake makes no sense.
    #[error("the extras of {place}: {key}: {problem}; correct it, or take it away")]
    Extras {
        /// Where in the file.
        place: String,
        /// The key.
        key: String,
        /// What is wrong with it.
        problem: String,
    },
    /// Nodes form a cycle.
    #[error("nodes[{node}] is its own ancestor; remove it from the children of nodes[{parent}]")]
    NodeCycle {
        /// A node of the cycle.
        node: usize,
        /// The node that names it as its child.
        parent: usize,
    },
    /// The scene draws no triangle, so there is nothing to bake.
    #[error("{path} draws no triangles, so there is nothing to bake or to shade: {cause}", path = .path.display())]
    NoTriangles {
        /// The file.
        path: PathBuf,
        /// What was found instead.
        cause: String,
    },
}

/// A number of bytes with a readable unit.
fn size(bytes: u64) -> String {
    match bytes {
        0..10_000 => format!("{bytes} bytes"),
        10_000..10_000_000 => format!("{:.1} KiB", bytes as f64 / f64::from(1 << 10)),
        _ => format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20)),
    }
}

impl LoadError {
    pub(super) fn structure(place: impl Into<String>, problem: impl Into<String>) -> Self {
        Self::Structure { place: place.into(), problem: problem.into() }
    }

    /// The same with who refers to the place: `accessors[9] (POSITION of meshes[3] primitive 0)`.
    pub(super) fn used_as(self, role: &str, user: impl std::fmt::Display) -> Self {
        match self {
            Self::Structure { place, problem } => Self::structure(format!("{place} ({role} of {user})"), problem),
            other => other,
        }
    }

    pub(super) fn read(path: &Path, cause: &dyn ToString, advice: &str) -> Self {
        Self::Read { path: path.to_owned(), cause: cause.to_string(), advice: advice.to_owned() }
    }
}
