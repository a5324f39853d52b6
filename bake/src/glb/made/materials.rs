//! Writes materials, their textures and images.

use super::binary::Binary;
use crate::scene::{Alpha, Image, Material, Scene, TextureRef, Wrap};
use glam::Mat3;
use serde_json::{Map, Value, json};

/// Lists of the JSON that materials fill.
#[derive(Default)]
pub(super) struct MadeMaterials {
    pub materials: Vec<Value>,
    pub textures: Vec<Value>,
    pub samplers: Vec<Value>,
    pub images: Vec<Value>,
    /// Names of the extensions used, in alphabetical order.
    pub extensions: Vec<Value>,
}

pub(super) fn write(scene: &Scene, binary: &mut Binary) -> MadeMaterials {
    let images = scene.images.iter().map(|picture| image(picture, binary)).collect();
    let mut written = MadeMaterials { images, ..MadeMaterials::default() };
    for material in &scene.materials {
        let value = written.material(material);
        written.materials.push(value);
    }
    written.extensions.sort_by_key(Value::to_string);
    written
}

fn image(image: &Image, binary: &mut Binary) -> Value {
    let view = binary.add_view(png_of(image));
    json!({ "bufferView": view, "mimeType": "image/png", "name": image.name })
}

fn png_of(image: &Image) -> Vec<u8> {
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, image.width, image.height);
    encoder.set_color(png::ColorType::Rgba);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(image.rgba.as_flattened()));
    written.expect("a vector takes as many texels as the size says");
    png
}

/// The index of an equal entry; the entry is added if there is none.
fn index_of(list: &mut Vec<Value>, value: Value) -> usize {
    list.iter().position(|known| *known == value).unwrap_or_else(|| {
        list.push(value);
        list.len() - 1
    })
}

impl MadeMaterials {
    fn material(&mut self, material: &Material) -> Value {
        let mut pbr = json!({ "baseColorFactor": material.base_color.to_array(), "metallicFactor": 0.0 });
        if let Some(texture) = &material.base_color_texture {
            pbr["baseColorTexture"] = self.texture_info(texture);
        }
        let mut written = json!({ "pbrMetallicRoughness": pbr, "doubleSided": material.is_double_sided });
        if let Some(name) = &material.name {
            written["name"] = json!(name);
        }
        match material.alpha {
            Alpha::Opaque => {}
            Alpha::Mask { cutoff } => {
                written["alphaMode"] = json!("MASK");
                written["alphaCutoff"] = json!(cutoff);
            }
            Alpha::Invisible => written["extras"] = json!({ "sunbake_leave_out": true }),
        }
        let mut extensions = Map::new();
        if material.is_clear && material.alpha != Alpha::Invisible {
            let name = self.extension("KHR_materials_transmission");
            extensions.insert(name, json!({ "transmissionFactor": 1.0 }));
        }
        self.add_emission(material, &mut written, &mut extensions);
        if material.is_unlit {
            extensions.insert(self.extension("KHR_materials_unlit"), json!({}));
        }
        if !extensions.is_empty() {
            written["extensions"] = extensions.into();
        }
        written
    }

    /// Emission above 1 needs an extension.
    fn add_emission(&mut self, material: &Material, written: &mut Value, extensions: &mut Map<String, Value>) {
        let strength = material.emissive.max_element();
        if strength > 1.0 {
            written["emissiveFactor"] = json!((material.emissive / strength).to_array());
            let name = self.extension("KHR_materials_emissive_strength");
            extensions.insert(name, json!({ "emissiveStrength": strength }));
        } else if strength > 0.0 {
            written["emissiveFactor"] = json!(material.emissive.to_array());
        }
    }

    fn texture_info(&mut self, texture: &TextureRef) -> Value {
        let [wrap_s, wrap_t] = texture.wrap.map(wrap_code);
        let sampler = index_of(&mut self.samplers, json!({ "wrapS": wrap_s, "wrapT": wrap_t }));
        let index = index_of(&mut self.textures, json!({ "source": texture.image, "sampler": sampler }));
        let mut info = json!({ "index": index, "texCoord": texture.texcoord });
        if texture.image_from_texcoord != Mat3::IDENTITY {
            let name = self.extension("KHR_texture_transform");
            info["extensions"] = json!({ name: transform(&texture.image_from_texcoord) });
        }
        info
    }

    /// Lists an extension as used. Returns its name.
    fn extension(&mut self, name: &str) -> String {
        index_of(&mut self.extensions, json!(name));
        name.to_owned()
    }
}

fn wrap_code(wrap: Wrap) -> u32 {
    match wrap {
        Wrap::Repeat => 10497,
        Wrap::Mirror => 33648,
        Wrap::Clamp => 33071,
    }
}

/// Decomposes the matrix into offset, rotation and scale: the inverse of what `scene::materials` does.
fn transform(matrix: &Mat3) -> Value {
    let (x, y) = (matrix.x_axis.truncate(), matrix.y_axis.truncate());
    let rotation = if x.length_squared() > 0.0 { (-x.y).atan2(x.x) } else { y.x.atan2(y.y) };
    let (sin, cos) = rotation.sin_cos();
    let scale = [x.x * cos - x.y * sin, y.x * sin + y.y * cos];
    let offset = matrix.z_axis.truncate();
    match rotation == 0.0 {
        true => json!({ "offset": offset.to_array(), "scale": scale }),
        false => json!({ "offset": offset.to_array(), "rotation": rotation, "scale": scale }),
    }
}
