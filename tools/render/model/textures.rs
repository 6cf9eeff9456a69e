//! Textures that cannot be shown: found, named with the reason, and taken out of
//! the document, because the engine loads a model with all its textures or not
//! at all.

use bevy::image::{CompressedImageFormats, Image, ImageFormat, ImageSampler, ImageType};
use serde_json::{Value, json};

use super::document::{Data, Document};

/// Extensions that name another image for a texture. The engine reads none.
const EXTENSIONS: [&str; 4] = [
    "EXT_texture_webp",
    "KHR_texture_basisu",
    "MSFT_texture_dds",
    "EXT_texture_avif",
];

/// Formats and the feature of Bevy that decodes each.
const FEATURES: [(&str, &str); 20] = [
    ("webp", "webp"),
    ("ktx2", "ktx2"),
    ("basis", "basis-universal"),
    ("dds", "dds"),
    ("tga", "tga"),
    ("targa", "tga"),
    ("bmp", "bmp"),
    ("tif", "tiff"),
    ("tiff", "tiff"),
    ("gif", "gif"),
    ("exr", "exr"),
    ("hdr", "hdr"),
    ("qoi", "qoi"),
    ("ico", "ico"),
    ("pbm", "pnm"),
    ("pgm", "pnm"),
    ("ppm", "pnm"),
    ("jpg", "jpeg"),
    ("jpeg", "jpeg"),
    ("png", "png"),
];

/// One white pixel.
const PLACEHOLDER: &str = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mP4//8/AAX+Av4zEpUUAAAAAElFTkSuQmCC";

/// A texture that is left out.
pub struct Unusable {
    /// Index in the document's `textures`.
    pub texture: usize,
    /// Its name, and why it cannot be shown.
    pub reason: String,
}

/// The textures that this build cannot show. Formats are told by name; with
/// `decode`, every file beside the model and every embedded image is decoded too.
pub fn unusable(document: &Document, decode: bool) -> Vec<Unusable> {
    let textures = document.list("textures").iter().enumerate();
    textures
        .filter_map(|(texture, entry)| {
            let reason = reason(document, entry, decode)?;
            Some(Unusable { texture, reason })
        })
        .collect()
}

/// Whether a texture has an image only by an extension.
pub fn needs_redirection(document: &Document) -> bool {
    document
        .list("textures")
        .iter()
        .any(|t| t["source"].is_null())
}

/// The image of a texture, where it has one.
fn image_index(texture: &Value) -> Option<usize> {
    let by_extension = || {
        EXTENSIONS
            .iter()
            .find_map(|name| texture["extensions"][name]["source"].as_u64())
    };
    texture["source"]
        .as_u64()
        .or_else(by_extension)
        .map(|index| index as usize)
}

fn reason(document: &Document, texture: &Value, decode: bool) -> Option<String> {
    let Some(index) = image_index(texture) else {
        return Some("names no image".into());
    };
    let Some(image) = document.list("images").get(index) else {
        return Some(format!("names image {index}, which does not exist"));
    };
    let data = document.data(image);
    let mime = match (&data, image["mimeType"].as_str()) {
        (Data::File(_), _) => None,
        (_, Some(mime)) => Some(mime.to_owned()),
        (Data::Inline(mime), None) => Some(mime.clone()),
        _ => None,
    };
    let (name, format, known) = match (&data, &mime) {
        (Data::File(uri), _) => {
            let extension = uri.rsplit_once('.').map_or("", |(_, e)| e).to_lowercase();
            let known = ImageFormat::from_extension(&extension);
            (format!("{uri:?}"), extension, known)
        }
        (_, mime) => {
            let mime = mime.clone().unwrap_or_default();
            let name = match image["name"].as_str() {
                Some(name) => format!("{name:?}"),
                None => format!("(image {index}, embedded)"),
            };
            let known = ImageFormat::from_mime_type(&mime);
            (name, short_format(&mime), known)
        }
    };
    if let Data::File(uri) = &data {
        let file = document.file(uri);
        if !file.is_file() {
            return Some(format!("{name} is missing: no file {}", file.display()));
        }
    }
    let bytes = (decode || format == "ktx2")
        .then(|| bytes(document, &data))
        .flatten();
    let Some(known) = known.filter(|_| !wants_transcoder(&format, bytes.as_deref())) else {
        return Some(format!("{name} {}", remedy(&format, bytes.as_deref())));
    };
    let error = decode.then(|| decoding_error(&bytes?, known)).flatten()?;
    Some(format!("{name} is damaged: {error}"))
}

/// `image/x-tga` is `tga`.
fn short_format(mime: &str) -> String {
    let name = mime.rsplit('/').next().unwrap_or_default().to_lowercase();
    let name = name.trim_start_matches("x-").trim_start_matches("vnd-ms.");
    name.to_owned()
}

/// The bytes of an image, except of `data:` URIs.
fn bytes(document: &Document, data: &Data) -> Option<Vec<u8>> {
    match data {
        Data::File(uri) => std::fs::read(document.file(uri)).ok(),
        Data::Binary(range) => Some(document.binary.as_ref()?.get(range.clone())?.to_vec()),
        Data::Inline(_) | Data::Other => None,
    }
}

/// Whether a KTX2 file holds Basis Universal data that this build cannot read:
/// its field `vkFormat`, after 12 bytes of identifier, is zero.
fn wants_transcoder(format: &str, bytes: Option<&[u8]>) -> bool {
    let field = bytes.and_then(|bytes| bytes.get(12..16));
    format == "ktx2"
        && ImageFormat::from_extension("ktx2").is_some()
        && ImageFormat::from_extension("basis").is_none()
        && field == Some(&[0; 4])
}

fn remedy(format: &str, bytes: Option<&[u8]>) -> String {
    let feature = if wants_transcoder(format, bytes) {
        Some("basis-universal")
    } else {
        let entry = FEATURES.iter().find(|(name, _)| *name == format);
        entry.map(|(_, feature)| *feature)
    };
    match feature {
        Some(feature) => format!(
            "cannot be decoded by this build: Bevy's feature `{feature}` decodes {format}; add \
             `--features bevy/{feature}` to `cargo run`"
        ),
        None if format.is_empty() => "has no format that Bevy knows".into(),
        None => format!("cannot be decoded: Bevy reads no {format}; convert it to PNG"),
    }
}

fn decoding_error(bytes: &[u8], format: ImageFormat) -> Option<String> {
    let decoded = Image::from_buffer(
        bytes,
        ImageType::Format(format),
        CompressedImageFormats::all(),
        true,
        ImageSampler::Default,
        bevy::asset::RenderAssetUsages::MAIN_WORLD,
    );
    decoded.err().map(|error| error.to_string())
}

/// Takes textures out of the document: its materials do without them. Textures
/// that name their image only by an extension name it directly after this.
pub fn take_out(document: &mut Document, textures: &[usize]) {
    let placeholder = document.list("images").len();
    let entries = document.list_mut("textures").into_iter().flatten();
    for (index, texture) in entries.enumerate() {
        if textures.contains(&index) {
            *texture = json!({ "source": placeholder });
        } else if let Some(image) = image_index(texture) {
            texture["source"] = json!(image);
        }
    }
    if !textures.is_empty() {
        let image = json!({ "uri": PLACEHOLDER });
        match document.list_mut("images") {
            Some(images) => images.push(image),
            None => document.json["images"] = json!([image]),
        }
    }
    if let Some(required) = document.list_mut("extensionsRequired") {
        required.retain(|name| !EXTENSIONS.iter().any(|known| name == known));
    }
    for material in document.list_mut("materials").into_iter().flatten() {
        strip(material, textures);
    }
}

/// Removes references to textures from a material, and gives the factors that
/// they were multiplied with values that can stand alone.
fn strip(value: &mut Value, textures: &[usize]) {
    let Some(object) = value.as_object_mut() else {
        return;
    };
    let is_gone = |key: &String, value: &Value| {
        let index = value["index"].as_u64().map(|index| index as usize);
        key.ends_with("Texture") && index.is_some_and(|index| textures.contains(&index))
    };
    let gone: Vec<String> = object
        .iter()
        .filter(|(key, value)| is_gone(key, value))
        .map(|(key, _)| key.clone())
        .collect();
    for key in gone {
        object.remove(&key);
        match key.as_str() {
            "baseColorTexture" if !object.contains_key("baseColorFactor") => {
                object.insert("baseColorFactor".into(), json!([0.6, 0.6, 0.6, 1.0]));
            }
            "metallicRoughnessTexture" => {
                object.insert("metallicFactor".into(), json!(0.0));
            }
            "emissiveTexture" => {
                object.remove("emissiveFactor");
            }
            _ => {}
        }
    }
    for child in object.values_mut() {
        strip(child, textures);
    }
}
