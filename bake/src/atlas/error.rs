//! Why a scene gets no atlas.

use thiserror::Error;

/// Why there is no atlas.
#[derive(Debug, Error, PartialEq)]
pub enum AtlasError {
    /// Page size, padding, density or page count is out of range.
    #[error("{name} is {value}, but must be {requirement}")]
    BadSetting {
        /// Name of the setting.
        name: &'static str,
        /// The value given, as text.
        value: String,
        /// Accepted values, to be read after "must be".
        requirement: &'static str,
    },
    /// The requested density needs too many texels.
    #[error(
        "the density makes about {texels} texels, {of_instance} of them for the mesh of instance {instance}, but at \
         most {most} are allowed"
    )]
    TooDense {
        /// The first instance ([`crate::scene::Scene::instances`]) of the mesh that asks for most of them.
        instance: usize,
        /// How many it asks for, with the mesh's other instances.
        of_instance: u64,
        /// Approximate number of texels needed.
        texels: u64,
        /// Most texels allowed.
        most: u64,
    },
    /// Charts do not fit at any density.
    #[error("{charts} charts with {padding} texels around each do not fit a page of {page_size} texels at any density")]
    PageTooSmall {
        /// Number of charts.
        charts: usize,
        /// Texels around each chart.
        padding: u32,
        /// Side of a page, in texels.
        page_size: u32,
    },
    /// The progress callback returned false.
    #[error("cancelled")]
    Cancelled,
}
