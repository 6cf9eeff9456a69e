//! Series of pictures: turntables and sheets of presets.

use std::{fs, io::BufReader};

use image::RgbImage;

use super::{Gltf, Part, Shape, bounds, figure, files};
use crate::{
    command_line::{folder, render},
    prelude::*,
};

const GREEN: [f32; 3] = [0.1, 0.6, 0.1];
const SIZE: (u32, u32) = (160, 120);

/// Pixels that are greener than the backdrop.
fn green(picture: &RgbImage) -> Vec<bool> {
    let is_green = |p: &image::Rgb<u8>| {
        let [r, g, b] = p.0.map(f32::from);
        g > 1.25 * r.max(b)
    };
    picture.pixels().map(is_green).collect()
}

#[test]
fn a_turntable_holds_its_framing_over_the_whole_turn() {
    let folder = folder("turntable");
    // A bar beside the origin: broad from one side, narrow from the next.
    let bar = Part::new(Shape::Box, [3.0, 1.0, 0.0], [1.0, 0.15, 0.1], GREEN);
    Gltf::new(&[bar], 1.0, [0.0; 3]).write_glb(&folder.join("bar.glb"));
    let arguments = "bar.glb --size 160x120 --msaa 1 --frames 1 --style none";
    render(&folder, &format!("{arguments} --turntable 12 --out turn"));
    let frames = files(&folder.join("turn"));
    assert_eq!(frames.len(), 12);
    assert!(frames[11].ends_with("frame-011.png"), "{frames:?}");
    let mut union = vec![false; (SIZE.0 * SIZE.1) as usize];
    let mut widths = Vec::new();
    for frame in &frames {
        let mask = green(&image::open(frame).expect("a frame").to_rgb8());
        let [left, right, ..] = bounds(&mask, SIZE.0);
        assert!(left <= right, "{frame:?} shows nothing");
        widths.push(right + 1 - left);
        for (sum, new) in union.iter_mut().zip(mask) {
            *sum |= new;
        }
    }
    let [left, right, top, bottom] = bounds(&union, SIZE.0);
    let across = f64::from(right + 1 - left) / f64::from(SIZE.0);
    // Between two of twelve frames the bar may be a little broader than in both.
    assert!((0.80..=0.87).contains(&across), "the turn spans {across}");
    assert!(
        (left + right).abs_diff(SIZE.0 - 1) <= 6,
        "{left} to {right}"
    );
    assert!(
        (top + bottom).abs_diff(SIZE.1 - 1) <= 4,
        "{top} to {bottom}"
    );
    let (least, most) = (widths.iter().min(), widths.iter().max());
    assert!(
        most > least.map(|w| w * 2).as_ref(),
        "it does not turn: {widths:?}"
    );
    fs::remove_dir_all(folder).expect("the folder goes");
}

#[test]
fn a_turntable_is_an_animated_png_or_numbered_files() {
    let folder = folder("animation");
    Gltf::new(&figure(), 1.0, [0.0; 3]).write_glb(&folder.join("figure.glb"));
    let run = |out: &str| {
        let arguments = "figure.glb --size 48x64 --msaa 1 --frames 1 --style none";
        render(&folder, &format!("{arguments} --turntable 3 --out {out}"));
    };
    run("turn.png");
    let file = fs::File::open(folder.join("turn.png")).expect("turn.png");
    let mut reader = png::Decoder::new(BufReader::new(file))
        .read_info()
        .expect("a PNG");
    let animation = *reader.info().animation_control().expect("animated");
    assert_eq!((animation.num_frames, animation.num_plays), (3, 0));
    let mut seen = HashSet::new();
    for _ in 0..3 {
        let mut pixels = vec![0; reader.output_buffer_size().expect("it fits")];
        reader.next_frame(&mut pixels).expect("a frame");
        seen.insert(pixels);
    }
    assert_eq!(seen.len(), 3, "all frames differ");
    run("numbered/a%02d.png");
    let names: Vec<_> = files(&folder.join("numbered"))
        .iter()
        .filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()))
        .collect();
    assert_eq!(names, ["a00.png", "a01.png", "a02.png"]);
    fs::remove_dir_all(folder).expect("the folder goes");
}

/// A sheet in `count` styles, the original among them: all different pictures, and all different labels.
fn sheet(name: &str, presets: &str, [columns, count]: [u32; 2]) -> [HashSet<Vec<u8>>; 2] {
    let folder = folder(name);
    Gltf::new(&figure(), 1.0, [0.0; 3]).write_glb(&folder.join("figure.glb"));
    let arguments = format!("figure.glb --size 72x48 --msaa 1 --frames 1 {presets} --out s.png");
    render(&folder, &arguments);
    let sheet = image::open(folder.join("s.png"))
        .expect("a sheet")
        .to_rgb8();
    fs::remove_dir_all(folder).expect("the folder goes");
    // Gaps of 4 and labels of 12 pixels.
    let rows = count.div_ceil(columns);
    assert_eq!(sheet.dimensions(), (columns * 76 + 4, rows * 64 + 4));
    let (mut pictures, mut labels) = (HashSet::new(), HashSet::new());
    for cell in 0..count {
        let (x, y) = (4 + cell % columns * 76, 4 + cell / columns * 64);
        let part = |y, height| image::imageops::crop_imm(&sheet, x, y, 72, height).to_image();
        let label = part(y + 48, 12);
        assert!(
            label.pixels().any(|p| p.0[0] < 128),
            "label {cell} is empty"
        );
        pictures.insert(part(y, 48).into_raw());
        labels.insert(label.into_raw());
    }
    [pictures, labels]
}

#[test]
fn a_sheet_shows_the_model_in_the_presets_that_are_named() {
    let [pictures, labels] = sheet("few", "--presets=noir,blueprint", [2, 3]);
    assert_eq!(pictures.len(), 3, "all pictures differ");
    assert_eq!(labels.len(), 3, "every preset has its own name");
}

#[test]
#[ignore = "long: compiles the shaders of every preset"]
fn a_sheet_shows_the_model_in_every_preset_with_its_name() {
    let count = presets::ALL.len() as u32 + 1;
    let [pictures, labels] = sheet("sheet", "--presets", [6, count]);
    // The figures of the paper differ by thresholds that a plain model need not show.
    let least = count as usize - 4;
    let seen = pictures.len();
    assert!(seen >= least, "{seen} different pictures");
    assert_eq!(labels.len(), count as usize, "names of presets");
}
