//! Reference of `lines/draw/draw.wgsl`: the ink of the lines at every pixel, without strokes beyond
//! loose ends.

use std::collections::{HashMap, HashSet};

use super::{
    bend::stored as stored_bend,
    boil::boiled,
    budget::Densities,
    chain::cracks_to_ends,
    coverage::disc_coverage,
    crack::{Crack, SIDES, crack, jump, stored_byte},
    edge::line_offset,
    faithful::faithful,
    fold::placed,
    gaps::{gaps, source},
    link::{Place, bend, joined, linked, without_short_pieces},
    rim::is_rim,
    sheet::{Sheet, Spot},
    straight::straight,
    view::View,
    weight::{largest_weight, local_weight, taper_weight, weighted},
};
use bevy_comics::{
    Outlines,
    lines::{LineBoil, LineEdge},
};

/// The cracks of a viewport.
pub struct Cracks {
    width: i64,
    height: i64,
    /// To the east and south of each pixel, row by row.
    pub cracks: Vec<[Option<Crack>; 2]>,
    /// Pixels around a pixel whose cracks draw lines there.
    pub(super) reach: i64,
    /// Opacity of silhouettes, creases, object edges.
    pub(super) opacity: [f64; 3],
    /// Whether lines leave their cracks.
    smooth: bool,
    /// Whether lines ink whole pixels.
    hard: bool,
    /// Whether only the best cracks of each column are searched.
    by_columns: bool,
}

impl Cracks {
    /// `scale`: physical pixels per logical pixel.
    pub fn new(s: &Outlines, view: &View, scale: f64) -> Self {
        Self::on_sheet(s, view, scale, Sheet::SMOOTH)
    }

    /// The same, drawn on a sheet.
    pub fn on_sheet(s: &Outlines, view: &View, scale: f64, sheet: Sheet) -> Self {
        let [x0, y0, w, h] = view.viewport.map(i64::from);
        let cracks = (0..h)
            .flat_map(|y| (0..w).map(move |x| [x0 + x, y0 + y]))
            .map(|pixel| [0, 1].map(|side| crack(s, view, pixel, side, scale)))
            .collect();
        let widest = f64::from(s.width) * largest_weight(&s.weight);
        let reach = (sheet.largest(0.5 * widest * scale) + 1.0).ceil() as i64 - 1;
        let reach = reach.max(1);
        // Between the centers of pixels, cracks half a pixel further away count.
        let grid_reach = reach + i64::from(s.boil.amplitude > 0.0);
        let mut found = Self {
            width: w,
            height: h,
            cracks,
            smooth: s.smooth && s.edge == LineEdge::Smooth,
            hard: s.edge == LineEdge::Hard,
            opacity: [
                s.silhouettes.unwrap_or_default().opacity,
                s.creases.unwrap_or_default().opacity,
                s.objects.unwrap_or_default().opacity,
            ]
            .map(f64::from),
            reach: grid_reach + i64::from(s.smooth && grid_reach > 1),
            by_columns: grid_reach > 1 && reach > 1,
        };
        let steps = ((f64::from(s.hysteresis) * scale).ceil() as i32).min(64);
        let all: HashMap<Place, Crack> = found.places().collect();
        // Only where gaps are closed, cracks are like others.
        let counts = |crack: &Crack| s.gap_closing == 0 || !crack.ledge;
        let sources = all.iter().filter(|(_, crack)| counts(crack));
        let sources = sources.map(|(place, crack)| (*place, *crack)).collect();
        let min_length = match s.min_length {
            ..2 => 1,
            least => (f64::from(least) * scale).ceil().min(64.0) as u32,
        };
        let linked = found.complete((&all, &sources), (steps, min_length, s), (view, jump(s)));
        let taper = (f64::from(s.weight.taper) * scale).min(64.0);
        found.weigh((s, view), [x0, y0], taper, (&linked, &sources));
        found
    }

    /// Multiplies the width of every crack by its weight. `taper`: the cracks over which loose ends
    /// taper; `linked`: the cracks of all lines, short pieces included; `all`: those that were found.
    fn weigh(
        &mut self,
        (s, view): (&Outlines, &View),
        [x0, y0]: [i64; 2],
        taper: f64,
        (linked, all): (&HashSet<Place>, &HashMap<Place, Crack>),
    ) {
        let [width, height] = [self.width, self.height];
        let lines: HashSet<Place> = self.places().map(|(place, _)| place).collect();
        let w = &s.weight;
        let densities = (s.ink_budget < 1.0).then(|| Densities::new(linked, [width, height]));
        let varies = w.shade > 0.0
            || w.lit > 0.0
            || w.perspective > 0.0
            || (w.nib_roundness < 1.0 && s.smooth)
            || w.taper > 0.0
            || view.widths.is_some();
        for (i, cracks) in self.cracks.iter_mut().enumerate() {
            for (side, slot) in cracks.iter_mut().enumerate() {
                let Some(mut crack) = *slot else { continue };
                let pixel = [i as i64 % width, i as i64 / width];
                crack.shifts &= !varies;
                let ([x, y], _) = source(all, (pixel, side));
                let at = [x0 + x, y0 + y];
                let mut factor = local_weight(s, view, &crack, at, side);
                if taper > 0.0 {
                    let ends = cracks_to_ends(&lines, (pixel, side), [width, height], taper);
                    factor *= taper_weight(taper, ends[0].min(ends[1]) as f64);
                }
                if let Some(densities) = &densities {
                    let width = 2.0 * crack.half_width * factor;
                    factor *= densities.budget_weight(f64::from(s.ink_budget), pixel, width);
                }
                *slot = weighted(crack, factor);
            }
        }
    }

    /// The cracks and where they are.
    fn places(&self) -> impl Iterator<Item = (Place, Crack)> {
        self.cracks.iter().enumerate().flat_map(|(i, cracks)| {
            let pixel = [i as i64 % self.width, i as i64 / self.width];
            let sides = [0, 1].map(|side| cracks[side].map(|crack| ((pixel, side), crack)));
            sides.into_iter().flatten()
        })
    }

    /// Closes gaps, leaves out the cracks that are not parts of lines, and bends the lines of the
    /// others. `all`: those that were found, and `sources` without ledges.
    /// Returns the cracks of all lines, short pieces included.
    fn complete(
        &mut self,
        (all, sources): (&HashMap<Place, Crack>, &HashMap<Place, Crack>),
        (steps, min_length, s): (i32, u32, &Outlines),
        (view, jump): (&View, f64),
    ) -> HashSet<Place> {
        let width = self.width;
        let mut linked = joined(&linked(all, steps), all);
        let closed = gaps(&linked, s.gap_closing);
        linked.extend(&closed);
        let kept = without_short_pieces(&linked, [self.width, self.height], min_length);
        let links = s.hysteresis > 0.0 || s.min_length > 1 || s.gap_closing > 0;
        for (i, cracks) in self.cracks.iter_mut().enumerate() {
            for (side, slot) in cracks.iter_mut().enumerate() {
                let place = ([i as i64 % width, i as i64 / width], side);
                if closed.contains(&place) {
                    let near = || sources[&source(sources, place)];
                    *slot = Some(all.get(&place).copied().unwrap_or_else(near));
                }
                *slot = slot.filter(|_| kept.contains(&place));
                let Some(crack) = slot else { continue };
                let at = source(sources, place);
                if links && !crack.kinds[0] && is_rim((all, &linked), place, (view, jump), at) {
                    crack.kinds = [true, false, crack.kinds[2]];
                    crack.shifts = true;
                }
                if self.smooth {
                    let run = bend(&linked, place);
                    let fold = || placed((view, jump), &linked, place, run);
                    let fold = crack.kinds[1].then(fold).flatten();
                    crack.bend = fold.map_or(run, stored_bend);
                }
            }
        }
        linked
    }

    pub(super) fn at(&self, x: i64, y: i64) -> [Option<Crack>; 2] {
        let inside = (0..self.width).contains(&x) && (0..self.height).contains(&y);
        if inside {
            self.cracks[(y * self.width + x) as usize]
        } else {
            [None; 2]
        }
    }

    /// Ink by kind (silhouette, crease, object edge) at a place in pixels of the
    /// viewport, before it is stored. The sign of `nudge` decides how ink rounds that
    /// lies between two codes.
    pub fn ink(&self, at: [f64; 2], nudge: f64) -> [f64; 3] {
        self.ink_at(at, &Spot::SMOOTH, nudge)
    }

    /// The same at a place on the sheet.
    fn ink_at(&self, at: [f64; 2], on: &Spot, nudge: f64) -> [f64; 3] {
        if self.hard {
            return self.ink_of_sides(at, nudge);
        }
        let lines = if self.by_columns {
            self.lines_by_columns(at, nudge)
        } else {
            self.lines_around(at)
        };
        ink_of_lines(lines, (at, on), nudge)
    }

    /// The same by an exhaustive search.
    pub fn exhaustive_ink(&self, at: [f64; 2], nudge: f64) -> [f64; 3] {
        ink_of_lines(self.lines_around(at), (at, &Spot::SMOOTH), nudge)
    }

    /// The ink of hard lines: along the sides of the pixel itself, and of those that lie nearer to
    /// a line than it is wide.
    fn ink_of_sides(&self, at: [f64; 2], nudge: f64) -> [f64; 3] {
        let [px, py] = at.map(|at| at.floor() as i64);
        let mut ink = [0.0; 3];
        for away in 0..2 * self.reach {
            // East, south, west, north: the pixel whose crack it is, and whether that is inside.
            for (side, [x, y], mine) in [
                (0, [px + away, py], true),
                (1, [px, py + away], true),
                (0, [px - away - 1, py], false),
                (1, [px, py - away - 1], false),
            ] {
                let Some(crack) = self.at(x, y)[side] else {
                    continue;
                };
                let width = (2.0 * crack.half_width).round_ties_even().max(1.0);
                if crack.mine == mine && (away as f64) < width {
                    ink = larger(ink, ink_of(&crack, nudge, 1.0));
                }
            }
        }
        ink
    }

    /// All lines within reach of a place.
    fn lines_around(&self, at: [f64; 2]) -> Vec<Line> {
        let (px, py) = (at[0].floor() as i64, at[1].floor() as i64);
        let mut lines = Vec::new();
        for [x, y] in self.around() {
            let [x, y] = [px + x, py + y];
            for (crack, v) in self.at(x, y).into_iter().zip(SIDES) {
                let Some(crack) = crack else { continue };
                let middle = middle(&crack, [x, y], v);
                let border = distance(middle, at) - crack.half_width;
                lines.push((border, middle, crack));
            }
        }
        lines
    }

    /// The pixels whose cracks are searched.
    fn around(&self) -> Vec<[i64; 2]> {
        let square = |n: i64| (-n..=n).flat_map(move |y| (-n..=n).map(move |x| [x, y]));
        let mut pixels: Vec<[i64; 2]> = square(self.reach).collect();
        if self.smooth && self.reach == 1 {
            pixels.extend([-1, 0, 1].map(|n| [n, -2]));
            pixels.extend([-1, 0, 1].map(|n| [-2, n]));
        }
        pixels
    }
}

/// The ink of lines at a place, which has a place on the sheet.
fn ink_of_lines(mut lines: Vec<Line>, (at, on): ([f64; 2], &Spot), nudge: f64) -> [f64; 3] {
    let found = lines.iter().fold([0.0; 3], |found, (border, _, crack)| {
        let away = border + crack.half_width;
        let covered = disc_coverage(away, on.half_width(crack.half_width));
        larger(found, ink_of(crack, nudge, covered))
    });
    let straight = straight(&mut lines, (at, on), nudge);
    let mut straight =
        (straight.into_iter()).map(|(ink, left)| larger(found, ink).map(|ink| ink * left));
    // Which of two lines at the same distance is the nearest is a matter of rounding.
    let sum = |ink: &[f64; 3]| ink.iter().sum::<f64>();
    let by_sum = |a: &[f64; 3], b: &[f64; 3]| sum(a).total_cmp(&sum(b));
    let chosen = if nudge > 0.0 {
        straight.max_by(by_sum)
    } else if nudge < 0.0 {
        straight.min_by(by_sum)
    } else {
        straight.next()
    };
    chosen.unwrap_or(found)
}

/// A line: the distance from its border, its middle, and its crack.
pub(super) type Line = (f64, [f64; 2], Crack);

fn larger(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k].max(b[k]))
}

/// Whether two middles are in different places.
pub(super) fn is_apart(a: [f64; 2], b: [f64; 2]) -> bool {
    distance(a, b).powi(2) > 0.07
}

pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The middle of the line along a crack.
pub(super) fn middle(crack: &Crack, [x, y]: [i64; 2], v: [i64; 2]) -> [f64; 2] {
    let shift = match (crack.shifts, crack.mine) {
        (false, _) => 0.0,
        (true, false) => line_offset(crack.half_width),
        (true, true) => -line_offset(crack.half_width),
    };
    let [offset, slope] = crack.bend;
    let length = 1f64.hypot(slope);
    let across = v.map(|v| v as f64);
    [0, 1].map(|i| {
        let normal = (across[i] - slope * across[1 - i]) / length;
        [x, y][i] as f64 + 0.5 + (0.5 + offset) * across[i] + shift * normal
    })
}

/// Ink by kind of a pixel of which a line covers a fraction.
pub(super) fn ink_of(crack: &Crack, nudge: f64, covered: f64) -> [f64; 3] {
    let opacity = stored(crack.opacity, nudge);
    let soft = stored(crack.ink, nudge);
    let whole = [soft, soft, 1.0];
    std::array::from_fn(|kind| {
        if crack.kinds[kind] {
            whole[kind] * opacity * covered
        } else {
            0.0
        }
    })
}

/// A value in eight bits. Within 0.02 codes of a tie, the sign of `nudge` selects the
/// code.
fn stored(value: f64, nudge: f64) -> f64 {
    let sign = if nudge == 0.0 { 0.0 } else { nudge.signum() };
    stored_byte(value.clamp(0.0, 1.0) + 0.02 * sign / 255.0)
}

/// The ink of every pixel of a viewport, as it is stored.
pub struct Ink {
    width: i64,
    height: i64,
    /// By kind, row by row: rounded down where undecided, as it is, and rounded up.
    pixels: Vec<[[f64; 3]; 3]>,
}

impl Ink {
    /// `scale`: physical pixels per logical pixel; `seconds`: of the app's clock.
    pub fn new((s, sheet): (&Outlines, Sheet), view: &View, scale: f64, seconds: f64) -> Self {
        let cracks = Cracks::on_sheet(s, view, scale, sheet);
        let widest = f64::from(s.width) * largest_weight(&s.weight);
        let boil = LineBoil {
            amplitude: s.boil.amplitude.min((8.0 / widest) as f32),
            ..s.boil
        };
        let [x0, y0, w, h] = view.viewport.map(i64::from);
        let pixel = |x: i64, y: i64| {
            let whole = faithful(s, view, [x0 + x, y0 + y]);
            [-1.0, 0.0, 1.0].map(|nudge| {
                let at = [x as f64 + 0.5, y as f64 + 0.5];
                let on = sheet.under([x0 as f64 + at[0], y0 as f64 + at[1]]);
                let at = boiled(&boil, at, scale, seconds);
                let mut ink = cracks.ink_at(at, &on, nudge);
                ink[0] = ink[0].max(whole[0]);
                ink[1] = ink[1].max(whole[1]);
                ink.map(|ink| decoded(stored(encoded(ink), nudge)))
            })
        };
        let pixels = (0..h)
            .flat_map(|y| (0..w).map(move |x| (x, y)))
            .map(|(x, y)| pixel(x, y))
            .collect();
        Self {
            width: w,
            height: h,
            pixels,
        }
    }

    /// Ink at a pixel of the viewport, which is clamped to it.
    pub fn texel(&self, x: i64, y: i64, nudge: f64) -> [f64; 3] {
        let x = x.clamp(0, self.width - 1);
        let y = y.clamp(0, self.height - 1);
        let [down, exact, up] = self.pixels[(y * self.width + x) as usize];
        match nudge {
            0.0 => exact,
            ..0.0 => down,
            _ => up,
        }
    }
}

/// Ink as it is stored: steps are finest where little light is left.
fn encoded(ink: f64) -> f64 {
    1.0 - (1.0 - ink.clamp(0.0, 1.0)).sqrt()
}

/// The inverse of [`encoded`].
fn decoded(stored: f64) -> f64 {
    1.0 - (1.0 - stored) * (1.0 - stored)
}
