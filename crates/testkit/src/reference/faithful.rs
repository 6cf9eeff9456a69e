//! Reference of `lines/find/faithful.wgsl`: the ink of the faithful equations.

use super::{
    crack::{ink, normal},
    edge::{Normal, component_response, edge_response, gradient_extremes},
    view::View,
};
use bevy_comics::{Outlines, effects::Equations};

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

/// Ink of silhouettes and creases of the faithful equations at a pixel, 0 to 1.
pub fn faithful(s: &Outlines, view: &View, [x, y]: [i64; 2]) -> [f64; 2] {
    let [x0, y0, w, h] = view.viewport.map(i64::from);
    let mut found = [0.0; 2];
    if let Some(k) = s.silhouettes.filter(|k| k.equations == Equations::Faithful) {
        let depths: [[f64; 5]; 5] = std::array::from_fn(|r| {
            std::array::from_fn(|c| depth(view, x + c as i64 - 2, y + r as i64 - 2))
        });
        let g = gradient_extremes(&depths, |a: f64, b: f64| (a - b).abs());
        let p = edge_response(g, f64::from(k.threshold));
        found[0] = ink(k.edge_limit, k.softness, 1.0, p);
    }
    if let Some(k) = s.creases.filter(|k| k.equations == Equations::Faithful) {
        let normals: [[Normal; 5]; 5] = std::array::from_fn(|r| {
            std::array::from_fn(|c| {
                let x = (x + c as i64 - 2).clamp(x0, x0 + w - 1) as u32;
                let y = (y + r as i64 - 2).clamp(y0, y0 + h - 1) as u32;
                normal(view, x, y)
            })
        });
        let kn = (0.5 * f64::from(k.angle)).to_radians().sin().max(0.02);
        found[1] = ink(
            k.edge_limit,
            k.softness,
            1.0,
            component_response(&normals, kn),
        );
    }
    let d = view.frame.depth_map(depth(view, x, y))[0];
    found.map(|ink| ink * (1.0 - f64::from(s.opacity_fade) * d))
}
