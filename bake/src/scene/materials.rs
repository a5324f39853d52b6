//! Materials, as far as shadows and the base colour need them.
//!
//! `BLEND` surfaces are read as alpha masks with a cutoff of one half. `MASK` and `BLEND` are simplified here, from the
//! range of alpha that a surface can have (factor times texture times vertex colour): if alpha is never below the
//! cutoff, the surface is opaque and nothing has to sample it; a blended surface that never reaches the cutoff is
//! clear: light passes it, and nothing has to sample it either.

use super::{
    Alpha, LoadError, Material, TextureRef, Wrap,
    document::{self, Document, TextureInfo, TextureTransform, place},
    images::Decoded,
    limits::WarningLog,
    primitives::DrawnMeshes,
};
use glam::{Mat3, Vec2, Vec3, Vec4};
use std::collections::{BTreeMap, BTreeSet};

/// Least alpha at which a `BLEND` surface is solid.
pub const BLEND_CUTOFF: f32 = 0.5;

/// Least `transmissionFactor` of a clear surface.
const CLEAR_TRANSMISSION: f32 = 0.5;

/// A material before its image is decoded: [`TextureRef::image`] is still an index into the file's images.
pub(super) struct DraftMaterial {
    place: String,
    material: Material,
    /// `None`: alpha is ignored.
    cutoff: Option<f32>,
    /// Whether the file says `BLEND`.
    is_blended: bool,
}

/// Reads the drawn materials, in file order with glTF's default material last, and sets the meshes' material indices.
pub(super) fn read(
    doc: &Document,
    drawn: &mut DrawnMeshes,
    log: &mut WarningLog,
) -> Result<Vec<DraftMaterial>, LoadError> {
    let sorted = |file: &Option<usize>| file.unwrap_or(usize::MAX);
    let used: BTreeSet<usize> = drawn.file_material.iter().map(sorted).collect();
    let new_from_file: BTreeMap<usize, usize> = used.iter().enumerate().map(|(new, &file)| (file, new)).collect();
    for (mesh, file) in drawn.meshes.iter_mut().zip(&drawn.file_material) {
        mesh.material = new_from_file.get(&sorted(file)).copied().unwrap_or_default();
    }
    used.into_iter().map(|file| draft(doc, file, log)).collect()
}

/// `index` is `usize::MAX` for the default material.
fn draft(doc: &Document, index: usize, log: &mut WarningLog) -> Result<DraftMaterial, LoadError> {
    let (place, file) = match index {
        usize::MAX => ("the default material".to_owned(), document::JsonMaterial::default()),
        _ => (place::<document::JsonMaterial>(index), doc.get::<document::JsonMaterial>(index)?),
    };
    let place = file.name.as_ref().map_or(place.clone(), |name| format!("{place} \"{name}\""));
    let is_blended = file.alpha_mode.as_deref() == Some("BLEND");
    let cutoff = match file.alpha_mode.as_deref() {
        Some("MASK") => Some(file.alpha_cutoff.filter(|c| c.is_finite()).unwrap_or(0.5)),
        Some("BLEND") => Some(BLEND_CUTOFF),
        _ => None,
    };
    let strength = file.extensions.emissive_strength.as_ref().and_then(|e| e.emissive_strength).unwrap_or(1.0);
    let transmission = file.extensions.transmission.as_ref();
    let mut material = Material {
        name: file.name.clone(),
        gltf: (index != usize::MAX).then_some(index),
        base_color: Vec4::ONE,
        base_color_texture: None,
        emissive: Vec3::from_array(file.emissive_factor.unwrap_or_default()).clamp(Vec3::ZERO, Vec3::ONE)
            * strength.clamp(0.0, 1e6),
        alpha: Alpha::Opaque,
        is_double_sided: file.double_sided,
        is_unlit: file.extensions.unlit.is_some(),
        is_clear: transmission.and_then(|e| e.transmission_factor).unwrap_or(0.0) >= CLEAR_TRANSMISSION,
    };
    let (factor, texture) = file.base_color();
    material.base_color = Vec4::from_array(factor).clamp(Vec4::ZERO, Vec4::ONE);
    match texture.map(|info| texture_ref(doc, &info)) {
        Some(Err(cause)) => report_unusable_texture(&place, "its base colour texture", &cause, cutoff.is_some(), log)?,
        Some(Ok(texture)) => material.base_color_texture = Some(texture),
        None => {}
    }
    Ok(DraftMaterial { place, material, cutoff, is_blended })
}

/// Where a texture is and how it is read; [`TextureRef::image`] is an index into the file's images.
pub(super) fn texture_ref(doc: &Document, info: &TextureInfo) -> Result<TextureRef, String> {
    let texture: document::JsonTexture = doc.get(info.index).map_err(|error| error.to_string())?;
    let image = texture.source.ok_or_else(|| match texture.extensions.iter().flatten().next() {
        Some((extension, _)) => format!("it is given by {extension} alone, which sunbake does not read"),
        None => "it names no image".to_owned(),
    })?;
    let sampler = texture.sampler.and_then(|sampler| doc.get::<document::JsonSampler>(sampler).ok());
    let wrap = |code: Option<u64>| match code {
        Some(33071) => Wrap::Clamp,
        Some(33648) => Wrap::Mirror,
        _ => Wrap::Repeat,
    };
    Ok(TextureRef {
        image,
        texcoord: info.texcoord(),
        image_from_texcoord: info.extensions.transform.as_ref().map_or(Mat3::IDENTITY, image_from_texcoord),
        wrap: sampler.map_or([Wrap::Repeat; 2], |sampler| [wrap(sampler.wrap_s), wrap(sampler.wrap_t)]),
    })
}

/// `KHR_texture_transform`: scale, then a rotation that looks counter-clockwise (v points down), then the offset.
fn image_from_texcoord(transform: &TextureTransform) -> Mat3 {
    let (sin, cos) = transform.rotation.unwrap_or_default().sin_cos();
    let turn = Mat3::from_cols(Vec3::new(cos, -sin, 0.0), Vec3::new(sin, cos, 0.0), Vec3::Z);
    let scale = Mat3::from_scale(transform.scale.map_or(Vec2::ONE, Vec2::from_array));
    let matrix = Mat3::from_translation(transform.offset.map_or(Vec2::ZERO, Vec2::from_array)) * turn * scale;
    if matrix.is_finite() { matrix } else { Mat3::IDENTITY }
}

/// Reports a texture that cannot be used: an error if it is an alpha mask, else a warning.
fn report_unusable_texture(
    place: &str,
    image: &str,
    cause: &str,
    is_mask: bool,
    log: &mut WarningLog,
) -> Result<(), LoadError> {
    if is_mask {
        return Err(LoadError::AlphaImage { place: place.into(), image: image.into(), cause: cause.into() });
    }
    log.warn(format!("{image} cannot be used ({cause}); drawn in its plain colour instead"), place);
    Ok(())
}

/// Indices in the file of the images that base colours use.
pub(super) fn needed_images(drafts: &[DraftMaterial]) -> BTreeSet<usize> {
    drafts.iter().filter_map(|draft| draft.material.base_color_texture).map(|texture| texture.image).collect()
}

/// Finishes the materials: sets final image indices and simplifies alpha.
pub(super) fn finish(
    drafts: Vec<DraftMaterial>,
    images: &BTreeMap<usize, Decoded>,
    drawn: &DrawnMeshes,
    log: &mut WarningLog,
) -> Result<Vec<Material>, LoadError> {
    let vertex_alpha = vertex_alpha_ranges(drawn, drafts.len());
    let finish_one = |(mut draft, vertex): (DraftMaterial, AlphaRange)| {
        let mut texture_alpha = AlphaRange { low: 1.0, high: 1.0 };
        if let Some(texture) = &mut draft.material.base_color_texture {
            match images.get(&texture.image) {
                Some(Decoded::Ready { index, lowest_alpha, highest_alpha }) => {
                    texture.image = *index;
                    texture_alpha = AlphaRange { low: unit(*lowest_alpha), high: unit(*highest_alpha) };
                }
                Some(Decoded::Failed { name, cause, has_no_alpha }) => {
                    let is_mask = draft.cutoff.is_some() && !has_no_alpha;
                    report_unusable_texture(&draft.place, name, cause, is_mask, log)?;
                    draft.material.base_color_texture = None;
                }
                None => draft.material.base_color_texture = None,
            }
        }
        let factor = draft.material.base_color.w;
        let range = AlphaRange {
            low: factor * texture_alpha.low * vertex.low,
            high: factor * texture_alpha.high * vertex.high,
        };
        draft.material.is_clear |= draft.is_blended && range.high < BLEND_CUTOFF;
        draft.material.alpha = draft.cutoff.map_or(Alpha::Opaque, |cutoff| range.masked_at(cutoff, draft.is_blended));
        Ok(draft.material)
    };
    drafts.into_iter().zip(vertex_alpha).map(finish_one).collect()
}

fn unit(byte: u8) -> f32 {
    f32::from(byte) / 255.0
}

/// A range of alpha.
#[derive(Clone, Copy)]
struct AlphaRange {
    low: f32,
    high: f32,
}

impl AlphaRange {
    fn masked_at(self, cutoff: f32, is_blended: bool) -> Alpha {
        match (self.low >= cutoff, self.high >= cutoff) {
            (true, _) => Alpha::Opaque,
            (_, false) if is_blended && self.high <= 0.0 => Alpha::Invisible,
            (_, false) if is_blended => Alpha::Opaque,
            _ => Alpha::Mask { cutoff },
        }
    }
}

/// For each material, the range of vertex alpha over all meshes that use it.
fn vertex_alpha_ranges(drawn: &DrawnMeshes, material_count: usize) -> Vec<AlphaRange> {
    let mut ranges = vec![AlphaRange { low: f32::INFINITY, high: f32::NEG_INFINITY }; material_count];
    for mesh in &drawn.meshes {
        let Some(range) = ranges.get_mut(mesh.material) else { continue };
        let mut widen = |alpha: f32| *range = AlphaRange { low: range.low.min(alpha), high: range.high.max(alpha) };
        match &mesh.colors {
            Some(colors) => colors.iter().for_each(|color| widen(color.w)),
            None => widen(1.0),
        }
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_texture_transform_rotates_counter_clockwise_about_the_origin() {
        let quarter = TextureTransform {
            offset: Some([0.25, 0.5]),
            rotation: Some(std::f32::consts::FRAC_PI_2),
            scale: Some([2.0, 4.0]),
            tex_coord: None,
        };
        let matrix = image_from_texcoord(&quarter);
        assert!(matrix.transform_point2(Vec2::ZERO).distance(Vec2::new(0.25, 0.5)) < 1e-6);
        assert!(
            matrix.transform_point2(Vec2::X).distance(Vec2::new(0.25, 0.5 - 2.0)) < 1e-6,
            "u turns upwards, since v points down"
        );
        assert!(matrix.transform_point2(Vec2::Y).distance(Vec2::new(0.25 + 4.0, 0.5)) < 1e-6);
    }

    #[test]
    fn alpha_is_sampled_only_where_it_can_fall_on_both_sides_of_the_cutoff() {
        let masked = |low, high, cutoff| AlphaRange { low, high }.masked_at(cutoff, true);
        assert_eq!(masked(0.0, 1.0, 0.5), Alpha::Mask { cutoff: 0.5 });
        assert_eq!(masked(0.0, 1.0, 0.0), Alpha::Opaque, "nothing is below a cutoff of 0");
        assert_eq!(masked(0.0, 1.0, 1.0), Alpha::Mask { cutoff: 1.0 }, "alpha 1 reaches a cutoff of 1");
        assert_eq!(masked(0.0, 0.49, 0.5), Alpha::Opaque, "glass can be seen");
        assert_eq!(masked(0.0, 0.0, 0.5), Alpha::Invisible);
        assert_eq!(masked(0.5, 0.5, 0.5), Alpha::Opaque);
        let mask = AlphaRange { low: 0.0, high: 0.4 }.masked_at(0.5, false);
        assert_eq!(mask, Alpha::Mask { cutoff: 0.5 }, "a mask remains a mask even if it hides everything");
    }
}
