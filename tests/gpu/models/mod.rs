//! The `render` example with models that it has not seen: how they are framed
//! and lit, and what is said about textures that cannot be shown.

pub mod gltf;
mod textures;
mod turntable;

use std::fs;

use gltf::{Gltf, Part, Shape};
use image::RgbImage;
use serde_json::json;

use crate::{
    command_line::{dumped, folder, frame, render},
    prelude::*,
};

const SKIN: [f32; 3] = [0.78, 0.59, 0.43];

/// A ball of one material.
fn ball(color: [f32; 3], metallic: f32, roughness: f32) -> Gltf {
    let part = Part {
        metallic,
        roughness,
        ..Part::new(Shape::Ball, [0.0; 3], [1.0; 3], color)
    };
    Gltf::new(&[part], 1.0, [0.0; 3])
}

/// A figure of balls and boxes, 1.8 units tall.
fn figure() -> Vec<Part> {
    let blue = [0.2, 0.28, 0.5];
    vec![
        Part::new(Shape::Ball, [0.0, 1.62, 0.0], [0.14, 0.17, 0.15], SKIN),
        Part::new(
            Shape::Box,
            [0.0, 1.1, 0.0],
            [0.2, 0.32, 0.12],
            [0.75, 0.2, 0.18],
        ),
        Part::new(Shape::Box, [0.28, 1.1, 0.1], [0.05, 0.3, 0.05], SKIN),
        Part::new(Shape::Box, [-0.28, 1.1, 0.0], [0.05, 0.3, 0.05], SKIN),
        Part::new(Shape::Box, [0.1, 0.4, 0.0], [0.08, 0.4, 0.08], blue),
        Part::new(Shape::Box, [-0.1, 0.4, 0.0], [0.08, 0.4, 0.08], blue),
    ]
}

/// A foot, a stem and a shade of polished metal.
fn lamp() -> Vec<Part> {
    let metal = |shape, at, half| Part {
        metallic: 1.0,
        roughness: 0.2,
        ..Part::new(shape, at, half, [0.9, 0.8, 0.6])
    };
    vec![
        metal(Shape::Ball, [0.0, 0.05, 0.0], [0.3, 0.06, 0.3]),
        metal(Shape::Box, [0.0, 0.5, 0.0], [0.04, 0.45, 0.04]),
        metal(Shape::Ball, [0.0, 1.0, 0.0], [0.35, 0.3, 0.35]),
    ]
}

/// A picture, which of its pixels show the model, namely those with depth, and what was written to
/// stderr.
struct Shot {
    picture: RgbImage,
    mask: Vec<bool>,
    errors: String,
}

impl Shot {
    fn take(folder: &Path, model: &str, size: (u32, u32), more: &str) -> Self {
        let size = format!("--size {}x{} --msaa 1 --frames 4", size.0, size.1);
        let errors = render(
            folder,
            &format!("{model} {size} --out p.png --dump d {more}"),
        );
        let picture = image::open(folder.join("p.png"));
        let (_, depth) = dumped(folder, "depth.exr");
        Self {
            picture: picture.expect("a picture").to_rgb8(),
            // Depth is reversed: zero is infinitely far away.
            mask: depth.values_as_f32().map(|depth| depth > 0.0).collect(),
            errors,
        }
    }

    fn pixels(&self) -> Vec<[u8; 3]> {
        let pixels = self.picture.pixels().zip(&self.mask);
        let shown = pixels.filter(|(_, shown)| **shown);
        let pixels: Vec<_> = shown.map(|(pixel, _)| pixel.0).collect();
        assert!(pixels.len() > 50, "{} pixels show the model", pixels.len());
        pixels
    }

    /// Fraction of the model's pixels with a channel at the end of its range.
    fn clipped(&self) -> f64 {
        let pixels = self.pixels();
        let clipped = pixels.iter().filter(|p| p.iter().any(|c| *c >= 254));
        clipped.count() as f64 / pixels.len() as f64
    }

    /// Mean color of the brighter half of the model's pixels, 0 to 1, sRGB.
    fn lit_color(&self) -> [f64; 3] {
        let mut pixels = self.pixels();
        pixels.sort_by_key(|p| std::cmp::Reverse(p.iter().map(|c| u32::from(*c)).sum::<u32>()));
        pixels.truncate(pixels.len() / 2);
        [0, 1, 2].map(|c| {
            let sum: f64 = pixels.iter().map(|p| f64::from(p[c]) / 255.0).sum();
            sum / pixels.len() as f64
        })
    }
}

/// First and last column and row of the pixels that are set.
fn bounds(mask: &[bool], width: u32) -> [u32; 4] {
    let mut bounds = [u32::MAX, 0, u32::MAX, 0];
    for (index, _) in mask.iter().enumerate().filter(|(_, set)| **set) {
        let (x, y) = (index as u32 % width, index as u32 / width);
        let [left, right, top, bottom] = bounds;
        bounds = [left.min(x), right.max(x), top.min(y), bottom.max(y)];
    }
    bounds
}

/// The model spans 85 % of the side that it meets first, and is in the middle.
fn assert_framed(folder: &Path, model: &str, size: (u32, u32), more: &str) {
    let shot = Shot::take(folder, model, size, more);
    let [left, right, top, bottom] = bounds(&shot.mask, size.0);
    let what = format!("{model} {size:?} {more}: x {left}..={right}, y {top}..={bottom}");
    assert!(left <= right, "{what}: nothing is seen");
    let spans = [
        f64::from(right + 1 - left) / f64::from(size.0),
        f64::from(bottom + 1 - top) / f64::from(size.1),
    ];
    let largest = spans[0].max(spans[1]);
    assert!(
        (0.83..=0.87).contains(&largest),
        "{what}: it spans {spans:?}"
    );
    // Rounding to pixels moves each edge by up to one pixel.
    for (low, high, side) in [(left, right, size.0), (top, bottom, size.1)] {
        assert!(
            (low + high).abs_diff(side - 1) <= 2,
            "{what}: it is not in the middle"
        );
    }
}

/// The lamp far from the origin.
fn lamp_far_off(folder: &Path) -> &'static str {
    let name = "off-center.glb";
    let far_off = [1200.0, -300.0, 4000.0];
    Gltf::new(&lamp(), 1.0, far_off).write_glb(&folder.join(name));
    name
}

/// With perspective, a skinned model does.
#[test]
fn a_model_fills_the_frame() {
    let folder = folder("frame");
    let model = lamp_far_off(&folder);
    assert_framed(&folder, model, (120, 200), "--style none --ortho fit");
    fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
#[ignore = "long: starts the example for each of many models"]
fn models_fill_the_frame_whatever_their_size_place_and_shape() {
    let folder = folder("framing");
    let bar = [Part::new(Shape::Box, [0.0; 3], [0.02, 1.0, 0.02], SKIN)];
    let slab = [Part::new(Shape::Box, [0.0; 3], [1.0, 0.05, 2.0], SKIN)];
    let cases: [(&str, &[Part], f32); 5] = [
        ("figure", &figure(), 1.0),
        ("tiny", &lamp(), 1e-3),
        ("huge", &figure(), 1e4),
        ("thin", &bar, 1.0),
        ("slab", &slab, 1.0),
    ];
    for (name, parts, scale) in cases {
        let file = format!("{name}.glb");
        Gltf::new(parts, scale, [0.0; 3]).write_glb(&folder.join(&file));
        assert_framed(&folder, &file, (200, 120), "--style none");
    }
    let model = lamp_far_off(&folder);
    assert_framed(&folder, model, (200, 120), "--style none");
    assert_framed(&folder, "slab.glb", (120, 200), "--style none");
    assert_framed(&folder, "figure.glb", (120, 200), "--ortho fit");
    assert_framed(&folder, "slab.glb", (200, 120), "--ortho fit");
    fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn a_skinned_model_is_framed_in_its_pose() {
    let folder = folder("skinned");
    let bar = Part::new(Shape::Box, [0.0; 3], [0.1, 2.0, 0.1], SKIN);
    let mut gltf = Gltf::new(&[bar], 1.0, [0.0; 3]);
    // All vertices follow one joint, which lies down and is five times as large.
    let vertices = 24;
    let joints = json!({"componentType": 5121, "count": vertices, "type": "VEC4"});
    let joints = gltf.accessor(&vec![0; 4 * vertices], joints);
    let weights = [1.0, 0.0, 0.0, 0.0].repeat(vertices);
    let weights = gltf.floats(&weights, "VEC4", vertices);
    let attributes = &mut gltf.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let joint = json!({"rotation": [0.0, 0.0, half, half], "scale": [5.0, 5.0, 5.0]});
    let joint = gltf.push("nodes", joint);
    gltf.push("skins", json!({"joints": [joint]}));
    gltf.json["nodes"][1]["skin"] = json!(0);
    gltf.json["scenes"][0]["nodes"] = json!([0, joint]);
    gltf.write_glb(&folder.join("skinned.glb"));
    assert_framed(&folder, "skinned.glb", (160, 120), "--style none");
    fs::remove_dir_all(folder).expect("the folder goes");
}

/// A picture of a model without a style.
fn plain(folder: &Path, name: &str, gltf: Gltf, more: &str) -> Shot {
    gltf.write_glb(&folder.join(name));
    Shot::take(folder, name, (96, 96), &format!("--style none {more}"))
}

fn assert_color_of_skin(shot: &Shot) {
    let lit = shot.lit_color();
    for (seen, own) in lit.iter().zip(SKIN) {
        assert!((seen - f64::from(own)).abs() <= 0.1, "{lit:?} for {SKIN:?}");
    }
}

/// The environment lights metals, which the lamps alone leave black.
fn assert_lit_without_clipping(name: &str, shot: &Shot) {
    assert!(shot.clipped() < 0.01, "{name}: {} clipped", shot.clipped());
    let lit = shot.lit_color();
    assert!(lit[1] > 0.35, "{name}: {lit:?}");
}

/// That skin has its color is checked with textures.
#[test]
fn chrome_is_lit_and_does_not_clip() {
    let folder = folder("light");
    let chrome = ball([0.95; 3], 1.0, 0.05);
    assert_lit_without_clipping("chrome", &plain(&folder, "chrome.glb", chrome, ""));
    assert!(!folder.join("d/ids.exr").exists(), "no line wants ids");
    fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
#[ignore = "long: starts the example for each of many materials"]
fn lit_colors_are_those_of_the_material_and_nothing_clips() {
    let folder = folder("lighting");
    for more in ["", "--hdr", "--material toon"] {
        assert_color_of_skin(&plain(&folder, "skin.glb", ball(SKIN, 0.0, 0.8), more));
    }
    for (name, gltf) in [
        ("white", ball([1.0; 3], 0.0, 0.5)),
        ("lamp", Gltf::new(&lamp(), 1.0, [0.0; 3])),
        ("rough", ball([0.95; 3], 1.0, 0.3)),
    ] {
        let shot = plain(&folder, &format!("{name}.glb"), gltf, "");
        assert_lit_without_clipping(name, &shot);
    }
    fs::remove_dir_all(folder).expect("the folder goes");
}

/// A ball with a lamp of its own, at a distance in units.
fn assert_own_light_suits(name: &str, intensity: f32, distance: f32) {
    let folder = folder(name);
    let mut gltf = ball(SKIN, 0.0, 0.8);
    gltf.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    gltf.json["extensions"]["KHR_lights_punctual"]["lights"] =
        json!([{"type": "point", "intensity": intensity, "color": [1.0, 1.0, 1.0]}]);
    let lamp = json!({"extensions": {"KHR_lights_punctual": {"light": 0}},
        "translation": [0.0, distance * 0.5, distance]});
    let node = gltf.push("nodes", lamp);
    gltf.json["scenes"][0]["nodes"] = json!([0, node]);
    let shot = plain(&folder, "lamp.glb", gltf, "");
    assert!(shot.clipped() < 0.01, "{name}: {} clipped", shot.clipped());
    let lit = shot.lit_color();
    assert!((0.5..0.9).contains(&lit[0]), "{name}: {lit:?}");
    let lights = json!({"directional": 0, "point": 1, "spot": 0});
    assert_eq!(frame(&folder)["lights"], lights);
    fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn lights_of_the_model_are_kept_at_a_level_that_suits() {
    assert_own_light_suits("dim", 1e-3, 500.0);
}

#[test]
#[ignore = "long: quick test models::lights_of_the_model_are_kept_at_a_level_that_suits"]
fn bright_lights_of_the_model_are_kept_at_a_level_that_suits() {
    assert_own_light_suits("bright", 1e7, 3.0);
}

/// The folder's files, by name.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("the folder");
    let mut files: Vec<_> = entries.map(|entry| entry.expect("entry").path()).collect();
    files.sort();
    files
}
