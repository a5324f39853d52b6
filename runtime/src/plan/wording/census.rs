//! Counts in words.

use super::super::Census;

/// What a census counts: in the order of its counts, for one and for several. Empty for what other counts include.
const COUNTED: [[&str; 2]; Census::COUNTS] = [
    ["pass", "passes"],
    ["pipeline", "pipelines"],
    ["alpha-test pipeline", "alpha-test pipelines"],
    ["two-sided pipeline", "two-sided pipelines"],
    ["specular pipeline", "specular pipelines"],
    ["blending pipeline", "blending pipelines"],
    ["texture of times", "textures of times"],
    ["", ""],
    ["texture of ambient light", "textures of ambient light"],
    ["texture of walls", "textures of walls"],
    ["", ""],
    ["base colour texture", "base colour textures"],
    ["texture of looks", "textures of looks"],
    ["vertex buffer", "vertex buffers"],
    ["group of bindings", "groups of bindings"],
    ["binding", "bindings"],
    ["target", "targets"],
    ["draw", "draws"],
    ["of maps", "of maps"],
    ["stencil pipeline", "stencil pipelines"],
    ["buffer of volumes", "buffers of volumes"],
    ["of volumes", "of volumes"],
    ["shadow pipeline", "shadow pipelines"],
    ["shadow map", "shadow maps"],
    ["mask", "masks"],
    ["of shadow maps and masks", "of shadow maps and masks"],
];

impl Census {
    /// The counts in words, without zeros. Pipelines of a kind are among the pipelines.
    pub fn in_words(&self) -> String {
        let said = |(i, count): (usize, u64)| {
            let words = COUNTED[i][usize::from(count != 1)];
            let is_said = count > 0 && !words.is_empty();
            let amount = if Self::BYTES.contains(&i) { size(count) } else { count.to_string() };
            is_said.then(|| format!("{amount} {words}"))
        };
        self.counts().into_iter().enumerate().filter_map(said).collect::<Vec<_>>().join(", ")
    }
}

/// Bytes in the unit that suits them.
fn size(bytes: u64) -> String {
    match bytes {
        ..1024 => format!("{bytes} bytes"),
        1024..1_048_576 => format!("{:.1} KiB", bytes as f64 / 1024.0),
        _ => format!("{:.1} MiB", bytes as f64 / 1_048_576.0),
    }
}
