//! A page's ambient light as files: occlusion for viewers and for playback, bent normals, the sky, and all of them as
//! numbers.

use super::exr_file::write_exr;
use super::manifest::{AtlasEntry, SkyMapsEntry};
use super::write::{SetWriter, WriteError};
use crate::ambient::{AmbientPage, Side};
use crate::maps::{AmbientMaps, AmbientSide, Bits, in_8_bits};
use crate::settings::AmbientRequest;
use std::io::{Result, Seek, Write};

type WriteResult<T> = std::result::Result<T, WriteError>;

impl SetWriter {
    /// Writes the ambient light of page `index` and adds it to what the manifest says of the page.
    pub fn write_ambient(
        &mut self,
        index: usize,
        page: &AmbientPage,
        maps: &AmbientMaps,
        request: &AmbientRequest,
        entry: AtlasEntry,
    ) -> WriteResult<AtlasEntry> {
        let size = (entry.width, entry.height);
        let ao = format!("page{index}_ao.png");
        self.write_file(&ao, |file| write_occlusion(maps, size, request.bits, file))?;
        let of_side = |side: &Option<AmbientSide>| side.clone().unwrap_or_default();
        let back = of_side(&maps.back);
        let bent = self.write_bent(format!("page{index}_bent.png"), &maps.front, size)?;
        let bent_back = self.write_bent(format!("page{index}_bent_back.png"), &back, size)?;
        let front = self.write_sky(&format!("page{index}_sky"), &maps.front, size)?;
        let back = self.write_sky(&format!("page{index}_sky_back"), &back, size)?;
        let sky = front.map(|front| SkyMapsEntry { basis: "sh2".into(), front, back });
        let ambient_exr = request.exr.then(|| format!("page{index}_ambient.exr"));
        if let Some(name) = &ambient_exr {
            self.write_file(name, |file| write_numbers(page, file))?;
        }
        Ok(AtlasEntry { ao: Some(ao), bent, bent_back, sky, ambient_exr, ..entry })
    }

    fn write_bent(&mut self, name: String, side: &AmbientSide, size: (u32, u32)) -> WriteResult<Option<String>> {
        let Some(bent) = &side.bent else { return Ok(None) };
        self.write_file(&name, |file| write_rgb16(bent.iter().copied(), size, file))?;
        Ok(Some(name))
    }

    fn write_sky(&mut self, stem: &str, side: &AmbientSide, size: (u32, u32)) -> WriteResult<Option<[String; 3]>> {
        let Some(sky) = &side.sky else { return Ok(None) };
        let names = [0, 1, 2].map(|k| format!("{stem}{k}.png"));
        for (k, name) in names.iter().enumerate() {
            let three = sky.iter().map(|codes| [codes[3 * k], codes[3 * k + 1], codes[3 * k + 2]]);
            self.write_file(name, |file| write_rgb16(three, size, file))?;
        }
        Ok(Some(names))
    }
}

/// Grey, or where there are backs red for viewers, green for fronts, blue for backs.
fn write_occlusion(maps: &AmbientMaps, size: (u32, u32), bits: Bits, file: impl Write) -> Result<()> {
    let front = &maps.front.open;
    let (color, codes): (_, Vec<u16>) = match &maps.back {
        None => (png::ColorType::Grayscale, front.clone()),
        Some(back) => {
            (png::ColorType::Rgb, front.iter().zip(&back.open).flat_map(|(&f, &b)| [f.max(b), f, b]).collect())
        }
    };
    write_png(&codes, color, size, bits, file)
}

fn write_rgb16(texels: impl Iterator<Item = [u16; 3]>, size: (u32, u32), file: impl Write) -> Result<()> {
    write_png(&texels.flatten().collect::<Vec<u16>>(), png::ColorType::Rgb, size, Bits::Sixteen, file)
}

fn write_png(codes: &[u16], color: png::ColorType, size: (u32, u32), bits: Bits, file: impl Write) -> Result<()> {
    let mut encoder = png::Encoder::new(file, size.0, size.1);
    encoder.set_color(color);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Up);
    let bytes: Vec<u8> = match bits {
        Bits::Eight => codes.iter().map(|&code| in_8_bits(code)).collect(),
        Bits::Sixteen => codes.iter().flat_map(|code| code.to_be_bytes()).collect(),
    };
    encoder.set_depth(match bits {
        Bits::Eight => png::BitDepth::Eight,
        Bits::Sixteen => png::BitDepth::Sixteen,
    });
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&bytes)?;
    Ok(writer.finish()?)
}

/// One channel a quantity: `ao`, `bent.x` and so on, `sky.0` to `sky.8`; those of backs begin with `back.`.
fn write_numbers(page: &AmbientPage, file: impl Write + Seek) -> Result<()> {
    let mut channels = Vec::new();
    for (prefix, side) in std::iter::once(("", &page.front)).chain(page.back.as_ref().map(|back| ("back.", back))) {
        let Side { open, bent, sky } = side;
        let mut add = |name: String, plane: &[f32]| channels.push((name, plane.to_vec()));
        add(format!("{prefix}ao"), open);
        bent.iter().zip(["x", "y", "z"]).for_each(|(plane, axis)| add(format!("{prefix}bent.{axis}"), plane));
        sky.iter().enumerate().for_each(|(k, plane)| add(format!("{prefix}sky.{k}"), plane));
    }
    write_exr([page.size.width, page.size.height], channels, file)
}
