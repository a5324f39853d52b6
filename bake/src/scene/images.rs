//! Images: format from their first bytes, size checked before decoding, decoded on all cores.
//!
//! Loading decodes only images that a drawn material uses for its base colour; [`super::looks`] decodes others when a
//! picture needs them. All are read, if possible, because `scene.glb` keeps them, and the scene's hash covers every
//! file that it names.

use super::{
    Image, LoadError,
    document::{self, Document, place},
    limits::MemoryBudget,
    resources::{Buffers, Fetcher},
};
use image::{ImageFormat, ImageReader, Limits};
use rayon::prelude::*;
use std::{
    collections::{BTreeMap, BTreeSet},
    io::Cursor,
};

/// The result for an image of the file.
pub(super) enum Decoded {
    /// Decoded, at `index` in the scene's list; alphas are 0 to 255.
    Ready { index: usize, lowest_alpha: u8, highest_alpha: u8 },
    /// It cannot be used.
    Failed { name: String, cause: String, has_no_alpha: bool },
}

/// A needed image, not decoded yet.
struct Encoded<'a> {
    name: String,
    bytes: &'a [u8],
}

/// The bytes of an image that a URI names, or why there are none; `None` for an image in a buffer view.
pub(super) type Picture = Option<Result<Vec<u8>, LoadError>>;

/// Reads the images that URIs name, needed or not: `scene.glb` keeps them all.
pub(super) fn fetch(doc: &Document, fetcher: &mut Fetcher) -> Vec<Picture> {
    let fetch_one = |index: usize| {
        let place = place::<document::JsonImage>(index);
        let uri = doc.get::<document::JsonImage>(index).ok()?.uri?;
        let read = fetcher.fetch(&place, &uri);
        if let Err(LoadError::TooLarge { .. }) = read {
            // The scene's hash covers it all the same.
            let _ = fetcher.hash_only(&place, &uri);
        }
        Some(read)
    };
    (0..doc.count::<document::JsonImage>()).map(fetch_one).collect()
}

/// Decodes the needed images. One outside of the scene's folder or beyond the budget stops it.
pub(super) fn read(
    doc: &Document,
    buffers: &Buffers,
    pictures: &[Picture],
    budget: &MemoryBudget,
    needed: &BTreeSet<usize>,
) -> Result<(Vec<Image>, BTreeMap<usize, Decoded>), LoadError> {
    let found = needed.iter().map(|&index| (index, encoded(doc, buffers, pictures, budget, index)));
    let is_fatal = |error: &LoadError| matches!(error, LoadError::Outside { .. } | LoadError::TooLarge { .. });
    let all = found.map(|(index, read)| match read {
        Err(error) if is_fatal(&error) => Err(error),
        read => Ok((index, read)),
    });
    Ok(decode_all(doc, all.collect::<Result<_, _>>()?))
}

/// Decodes images that only looks need: what cannot be had is a failure of that image alone.
pub(super) fn read_what_can_be(
    doc: &Document,
    buffers: &Buffers,
    pictures: &[Picture],
    budget: &MemoryBudget,
    needed: &BTreeSet<usize>,
) -> (Vec<Image>, BTreeMap<usize, Decoded>) {
    let found = needed.iter().map(|&index| (index, encoded(doc, buffers, pictures, budget, index)));
    decode_all(doc, found.collect())
}

/// An image's bytes, with the memory for decoding it taken from the budget.
fn encoded<'a>(
    doc: &Document,
    buffers: &'a Buffers,
    pictures: &'a [Picture],
    budget: &MemoryBudget,
    file_index: usize,
) -> Result<Encoded<'a>, LoadError> {
    let name = name(doc, file_index);
    let bytes = bytes(doc, file_index, buffers, pictures)?;
    reserve_memory(bytes, &name, budget)?;
    Ok(Encoded { name, bytes })
}

fn decode_all(
    doc: &Document,
    found: Vec<(usize, Result<Encoded, LoadError>)>,
) -> (Vec<Image>, BTreeMap<usize, Decoded>) {
    let decode_one = |(file_index, read): (usize, Result<Encoded, LoadError>)| match read {
        Ok(encoded) => (file_index, decode(encoded)),
        Err(error) => {
            let name = name(doc, file_index);
            (file_index, Err(Decoded::Failed { name, cause: error.to_string(), has_no_alpha: false }))
        }
    };
    let results: Vec<_> = found.into_par_iter().map(decode_one).collect();
    let (mut images, mut decoded) = (Vec::new(), BTreeMap::new());
    for (file_index, result) in results {
        let entry = match result {
            Ok((image, [lowest_alpha, highest_alpha])) => {
                images.push(image);
                Decoded::Ready { index: images.len() - 1, lowest_alpha, highest_alpha }
            }
            Err(failed) => failed,
        };
        decoded.insert(file_index, entry);
    }
    (images, decoded)
}

/// An image's place and name, for messages: `images[3] "bark.png"`.
fn name(doc: &Document, index: usize) -> String {
    let place = place::<document::JsonImage>(index);
    let image: Option<document::JsonImage> = doc.get(index).ok();
    let named = image.and_then(|i| i.name.or(i.uri.filter(|uri| !uri.starts_with("data:"))));
    named.map_or(place.clone(), |name| format!("{place} \"{name}\""))
}

fn bytes<'a>(
    doc: &Document,
    index: usize,
    buffers: &'a Buffers,
    pictures: &'a [Picture],
) -> Result<&'a [u8], LoadError> {
    let image: document::JsonImage = doc.get(index)?;
    match (pictures.get(index), image.buffer_view) {
        (Some(Some(picture)), _) => picture.as_deref().map_err(LoadError::clone),
        (_, Some(view)) => Ok(buffers.view(doc, view)?.0),
        _ => {
            let problem = "it has neither a uri nor a bufferView";
            Err(LoadError::structure(place::<document::JsonImage>(index), problem))
        }
    }
}

/// Takes the decoded image's memory from the budget. A small file can hold a huge image, so the header is read first.
fn reserve_memory(bytes: &[u8], name: &str, budget: &MemoryBudget) -> Result<(), LoadError> {
    let Some((width, height)) = format_of(bytes).ok().and_then(|format| dimensions(bytes, format)) else {
        return Ok(());
    };
    budget.take(u64::from(width) * u64::from(height), 4, || format!("{name}, of {width} by {height} texels,"))
}

fn dimensions(bytes: &[u8], format: ImageFormat) -> Option<(u32, u32)> {
    ImageReader::with_format(Cursor::new(bytes), format).into_dimensions().ok()
}

/// PNG or JPEG, by content and not by name.
fn format_of(bytes: &[u8]) -> Result<ImageFormat, String> {
    match image::guess_format(bytes) {
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => Ok(format),
        Ok(ImageFormat::WebP) => {
            Err("it is WebP; convert it: npx @gltf-transform/cli png IN OUT.glb --formats \"*\"".into())
        }
        Ok(other) => Err(format!("it is {other:?}, and only PNG and JPEG are read")),
        Err(_) => Err("it is neither PNG nor JPEG".into()),
    }
}

fn decode(encoded: Encoded) -> Result<(Image, [u8; 2]), Decoded> {
    let Encoded { name, bytes, .. } = encoded;
    let format = match format_of(bytes) {
        Ok(format) => format,
        Err(cause) => return Err(Decoded::Failed { name, cause, has_no_alpha: false }),
    };
    let rgba = match decode_rgba(bytes, format) {
        Ok(rgba) => rgba,
        Err(error) => {
            let has_no_alpha = format == ImageFormat::Jpeg;
            return Err(Decoded::Failed { name, cause: error.to_string(), has_no_alpha });
        }
    };
    let (width, height) = rgba.dimensions();
    let rgba = rgba.as_raw().as_chunks::<4>().0.to_vec();
    let range = rgba.iter().fold([255, 0], |[low, high], [_, _, _, a]| [a.min(&low), a.max(&high)].map(|x: &u8| *x));
    Ok((Image { name, width, height, rgba }, range))
}

fn decode_rgba(bytes: &[u8], format: ImageFormat) -> image::ImageResult<image::RgbaImage> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let texels = dimensions(bytes, format).map_or(0, |(width, height)| u64::from(width) * u64::from(height));
    let mut limits = Limits::no_limits();
    // Four channels of sixteen bits, twice, and the decoder's tables.
    limits.max_alloc = Some(texels.saturating_mul(16).saturating_add(16 << 20));
    reader.limits(limits);
    Ok(reader.decode()?.into_rgba8())
}
