//! A glTF document as far as its textures go: read, written, and given to the
//! asset server after it was changed.

use std::path::{Path, PathBuf};

use bevy::asset::{AssetPath, io::embedded::EmbeddedAssetRegistry};
use serde_json::Value;

/// Where a changed document is put in the engine's in-memory asset source. Deep,
/// so that files may refer to several folders above their own.
const FOLDER: &str = "render-model/1/2/3/4/5/6/7/8";

/// Types of the chunks of a `.glb` file.
const JSON_CHUNK: u32 = 0x4e4f_534a;
const BINARY_CHUNK: u32 = 0x004e_4942;

pub struct Document {
    pub path: PathBuf,
    pub json: Value,
    /// The binary chunk of a `.glb` file.
    pub binary: Option<Vec<u8>>,
}

/// Where the bytes of an image or a buffer are.
pub enum Data {
    /// A file beside the model: its URI, decoded.
    File(String),
    /// A `data:` URI with this MIME type.
    Inline(String),
    /// A range of the binary chunk.
    Binary(std::ops::Range<usize>),
    /// Elsewhere, or not stated correctly.
    Other,
}

impl Document {
    pub fn read(path: &Path) -> Result<Self, String> {
        let bytes = std::fs::read(path)
            .map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        let wrong = |what: &str| format!("{} is no glTF model: {what}", path.display());
        let (text, binary) = if bytes.starts_with(b"glTF") {
            let text = chunk(&bytes, JSON_CHUNK).ok_or_else(|| wrong("no JSON chunk"))?;
            (text, chunk(&bytes, BINARY_CHUNK).map(<[u8]>::to_vec))
        } else {
            (&bytes[..], None)
        };
        let json: Value =
            serde_json::from_slice(text).map_err(|error| wrong(&error.to_string()))?;
        if !json.is_object() {
            return Err(wrong("its JSON is no object"));
        }
        Ok(Self {
            path: path.to_owned(),
            json,
            binary,
        })
    }

    /// The list of this name; empty if there is none.
    pub fn list(&self, name: &str) -> &[Value] {
        self.json[name].as_array().map_or(&[], Vec::as_slice)
    }

    /// The same to be changed, where there is one.
    pub fn list_mut(&mut self, name: &str) -> Option<&mut Vec<Value>> {
        self.json.get_mut(name).and_then(Value::as_array_mut)
    }

    /// The scene to show: the default one, or the first.
    pub fn scene(&self) -> usize {
        self.json["scene"].as_u64().unwrap_or(0) as usize
    }

    /// Where an entry of `images` or `buffers` has its bytes.
    pub fn data(&self, entry: &Value) -> Data {
        if let Some(uri) = entry["uri"].as_str() {
            return match uri.strip_prefix("data:") {
                Some(rest) => {
                    let end = rest.find([';', ',']).unwrap_or(rest.len());
                    Data::Inline(rest[..end].to_owned())
                }
                None => Data::File(percent_decoded(uri)),
            };
        }
        let view = entry["bufferView"]
            .as_u64()
            .and_then(|index| self.list("bufferViews").get(index as usize));
        match view {
            Some(view) if view["buffer"] == 0 && self.json["buffers"][0]["uri"].is_null() => {
                let start = view["byteOffset"].as_u64().unwrap_or(0) as usize;
                let length = view["byteLength"].as_u64().unwrap_or(0) as usize;
                Data::Binary(start..start.saturating_add(length))
            }
            _ => Data::Other,
        }
    }

    /// A file that the document refers to.
    pub fn file(&self, uri: &str) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(uri)
    }

    /// Puts the document and the files that it refers to into the engine's
    /// in-memory asset source, and gives the path of the document there.
    pub fn embed(
        &self,
        registry: &EmbeddedAssetRegistry,
    ) -> Result<AssetPath<'static>, serde_json::Error> {
        let name = if self.binary.is_some() {
            "model.glb"
        } else {
            "model.gltf"
        };
        let path = AssetPath::parse(&format!("embedded://{FOLDER}/{name}")).into_owned();
        registry.insert_asset(self.path.clone(), path.path(), self.bytes()?);
        for entry in self.list("buffers").iter().chain(self.list("images")) {
            let Data::File(uri) = self.data(entry) else {
                continue;
            };
            let file = self.file(&uri);
            // A file that is missing here is missing for the loader, which says so.
            if let (Ok(bytes), Ok(inside)) = (std::fs::read(&file), path.resolve_embed_str(&uri)) {
                registry.insert_asset(file, inside.path(), bytes);
            }
        }
        Ok(path)
    }

    fn bytes(&self) -> Result<Vec<u8>, serde_json::Error> {
        let mut text = serde_json::to_vec(&self.json)?;
        let Some(binary) = &self.binary else {
            return Ok(text);
        };
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut binary = binary.clone();
        binary.resize(binary.len().next_multiple_of(4), 0);
        let length = 12 + 8 + text.len() + 8 + binary.len();
        let mut bytes = Vec::with_capacity(length);
        bytes.extend(b"glTF");
        for word in [2, length as u32, text.len() as u32, JSON_CHUNK] {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(text);
        for word in [binary.len() as u32, BINARY_CHUNK] {
            bytes.extend(word.to_le_bytes());
        }
        bytes.extend(binary);
        Ok(bytes)
    }
}

/// The first chunk of this type in a `.glb` file.
fn chunk(bytes: &[u8], wanted: u32) -> Option<&[u8]> {
    let word = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?));
    let mut at = 12;
    loop {
        let (length, kind) = (word(at)? as usize, word(at + 4)?);
        let content = bytes.get(at + 8..at.checked_add(8 + length)?)?;
        if kind == wanted {
            return Some(content);
        }
        at += 8 + length;
    }
}

fn percent_decoded(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while at < bytes.len() {
        let code = bytes
            .get(at + 1..at + 3)
            .and_then(|digits| std::str::from_utf8(digits).ok())
            .and_then(|digits| u8::from_str_radix(digits, 16).ok());
        match (bytes[at], code) {
            (b'%', Some(code)) => {
                decoded.push(code);
                at += 3;
            }
            (byte, _) => {
                decoded.push(byte);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&decoded).into_owned()
}
