//! Shadow tracks on disk: a picture of where texels have their spans, and one of the spans.

use super::manifest::TracksEntry;
use super::png_file::write_png;
use super::read::{ReadError, decode};
use super::write::{SetWriter, WriteError};
use crate::maps::Bits;
use crate::tracks::{PageTracks, SPANS_WIDTH, TrackSpan};
use std::path::Path;

impl SetWriter {
    /// Writes the tracks of a page of a size in texels.
    pub(super) fn write_tracks(
        &mut self,
        names: &TracksEntry,
        tracks: &PageTracks,
        size: (u32, u32),
    ) -> Result<(), WriteError> {
        let lists: Vec<u8> = tracks.lists().flat_map(u32::to_le_bytes).collect();
        self.write_file(&names.lists, |file| write_png(&lists, png::ColorType::Rgba, size, Bits::Eight, file))?;
        let codes = tracks.spans.iter().flat_map(|span| [span.track, span.start, span.end]);
        let mut spans: Vec<u8> = codes.flat_map(u16::to_be_bytes).collect();
        let size = spans_size(names.count);
        spans.resize(SPAN_BYTES * size.0 as usize * size.1 as usize, 0);
        self.write_file(&names.spans, |file| write_png(&spans, png::ColorType::Rgb, size, Bits::Sixteen, file))
    }
}

/// Bytes of a span.
const SPAN_BYTES: usize = 6;

/// Width and height of the picture of this many spans.
fn spans_size(count: u32) -> (u32, u32) {
    (SPANS_WIDTH, count.div_ceil(SPANS_WIDTH).max(1))
}

/// Reads the tracks of a page of a size in texels.
pub(super) fn read_tracks(folder: &Path, names: &TracksEntry, size: (u32, u32)) -> Result<PageTracks, ReadError> {
    let [lists_file, spans_file] = [&names.lists, &names.spans].map(|name| folder.join(name));
    let wrong = |path: &Path, reason: String| ReadError::Texture { path: path.to_owned(), reason };
    let lists = match decode(&lists_file, size)? {
        image::DynamicImage::ImageRgba8(image) => image,
        image => return Err(wrong(&lists_file, format!("its texels are {:?}, not RGBA of 8 bits", image.color()))),
    };
    let spans = match decode(&spans_file, spans_size(names.count))? {
        image::DynamicImage::ImageRgb16(image) => image,
        image => return Err(wrong(&spans_file, format!("its texels are {:?}, not RGB of 16 bits", image.color()))),
    };
    let span = |texel: &image::Rgb<u16>| {
        let [track, start, end] = texel.0;
        TrackSpan { track, start, end }
    };
    let spans: Vec<TrackSpan> = spans.pixels().take(names.count as usize).map(span).collect();
    let mut ranges = Vec::with_capacity(size.0 as usize * size.1 as usize);
    for (texel, list) in lists.pixels().map(|texel| u32::from_le_bytes(texel.0)).enumerate() {
        let [first, count] = PageTracks::range_of(list);
        let own = spans.get(first as usize..first as usize + count as usize);
        if !own.is_some_and(|own| own.is_sorted_by(|a, b| a.track < b.track)) {
            let (x, y) = (texel % size.0 as usize, texel / size.0 as usize);
            let reason =
                format!("the list of texel {x}, {y} is not one of ascending tracks among {} spans", spans.len());
            return Err(wrong(&lists_file, reason));
        }
        ranges.push([first, count]);
    }
    Ok(PageTracks { ranges, spans })
}
