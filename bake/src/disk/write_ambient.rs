//! Writes a page's ambient light: occlusion, bent normals, sky coefficients, and all of them as floats.

use super::exr_file::write_exr;
use super::manifest::AtlasEntry;
use super::page::BakedPage;
use super::png_file::write_png;
use super::write::{SetWriter, WriteError};
use crate::ambient::{AmbientPage, AmbientPlanes};
use crate::maps::{AmbientMaps, AmbientSide, Bits, in_8_bits};
use std::io::{Result, Seek, Write};

type WriteResult<T> = std::result::Result<T, WriteError>;

impl SetWriter {
    /// Writes the ambient light of a page, if it has any.
    pub(super) fn write_ambient(&mut self, entry: &AtlasEntry, page: &BakedPage, bits: Bits) -> WriteResult<()> {
        let (Some(ao), Some(AmbientMaps { front, back })) = (&entry.ao, &page.maps.ambient) else { return Ok(()) };
        let size = (entry.width, entry.height);
        self.write_file(ao, |file| write_occlusion(front, back.as_ref(), size, bits, file))?;
        let names = [entry.sky.as_ref().map(|sky| &sky.front), entry.sky.as_ref().and_then(|sky| sky.back.as_ref())];
        let sides = [(&entry.bent, names[0], Some(front)), (&entry.bent_back, names[1], back.as_ref())];
        for (bent_name, sky_names, side) in sides {
            if let Some((name, bent)) = bent_name.as_ref().zip(side.and_then(|side| side.bent.as_ref())) {
                self.write_file(name, |file| write_rgb16(bent.iter().copied(), size, file))?;
            }
            if let Some((names, sky)) = sky_names.zip(side.and_then(|side| side.sky.as_ref())) {
                self.write_sky(names, sky, size)?;
            }
        }
        if let Some((name, numbers)) = entry.ambient_exr.as_ref().zip(page.ambient_numbers.as_ref()) {
            self.write_file(name, |file| write_numbers(numbers, file))?;
        }
        Ok(())
    }

    fn write_sky(&mut self, names: &[String; 3], sky: &[[u16; 9]], size: (u32, u32)) -> WriteResult<()> {
        for (k, name) in names.iter().enumerate() {
            let three = sky.iter().map(|codes| [codes[3 * k], codes[3 * k + 1], codes[3 * k + 2]]);
            self.write_file(name, |file| write_rgb16(three, size, file))?;
        }
        Ok(())
    }
}

/// Grey; or, if some texel has a back, RGB: green is the front, blue the back, and red, for viewers, the brighter of
/// both.
fn write_occlusion(
    front: &AmbientSide,
    back: Option<&AmbientSide>,
    size: (u32, u32),
    bits: Bits,
    file: impl Write,
) -> Result<()> {
    let (color, codes): (_, Vec<u16>) = match back {
        None => (png::ColorType::Grayscale, front.visibility.clone()),
        Some(back) => (
            png::ColorType::Rgb,
            front.visibility.iter().zip(&back.visibility).flat_map(|(&f, &b)| [f.max(b), f, b]).collect(),
        ),
    };
    write_codes(&codes, color, size, bits, file)
}

fn write_rgb16(texels: impl Iterator<Item = [u16; 3]>, size: (u32, u32), file: impl Write) -> Result<()> {
    write_codes(&texels.flatten().collect::<Vec<u16>>(), png::ColorType::Rgb, size, Bits::Sixteen, file)
}

/// Writes codes of 16 bits, rounded to 8 bits if asked.
fn write_codes(codes: &[u16], color: png::ColorType, size: (u32, u32), bits: Bits, file: impl Write) -> Result<()> {
    let bytes: Vec<u8> = match bits {
        Bits::Eight => codes.iter().map(|&code| in_8_bits(code)).collect(),
        Bits::Sixteen => codes.iter().flat_map(|code| code.to_be_bytes()).collect(),
    };
    write_png(&bytes, color, size, bits, file)
}

/// Writes one channel for each quantity: `ao`, `bent.x` to `bent.z`, `sky.0` to `sky.8`. Backs have the prefix `back.`.
fn write_numbers(page: &AmbientPage, file: impl Write + Seek) -> Result<()> {
    let mut channels = Vec::new();
    for (prefix, side) in std::iter::once(("", &page.front)).chain(page.back.as_ref().map(|back| ("back.", back))) {
        let AmbientPlanes { visibility, bent, sky } = side;
        let mut add = |name: String, plane: &[f32]| channels.push((name, plane.to_vec()));
        add(format!("{prefix}ao"), visibility);
        bent.iter().zip(["x", "y", "z"]).for_each(|(plane, axis)| add(format!("{prefix}bent.{axis}"), plane));
        sky.iter().enumerate().for_each(|(k, plane)| add(format!("{prefix}sky.{k}"), plane));
    }
    write_exr([page.size.width, page.size.height], channels, file)
}
