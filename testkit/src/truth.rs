//! Which pixels should have a line, from the same scene at [`FINE`] times the resolution.
//!
//! A pixel has a line if two neighbours among its finer pixels differ:
//!
//! * silhouette: the step of their raw depth exceeds the slopes on both sides by more than
//!   2 % of the nearer depth;
//! * crease: no silhouette, and their normals differ by more than 30 degrees;
//! * object edge: their ids differ.
//!
//! A line is faint where ink of the default outlines begins: at a step of 1 % or a fold of
//! 20 degrees. Outlines may or may not draw it.

use std::collections::HashSet;

use bevy::prelude::*;
use bevy_comics::{ObjectEdges, Outlines};

use crate::read_back::{self, CrackWords};

/// Finer pixels along each side of a pixel.
pub const FINE: u32 = 4;

/// Invisible object edges: ids are drawn, and no line.
pub fn ids_alone() -> Outlines {
    Outlines {
        silhouettes: None,
        creases: None,
        objects: Some(ObjectEdges {
            opacity: 1e-6,
            ..default()
        }),
        ..default()
    }
}

/// What the prepasses of a camera show: raw depth, normals and object ids, row by row.
pub struct Seen<'a> {
    pub depth: &'a [f32],
    pub normals: &'a [[f32; 4]],
    pub ids: &'a [u32],
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
    /// The lines of a picture of this width and height, from what is seen at `fine` times
    /// both: [`FINE`] for the truth, 1 for what the same rule finds in the picture.
    pub fn new([width, height]: [usize; 2], fine: usize, seen: &Seen) -> Self {
        let Seen {
            depth,
            normals,
            ids,
        } = *seen;
        let (w, h) = (width * fine, height * fine);
        let mut kinds = [0; 3].map(|_| vec![false; width * height]);
        let mut faint = vec![false; width * height];
        for y in 1..h - 2 {
            for x in 1..w - 2 {
                let i = y * w + x;
                for step in [1, w] {
                    let j = i + step;
                    let (a, b) = (depth[i], depth[j]);
                    let (before, beyond) = (depth[i - step], depth[j + step]);
                    let near = a.max(b);
                    if near <= 0.0 {
                        continue;
                    }
                    let (here, there, back, ahead) = if a >= b {
                        (a, b, before, beyond)
                    } else {
                        (b, a, beyond, before)
                    };
                    let excess = (here - there) - (back - here).max(there - ahead).max(0.0);
                    let at = (y / fine) * width + x / fine;
                    let silhouette = excess > 0.02 * near;
                    kinds[0][at] |= silhouette;
                    let (m, n) = (normals[i], normals[j]);
                    let cosine = cosine(m, n);
                    let both = a > 0.0 && b > 0.0;
                    kinds[1][at] |= both && !silhouette && cosine < 30f32.to_radians().cos();
                    kinds[2][at] |= ids[i] != ids[j];
                    faint[at] |= excess > 0.01 * near
                        || both && cosine < 20f32.to_radians().cos()
                        || ids[i] != ids[j];
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

    /// The lines of a picture of `size`, from the prepasses of a view that is `fine` times
    /// as large and draws [`ids_alone`], with prepasses of depth and normals.
    pub fn read(render_world: &World, view: Entity, size: UVec2, fine: u32) -> Self {
        let depth = read_back::depth(render_world, view).expect("a prepass");
        let depth: Vec<f32> = depth.bits.iter().map(|b| f32::from_bits(*b)).collect();
        let normals = read_back::normals(render_world, view).expect("a prepass");
        let ids = read_back::object_ids(render_world, view).expect("ids");
        let ids: Vec<u32> = ids.pixels.iter().map(|p| p[0]).collect();
        let seen = Seen {
            depth: &depth,
            normals: &normals.pixels,
            ids: &ids,
        };
        Self::new(size.to_array().map(|v| v as usize), fine as usize, &seen)
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

/// Ends of lines: corners of pixels at which a single crack that is part of a line ends. Not at
/// the border of the picture, and not where another line runs at most a pixel away, under whose
/// ink the end lies.
pub fn line_ends(cracks: &CrackWords) -> usize {
    let [_, _, width, height] = cracks.rect.map(i64::from);
    let is_line = |side: usize, x: i64, y: i64| {
        let inside = (0..width).contains(&x) && (0..height).contains(&y);
        inside && { cracks.words[(y * width + x) as usize][side] & 7 != 0 }
    };
    // The cracks that end at the top left corner of a pixel: above, below, left, right.
    let at_corner = |x: i64, y: i64| {
        [
            (0, x - 1, y - 1),
            (0, x - 1, y),
            (1, x - 1, y - 1),
            (1, x, y - 1),
        ]
        .into_iter()
        .filter(|(side, x, y)| is_line(*side, *x, *y))
    };
    let corners_of = |(side, x, y): (usize, i64, i64)| {
        let first = if side == 0 { (x + 1, y) } else { (x, y + 1) };
        [first, (x + 1, y + 1)]
    };
    let is_end = |x: i64, y: i64| at_corner(x, y).count() == 1;
    let is_covered = |x: i64, y: i64| {
        // The corners of the end's own line, up to three cracks away.
        let mut own = HashSet::from([(x, y)]);
        for _ in 0..3 {
            let more = own.iter().flat_map(|(x, y)| at_corner(*x, *y));
            let more: Vec<_> = more.flat_map(corners_of).collect();
            own.extend(more);
        }
        let around = (-1..=1).flat_map(|j| (-1..=1).map(move |i| (x + i, y + j)));
        let mut others = around.filter(|corner| !own.contains(corner));
        others.any(|(x, y)| at_corner(x, y).next().is_some())
    };
    let corners = (1..height).flat_map(|y| (1..width).map(move |x| (x, y)));
    corners
        .filter(|(x, y)| is_end(*x, *y) && !is_covered(*x, *y))
        .count()
}

/// Whether the mask is set within `reach` pixels along both axes.
fn near(mask: &[bool], width: usize, height: usize, at: usize, reach: i64) -> bool {
    let (x, y) = ((at % width) as i64, (at / width) as i64);
    (-reach..=reach).any(|j| {
        (-reach..=reach).any(|i| {
            let (u, v) = (x + i, y + j);
            (0..width as i64).contains(&u)
                && (0..height as i64).contains(&v)
                && mask[v as usize * width + u as usize]
        })
    })
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
            for v in y.saturating_sub(1)..=(y + 1).min(mask.len() / width - 1) {
                for u in x.saturating_sub(1)..=(x + 1).min(width - 1) {
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

#[cfg(test)]
mod tests {
    use super::{CrackWords, Seen, Truth, line_ends};

    /// A line across the picture has no ends, a loose one two, and a branch one more.
    #[test]
    fn ends_of_lines_are_counted() {
        let ends = |places: &[(usize, i64, i64)]| {
            let mut cracks = CrackWords {
                rect: [0, 0, 40, 36],
                words: vec![[0; 2]; 40 * 36],
                planes: vec![],
                bends: vec![],
            };
            for (side, x, y) in places {
                cracks.words[(y * 40 + x) as usize][*side] = 1;
            }
            line_ends(&cracks)
        };
        let across: Vec<_> = (0..40).map(|x| (1, x, 20)).collect();
        assert_eq!(ends(&across), 0);
        let down: Vec<_> = (10..34).map(|y| (0, 7, y)).collect();
        assert_eq!(ends(&down), 2);
        let branch: Vec<_> = (21..30).map(|y| (0, 7, y)).collect();
        assert_eq!(ends(&[across.clone(), branch].concat()), 1);
        // An end one pixel below the line is covered by it; two pixels below it is not.
        let near: Vec<_> = (22..30).map(|y| (0, 7, y)).collect();
        assert_eq!(ends(&[across.clone(), near].concat()), 1);
        let apart: Vec<_> = (23..30).map(|y| (0, 7, y)).collect();
        assert_eq!(ends(&[across, apart].concat()), 2);
    }

    #[test]
    fn fragments_are_parts_of_few_pixels() {
        let rows = ["##....#", "..#....", "......#", "#####.#"];
        let mask: Vec<bool> = rows.concat().chars().map(|c| c == '#').collect();
        // Three pixels joined over a corner, one alone, five in a row, two in a column.
        assert_eq!(super::fragments(&mask, 7, 0), 0);
        assert_eq!(super::fragments(&mask, 7, 1), 1);
        assert_eq!(super::fragments(&mask, 7, 2), 2);
        assert_eq!(super::fragments(&mask, 7, 3), 3);
        assert_eq!(super::fragments(&mask, 7, 5), 4);
    }

    /// Interpolated normals are shorter than 1: the angle between them decides.
    #[test]
    fn short_normals_are_no_creases() {
        let folded = |degrees: f32, length: f32| {
            let normals: Vec<[f32; 4]> = (0..64)
                .map(|i| {
                    let turned = if i % 8 < 4 { 0.0 } else { degrees.to_radians() };
                    [turned.sin() * length, 0.0, turned.cos() * length, 1.0]
                })
                .collect();
            let seen = Seen {
                depth: &[0.1; 64],
                normals: &normals,
                ids: &[1; 64],
            };
            let truth = Truth::new([8, 8], 1, &seen);
            let any = |mask: &[bool]| mask.contains(&true);
            (any(&truth.kinds[1]), any(&truth.faint))
        };
        for length in [0.6, 0.8, 1.0] {
            assert_eq!(folded(10.0, length), (false, false), "{length}");
            assert_eq!(folded(25.0, length), (false, true), "{length}");
            assert_eq!(folded(35.0, length), (true, true), "{length}");
        }
    }
}
