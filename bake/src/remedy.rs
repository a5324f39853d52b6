//! What to do next about an error or a warning, as a value.
//!
//! The libraries name settings; only a command knows which of its options stands for one.

/// A setting that a caller of these libraries can change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Setting {
    /// Edge of a page, in texels.
    PageSize,
    /// Density of the texels, per metre.
    TexelsPerMetre,
    /// Width of the gutter around every chart.
    Padding,
    /// Bits of a stored time.
    Bits,
    /// Most layers of four intervals.
    Layers,
    /// Lanes across the sun's disc.
    Lanes,
    /// How lit intervals are found.
    Engine,
    /// What a set stores: lit intervals, ambient light.
    Contents,
    /// Where storing lost minutes, written as files.
    LossMap,
    /// Ambient light as OpenEXR.
    Exr,
    /// Rays of sky a texel.
    AoRays,
    /// Error of ambient occlusion at which a texel's rays stop.
    AoError,
    /// Points of a texel on which its rays are spread.
    AoSupersample,
    /// Number of working threads.
    Threads,
    /// Memory that may be planned for.
    MaxMemory,
    /// Objects that are left out.
    LeaveOut,
    /// Objects that cast no shadow.
    NoCast,
    /// Objects that nothing shades.
    NoReceive,
    /// Texels a metre of an object.
    ObjectDensity,
    /// Texels a metre of an object and of what its shadow falls on.
    ObjectDensityAround,
    /// Where on Earth the scene lies.
    Place,
    /// The date of the sun's day.
    Date,
    /// The file of a keyed path.
    Path,
    /// The file of a lamp's path.
    Lamp,
    /// Where the result is written.
    Output,
    /// Whether an older result is replaced.
    Force,
    /// Whether the GPU or the CPU draws.
    Renderer,
    /// How visibility is found.
    Technique,
    /// Edge of a shadow map, in texels.
    MapSize,
    /// Number of cascaded shadow maps.
    Cascades,
    /// Width and height of a picture, in pixels.
    PictureSize,
    /// Where a picture is taken from.
    Camera,
    /// The time of day of a picture.
    Time,
    /// The technique that others are compared with.
    Reference,
}

/// What to do next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Remedy {
    /// Give the setting a smaller value.
    Lower(Setting),
    /// Give the setting a larger value.
    Raise(Setting),
    /// Give fewer values of a setting that takes several.
    Fewer(Setting),
    /// Give the setting another value.
    Change(Setting),
    /// Give the setting this value.
    Set(Setting, String),
    /// Do not give the setting.
    Omit(Setting),
    /// Give each of these settings its value, together.
    SetAll(Vec<(Setting, String)>),
    /// See what the scene has to name.
    ListNames,
    /// Bake the scene again, with this changed.
    Rebake(Box<Remedy>),
    /// Something that is no setting, as a phrase: `simplify the scene`.
    Do(&'static str),
    /// Any one of these, the first first.
    AnyOf(Vec<Remedy>),
}

impl Remedy {
    /// Any one of these.
    pub(crate) fn any<const N: usize>(remedies: [Self; N]) -> Self {
        Self::AnyOf(remedies.into())
    }
}
