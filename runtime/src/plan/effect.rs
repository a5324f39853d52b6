//! The effects that a picture may have, and why each is on or off.

/// An effect of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum DrawEffect {
    /// A pass that draws depths first, so that each pixel is lit once.
    DepthPass,
    /// A pass that lights surfaces, or shows how much light they see.
    LightPass,
    /// A sky behind the scene.
    SkyBackground,
    /// Base colour textures.
    BaseColorTextures,
    /// Colours of vertices.
    VertexColors,
    /// Alpha masks, tested per pixel.
    AlphaTest,
    /// Surfaces drawn from both sides.
    TwoSidedFaces,
    /// Metal, and highlights of sun, lamp and sky.
    Highlights,
    /// Metallic-roughness textures.
    MetallicRoughnessTextures,
    /// Normal maps.
    NormalMaps,
    /// Emissive textures.
    EmissiveTextures,
    /// Surfaces blended with what lies behind.
    BlendedSurfaces,
    /// Light that ends on smooth surfaces where their shading normals say.
    SmoothTerminator,
    /// Stored times of the sun.
    SunTimes,
    /// A sun with a width, which softens edges along its path.
    Penumbra,
    /// Several lanes across the sun's disc.
    DiscLanes,
    /// Room for more than four intervals per texel.
    SeveralLayers,
    /// Stored times of 16 bits.
    SixteenBitTimes,
    /// A lamp and its stored times.
    Lamp,
    /// Shadow tracks, instead of the sun's stored times.
    Tracks,
    /// Ambient occlusion.
    AmbientOcclusion,
    /// Bent normals.
    BentNormals,
    /// Sky visibility in spherical harmonics.
    SkyHarmonics,
    /// Ambient light of the backs of surfaces.
    AmbientOfBacks,
    /// Filters that blend nothing across walls.
    Walls,
    /// More than one atlas page.
    SeveralPages,
    /// Shadow volumes of the sun.
    SunVolumes,
    /// Several suns that share the sun's disc.
    SoftSun,
    /// Volumes counted in front of the surface.
    ZPass,
    /// Volumes counted behind the surface.
    ZFail,
    /// Casters that are not closed.
    OpenMeshes,
    /// Facets of smooth solids that turn away from the light.
    SmoothSolids,
    /// Silhouettes found by the vertex shader.
    SilhouettesByGpu,
    /// Volumes counted in several runs.
    SeveralRuns,
    /// A picture of the volumes.
    VisualizedVolumes,
    /// Shadow maps of the sun.
    SunShadows,
    /// More than one shadow map.
    SeveralMaps,
    /// A blurred mask of casters on the ground.
    BlurredMask,
    /// A mask of casters projected flat onto the ground.
    FlatMask,
    /// A sampler that reads shadow maps.
    MapSampler,
    /// A filter of several comparisons.
    WideFilter,
    /// A filter as wide as the penumbra.
    MapPenumbra,
    /// The ground as draws of its own.
    SeparateGroundDraws,
    /// Rays over the light's disc.
    TruthOfDisc,
    /// A lamp that rays are traced to.
    TracedLamp,
    /// Alpha masks that rays look up.
    TracedAlphaMask,
}

/// Why an effect is on or off. What it means depends on the effect: `wording.rs` makes a sentence of the two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// The effect has one reason to be on, and one to be off.
    Usual,
    /// It may be needed, which depends on the view and the light.
    Possible,
    /// N things need it: images, batches, layers, suns, maps.
    Count(usize),
    /// N pages were baked, and one texel more stands for what nothing shades.
    PagesAndOpenTexel(usize),
    /// The picture shows how much of the light is seen, and no colours.
    VisibilityPicture,
    /// What it depends on is not read at all.
    Unread,
    /// The sun gives no light, or was not asked for.
    SunDown,
    /// N slices of the view have a map each.
    Slices(usize),
    /// N faces of a cube around the sun are seen.
    CubeFaces(usize),
    /// The shader compares four gathered texels itself.
    Gathered,
}

/// What an effect takes that a census does not count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Uncounted {
    /// No more than `wording.rs` says of the effect in general.
    Nothing,
    /// Prisms of N triangles.
    Prisms(usize),
    /// N comparisons per pixel.
    Comparisons(u32),
    /// N rays per pixel and light; none where one ray is traced.
    Rays(Option<u32>),
}
