//! Looks of scenes that are made in code.

use crate::stage::Stage;
use sunbake::scene::looks::{Look, Looks, MeshLook};
use sunbake::scene::{Image, Material, TextureRef, Wrap};
use sunbake::testing::opaque;

/// A material that [`with_looks`] finds by its name.
pub fn named(name: &str) -> Material {
    Material { name: Some(name.into()), ..opaque() }
}

/// The same stage, whose materials with names look as `look` says.
pub fn with_looks(stage: Stage, images: Vec<Image>, look: impl Fn(&str) -> Look) -> Stage {
    let materials: Vec<Look> =
        stage.scene.materials.iter().map(|m| m.name.as_deref().map_or(Look::PLAIN, &look)).collect();
    let mesh = |material: usize| {
        let look = &materials[material];
        MeshLook { is_blended: look.says_blend || look.transmission > 0.0, tangents: None }
    };
    let meshes = stage.scene.meshes.iter().map(|one| mesh(one.material)).collect();
    stage.with_looks(Looks { materials, meshes, images, warnings: Vec::new() })
}

/// An image of one colour.
pub fn flat_image(rgb: [u8; 3]) -> Image {
    let [r, g, b] = rgb;
    Image { name: "flat".into(), width: 2, height: 2, rgba: vec![[r, g, b, 255]; 4] }
}

/// The first set of texture coordinates, of an image that tiles.
pub fn texture(image: usize) -> TextureRef {
    TextureRef { image, texcoord: 0, image_from_texcoord: glam::Mat3::IDENTITY, wrap: [Wrap::Repeat; 2] }
}
