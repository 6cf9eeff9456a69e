//! Styles in numbers: what the gallery prints and the tests bound.

use std::time::Duration;

use bevy::{
    prelude::*,
    render::{RenderApp, sync_world::RenderEntity},
    time::TimeUpdateStrategy,
};
use bevy_comics::{ComicStyle, Outlines, presets, style::Preset};
use image::RgbaImage;

use crate::{
    headless::Headless,
    read_back::{self, DepthImage},
    scenes::BuiltIn,
    studio::Studio,
};

/// No two styles are closer, in FLIP.
pub const LEAST_APART: f64 = 0.25;
/// The largest part of a picture that is white or black, unless the paper is white.
pub const MOST_CLIPPED: f64 = 0.05;
/// The least contrast of planes: a just noticeable difference in CIELAB (Mahy et al. 1994).
pub const LEAST_CONTRAST: f64 = 2.3;
/// The largest flicker beyond that of the scene: one 8-bit code.
pub const MOST_FLICKER: f64 = 1.0;
/// The largest part of lines that is in fragments.
pub const MOST_FRAGMENTS: f64 = 0.05;

/// The styles whose paper is white: white is not clipped there.
const WHITE_PAPER: [Preset; 2] = [presets::MANGA_PAGE, presets::HARD_BOILED];

/// Pieces of line of fewer pixels are fragments.
const FRAGMENT: usize = 8;
/// The change of a channel, in codes, from which a pixel belongs to a line.
const LINE: u8 = 8;
/// The move of what is far away from one frame of the turntable to the next, pixels.
const STEP: f32 = 0.25;

/// What is measured of a style.
#[derive(Clone, Copy, Debug, Default)]
pub struct Measures {
    /// Parts of the picture: darker than a quarter of the display's range, white, black.
    pub ink: f64,
    pub white: f64,
    pub black: f64,
    /// See `contrast`.
    pub contrast: f64,
    /// See `flicker`.
    pub flicker: f64,
    /// See `fragments`; 0 without lines, and where they are not counted.
    pub fragments: f64,
}

impl Measures {
    /// The means over pictures.
    pub fn mean(all: &[Self]) -> Self {
        let mean = |value: fn(&Self) -> f64| all.iter().map(value).sum::<f64>() / all.len() as f64;
        Self {
            ink: mean(|m| m.ink),
            white: mean(|m| m.white),
            black: mean(|m| m.black),
            contrast: mean(|m| m.contrast),
            flicker: mean(|m| m.flicker),
            fragments: mean(|m| m.fragments),
        }
    }

    /// The limits that a style does not keep, in words. `unstyled` is measured of the same scenes.
    pub fn failures(&self, style: Preset, unstyled: &Self) -> Vec<String> {
        let is_paper = WHITE_PAPER.contains(&style);
        let clipped = self.black + if is_paper { 0.0 } else { self.white };
        let beyond = self.flicker - unstyled.flicker;
        let [contrast, fragments] = [self.contrast, self.fragments];
        let is_broken = fragments > MOST_FRAGMENTS;
        let checks = [
            (clipped > MOST_CLIPPED, format!("clipped {clipped:.3}")),
            (contrast < LEAST_CONTRAST, format!("contrast {contrast:.2}")),
            (beyond > MOST_FLICKER, format!("flicker {beyond:.2}")),
            (is_broken, format!("fragments {fragments:.3}")),
        ];
        let failed = checks.into_iter().filter(|(failed, _)| *failed);
        failed.map(|(_, text)| text).collect()
    }
}

/// A scene in which styles are measured.
pub struct StyleBench {
    pub studio: Studio,
    /// The plane of each pixel: 0 near, 1 middle, 2 far; `None` for the sky.
    planes: Vec<Option<u8>>,
    frames: usize,
    /// Whether fragments of lines are counted, which needs a picture without lines. Default: true.
    pub count_fragments: bool,
}

impl StyleBench {
    /// `frames` on the turntable.
    pub fn new(scene: BuiltIn, size: UVec2, frames: usize) -> Self {
        let mut studio = Studio::new(scene, size, Msaa::Sample4);
        // For its depth prepass.
        studio.shoot(Some(&ComicStyle::new().with(Outlines::default())));
        let world = studio.headless.app.world();
        let view = world.get::<RenderEntity>(studio.camera).expect("a view");
        let render_world = studio.headless.app.sub_app(RenderApp).world();
        let depth = read_back::depth(render_world, view.id()).expect("a depth prepass");
        Self {
            planes: planes(&depth),
            studio,
            frames,
            count_fragments: true,
        }
    }

    /// The picture in a style, and what is measured of it. Time stands still on the turntable, so
    /// that lines that are drawn anew by the clock do not count as flicker.
    pub fn measure(&mut self, style: Option<&ComicStyle>) -> (RgbaImage, Measures) {
        let lined = style.filter(|style| self.count_fragments && style.get::<Outlines>().is_some());
        let bare = lined.map(|style| style.clone().without::<Outlines>());
        let bare = bare.map(|style| self.studio.shoot(Some(&style)));
        let picture = self.studio.shoot(style);
        let fragments = bare.map_or(0.0, |bare| fragments(&picture, &bare));
        let frames = self.turn(&picture);
        let measures = Measures {
            ink: part(&picture, |c| c < 64),
            white: part(&picture, |c| c == 255),
            black: part(&picture, |c| c == 0),
            contrast: contrast(&picture, &self.planes),
            flicker: flicker(&frames),
            fragments,
        };
        (picture, measures)
    }

    /// Frames while the camera goes around its target, from `start` on.
    fn turn(&mut self, start: &RgbaImage) -> Vec<RgbaImage> {
        let vantage = &self.studio.vantage;
        let (eye, target) = (vantage.eye, vantage.target);
        let height = self.studio.headless.options.size.y as f32;
        let angle = STEP * (0.5 * vantage.fov).tan() / (0.5 * height);
        let stopped = TimeUpdateStrategy::ManualDuration(Duration::ZERO);
        self.studio.headless.app.insert_resource(stopped);
        let turned = |frame: usize| {
            let turn = Quat::from_rotation_y(angle * frame as f32);
            Transform::from_translation(target + turn * (eye - target)).looking_at(target, Vec3::Y)
        };
        let camera = self.studio.camera;
        let headless = &mut self.studio.headless;
        let look_from = |headless: &mut Headless, frame| {
            let mut camera = headless.app.world_mut().entity_mut(camera);
            camera.insert(turned(frame));
        };
        let mut frames = vec![start.clone()];
        for frame in 1..self.frames {
            look_from(headless, frame);
            headless.step(1);
            frames.push(headless.picture());
        }
        look_from(headless, 0);
        frames
    }
}

/// Divides the pixels with geometry by distance into three groups of the same size.
fn planes(depth: &DepthImage) -> Vec<Option<u8>> {
    let first = (0..depth.height).flat_map(|y| (0..depth.width).map(move |x| (x, y)));
    let raw: Vec<f32> = first.map(|(x, y)| depth.at(x, y, 0)).collect();
    // Raw depth is reversed: 0 is infinitely far.
    let mut seen: Vec<f32> = raw.iter().copied().filter(|d| *d > 0.0).collect();
    seen.sort_by(|a, b| b.total_cmp(a));
    let border = |third: usize| seen.get(third * seen.len() / 3).copied().unwrap_or(0.0);
    let (near_end, far_start) = (border(1), border(2));
    let plane = |d: &f32| match *d {
        d if d <= 0.0 => None,
        d if d > near_end => Some(0),
        d if d > far_start => Some(1),
        _ => Some(2),
    };
    raw.iter().map(plane).collect()
}

/// The part of pixels of which every channel satisfies something.
fn part(picture: &RgbaImage, is: impl Fn(u8) -> bool) -> f64 {
    let all = picture.pixels().len() as f64;
    let counted = picture.pixels().filter(|p| p.0[..3].iter().all(|c| is(*c)));
    counted.count() as f64 / all
}

/// CIELAB (D65) of a display color.
fn lab(code: &[u8; 4]) -> [f64; 3] {
    let [r, g, b] = [0, 1, 2].map(|i| {
        let c = f64::from(code[i]) / 255.0;
        match c <= 0.04045 {
            true => c / 12.92,
            false => ((c + 0.055) / 1.055).powf(2.4),
        }
    });
    let xyz = [
        (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505,
        0.2126 * r + 0.7152 * g + 0.0722 * b,
        (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089,
    ];
    let [x, y, z] = xyz.map(|t: f64| match t > 0.008856 {
        true => t.cbrt(),
        false => 7.787 * t + 16.0 / 116.0,
    });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The mean difference in CIELAB between the mean colors of near and middle, and of middle and
/// far.
fn contrast(picture: &RgbaImage, planes: &[Option<u8>]) -> f64 {
    let mut sums = [[0.0; 4]; 3];
    for (pixel, plane) in picture.pixels().zip(planes) {
        let Some(plane) = plane else { continue };
        let [l, a, b] = lab(&pixel.0);
        let sum = &mut sums[usize::from(*plane)];
        for (sum, value) in sum.iter_mut().zip([l, a, b, 1.0]) {
            *sum += value;
        }
    }
    let means = sums.map(|[l, a, b, n]| [l, a, b].map(|sum| sum / f64::max(n, 1.0)));
    let apart = |p: [f64; 3], q: [f64; 3]| {
        let square = |i: usize| (p[i] - q[i]).powi(2);
        (square(0) + square(1) + square(2)).sqrt()
    };
    0.5 * (apart(means[0], means[1]) + apart(means[1], means[2]))
}

/// How far pixels jump and jump back from frame to frame, in codes: the mean over pixels and over
/// all three successive frames, of the channel that jumps most. An edge that moves on does not
/// count.
fn flicker(frames: &[RgbaImage]) -> f64 {
    let (mut sum, mut count) = (0u64, 0u64);
    for three in frames.windows(3) {
        let pixels = three[0]
            .pixels()
            .zip(three[1].pixels())
            .zip(three[2].pixels());
        for ((a, b), c) in pixels {
            let jump = |i: usize| {
                let there = i32::from(b[i]) - i32::from(a[i]);
                let back = i32::from(b[i]) - i32::from(c[i]);
                match there.signum() == back.signum() {
                    true => there.abs().min(back.abs()),
                    false => 0,
                }
            };
            sum += jump(0).max(jump(1)).max(jump(2)).unsigned_abs() as u64;
            count += 1;
        }
    }
    sum as f64 / count.max(1) as f64
}

/// The part of the pixels of lines that are in pieces of fewer than eight pixels. Lines are where
/// the picture without outlines differs.
fn fragments(with: &RgbaImage, without: &RgbaImage) -> f64 {
    let differs =
        |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| (0..3).any(|i| a[i].abs_diff(b[i]) > LINE);
    let mut open: Vec<bool> = with.pixels().zip(without.pixels()).map(differs).collect();
    let (width, height) = (with.width() as usize, with.height() as usize);
    let all = open.iter().filter(|line| **line).count();
    let mut small = 0;
    for start in 0..open.len() {
        let size = take_piece(&mut open, width, height, start);
        if size < FRAGMENT {
            small += size;
        }
    }
    small as f64 / all.max(1) as f64
}

/// Removes the piece of a pixel, over edges and corners, and returns its size.
fn take_piece(open: &mut [bool], width: usize, height: usize, start: usize) -> usize {
    let mut stack = vec![start];
    let mut size = 0;
    while let Some(at) = stack.pop() {
        if !std::mem::take(&mut open[at]) {
            continue;
        }
        size += 1;
        let (x, y) = (at % width, at / width);
        for ny in y.saturating_sub(1)..(y + 2).min(height) {
            for nx in x.saturating_sub(1)..(x + 2).min(width) {
                stack.push(ny * width + nx);
            }
        }
    }
    size
}
