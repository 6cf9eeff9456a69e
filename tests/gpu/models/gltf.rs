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
    /// Base color, sRGB.
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

    pub fn accessor(&mut self, bytes: &[u8], description: Value) -> usize {
        let mut accessor = description;
        accessor["bufferView"] = json!(self.view(bytes));
        self.push("accessors", accessor)
    }

    pub fn floats(&mut self, values: &[f32], kind: &str, count: usize) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let mut floats = json!({"componentType": 5126, "count": count, "type": kind});
        if kind == "VEC3" {
            floats["min"] = json!([-1, -1, -1]);
            floats["max"] = json!([1, 1, 1]);
        }
        self.accessor(&bytes, floats)
    }

    fn add(&mut self, part: &Part) {
        let mesh = match part.shape {
            Shape::Ball => Sphere::new(1.0).mesh().uv(64, 32),
            Shape::Box => Cuboid::from_length(2.0).into(),
        };
        let points = |attribute| {
            let values = mesh
                .attribute(attribute)
                .and_then(VertexAttributeValues::as_float3);
            values.expect("three numbers a vertex").as_flattened()
        };
        let count = mesh.count_vertices();
        let position = self.floats(points(Mesh::ATTRIBUTE_POSITION), "VEC3", count);
        let normal = self.floats(points(Mesh::ATTRIBUTE_NORMAL), "VEC3", count);
        // Every face shows the texture's middle.
        let uv = self.floats(&vec![0.5; 2 * count], "VEC2", count);
        let indices: Vec<usize> = mesh.indices().expect("indices").iter().collect();
        let bytes: Vec<u8> = (indices.iter())
            .flat_map(|i| (*i as u16).to_le_bytes())
            .collect();
        let index = json!({"componentType": 5123, "count": indices.len(), "type": "SCALAR"});
        let index = self.accessor(&bytes, index);
        let color = Color::srgb_from_array(part.color)
            .to_linear()
            .to_f32_array();
        let material = self.push(
            "materials",
            json!({"pbrMetallicRoughness": {"baseColorFactor": color,
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

    /// Gives the first material this image as its base color.
    pub fn texture(&mut self, image: Value, texture: Value) {
        self.push("images", image);
        let texture = json!({"index": self.push("textures", texture)});
        self.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = texture;
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
