//! Small glTF models made by code.

use std::fs;

use serde_json::{Value, json};

use crate::prelude::*;

/// A ball or a box with one material.
#[derive(Clone, Copy)]
pub struct Part {
    pub shape: Shape,
    pub at: [f32; 3],
    /// Half the size along each axis.
    pub half: [f32; 3],
    /// Base colour, sRGB.
    pub color: [f32; 3],
    pub metallic: f32,
    pub roughness: f32,
}

#[derive(Clone, Copy, PartialEq)]
pub enum Shape {
    Ball,
    Box,
}

impl Part {
    pub fn new(shape: Shape, at: [f32; 3], half: [f32; 3], color: [f32; 3]) -> Self {
        Self {
            shape,
            at,
            half,
            color,
            metallic: 0.0,
            roughness: 0.8,
        }
    }
}

/// A document and its buffer.
pub struct Gltf {
    pub json: Value,
    binary: Vec<u8>,
}

impl Gltf {
    /// Parts below one node that scales and moves them.
    pub fn new(parts: &[Part], scale: f32, offset: [f32; 3]) -> Self {
        let mut gltf = Self {
            json: json!({
                "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": [{"scale": [scale, scale, scale], "translation": offset, "children": []}],
                "meshes": [], "materials": [], "accessors": [], "bufferViews": [], "buffers": [],
            }),
            binary: Vec::new(),
        };
        for part in parts {
            gltf.add(part);
        }
        gltf
    }

    /// Appends to a list of the document and gives the index.
    pub fn push(&mut self, list: &str, value: Value) -> usize {
        if self.json[list].is_null() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let offset = self.binary.len();
        self.binary.extend(bytes);
        let view = json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()});
        self.push("bufferViews", view)
    }

    fn add(&mut self, part: &Part) {
        let (positions, normals, indices) = match part.shape {
            Shape::Ball => ball(),
            Shape::Box => cube(),
        };
        // Every face of a texture coordinate set shows the whole texture's middle.
        let uvs = vec![[0.5f32, 0.5]; positions.len()];
        let count = positions.len();
        let mut accessor = |bytes: Vec<u8>, kind: &str, component: u32, count: usize| {
            let view = self.view(&bytes);
            let value = json!({"bufferView": view, "componentType": component, "count": count,
                "type": kind, "min": [-1, -1, -1], "max": [1, 1, 1]});
            let value = if kind == "VEC3" {
                value
            } else {
                json!({"bufferView": view, "componentType": component, "count": count, "type": kind})
            };
            self.push("accessors", value)
        };
        let position = accessor(bytes(positions.as_flattened()), "VEC3", 5126, count);
        let normal = accessor(bytes(normals.as_flattened()), "VEC3", 5126, count);
        let uv = accessor(bytes(uvs.as_flattened()), "VEC2", 5126, count);
        let index_bytes = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        let index = accessor(index_bytes, "SCALAR", 5123, indices.len());
        let [r, g, b] = part.color.map(linear);
        let material = self.push(
            "materials",
            json!({"pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1.0],
                "metallicFactor": part.metallic, "roughnessFactor": part.roughness}}),
        );
        let mesh = self.push(
            "meshes",
            json!({"primitives": [{"indices": index, "material": material,
                "attributes": {"POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv}}]}),
        );
        let node = json!({"mesh": mesh, "translation": part.at, "scale": part.half});
        let node = self.push("nodes", node);
        let children = self.json["nodes"][0]["children"].as_array_mut();
        children.expect("a list").push(json!(node));
    }

    /// Gives the first material this image as its base colour.
    pub fn texture(&mut self, image: Value, texture: Value) {
        self.push("images", image);
        let index = self.push("textures", texture);
        self.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] =
            json!({"index": index});
    }

    pub fn write_glb(mut self, path: &Path) {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.json["buffers"] = json!([{"byteLength": self.binary.len()}]);
        let mut text = self.json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let length = 28 + text.len() + self.binary.len();
        let mut file = b"glTF".to_vec();
        for word in [2, length, text.len(), 0x4e4f_534a] {
            file.extend((word as u32).to_le_bytes());
        }
        file.extend(text);
        for word in [self.binary.len(), 0x004e_4942] {
            file.extend((word as u32).to_le_bytes());
        }
        file.extend(self.binary);
        fs::write(path, file).expect("written");
    }

    /// The document, and its buffer beside it under the given name.
    pub fn write_gltf(mut self, path: &Path, buffer: &str) {
        let uri = buffer.replace(' ', "%20");
        self.json["buffers"] = json!([{"byteLength": self.binary.len(), "uri": uri}]);
        fs::write(path.with_file_name(buffer), self.binary).expect("written");
        fs::write(path, self.json.to_string()).expect("written");
    }
}

fn bytes(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|x| x.to_le_bytes()).collect()
}

pub fn linear(srgb: f32) -> f32 {
    if srgb <= 0.04045 {
        srgb / 12.92
    } else {
        ((srgb + 0.055) / 1.055).powf(2.4)
    }
}

type Geometry = (Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<u16>);

/// The unit sphere.
fn ball() -> Geometry {
    const RINGS: u16 = 32;
    let across = 2 * RINGS + 1;
    let points: Vec<[f32; 3]> = (0..=RINGS)
        .flat_map(|ring| (0..across).map(move |step| (ring, step)))
        .map(|(ring, step)| {
            let polar = std::f32::consts::PI * f32::from(ring) / f32::from(RINGS);
            let turn = std::f32::consts::PI * f32::from(step) / f32::from(RINGS);
            let (sin, cos) = polar.sin_cos();
            [sin * turn.cos(), cos, -sin * turn.sin()]
        })
        .collect();
    let indices = (0..RINGS)
        .flat_map(|ring| (0..2 * RINGS).map(move |step| ring * across + step))
        .flat_map(|k| [k, k + across, k + across + 1, k, k + across + 1, k + 1])
        .collect();
    (points.clone(), points, indices)
}

/// The cube from -1 to 1.
fn cube() -> Geometry {
    let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [1.0f32, -1.0] {
            let first = positions.len() as u16;
            for (a, b) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                let (mut position, mut normal) = ([0.0; 3], [0.0; 3]);
                position[axis] = side;
                position[(axis + 1) % 3] = a * side;
                position[(axis + 2) % 3] = b;
                normal[axis] = side;
                positions.push(position);
                normals.push(normal);
            }
            indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
        }
    }
    (positions, normals, indices)
}
