//! The scene's textures, computed pixel by pixel with arithmetic that is the same on every machine.

mod ground;
mod leaf;
mod pixmap;
mod sign;
mod surface;

use pixmap::Pixmap;

/// A base colour texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Texture {
    Sand,
    Cliff,
    Road,
    Crossing,
    Concrete,
    Stucco,
    Paint,
    Checker,
    Rust,
    Corrugated,
    Wood,
    Tarp,
    Leaf,
    SignSun,
    SignGas,
}

impl Texture {
    /// The texture's name in the file.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Sand => "sand",
            Self::Cliff => "cliff",
            Self::Road => "road",
            Self::Crossing => "crossing",
            Self::Concrete => "concrete",
            Self::Stucco => "stucco",
            Self::Paint => "paint",
            Self::Checker => "checker",
            Self::Rust => "rust",
            Self::Corrugated => "corrugated",
            Self::Wood => "wood",
            Self::Tarp => "tarp",
            Self::Leaf => "leaf",
            Self::SignSun => "sign sun",
            Self::SignGas => "sign gas",
        }
    }

    /// The texture as a PNG file.
    pub(crate) fn png(self) -> Vec<u8> {
        self.pixmap().png()
    }

    fn pixmap(self) -> Pixmap {
        match self {
            Self::Sand => Pixmap::paint(512, 512, ground::sand),
            Self::Cliff => Pixmap::paint(256, 256, ground::cliff),
            Self::Road => Pixmap::paint(512, 512, ground::road),
            Self::Crossing => Pixmap::paint(512, 512, ground::crossing),
            Self::Concrete => Pixmap::paint(256, 256, ground::concrete),
            Self::Stucco => Pixmap::paint(256, 256, surface::stucco),
            Self::Paint => Pixmap::paint(256, 256, surface::paint),
            Self::Checker => Pixmap::paint(256, 256, surface::checker),
            Self::Rust => Pixmap::paint(256, 256, surface::rust),
            Self::Corrugated => Pixmap::paint(256, 256, surface::corrugated),
            Self::Wood => Pixmap::paint(256, 256, surface::wood),
            Self::Tarp => Pixmap::paint(128, 128, surface::tarp),
            Self::Leaf => leaf::pixmap(),
            Self::SignSun => Pixmap::paint(512, 256, sign::sun),
            Self::SignGas => Pixmap::paint(256, 128, sign::gas),
        }
    }
}
