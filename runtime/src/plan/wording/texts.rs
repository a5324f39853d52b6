//! What is said of each effect, whatever the scene.

use super::super::DrawEffect;

/// The texts of an effect.
pub struct EffectText {
    pub effect: DrawEffect,
    /// Its name, in reports and manifests.
    pub name: &'static str,
    /// Why it is on, unless its reason says more.
    pub why_on: &'static str,
    /// Why it is off, unless its reason says more.
    pub why_off: &'static str,
    /// What it would take where it is off.
    pub would_take: &'static str,
    /// What it takes besides what a census counts.
    pub also_takes: &'static str,
    /// What turns it off.
    pub off_by: &'static str,
    /// What turns it on.
    pub on_by: &'static str,
}

/// What saves the texel that stands for what nothing shades.
pub const EVERYTHING_SHADED: &str = "a set in which all objects take shadows: baked without --no-receive";
/// The same, and what saves pages.
pub const ONE_PAGE_AND_EVERYTHING_SHADED: &str =
    "a set baked with a larger --size, or without --texels-per-metre, and without --no-receive";
pub const SUN_DOWN: &str = "the sun is down, off or not asked for";
const NEVER: &str = "nothing: it is what a picture is made of";
const OTHER_MAP: &str = "another --technique map:VARIANT";
const WIDTH_COST: &str = "the sun's width measured against each interval, at each texel";
const PENUMBRA_COST: &str = "a search for blockers a pixel, and as many comparisons as the penumbra is wide";
const ALPHA_RAY_COST: &str = "alpha looked up wherever a ray meets such a surface";
const METAL: &str = "a material of metallicFactor above 0 (where it is absent, it is 1) or roughnessFactor below 1";
const TEXTURE_COST: &str = "a texture an image, a group of bindings, a vertex buffer, and a pipeline a kind of surface";
const NO_BLEND: &str = "materials of alphaMode OPAQUE or MASK, without KHR_materials_transmission";
const NO_ALPHA: &str = "materials of alphaMode OPAQUE";
const ALPHA: &str = "a material of alphaMode MASK or BLEND";

/// No text at all.
const NONE: EffectText = EffectText {
    effect: DrawEffect::DepthPass,
    name: "",
    why_on: "",
    why_off: "",
    would_take: "",
    also_takes: "",
    off_by: "",
    on_by: "",
};

/// One entry per effect.
pub const TEXTS: [EffectText; 46] = [
    EffectText {
        effect: DrawEffect::DepthPass,
        name: "depth-pass",
        why_on: "the nearest surfaces are found first, so that each pixel is lit once",
        off_by: NEVER,
        on_by: NEVER,
        ..NONE
    },
    EffectText {
        effect: DrawEffect::LightPass,
        name: "light-pass",
        why_on: "surfaces are lit",
        off_by: NEVER,
        on_by: NEVER,
        ..NONE
    },
    EffectText {
        effect: DrawEffect::SkyBackground,
        name: "sky-background",
        why_on: "the sky behind the scene is drawn",
        why_off: "a picture of visibility has no sky",
        would_take: "a pipeline",
        off_by: "--output visibility",
        on_by: "--output color",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::BaseColorTextures,
        name: "base-colour-textures",
        would_take: "a texture an image, a group of two bindings, a vertex buffer, and a pipeline a kind of surface",
        off_by: "materials without baseColorTexture",
        on_by: "a baseColorTexture",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::VertexColors,
        name: "vertex-colours",
        would_take: "a vertex buffer, and a pipeline a kind of surface",
        off_by: "meshes without COLOR_0",
        on_by: "a mesh with COLOR_0",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::AlphaTest,
        name: "alpha-test",
        would_take: "a pipeline for depths and one a kind of surface",
        also_takes: "alpha looked up at each of their pixels in every pass",
        off_by: NO_ALPHA,
        on_by: ALPHA,
        ..NONE
    },
    EffectText {
        effect: DrawEffect::TwoSidedFaces,
        name: "two-sided-faces",
        would_take: "a pipeline for depths and one a kind of surface, without culling",
        off_by: "materials without \"doubleSided\"",
        on_by: "a material with \"doubleSided\": true",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::Highlights,
        name: "metal-and-highlights",
        would_take: "a pipeline a kind of surface",
        also_takes: "two lobes of reflected light for each light, and the sky's colour, at each of their pixels",
        off_by: "materials of metallicFactor 0 and roughnessFactor 1",
        on_by: METAL,
        ..NONE
    },
    EffectText {
        effect: DrawEffect::MetallicRoughnessTextures,
        name: "metallic-roughness-textures",
        would_take: TEXTURE_COST,
        off_by: "materials without metallicRoughnessTexture",
        on_by: "a metallicRoughnessTexture",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::NormalMaps,
        name: "normal-maps",
        would_take: TEXTURE_COST,
        off_by: "materials without normalTexture",
        on_by: "a normalTexture",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::EmissiveTextures,
        name: "emissive-textures",
        would_take: TEXTURE_COST,
        off_by: "materials without emissiveTexture",
        on_by: "an emissiveTexture, and an emissiveFactor",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::BlendedSurfaces,
        name: "blended-surfaces",
        would_take: "a pipeline a kind of surface; of shadow volumes, a pass",
        also_takes: "sorting their triangles each frame",
        off_by: NO_BLEND,
        on_by: "a material of alphaMode BLEND with alpha below 1, or of KHR_materials_transmission",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::SmoothTerminator,
        name: "smooth-terminator",
        why_on: "some surfaces of several faces are smooth-shaded",
        why_off: "no surface of several faces is smooth-shaded, or the set was baked without regard to it",
        would_take: "a pipeline a kind of surface; with shadow maps a vertex buffer",
        off_by: "flat normals, or a set baked with --flat-terminator",
        on_by: "vertex normals that turn from corner to corner of a triangle",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::SunTimes,
        name: "sun-times",
        why_on: "the set stores when texels see the sun, and this reads it",
        why_off: "none is read",
        would_take: "two textures and two bindings a page",
        also_takes: "four texels of each a pixel",
        off_by: "--light sky",
        on_by: "--technique baked, of a set with a sun",
    },
    EffectText {
        effect: DrawEffect::Penumbra,
        name: "penumbra",
        why_on: "the sun has a width",
        why_off: "the sun has no width: it is seen or not",
        would_take: WIDTH_COST,
        also_takes: WIDTH_COST,
        off_by: "a set whose sun has no width",
        on_by: "a set whose sun has a width",
    },
    EffectText {
        effect: DrawEffect::DiscLanes,
        name: "disc-lanes",
        would_take: "as many layers for each lane more",
        off_by: "a set baked with --lanes 1",
        on_by: "a set baked with --lanes 3 or 5",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::SeveralLayers,
        name: "several-layers",
        would_take: "a layer more of each texture of times",
        off_by: "a set baked with --layers 1",
        on_by: "a set with texels of more than four intervals",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::SixteenBitTimes,
        name: "16-bit-times",
        would_take: "twice the bytes of times",
        off_by: "a set baked with --bits 8",
        on_by: "a set baked with --bits 16",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::Lamp,
        name: "lamp",
        why_on: "the set has a lamp, and stores when texels see it",
        why_off: "there is no lamp, or it is off",
        would_take: "a binding of the frame, and two textures and two bindings a page",
        off_by: "--light sun",
        on_by: "a set baked with --lamp FILE",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::Tracks,
        name: "shadow-tracks",
        why_on: "the sun's shade is read occluder by occluder, which draws shadows narrower than texels",
        why_off: "the sun's times are read, or none",
        would_take: "three textures and bindings a page instead of two: 4 bytes a texel and 6 a span",
        also_takes: "a list of spans for each of four texels a pixel",
        off_by: "another --filter",
        on_by: "--filter tracks, of a set baked with --tracks",
    },
    EffectText {
        effect: DrawEffect::AmbientOcclusion,
        name: "ambient-occlusion",
        why_on: "the share of the sky that texels see is read",
        why_off: "the share of the sky that texels see is not read",
        would_take: "a texture and a binding a page, 2 bytes a texel and side",
        off_by: "--ambient hemisphere",
        on_by: "--ambient ao, of a set baked with ao",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::BentNormals,
        name: "bent-normals",
        why_on: "from where texels see the sky is read",
        why_off: "from where texels see the sky is not read",
        would_take: "a texture and a binding a page, 8 bytes a texel and side",
        off_by: "--ambient ao",
        on_by: "--ambient bent, of a set baked with --bent",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::SkyHarmonics,
        name: "sky-sh2",
        why_on: "how any sky adds up at texels is read",
        why_off: "how any sky adds up at texels is not read",
        would_take: "a texture and a binding a page, 24 bytes a texel and side, and a binding of the frame",
        off_by: "--ambient hemisphere, ao or bent",
        on_by: "--ambient sh2, of a set baked with --sky sh2",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::AmbientOfBacks,
        name: "ambient-of-backs",
        why_on: "what the backs of surfaces see of the sky is read",
        why_off: "what the backs of surfaces see of the sky is not read",
        would_take: "twice the bytes of ambient light",
        off_by: "--ambient hemisphere",
        on_by: "ambient light of a set with double-sided surfaces",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::Walls,
        name: "walls",
        why_on: "walls stand between neighbouring texels, and no filter blends across them",
        why_off: "nothing stands between neighbouring texels, or they are not read",
        would_take: "a texture and a binding a page, 2 bytes a texel; three reads a filter",
        off_by: "a set without `walls` in its sunbake.json",
        on_by: "a set of a scene with walls, higher than a texel is wide, on floors that run on behind them",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::SeveralPages,
        name: "several-pages",
        would_take: "the textures and bindings of one page more, and a draw",
        off_by: "a set baked with a larger --size, or without --texels-per-metre",
        on_by: "a set baked with --texels-per-metre or a --density and a small --size, or with --no-receive",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::SunVolumes,
        name: "sun-volumes",
        why_on: "the sun is up",
        why_off: SUN_DOWN,
        would_take: "a pass of light, and where something casts one of volumes; a pipeline a kind of surface",
        off_by: "--light sky or lamp, or an hour without sun",
        on_by: "an hour with a sun",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::SoftSun,
        name: "soft-sun",
        would_take: "a pass of volumes and one of light for each sun more",
        off_by: "--sun-samples 1",
        on_by: "--sun-samples N",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::ZPass,
        name: "z-pass",
        why_on: "the eye is outside of some volume, and the surface hides its caps",
        why_off: "nothing is counted in front of the surface",
        would_take: "a pipeline",
        off_by: "--technique volumes:zfail",
        on_by: "--technique volumes or volumes:zpass, and a closed mesh",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::ZFail,
        name: "z-fail",
        why_on: "the eye may be in some volume, or a cap shows: it is counted behind the surface, with its caps",
        why_off: "no eye is in a volume, and no cap shows",
        would_take: "a pipeline",
        off_by: "a view from outside of all volumes, of closed meshes",
        on_by: "an eye in shadow, an open mesh, or --technique volumes:zfail",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::OpenMeshes,
        name: "open-meshes",
        would_take: "prisms of all of its triangles, where a closed mesh has those of what faces the light",
        off_by: "closing their holes, or --leave-out when baking",
        on_by: "a mesh with a hole",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::SmoothSolids,
        name: "smooth-solids",
        why_on: "facets of smooth-shaded solids turn away from the light: their own volume does not shade them",
        why_off: "no solid that casts is smooth-shaded",
        would_take: "a pipeline that draws such facets into the stencil",
        off_by: "flat normals, or a set baked with --flat-terminator",
        on_by: "a closed mesh whose normals turn from corner to corner of a triangle",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::SilhouettesByGpu,
        name: "silhouettes-by-gpu",
        why_on: "volumes:gpu asks for it",
        why_off: "the CPU finds silhouettes",
        would_take: "two buffers of edges and triangles, and pipelines for each part of a volume",
        also_takes: "every edge is drawn, and the vertex shader drops those that are no silhouette",
        off_by: "--technique volumes",
        on_by: "--technique volumes:gpu",
    },
    EffectText {
        effect: DrawEffect::SeveralRuns,
        name: "several-runs",
        why_on: "more than 255 prisms may hold a pixel",
        why_off: "no more than 255 prisms hold a pixel: eight bits count them",
        would_take: "a pipeline that keeps what was counted, and a group of bindings and a buffer a run",
        off_by: "casters that overlap less",
        on_by: "casters that overlap more",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::VisualizedVolumes,
        name: "shown-volumes",
        why_on: "--output volumes shows them",
        why_off: "volumes are counted, and not shown",
        would_take: "a pipeline a part of a volume, and a pass over all faces",
        also_takes: "a pass over all faces, after the picture",
        off_by: "--output color",
        on_by: "--output volumes",
    },
    EffectText {
        effect: DrawEffect::SunShadows,
        name: "sun-shadows",
        why_on: "something in view may be in shadow",
        why_off: "nothing can be in shadow",
        would_take: "a map and a pass, a pipeline for casters, and bindings",
        off_by: "--light sky, or a scene in which nothing casts",
        on_by: "an hour with a sun, and something that casts",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::SeveralMaps,
        name: "several-maps",
        would_take: "a map, a pass, a group and a binding for each more",
        off_by: OTHER_MAP,
        on_by: "--technique map:cascades or map:cube",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::BlurredMask,
        name: "blurred-mask",
        why_on: "map:ground blurs a mask of casters on the ground",
        why_off: "no surface reads one",
        would_take: "two masks of a map's size, three passes, three pipelines, and two bindings",
        off_by: OTHER_MAP,
        on_by: "--technique map:ground, and a level plane",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::FlatMask,
        name: "flat-mask",
        why_on: "map:planar projects casters flat onto the ground",
        why_off: "no surface reads one",
        would_take: "a mask of the picture's size, a pass, a pipeline, and a binding",
        off_by: OTHER_MAP,
        on_by: "--technique map:planar, and a level plane",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::MapSampler,
        name: "map-sampler",
        why_on: "a sampler compares",
        why_off: "the shader compares texels itself, or none is read",
        would_take: "a binding",
        off_by: "--technique map:plain",
        on_by: "--technique map and most variants",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::WideFilter,
        name: "wide-filter",
        why_on: "edges are filtered over four by four texels",
        why_off: "one place is compared",
        would_take: "4 or 16 comparisons a pixel",
        off_by: "--technique map:compare",
        on_by: "--technique map:pcf16, map:pcf4 or map:cascades",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::MapPenumbra,
        name: "map-penumbra",
        why_on: "map:pcss filters as widely as the penumbra is",
        why_off: "filters have one width",
        would_take: PENUMBRA_COST,
        also_takes: PENUMBRA_COST,
        off_by: "--technique map:pcf16",
        on_by: "--technique map:pcss",
    },
    EffectText {
        effect: DrawEffect::SeparateGroundDraws,
        name: "ground-apart",
        why_on: "the lowest large level plane is drawn apart",
        why_off: "no surface is level",
        would_take: "a draw",
        off_by: "a scene without a level plane",
        on_by: "a level plane",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::TruthOfDisc,
        name: "truth-of-disc",
        why_on: "truth:soft sees the light's disc",
        why_off: "truth:hard sees the light's middle",
        off_by: "--technique truth:hard",
        on_by: "--technique truth:soft:N",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::TracedLamp,
        name: "lamp",
        why_on: "the set has a lamp",
        why_off: "there is no lamp, or it is off",
        off_by: "--light sun",
        on_by: "a set baked with --lamp FILE",
        ..NONE
    },
    EffectText {
        effect: DrawEffect::TracedAlphaMask,
        name: "alpha-test",
        why_on: "surfaces have alpha masks",
        why_off: "no surface has an alpha mask",
        would_take: ALPHA_RAY_COST,
        also_takes: ALPHA_RAY_COST,
        off_by: NO_ALPHA,
        on_by: ALPHA,
    },
];
