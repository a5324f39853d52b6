//! Pictures that the file names by URIs: they become part of the binary chunk.

use super::binary::Binary;
use super::list;
use crate::scene::SceneFile;
use serde_json::{Value, json};

/// Copies pictures into the chunk, and says which could not be read.
pub(super) fn embed(file: &SceneFile, root: &mut Value, binary: &mut Binary, not_kept: &mut Vec<String>) {
    if root.get("images").is_none() {
        return;
    }
    for (index, image) in list(root, "images").iter_mut().enumerate() {
        let Some(object) = image.as_object_mut() else { continue };
        match file.picture(index) {
            None => {}
            Some(Err(error)) => not_kept.push(format!("a picture that no shadow needs is still a link: {error}")),
            Some(Ok(bytes)) => {
                let mime_type = mime_type(bytes).map(Value::from).or_else(|| object.get("mimeType").cloned());
                let Some(mime_type) = mime_type else { continue };
                object.remove("uri");
                object.insert("mimeType".into(), mime_type);
                object.insert("bufferView".into(), json!(binary.add_view(json!({}), bytes.to_vec())));
            }
        }
    }
}

/// By the first bytes.
fn mime_type(bytes: &[u8]) -> Option<&'static str> {
    match bytes.starts_with(b"\xABKTX 20\xBB") {
        true => Some("image/ktx2"),
        false => image::guess_format(bytes).ok().map(|format| format.to_mime_type()),
    }
}
