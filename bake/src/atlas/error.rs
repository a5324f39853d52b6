//! Why a scene gets no atlas.

use thiserror::Error;

/// Why there is no atlas.
#[derive(Debug, Error, PartialEq)]
pub enum AtlasError {
    /// Page size, padding, density or page count out of range.
    #[error("{name} is {value}, but must be {requirement}")]
    BadSetting {
        /// Which.
        name: &'static str,
        /// What was given.
        value: String,
        /// What would be accepted.
        requirement: &'static str,
    },
    /// The density asked for needs too many texels.
    #[error(
        "{density_per_metre} texels a metre make about {texels} texels, but at most {most} are allowed: lower the density"
    )]
    TooDense {
        /// Asked for.
        density_per_metre: f64,
        /// About what it needs.
        texels: u64,
        /// The limit.
        most: u64,
    },
    /// Charts do not fit at any density.
    #[error(
        "{charts} charts with {padding} texels around each do not fit a page of {page_size} texels at any density: use larger pages"
    )]
    PageTooSmall {
        /// How many charts there are.
        charts: usize,
        /// Around each.
        padding: u32,
        /// Side of a page.
        page_size: u32,
    },
    /// The progress callback returned false.
    #[error("cancelled")]
    Cancelled,
}
