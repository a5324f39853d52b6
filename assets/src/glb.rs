//! Writes a [`Scene`] as a binary glTF 2.0 file. Based on: Khronos, glTF 2.0 specification, 2021.

use serde_json::{Value, json};

use crate::material::Material;
use crate::scene::{Content, Mesh, Node, Scene};
use crate::textures::Texture;
use crate::weld::Primitive;

const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const REPEAT: u32 = 10497;
const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;

/// The file's lists while they grow.
#[derive(Default)]
struct Writer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<Material>,
    textures: Vec<Texture>,
}

/// The scene as the bytes of a GLB file.
pub(crate) fn write(scene: &Scene) -> Vec<u8> {
    let mut writer = Writer::default();
    let meshes: Vec<_> = scene.meshes.iter().map(|m| writer.mesh(m)).collect();
    let materials: Vec<_> = writer.materials.clone().iter().map(|&m| writer.material(m)).collect();
    let images: Vec<_> = writer.textures.clone().iter().map(|&t| writer.image(t)).collect();
    let textures: Vec<_> = (0..images.len()).map(|k| json!({ "sampler": 0, "source": k })).collect();
    let (nodes, cameras) = nodes(scene);
    let root = nodes.len() - 1;
    let mut root_json = json!({
        "asset": asset(),
        "scene": 0,
        "scenes": [{ "name": "gas station", "nodes": [root] }],
        "nodes": nodes,
        "cameras": cameras,
        "meshes": meshes,
        "materials": materials,
        "textures": textures,
        "images": images,
        "samplers": [{ "magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR, "wrapS": REPEAT, "wrapT": REPEAT }],
        "accessors": writer.accessors,
        "bufferViews": writer.views,
        "buffers": [{ "byteLength": writer.bytes.len() }],
    });
    // Another crate of the workspace may make maps keep their order of insertion; the bytes must not notice.
    root_json.sort_all_objects();
    container(&root_json.to_string(), writer.bytes)
}

fn asset() -> Value {
    json!({
        "version": "2.0",
        "generator": "sunbake-assets",
        "copyright": "The sunbake authors, MIT OR Apache-2.0",
        "extras": { "sunbake": { "place": [35.0, -116.0], "date": "2026-06-21", "utc_offset": -7 } },
    })
}

/// Header, JSON chunk and binary chunk, each padded to four bytes.
fn container(json: &str, mut bytes: Vec<u8>) -> Vec<u8> {
    let mut text = json.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let total = 12 + 8 + text.len() + 8 + bytes.len();
    let mut file = b"glTF".to_vec();
    for word in [2, total as u32, text.len() as u32] {
        file.extend(word.to_le_bytes());
    }
    file.extend(b"JSON");
    file.extend(text);
    file.extend((bytes.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(bytes);
    file
}

fn nodes(scene: &Scene) -> (Vec<Value>, Vec<Value>) {
    let (mut nodes, mut cameras) = (Vec::new(), Vec::new());
    for node in &scene.nodes {
        let mut value = placement(node);
        match node.content {
            Content::Mesh(id) => value["mesh"] = json!(id.0),
            Content::Camera { fov_deg } => {
                value["camera"] = json!(cameras.len());
                cameras.push(camera(&node.name, fov_deg));
            }
        }
        nodes.push(value);
    }
    let children: Vec<_> = (0..nodes.len()).collect();
    let turn = tidy(&crate::scene::yaw(scene.turn_deg).to_array(), 1e7);
    nodes.push(json!({ "name": "gas station", "rotation": turn, "children": children }));
    (nodes, cameras)
}

fn camera(name: &str, fov_deg: f64) -> Value {
    let yfov = (fov_deg.to_radians() * 1e6).round() / 1e6;
    json!({ "name": name, "type": "perspective",
        "perspective": { "yfov": yfov, "aspectRatio": 1.7778, "znear": 0.1, "zfar": 400.0 } })
}

/// Name, translation, rotation and scale; what is the identity stays out.
fn placement(node: &Node) -> Value {
    let mut value = json!({ "name": node.name });
    if node.at_m.length() > 0.0 {
        value["translation"] = json!(tidy(&node.at_m.to_array(), 1e4));
    }
    if node.turn.xyz().length() > 1e-9 {
        value["rotation"] = json!(tidy(&node.turn.to_array(), 1e7));
    }
    if node.scale != glam::DVec3::ONE {
        value["scale"] = json!(tidy(&node.scale.to_array(), 1e4));
    }
    value
}

/// Rounds to steps of `1 / per_unit`, with no negative zero.
fn tidy(values: &[f64], per_unit: f64) -> Vec<f64> {
    values.iter().map(|v| (v * per_unit).round() / per_unit + 0.0).collect()
}

impl Writer {
    fn mesh(&mut self, mesh: &Mesh) -> Value {
        let primitives: Vec<_> = mesh.primitives.iter().map(|p| self.primitive(p)).collect();
        json!({ "name": mesh.name, "primitives": primitives, "extras": { "closed": mesh.closed } })
    }

    fn primitive(&mut self, p: &Primitive) -> Value {
        let position = self.floats(&p.positions_m, "VEC3");
        let (low, high) = bounds(&p.positions_m);
        self.accessors[position]["min"] = json!(low);
        self.accessors[position]["max"] = json!(high);
        let normal = self.floats(&p.normals, "VEC3");
        let mut attributes = json!({ "POSITION": position, "NORMAL": normal });
        if p.material.spec().texture.is_some() {
            attributes["TEXCOORD_0"] = json!(self.floats(&p.uvs, "VEC2"));
        }
        let indices = self.indices(&p.indices, p.positions_m.len());
        let material = index_of(&mut self.materials, p.material);
        json!({ "attributes": attributes, "indices": indices, "material": material })
    }

    /// Appends a view of the buffer that starts at a multiple of four bytes.
    fn view(&mut self, data: &[u8], target: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": data.len() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bytes.extend(data);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, view: usize, component: u32, count: usize, kind: &str) -> usize {
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }));
        self.accessors.len() - 1
    }

    fn floats<const N: usize>(&mut self, values: &[[f32; N]], kind: &str) -> usize {
        let data: Vec<u8> = values.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        let view = self.view(&data, Some(ARRAY_BUFFER));
        self.accessor(view, FLOAT, values.len(), kind)
    }

    fn indices(&mut self, indices: &[u32], vertex_count: usize) -> usize {
        let short = vertex_count < 65_535;
        let data: Vec<u8> = if short {
            indices.iter().flat_map(|&k| (k as u16).to_le_bytes()).collect()
        } else {
            indices.iter().flat_map(|k| k.to_le_bytes()).collect()
        };
        let view = self.view(&data, Some(ELEMENT_ARRAY_BUFFER));
        self.accessor(view, if short { UNSIGNED_SHORT } else { UNSIGNED_INT }, indices.len(), "SCALAR")
    }

    fn image(&mut self, texture: Texture) -> Value {
        let view = self.view(&texture.png(), None);
        json!({ "name": texture.name(), "bufferView": view, "mimeType": "image/png" })
    }

    fn material(&mut self, material: Material) -> Value {
        let spec = material.spec();
        let [r, g, b] = spec.color;
        let mut surface = json!({
            "baseColorFactor": [r, g, b, 1.0],
            "roughnessFactor": spec.roughness,
            "metallicFactor": spec.metallic,
        });
        if let Some(texture) = spec.texture {
            surface["baseColorTexture"] = json!({ "index": index_of(&mut self.textures, texture) });
        }
        let mut value = json!({ "name": spec.name, "pbrMetallicRoughness": surface });
        if spec.double_sided {
            value["doubleSided"] = json!(true);
        }
        if spec.masked {
            value["alphaMode"] = json!("MASK");
            value["alphaCutoff"] = json!(0.5);
        }
        value
    }
}

fn index_of<T: PartialEq>(list: &mut Vec<T>, item: T) -> usize {
    list.iter().position(|known| *known == item).unwrap_or_else(|| {
        list.push(item);
        list.len() - 1
    })
}

fn bounds(positions_m: &[[f32; 3]]) -> ([f32; 3], [f32; 3]) {
    let pick = |f: fn(f32, f32) -> f32, start: f32| {
        std::array::from_fn(|axis| positions_m.iter().fold(start, |best, p| f(best, p[axis])))
    };
    (pick(f32::min, f32::INFINITY), pick(f32::max, f32::NEG_INFINITY))
}
