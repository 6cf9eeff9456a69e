//! Which pixels should have a line, from the same scene at [`FINE`] times the resolution.
//!
//! A pixel has a line if two neighbors among its finer pixels differ:
//!
//! * silhouette: the step of their raw depth exceeds the slopes on both sides by more than
//!   2 % of the nearer depth;
//! * crease: no silhouette, and their normals differ by more than 30 degrees, or they are of two
//!   sections of a mesh that bend by 20 degrees there or have a step of 2e-4 of the depth;
//! * object edge: their ids differ.
//!
//! A line is faint where ink of the default outlines begins: at a step of 1 % or a fold of
//! 20 degrees; between sections, of 5e-5 or 10 degrees. Outlines may or may not draw it.

mod ends;

use bevy::prelude::*;
use bevy_comics::{
    Outlines,
    lines::{Creases, ObjectEdges},
};

pub use self::ends::{at_places, ends_of_lines, line_ends};
use crate::read_back::{self, CrackWords};

/// Finer pixels along each side of a pixel.
pub const FINE: u32 = 4;

/// Invisible creases and object edges: ids and sections are drawn, and no line.
pub fn ids_alone() -> Outlines {
    Outlines {
        silhouettes: None,
        creases: Some(Creases {
            opacity: 1e-6,
            ..default()
        }),
        objects: Some(ObjectEdges {
            opacity: 1e-6,
            ..default()
        }),
        ..default()
    }
}

/// What the prepasses of a view that draws [`ids_alone`] show: raw depth, normals and object ids,
/// row by row.
struct Seen {
    depth: Vec<f32>,
    normals: Vec<[f32; 4]>,
    ids: Vec<u32>,
    /// Sections of meshes; 0 for none.
    sections: Vec<u32>,
}

/// The border between two pixels: which kinds of line run along it, and whether one does that may
/// be faint.
struct Border {
    kinds: [bool; 3],
    faint: bool,
}

impl Seen {
    fn read(render_world: &World, view: Entity) -> Self {
        let depth = read_back::depth(render_world, view).expect("a prepass");
        let normals = read_back::normals(render_world, view).expect("a prepass");
        let ids = read_back::object_ids(render_world, view).expect("ids");
        Self {
            depth: depth.bits.iter().map(|b| f32::from_bits(*b)).collect(),
            normals: normals.pixels,
            ids: ids.pixels.iter().map(|p| p[0]).collect(),
            sections: ids.pixels.iter().map(|p| p[1] >> 8).collect(),
        }
    }

    /// The border between a pixel and the one `step` pixels later, row by row.
    fn border(&self, i: usize, step: usize) -> Border {
        let j = i + step;
        let (a, b) = (self.depth[i], self.depth[j]);
        let (before, beyond) = (self.depth[i - step], self.depth[j + step]);
        let near = a.max(b);
        if near <= 0.0 {
            return Border {
                kinds: [false; 3],
                faint: false,
            };
        }
        let (here, there, back, ahead) = if a >= b {
            (a, b, before, beyond)
        } else {
            (b, a, beyond, before)
        };
        let excess = (here - there) - (back - here).max(there - ahead).max(0.0);
        let silhouette = excess > 0.02 * near;
        let cosine = cosine(self.normals[i], self.normals[j]);
        let both = a > 0.0 && b > 0.0;
        let object = self.ids[i] != self.ids[j];
        let [section, other] = [self.sections[i], self.sections[j]];
        let parts = !object && section != other && section.min(other) > 0;
        let folds = |degrees: f32| both && cosine < degrees.to_radians().cos();
        let ends = |degrees, step| parts && (folds(degrees) || excess > step * near);
        let crease = both && !silhouette && (folds(30.0) || ends(20.0, 2e-4));
        Border {
            kinds: [silhouette, crease, object],
            faint: excess > 0.01 * near || folds(20.0) || ends(10.0, 5e-5) || object,
        }
    }

    /// The borders of a picture of this size that lines run along: one bit for each kind.
    fn cracks(&self, [width, height]: [usize; 2]) -> CrackWords {
        let mut words = vec![[0; 2]; width * height];
        for y in 1..height.saturating_sub(2) {
            for x in 1..width.saturating_sub(2) {
                let i = y * width + x;
                words[i] = [1, width].map(|step| {
                    let kinds = self.border(i, step).kinds.into_iter().enumerate();
                    kinds
                        .map(|(kind, is_line)| u32::from(is_line) << kind)
                        .sum()
                });
            }
        }
        CrackWords {
            rect: [0, 0, width as u32, height as u32],
            words,
            planes: vec![],
            bends: vec![],
        }
    }
}

/// The three kinds, one mask each: silhouettes, creases, object edges.
pub struct Truth {
    pub width: usize,
    pub height: usize,
    pub kinds: [Vec<bool>; 3],
    /// Pixels with a line of any kind, or a faint one.
    pub faint: Vec<bool>,
}

impl Truth {
    /// The lines of a picture of `size`, from the prepasses of a view that is `fine` times
    /// as large and draws [`ids_alone`], with prepasses of depth and normals: [`FINE`] for the
    /// truth, 1 for what the same rule finds in the picture.
    pub fn read(render_world: &World, view: Entity, size: UVec2, fine: u32) -> Self {
        let seen = Seen::read(render_world, view);
        let [width, height] = size.to_array().map(|v| v as usize);
        let fine = fine as usize;
        let (w, h) = (width * fine, height * fine);
        let mut kinds = [0; 3].map(|_| vec![false; width * height]);
        let mut faint = vec![false; width * height];
        for y in 1..h - 2 {
            for x in 1..w - 2 {
                for step in [1, w] {
                    let border = seen.border(y * w + x, step);
                    let at = (y / fine) * width + x / fine;
                    for (kind, is_line) in kinds.iter_mut().zip(border.kinds) {
                        kind[at] |= is_line;
                    }
                    faint[at] |= border.faint;
                }
            }
        }
        Self {
            width,
            height,
            kinds,
            faint,
        }
    }

    /// The true lines themselves, from the same view of [`FINE`] times the resolution: the
    /// borders of its pixels.
    pub fn fine_cracks(render_world: &World, view: Entity, fine_size: UVec2) -> CrackWords {
        let seen = Seen::read(render_world, view);
        seen.cracks(fine_size.to_array().map(|v| v as usize))
    }

    /// The pixels that have a line of any of these kinds.
    pub fn any(&self, kinds: &[usize]) -> Vec<bool> {
        (0..self.width * self.height)
            .map(|i| kinds.iter().any(|kind| self.kinds[*kind][i]))
            .collect()
    }

    /// The pixels that count. A rim of 3 pixels does not: detectors read beyond the
    /// picture there.
    pub fn inside(&self) -> impl Iterator<Item = usize> {
        let (w, h) = (self.width, self.height);
        (0..w * h).filter(move |i| (3..w - 3).contains(&(i % w)) && (3..h - 3).contains(&(i / w)))
    }

    /// (found, all) of the true pixels. A pixel is found if a line is at most one pixel
    /// away.
    pub fn recall(&self, truth: &[bool], lines: &[bool]) -> (usize, usize) {
        count(
            self.inside()
                .filter(|i| truth[*i])
                .map(|i| near(lines, self.width, self.height, i, 1)),
        )
    }

    /// (right, all) of the drawn pixels. A pixel is right if a true pixel is at most two
    /// pixels away.
    pub fn precision(&self, truth: &[bool], lines: &[bool]) -> (usize, usize) {
        count(
            self.inside()
                .filter(|i| lines[*i])
                .map(|i| near(truth, self.width, self.height, i, 2)),
        )
    }
}

/// The cosine of the angle between two normals, which may be shorter than 1: they are
/// interpolated.
fn cosine(a: [f32; 4], b: [f32; 4]) -> f32 {
    let [a, b] = [a, b].map(|n| Vec3::from_slice(&n).normalize_or_zero());
    a.dot(b)
}

fn count(all: impl Iterator<Item = bool>) -> (usize, usize) {
    all.fold((0, 0), |(yes, total), hit| {
        (yes + usize::from(hit), total + 1)
    })
}

/// The pixels that lines have changed: some channel differs by more than a quarter of the
/// brightest channel of the plain pixel, which counts as 24 codes at least.
pub fn mask(plain: &image::RgbaImage, lined: &image::RgbaImage) -> Vec<bool> {
    plain
        .pixels()
        .zip(lined.pixels())
        .map(|(a, b)| {
            let largest = (0..3).map(|i| a.0[i].abs_diff(b.0[i])).max().unwrap_or(0);
            let light = a.0[..3].iter().copied().max().unwrap_or(0);
            f32::from(largest) > 0.25 * f32::from(light.max(24))
        })
        .collect()
}

/// Whether the mask is set within `reach` pixels along both axes.
fn near(mask: &[bool], width: usize, height: usize, at: usize, reach: usize) -> bool {
    let around = |n: usize, size: usize| n.saturating_sub(reach)..(n + reach + 1).min(size);
    let mut rows = around(at / width, height);
    rows.any(|y| around(at % width, width).any(|x| mask[y * width + x]))
}

/// Number of connected parts of a mask, over sides and corners, of at most `most` pixels.
pub fn fragments(mask: &[bool], width: usize, most: usize) -> usize {
    let mut seen = vec![false; mask.len()];
    let mut small = 0;
    for start in 0..mask.len() {
        if !mask[start] || seen[start] {
            continue;
        }
        seen[start] = true;
        let mut open = vec![start];
        let mut size = 0;
        while let Some(at) = open.pop() {
            size += 1;
            let (x, y) = (at % width, at / width);
            for v in y.saturating_sub(1)..(y + 2).min(mask.len() / width) {
                for u in x.saturating_sub(1)..(x + 2).min(width) {
                    let next = v * width + u;
                    if mask[next] && !seen[next] {
                        seen[next] = true;
                        open.push(next);
                    }
                }
            }
        }
        small += usize::from(size <= most);
    }
    small
}
