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
fn a_turntable_is_an_animated_png() {
    let folder = folder("animation");
    Gltf::new(&figure(), 1.0, [0.0; 3]).write_glb(&folder.join("figure.glb"));
    let arguments = "figure.glb --size 48x64 --msaa 1 --frames 1 --style none";
    render(
        &folder,
        &format!("{arguments} --turntable 3 --out turn.png"),
    );
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
    fs::remove_dir_all(folder).expect("the folder goes");
}

/// The original and two presets: all different pictures, and all different labels.
#[test]
fn a_sheet_shows_the_model_in_the_presets_that_are_named() {
    let folder = folder("few");
    Gltf::new(&figure(), 1.0, [0.0; 3]).write_glb(&folder.join("figure.glb"));
    let arguments = "figure.glb --size 72x48 --msaa 1 --frames 1 --out s.png";
    render(
        &folder,
        &format!("{arguments} --presets=sepia,crimson-dusk"),
    );
    let sheet = image::open(folder.join("s.png"))
        .expect("a sheet")
        .to_rgb8();
    fs::remove_dir_all(folder).expect("the folder goes");
    // Two columns and two rows, gaps of 4 and labels of 12 pixels.
    assert_eq!(sheet.dimensions(), (2 * 76 + 4, 2 * 64 + 4));
    let (mut pictures, mut labels) = (HashSet::new(), HashSet::new());
    for (x, y) in [(4, 4), (80, 4), (4, 68)] {
        let part = |y, height| image::imageops::crop_imm(&sheet, x, y, 72, height).to_image();
        let label = part(y + 48, 12);
        let is_written = label.pixels().any(|p| p.0[0] < 128);
        assert!(is_written, "the label at {x}, {y} is empty");
        pictures.insert(part(y, 48).into_raw());
        labels.insert(label.into_raw());
    }
    assert_eq!((pictures.len(), labels.len()), (3, 3));
}
