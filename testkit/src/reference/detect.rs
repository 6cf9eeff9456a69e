//! Twin of `lines/detect.wgsl`: the lines that each pixel owns.

use super::{
    edge::{
        Normal, component_response, edge_response, gradient_extremes, normal_step, step_excess,
    },
    map::is_background,
    smoothstep,
    view::View,
};
use bevy_comics::{Form, Outlines};

/// The lines that a pixel owns.
#[derive(Clone, Copy, Debug, Default)]
pub struct Edge {
    /// Whether a line runs along a side of the pixel, by kind (silhouette, crease,
    /// object edge) and side (west, east, north, south).
    pub runs: [[bool; 4]; 3],
    /// Whether the whole pixel is line, by kind: the faithful forms.
    pub whole: [bool; 3],
    /// Ink by kind, 0 to 1.
    pub ink: [f64; 3],
    /// Half the width of the lines, physical pixels.
    pub half_width: f64,
}

const SIDES: [[i64; 2]; 4] = [[-1, 0], [1, 0], [0, -1], [0, 1]];

/// Ink for a response `p`. Softness 1 makes the ramp around `limit` as wide as
/// fits into [0, 1] symmetrically.
fn ink(limit: f32, softness: f32, p: f64) -> f64 {
    let limit = f64::from(limit);
    let half = f64::from(softness).max(1e-3) * limit.min(1.0 - limit);
    smoothstep(limit - half, limit + half, p)
}

/// Raw depth at a pixel. Outside the viewport it continues the plane at the
/// border: the point reflection of the inside.
fn depth(view: &View, x: i64, y: i64) -> f64 {
    let [x0, y0, w, h] = view.viewport.map(i64::from);
    let (bx, by) = (x.clamp(x0, x0 + w - 1), y.clamp(y0, y0 + h - 1));
    let at = |x: i64, y: i64| view.depth(x as u32, y as u32, 0);
    if (bx, by) == (x, y) {
        return at(x, y);
    }
    let (mx, my) = (
        (2 * bx - x).clamp(x0, x0 + w - 1),
        (2 * by - y).clamp(y0, y0 + h - 1),
    );
    (2.0 * at(bx, by) - at(mx, my)).max(0.0)
}

/// World normal of a pixel, or of the nearest one in the viewport; `None` for the
/// sky and for a texel without a unit normal.
fn normal(view: &View, x: i64, y: i64) -> Normal {
    let [x0, y0, w, h] = view.viewport.map(i64::from);
    let (x, y) = (
        x.clamp(x0, x0 + w - 1) as u32,
        y.clamp(y0, y0 + h - 1) as u32,
    );
    let n = view.normals.as_ref()?.pixels[(y * view.width + x) as usize].map(f64::from);
    let found = super::normal::there([n[0], n[1], n[2]]);
    found.filter(|_| !is_background(view.depth(x, y, 0)))
}

/// The lines that the pixel (`x`, `y`) owns. `scale`: physical pixels per logical
/// pixel. `OutlineStyle` and `NoOutlines` of objects are not part of the twin.
pub fn edge(s: &Outlines, view: &View, x: u32, y: u32, scale: f64) -> Edge {
    let [x0, y0, w, h] = view.viewport.map(i64::from);
    let (x, y) = (i64::from(x), i64::from(y));
    let depths: [[f64; 5]; 5] = std::array::from_fn(|r| {
        std::array::from_fn(|c| depth(view, x + c as i64 - 2, y + r as i64 - 2))
    });
    let along = |v: [i64; 2], n: i64| depths[(2 + v[1] * n) as usize][(2 + v[0] * n) as usize];
    let nearest = depths.iter().flatten().copied().fold(0.0, f64::max);
    let mut edge = Edge::default();
    if nearest <= 0.0 {
        return edge;
    }
    let here = depths[2][2];
    let reference = view.jump_reference(nearest);
    let g = gradient_extremes(&depths, |a: f64, b: f64| (a - b).abs());
    // Sides with a neighbour inside the viewport.
    let open =
        |v: [i64; 2]| (x0..x0 + w).contains(&(x + v[0])) && (y0..y0 + h).contains(&(y + v[1]));
    let jump = f64::from(s.silhouettes.unwrap_or_default().threshold) * reference;

    if let Some(k) = s.silhouettes {
        let threshold = f64::from(k.threshold);
        if k.form == Form::Faithful {
            edge.whole[0] = true;
            edge.ink[0] = ink(k.edge_limit, k.softness, edge_response(g, threshold));
        } else {
            for (side, v) in SIDES.into_iter().enumerate() {
                let excess = step_excess(along(v, -1), here, along(v, 1), along(v, 2));
                // The response of a straight step is half its height.
                let p = edge_response([0.0, 0.5 * excess], 0.5 * threshold * reference);
                let amount = ink(k.edge_limit, k.softness, p);
                if open(v) && amount > 0.0 && excess > 0.0 && excess >= 0.5 * (g[1] - g[0]) {
                    edge.runs[0][side] = true;
                    edge.ink[0] = edge.ink[0].max(amount);
                }
            }
        }
    }
    if let Some(k) = s.creases {
        let normals: [[Normal; 5]; 5] = std::array::from_fn(|r| {
            std::array::from_fn(|c| normal(view, x + c as i64 - 2, y + r as i64 - 2))
        });
        let n = |v: [i64; 2], i: i64| normals[(2 + v[1] * i) as usize][(2 + v[0] * i) as usize];
        let kn = (0.5 * f64::from(k.angle)).to_radians().sin().max(0.02);
        if k.form == Form::Faithful {
            edge.whole[1] = true;
            edge.ink[1] = ink(k.edge_limit, k.softness, component_response(&normals, kn));
        } else {
            let gn = gradient_extremes(&normals, normal_step);
            for (side, v) in SIDES.into_iter().enumerate() {
                let crease = normal_step(n(v, 0), n(v, 1));
                let amount = ink(
                    k.edge_limit,
                    k.softness,
                    edge_response([0.0, 0.5 * crease], kn),
                );
                let around = normal_step(n(v, -1), n(v, 0)).max(normal_step(n(v, 1), n(v, 2)));
                let complete = n(v, -1).is_some() && n(v, 2).is_some();
                let there = along(v, 1);
                let joined = step_excess(along(v, -1), here, there, along(v, 2)).abs() < jump
                    && step_excess(along(v, 2), there, here, along(v, -1)).abs() < jump;
                let mine = here > there || here == there && side % 2 == 1;
                if open(v)
                    && amount > 0.0
                    && joined
                    && mine
                    && complete
                    && crease >= around
                    && crease >= gn[1] - gn[0]
                {
                    edge.runs[1][side] = true;
                    edge.ink[1] = edge.ink[1].max(amount);
                }
            }
        }
    }
    if let (Some(_), Some(ids)) = (s.objects, view.ids) {
        edge.ink[2] = 1.0;
        let id = |x: i64, y: i64| ids.pixels[(y * i64::from(view.width) + x) as usize][0];
        for (side, v) in SIDES.into_iter().enumerate() {
            let there = along(v, 1);
            let hides = (here - there).abs() > jump;
            let mine = here > there || !hides && here == there && side % 2 == 1;
            edge.runs[2][side] = open(v) && mine && id(x, y) != id(x + v[0], y + v[1]);
        }
    }
    let d = view.frame.depth_map(here)[0];
    let left = |fade: f32| 1.0 - f64::from(fade) * d;
    edge.ink = edge.ink.map(|ink| ink * left(s.opacity_fade));
    edge.half_width = 0.5 * f64::from(s.width) * scale * left(s.width_fade);
    edge
}
