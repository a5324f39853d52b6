//! Why a scene gets no atlas.

use thiserror::Error;

/// What does not fit pages, however few texels the scene has a metre. Its text ends with the word page or pages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Misfit {
    /// A mesh has too many charts.
    #[error("the mesh of instance {instance} has {charts} charts, too many for a page")]
    Charts {
        /// The mesh's first instance ([`crate::scene::Scene::instances`]).
        instance: usize,
        /// How many it has.
        charts: usize,
    },
    /// A mesh is too large at a density of its own.
    #[error("at the density asked for, the mesh of instance {instance} is too large for a page")]
    Density {
        /// The instance that asks for most texels.
        instance: usize,
    },
    /// All meshes together have too many charts.
    #[error("{charts} charts do not fit {pages} pages")]
    Pages {
        /// How many they have.
        charts: usize,
        /// Most pages that there may be.
        pages: u32,
    },
}

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
    #[error("{misfit} of {page_size} texels, with {padding} texels around each chart")]
    PageTooSmall {
        /// What does not fit.
        misfit: Misfit,
        /// Texels around each chart.
        padding: u32,
        /// Side of a page, in texels.
        page_size: u32,
    },
    /// The progress callback returned false.
    #[error("cancelled")]
    Cancelled,
}
