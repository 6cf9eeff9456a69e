//! Textures that cannot be shown are named, and the model is drawn without them.

use std::fs;

use serde_json::{Value, json};

use super::{Gltf, SKIN, Shot, assert_color_of_skin, ball};
use crate::{
    command_line::{folder, render, run},
    prelude::*,
};

/// A PNG of one color.
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

/// A white ball whose base color is the embedded image.
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
fn textures_that_are_missing_or_that_this_build_cannot_read_are_named_with_the_remedy() {
    let folder = folder("formats");
    let source = |image: usize| json!({"source": image});
    let mut gltf = embedded(b"RIFF....WEBP", "image/webp", source(0));
    let basis = gltf.view(&basis_ktx2());
    gltf.texture(
        json!({"bufferView": basis, "mimeType": "image/ktx2"}),
        json!({"extensions": {"KHR_texture_basisu": {"source": 1}}}),
    );
    gltf.json["extensionsRequired"] = json!(["KHR_texture_basisu"]);
    gltf.json["extensionsUsed"] = json!(["KHR_texture_basisu"]);
    gltf.texture(json!({"uri": "my%20skin.png"}), source(2));
    gltf.texture(json!({"uri": "coat.tga"}), source(3));
    fs::write(folder.join("coat.tga"), b"tga").expect("written");
    gltf.write_glb(&folder.join("four.glb"));
    let webp = ["texture 0", "\"paint\"", "`webp`", "bevy/webp"];
    let basis = ["texture 1", "`basis-universal`"];
    let missing = ["texture 2", "\"my skin.png\"", "missing"];
    let unknown = ["texture 3", "\"coat.tga\"", "`tga`"];
    assert_named(&folder, "four.glb", &[&webp, &basis, &missing, &unknown]);
    fs::remove_dir_all(folder).expect("the folder goes");
}

/// What is damaged is found when the engine cannot load the model.
#[test]
fn damaged_textures_are_named() {
    let folder = folder("damaged");
    embedded(
        b"\x89PNG\r\n\x1a\nbroken",
        "image/png",
        json!({"source": 0}),
    )
    .write_glb(&folder.join("damaged.glb"));
    let damaged = ["texture 0", "\"paint\"", "damaged"];
    assert_named(&folder, "damaged.glb", &[&damaged]);
    fs::remove_dir_all(folder).expect("the folder goes");
}

/// The picture of a ball of skin.
fn paint() -> Vec<u8> {
    png(SKIN.map(|c| (255.0 * c).round() as u8))
}

/// The ball has the color of its texture, and nothing is said.
fn assert_seen(folder: &Path, model: &str) {
    let shot = Shot::take(folder, model, (64, 64), "--style none");
    assert_eq!(warnings(&shot.errors), Vec::<&str>::new(), "{model}");
    assert_color_of_skin(&shot);
}

/// A ball whose buffer and texture are files beside it.
fn write_beside(folder: &Path, model: &str, texture: Value) {
    let mut beside = ball([1.0; 3], 0.0, 0.8);
    beside.texture(json!({"uri": "my%20skin.png"}), texture);
    beside.write_gltf(&folder.join(model), "a buffer.bin");
    fs::write(folder.join("my skin.png"), paint()).expect("written");
}

/// An image that only an extension names is shown if the build reads its format.
fn by_extension() -> Value {
    json!({"extensions": {"EXT_texture_webp": {"source": 0}}})
}

#[test]
fn a_texture_beside_the_model_is_seen_and_nothing_is_said() {
    let folder = folder("texture-beside");
    write_beside(&folder, "beside.gltf", by_extension());
    assert_seen(&folder, "beside.gltf");
    fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
#[ignore = "long: starts the example for each of three models"]
fn textures_in_and_beside_the_model_are_seen_and_nothing_is_said() {
    let folder = folder("good-textures");
    let good = embedded(&paint(), "image/png", json!({"source": 0}));
    good.write_glb(&folder.join("good.glb"));
    embedded(&paint(), "image/png", by_extension()).write_glb(&folder.join("extension.glb"));
    write_beside(&folder, "beside.gltf", json!({"source": 0}));
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
