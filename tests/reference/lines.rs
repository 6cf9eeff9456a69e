//! Twin of `stylize/lines.wgsl` and, for its result, of `outlining/flood.wgsl`:
//! the lines at a place, looked for everywhere.

use super::{
    Rgb,
    bindings::View,
    detect::{Edge, edge},
    mix,
    outlines::{line_coverage, line_offset},
};
use bevy_comics::Outlines;

/// Every pixel's edge, row by row.
pub struct Edges {
    width: u32,
    height: u32,
    edges: Vec<Edge>,
    reach: i64,
}

impl Edges {
    pub fn new(s: &Outlines, view: &View, height: u32, scale: f64) -> Self {
        let edges = (0..height)
            .flat_map(|y| (0..view.width).map(move |x| (x, y)))
            .map(|(x, y)| {
                if view.contains(x, y) {
                    edge(s, view, x, y, scale)
                } else {
                    Edge::default()
                }
            })
            .collect();
        Self {
            width: view.width,
            height,
            edges,
            reach: (0.5 * f64::from(s.width) * scale).ceil() as i64 + 2,
        }
    }

    fn at(&self, x: i64, y: i64) -> Option<&Edge> {
        let inside =
            (0..i64::from(self.width)).contains(&x) && (0..i64::from(self.height)).contains(&y);
        inside.then(|| &self.edges[(y * i64::from(self.width) + x) as usize])
    }

    /// Every line around a pixel: its owner, kinds, place and half width.
    fn lines(&self, px: i64, py: i64) -> Vec<Line<'_>> {
        let mut lines = Vec::new();
        for y in py - self.reach..=py + self.reach {
            for x in px - self.reach..=px + self.reach {
                let Some(edge) = self.at(x, y) else { continue };
                let offset = line_offset(edge.half_width);
                for (side, v) in [[-1.0, 0.0], [1.0, 0.0], [0.0, -1.0], [0.0, 1.0]]
                    .into_iter()
                    .enumerate()
                {
                    let kinds = [0, 1, 2].map(|kind: usize| edge.runs[kind][side]);
                    if kinds != [false; 3] {
                        let at = [
                            x as f64 + 0.5 + v[0] * offset,
                            y as f64 + 0.5 + v[1] * offset,
                        ];
                        lines.push(Line {
                            edge,
                            kinds,
                            at,
                            owner: [x, y],
                        });
                    }
                }
            }
        }
        lines
    }

    /// Ink by kind at a place in pixels. Gathered lines are all lines around;
    /// of flooded ones a pixel knows those of the one pixel whose border is
    /// nearest to its centre. Where two are as near, `nudge` takes the more or
    /// the less inked.
    pub fn ink(&self, at: [f64; 2], flooded: bool, nudge: f64) -> [f64; 3] {
        let (px, py) = (at[0].floor() as i64, at[1].floor() as i64);
        let mut ink = [0.0f64; 3];
        if let Some(own) = self.at(px, py) {
            for kind in 0..3 {
                if own.whole[kind] {
                    ink[kind] = own.ink[kind];
                }
            }
        }
        let mut lines = self.lines(px, py);
        if flooded {
            let centre = [px as f64 + 0.5, py as f64 + 0.5];
            let border = |line: &Line| line.distance(centre) - line.edge.half_width;
            let nearest = lines.iter().map(border).fold(f64::INFINITY, f64::min);
            let mut owners: Vec<[i64; 2]> = lines
                .iter()
                .filter(|line| border(line) <= nearest + 4e-3)
                .map(|line| line.owner)
                .collect();
            owners.dedup();
            let inked = |owner: &[i64; 2]| -> f64 {
                let own = lines.iter().filter(|line| line.owner == *owner);
                own.map(|line| line.ink(at).into_iter().fold(0.0, f64::max))
                    .fold(0.0, f64::max)
            };
            owners.sort_by(|a, b| inked(a).total_cmp(&inked(b)));
            let owner = if nudge > 0.0 {
                owners.last().copied()
            } else {
                owners.first().copied()
            };
            lines.retain(|line| Some(line.owner) == owner);
        }
        for line in &lines {
            let own = line.ink(at);
            ink = std::array::from_fn(|kind| ink[kind].max(own[kind]));
        }
        ink
    }
}

struct Line<'a> {
    edge: &'a Edge,
    kinds: [bool; 3],
    at: [f64; 2],
    owner: [i64; 2],
}

impl Line<'_> {
    fn distance(&self, to: [f64; 2]) -> f64 {
        (self.at[0] - to[0]).hypot(self.at[1] - to[1])
    }

    fn ink(&self, at: [f64; 2]) -> [f64; 3] {
        let covered = line_coverage(self.distance(at), self.edge.half_width);
        [0, 1, 2].map(|kind: usize| {
            if self.kinds[kind] {
                self.edge.ink[kind] * covered
            } else {
                0.0
            }
        })
    }
}

fn strength(s: &Outlines, ink: [f64; 3]) -> [(f64, Rgb); 3] {
    let rgb = |color: bevy::color::Color| {
        let c = color.to_linear();
        [c.red, c.green, c.blue].map(f64::from)
    };
    let (a, b, c) = (
        s.silhouettes.unwrap_or_default(),
        s.creases.unwrap_or_default(),
        s.objects.unwrap_or_default(),
    );
    [
        (ink[0] * f64::from(a.opacity), rgb(a.color)),
        (ink[2] * f64::from(c.opacity), rgb(c.color)),
        (ink[1] * f64::from(b.opacity), rgb(b.color)),
    ]
}

/// The strongest line over the picture.
pub fn draw(s: &Outlines, linear: Rgb, ink: [f64; 3]) -> Rgb {
    let kinds = strength(s, ink);
    let mut best = kinds[0];
    for kind in kinds {
        if kind.0 > best.0 + 0.01 {
            best = kind;
        }
    }
    std::array::from_fn(|i| mix(linear[i], best.1[i], best.0))
}

pub fn total(s: &Outlines, ink: [f64; 3]) -> f64 {
    strength(s, ink)
        .map(|k| k.0)
        .into_iter()
        .fold(0.0, f64::max)
}
