//! Twin of `lines/read.wgsl`: the lines at a place. It searches all lines, so it is
//! also the twin of the result of `lines/flood.wgsl`.

use super::{
    Rgb,
    detect::{Edge, edge},
    edge::{line_coverage, line_offset},
    mix,
    view::View,
};
use bevy_comics::Outlines;

/// The lines that the pixels of a target own.
pub struct Edges {
    width: u32,
    height: u32,
    /// Row by row.
    edges: Vec<Edge>,
    /// Distance in pixels within which lines are searched.
    reach: i64,
}

impl Edges {
    /// `height`: rows of the target in pixels; `scale`: physical pixels per logical
    /// pixel.
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

    /// All lines within reach of a pixel.
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

    /// The result of the flood at a pixel: the owner of the line whose border is
    /// nearest to the pixel's centre. Among owners at the same distance, a positive
    /// `nudge` selects the one with the most ink at `at`, another one that with the
    /// least.
    fn flooded(&self, px: i64, py: i64, at: [f64; 2], nudge: f64) -> Option<[i64; 2]> {
        let lines = self.lines(px, py);
        let centre = [px as f64 + 0.5, py as f64 + 0.5];
        let border = |line: &Line| line.distance(centre) - line.edge.half_width;
        let nearest = lines.iter().map(border).fold(f64::INFINITY, f64::min);
        let mut owners: Vec<[i64; 2]> = lines
            .iter()
            .filter(|line| border(line) <= nearest + 4e-3)
            .map(|line| line.owner)
            .collect();
        let inked = |owner: &[i64; 2]| -> f64 {
            let own = lines.iter().filter(|line| line.owner == *owner);
            own.map(|line| line.ink(at, nudge).into_iter().fold(0.0, f64::max))
                .fold(0.0, f64::max)
        };
        owners.sort_by(|a, b| inked(a).total_cmp(&inked(b)));
        if nudge > 0.0 {
            owners.last().copied()
        } else {
            owners.first().copied()
        }
    }

    /// Ink by kind (silhouette, crease, object edge), 0 to 1, at a place in pixels.
    pub fn ink(&self, at: [f64; 2], lookup: Lookup, nudge: f64) -> [f64; 3] {
        let (px, py) = (at[0].floor() as i64, at[1].floor() as i64);
        let mut ink = [0.0f64; 3];
        if let Some(own) = self.at(px, py) {
            ink = std::array::from_fn(|kind| {
                if own.whole[kind] {
                    stored_ink(own.ink[kind], nudge)
                } else {
                    0.0
                }
            });
        }
        let corner = at.map(|v| (v - 0.5).floor() as i64);
        let known: Vec<[i64; 2]> = match lookup {
            Lookup::Gather => Vec::new(),
            Lookup::Flood => vec![[px, py]],
            Lookup::FourFlooded => (0..4)
                .map(|i| [corner[0] + (i & 1), corner[1] + (i >> 1)])
                .collect(),
        };
        let owners: Vec<[i64; 2]> = known
            .into_iter()
            .map(|[x, y]| self.inside(x, y))
            .filter_map(|[x, y]| self.flooded(x, y, at, nudge))
            .collect();
        for line in self.lines(px, py) {
            if lookup == Lookup::Gather || owners.contains(&line.owner) {
                let own = line.ink(at, nudge);
                ink = std::array::from_fn(|kind| ink[kind].max(own[kind]));
            }
        }
        ink
    }

    /// The pixel of the target nearest to this one.
    fn inside(&self, x: i64, y: i64) -> [i64; 2] {
        [
            x.clamp(0, i64::from(self.width) - 1),
            y.clamp(0, i64::from(self.height) - 1),
        ]
    }
}

/// Which lines are read at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lookup {
    /// All lines within reach.
    Gather,
    /// The lines of one owner: the flood's result at the pixel.
    Flood,
    /// The lines of up to four owners: the flood's results at the four pixels around
    /// the place.
    FourFlooded,
}

/// Ink after storage in eight bits. Within 0.02 codes of a tie, the sign of `nudge`
/// selects the code.
fn stored_ink(ink: f64, nudge: f64) -> f64 {
    let code = 255.0 * ink.clamp(0.0, 1.0);
    let undecided = 0.02 * nudge.signum() * if nudge == 0.0 { 0.0 } else { 1.0 };
    (code + undecided).round().min(255.0) / 255.0
}

/// A line along one side of its owner.
struct Line<'a> {
    edge: &'a Edge,
    kinds: [bool; 3],
    /// Its middle, pixels.
    at: [f64; 2],
    /// The pixel that owns it.
    owner: [i64; 2],
}

impl Line<'_> {
    fn distance(&self, to: [f64; 2]) -> f64 {
        (self.at[0] - to[0]).hypot(self.at[1] - to[1])
    }

    fn ink(&self, at: [f64; 2], nudge: f64) -> [f64; 3] {
        let covered = line_coverage(self.distance(at), self.edge.half_width);
        [0, 1, 2].map(|kind: usize| {
            if self.kinds[kind] {
                stored_ink(self.edge.ink[kind], nudge) * covered
            } else {
                0.0
            }
        })
    }
}

/// (opacity, colour) of silhouettes, object edges and creases, in this order.
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

/// The colour with the strongest line drawn over it. Of lines whose opacity differs
/// by at most 0.01, the silhouette is drawn, else the object edge.
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

/// The opacity of the strongest line.
pub fn total(s: &Outlines, ink: [f64; 3]) -> f64 {
    strength(s, ink)
        .map(|k| k.0)
        .into_iter()
        .fold(0.0, f64::max)
}
