//! Textures that cannot be shown are named, and the model is drawn without them.

use std::fs;

use serde_json::{Value, json};

use super::{Gltf, SKIN, Shot, assert_color_of_skin, ball};
use crate::{
    command_line::{folder, render, run},
    prelude::*,
};

/// A PNG of one colour.
fn png(color: [u8; 3]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_pixel(4, 4, image::Rgb(color))
        .write_to(&mut bytes, image::ImageFormat::Png)
        .expect("encoded");
    bytes.into_inner()
}

/// The head of a KTX2 file with Basis Universal data: `vkFormat` is zero.
fn basis_ktx2() -> Vec<u8> {
    let mut bytes = b"\xabKTX 20\xbb\r\n\x1a\n".to_vec();
    bytes.resize(80, 0);
    bytes
}

/// A white ball whose base colour is the embedded image.
fn embedded(image: &[u8], mime: &str, texture: Value) -> Gltf {
    let mut gltf = ball([1.0; 3], 0.0, 0.8);
    let view = gltf.view(image);
    gltf.texture(
        json!({"bufferView": view, "mimeType": mime, "name": "paint"}),
        texture,
    );
    gltf
}

/// What the example warns of.
fn warnings(errors: &str) -> Vec<&str> {
    let lines = errors.lines();
    lines
        .filter(|line| line.starts_with("render: warning"))
        .collect()
}

/// The example ends well, writes a picture of the model, and says of each texture what these parts
/// are found in.
fn assert_named(folder: &Path, model: &str, says: &[&[&str]]) {
    let arguments = "--size 64x64 --msaa 1 --frames 2 --style none --out w.png";
    let errors = render(folder, &format!("{model} {arguments}"));
    let picture = image::open(folder.join("w.png"))
        .expect("a picture")
        .to_rgb8();
    fs::remove_file(folder.join("w.png")).expect("it goes");
    let [first, middle] = [(0, 0), (32, 32)].map(|(x, y)| picture.get_pixel(x, y).0);
    assert_ne!(first, middle, "{model}: no model is in the middle");
    let warnings = warnings(&errors);
    assert_eq!(warnings.len(), says.len(), "{model}: {warnings:?}");
    for (warning, parts) in warnings.iter().zip(says) {
        let is_named = parts.iter().all(|part| warning.contains(part));
        assert!(is_named, "{model}: {parts:?} are not in {warning}");
    }
}

#[test]
fn textures_of_formats_that_this_build_lacks_are_named_with_the_remedy() {
    let folder = folder("formats");
    let source = |extension: &str| json!({"extensions": {extension: {"source": 0}}});
    embedded(b"RIFF....WEBP", "image/webp", json!({"source": 0}))
        .write_glb(&folder.join("webp.glb"));
    let mut basis = embedded(&basis_ktx2(), "image/ktx2", source("KHR_texture_basisu"));
    basis.json["extensionsRequired"] = json!(["KHR_texture_basisu"]);
    basis.json["extensionsUsed"] = json!(["KHR_texture_basisu"]);
    basis.write_glb(&folder.join("basis.glb"));
    let webp = ["texture 0", "\"paint\"", "`webp`", "bevy/webp"];
    assert_named(&folder, "webp.glb", &[&webp]);
    assert_named(&folder, "basis.glb", &[&["texture 0", "`basis-universal`"]]);
    fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn damaged_and_missing_textures_are_named() {
    let folder = folder("damaged");
    embedded(
        b"\x89PNG\r\n\x1a\nbroken",
        "image/png",
        json!({"source": 0}),
    )
    .write_glb(&folder.join("damaged.glb"));
    let mut beside = ball([1.0; 3], 0.0, 0.8);
    beside.texture(json!({"uri": "my%20skin.png"}), json!({"source": 0}));
    beside.texture(json!({"uri": "coat.tga"}), json!({"source": 1}));
    beside.write_gltf(&folder.join("beside.gltf"), "a buffer.bin");
    fs::write(folder.join("coat.tga"), b"tga").expect("written");
    let damaged = ["texture 0", "\"paint\"", "damaged"];
    assert_named(&folder, "damaged.glb", &[&damaged]);
    let missing = ["texture 0", "\"my skin.png\"", "missing"];
    let unknown = ["texture 1", "\"coat.tga\"", "`tga`"];
    assert_named(&folder, "beside.gltf", &[&missing, &unknown]);
    fs::remove_dir_all(folder).expect("the folder goes");
}

/// The picture of a ball of skin.
fn paint() -> Vec<u8> {
    png(SKIN.map(|c| (255.0 * c).round() as u8))
}

/// The ball has the colour of its texture, and nothing is said.
fn assert_seen(folder: &Path, model: &str) {
    let shot = Shot::take(folder, model, (64, 64), "--style none");
    assert_eq!(warnings(&shot.errors), Vec::<&str>::new(), "{model}");
    assert_color_of_skin(&shot);
}

#[test]
fn textures_in_and_beside_the_model_are_seen_and_nothing_is_said() {
    let folder = folder("good-textures");
    let good = embedded(&paint(), "image/png", json!({"source": 0}));
    good.write_glb(&folder.join("good.glb"));
    // An image that only an extension names is shown if the build reads its format.
    let by_extension = json!({"extensions": {"EXT_texture_webp": {"source": 0}}});
    embedded(&paint(), "image/png", by_extension).write_glb(&folder.join("extension.glb"));
    let mut beside = ball([1.0; 3], 0.0, 0.8);
    beside.texture(json!({"uri": "my%20skin.png"}), json!({"source": 0}));
    beside.write_gltf(&folder.join("beside.gltf"), "a buffer.bin");
    fs::write(folder.join("my skin.png"), paint()).expect("written");
    for model in ["good.glb", "extension.glb", "beside.gltf"] {
        assert_seen(&folder, model);
    }
    fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn a_compressed_mesh_is_refused_with_the_remedy() {
    let folder = folder("draco");
    let mut gltf = ball(SKIN, 0.0, 0.8);
    gltf.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    gltf.write_glb(&folder.join("draco.glb"));
    let output = run(&folder, "draco.glb");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{errors}");
    assert!(
        errors.contains("without Draco mesh compression"),
        "{errors}"
    );
    fs::remove_dir_all(folder).expect("the folder goes");
}
