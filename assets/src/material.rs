//! The scene's materials.

use crate::textures::Texture;

/// How a surface looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Material {
    Sand,
    Cliff,
    Road,
    Crossing,
    Concrete,
    Stucco,
    StuccoTurquoise,
    Plaster,
    FloorTiles,
    RoofGravel,
    PaintWhite,
    PaintCream,
    PaintRed,
    PaintTurquoise,
    PaintMustard,
    PaintNavy,
    Rust,
    Iron,
    Galvanised,
    Corrugated,
    Wood,
    WoodWhite,
    Bark,
    Leaf,
    Twig,
    Tarp,
    Rubber,
    Dark,
    Porcelain,
    Cactus,
    Rock,
    SignSun,
    SignGas,
}

/// What the file says about a material.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spec {
    pub(crate) name: &'static str,
    /// Linear base colour; multiplies the texture.
    pub(crate) color: [f64; 3],
    pub(crate) roughness: f64,
    pub(crate) metallic: f64,
    pub(crate) texture: Option<Texture>,
    /// Metres that one repeat of the texture covers.
    pub(crate) tile_m: f64,
    pub(crate) double_sided: bool,
    /// Whether the texture's alpha cuts holes.
    pub(crate) masked: bool,
}

const fn plain(name: &'static str, color: [f64; 3], roughness: f64) -> Spec {
    Spec { name, color, roughness, metallic: 0.0, texture: None, tile_m: 1.0, double_sided: false, masked: false }
}

const fn textured(name: &'static str, texture: Texture, tile_m: f64, color: [f64; 3], roughness: f64) -> Spec {
    Spec { texture: Some(texture), tile_m, ..plain(name, color, roughness) }
}

const fn painted(name: &'static str, color: [f64; 3]) -> Spec {
    textured(name, Texture::Paint, 1.5, color, 0.55)
}

const fn metal(spec: Spec, metallic: f64) -> Spec {
    Spec { metallic, ..spec }
}

const WHITE: [f64; 3] = [1.0, 1.0, 1.0];

impl Material {
    /// The material's entry in the file.
    pub(crate) fn spec(self) -> Spec {
        match self {
            Self::Sand => textured("sand", Texture::Sand, 6.0, WHITE, 1.0),
            Self::Cliff => textured("cliff", Texture::Cliff, 6.0, WHITE, 1.0),
            Self::Road => textured("road", Texture::Road, 10.0, WHITE, 0.9),
            Self::Crossing => textured("crossing", Texture::Crossing, 10.0, WHITE, 0.9),
            Self::Concrete => textured("concrete", Texture::Concrete, 3.0, WHITE, 0.9),
            Self::Stucco => textured("stucco", Texture::Stucco, 2.5, [0.93, 0.90, 0.84], 0.95),
            Self::StuccoTurquoise => textured("stucco turquoise", Texture::Stucco, 2.5, [0.12, 0.46, 0.47], 0.9),
            Self::Plaster => textured("plaster", Texture::Stucco, 2.5, [0.86, 0.78, 0.62], 0.95),
            Self::FloorTiles => textured("floor tiles", Texture::Checker, 1.2, WHITE, 0.4),
            Self::RoofGravel => textured("roof gravel", Texture::Sand, 2.0, [0.55, 0.58, 0.62], 1.0),
            Self::PaintWhite => painted("paint white", [0.86, 0.84, 0.78]),
            Self::PaintCream => painted("paint cream", [0.84, 0.71, 0.46]),
            Self::PaintRed => painted("paint red", [0.60, 0.060, 0.035]),
            Self::PaintTurquoise => painted("paint turquoise", [0.07, 0.43, 0.44]),
            Self::PaintMustard => painted("paint mustard", [0.78, 0.42, 0.05]),
            Self::PaintNavy => painted("paint navy", [0.035, 0.09, 0.19]),
            Self::Rust => metal(textured("rust", Texture::Rust, 1.2, WHITE, 0.9), 0.1),
            Self::Iron => metal(plain("iron", [0.11, 0.10, 0.10], 0.6), 0.2),
            Self::Galvanised => metal(textured("galvanised", Texture::Paint, 1.0, [0.52, 0.54, 0.55], 0.45), 0.3),
            Self::Corrugated => metal(textured("corrugated", Texture::Corrugated, 0.8, WHITE, 0.5), 0.2),
            Self::Wood => textured("wood", Texture::Wood, 1.0, [0.62, 0.47, 0.34], 0.9),
            Self::WoodWhite => textured("wood white", Texture::Wood, 1.0, [0.95, 0.93, 0.88], 0.85),
            Self::Bark => textured("bark", Texture::Wood, 0.7, [0.34, 0.25, 0.18], 1.0),
            Self::Leaf => {
                let leaf = textured("leaf", Texture::Leaf, 1.0, WHITE, 0.8);
                Spec { double_sided: true, masked: true, ..leaf }
            }
            Self::Twig => plain("twig", [0.20, 0.15, 0.09], 1.0),
            Self::Tarp => Spec { double_sided: true, ..textured("tarp", Texture::Tarp, 0.5, [0.20, 0.33, 0.47], 0.7) },
            Self::Rubber => plain("rubber", [0.022, 0.022, 0.024], 0.85),
            Self::Dark => plain("dark", [0.035, 0.036, 0.040], 0.5),
            Self::Porcelain => plain("porcelain", [0.36, 0.17, 0.10], 0.25),
            Self::Cactus => textured("cactus", Texture::Stucco, 0.8, [0.12, 0.24, 0.09], 0.9),
            Self::Rock => textured("rock", Texture::Sand, 2.5, [0.72, 0.55, 0.47], 1.0),
            Self::SignSun => textured("sign sun", Texture::SignSun, 1.0, WHITE, 0.5),
            Self::SignGas => textured("sign gas", Texture::SignGas, 1.0, WHITE, 0.5),
        }
    }
}
