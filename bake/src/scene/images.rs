//! Base colour images: format from their first bytes, size checked before decoding, decoded on all cores.
//!
//! Only images that a drawn material uses for its base colour are decoded. The others are read, if possible, because
//! the scene's hash covers every file that it names.

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
struct Encoded {
    file_index: usize,
    name: String,
    bytes: Vec<u8>,
}

/// Reads the needed images, and hashes all that are separate files.
pub(super) fn read(
    doc: &Document,
    buffers: &Buffers,
    fetcher: &mut Fetcher,
    budget: &MemoryBudget,
    needed: &BTreeSet<usize>,
) -> Result<(Vec<Image>, BTreeMap<usize, Decoded>), LoadError> {
    let mut decoded = BTreeMap::new();
    let mut encoded = Vec::new();
    let count = doc.count::<document::JsonImage>();
    for file_index in (0..count).chain(needed.range(count..).copied()) {
        let is_needed = needed.contains(&file_index);
        let name = name(doc, file_index);
        match bytes(doc, file_index, buffers, fetcher, is_needed) {
            Err(error @ (LoadError::Outside { .. } | LoadError::TooLarge { .. })) if is_needed => return Err(error),
            Err(error) if is_needed => {
                decoded.insert(file_index, Decoded::Failed { name, cause: error.to_string(), has_no_alpha: false });
            }
            Ok(bytes) if is_needed => {
                reserve_memory(&bytes, &name, budget)?;
                encoded.push(Encoded { file_index, name, bytes });
            }
            _ => {}
        }
    }
    let results: Vec<_> = encoded.into_par_iter().map(|e| (e.file_index, decode(e))).collect();
    let mut images = Vec::new();
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
    Ok((images, decoded))
}

/// An image's place and name, for messages: `images[3] "bark.png"`.
fn name(doc: &Document, index: usize) -> String {
    let place = place::<document::JsonImage>(index);
    let image: Option<document::JsonImage> = doc.get(index).ok();
    let named = image.and_then(|i| i.name.or(i.uri.filter(|uri| !uri.starts_with("data:"))));
    named.map_or(place.clone(), |name| format!("{place} \"{name}\""))
}

fn bytes(
    doc: &Document,
    index: usize,
    buffers: &Buffers,
    fetcher: &mut Fetcher,
    is_needed: bool,
) -> Result<Vec<u8>, LoadError> {
    let image: document::JsonImage = doc.get(index)?;
    let place = place::<document::JsonImage>(index);
    match (image.uri, image.buffer_view) {
        (Some(uri), _) if is_needed => fetcher.fetch(&place, &uri),
        (Some(uri), _) => fetcher.hash_only(&place, &uri).map(|()| Vec::new()),
        (None, Some(view)) if is_needed => Ok(buffers.view(doc, view)?.0.to_vec()),
        (None, None) => Err(LoadError::structure(place, "it has neither a uri nor a bufferView")),
        _ => Ok(Vec::new()),
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
    let format = match format_of(&bytes) {
        Ok(format) => format,
        Err(cause) => return Err(Decoded::Failed { name, cause, has_no_alpha: false }),
    };
    let rgba = match decode_rgba(&bytes, format) {
        Ok(rgba) => rgba,
        Err(error) => {
            let has_no_alpha = format == ImageFormat::Jpeg;
            return Err(Decoded::Failed { name, cause: error.to_string(), has_no_alpha });
        }
    };
    let (width, height) = rgba.dimensions();
    let rgba = rgba.as_raw().as_chunks::<4>().0.to_vec();
    let range = rgba.iter().fold([255, 0], |[low, high], [_, _, _, a]| [a.min(&low), a.max(&high)].map(|x: &u8| *x));
    let mime_type = if format == ImageFormat::Png { "image/png" } else { "image/jpeg" };
    Ok((Image { name, width, height, rgba, encoded: bytes, mime_type }, range))
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
