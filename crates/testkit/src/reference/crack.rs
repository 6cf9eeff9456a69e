//! Reference of `lines/find/crack.wgsl`: the cracks that lines run along.

use super::{
    edge::{
        Normal, departures, fold, fold_response, is_ledge, is_outdone, is_ridge, is_rim_ridge,
        step_excess, step_response,
    },
    map::is_background,
    smoothstep,
    view::View,
};
use bevy_comics::{
    Outlines,
    effects::Equations,
    lines::{CreaseSource, LineEdge, LineResponse},
};

/// The border between a pixel and its neighbor to the east or south.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crack {
    /// Whether a silhouette, a crease, an object edge runs along it.
    pub kinds: [bool; 3],
    /// Whether the line belongs to the pixel, not to the neighbor.
    pub mine: bool,
    /// Ink of the silhouette or crease, 0 to 1.
    pub ink: f64,
    /// Fraction of the opacity that is left after fading.
    pub opacity: f64,
    /// Half the width in physical pixels.
    pub half_width: f64,
    /// Whether it is a line by itself; otherwise it only continues lines.
    pub certain: bool,
    /// Whether it only joins lines.
    pub ledge: bool,
    /// Offset and slope of its line, see [`bend`](super::bend).
    pub bend: [f64; 2],
    /// Whether the middle of a line of odd width is moved towards its owner.
    pub shifts: bool,
}

/// The neighbors of a pixel.
pub const SIDES: [[i64; 2]; 2] = [[1, 0], [0, 1]];

/// Ink for a response `p`. Softness 1 makes the ramp around `limit` as wide as
/// fits into [0, 1] symmetrically. It begins at `weakest` at the latest.
pub fn ink(limit: f32, softness: f32, weakest: f64, p: f64) -> f64 {
    let [low, high] = ramp(limit, softness, weakest);
    smoothstep(low, high, p)
}

/// The responses at which ink begins and is full.
fn ramp(limit: f32, softness: f32, weakest: f64) -> [f64; 2] {
    let limit = f64::from(limit);
    let half = f64::from(softness).max(1e-3) * limit.min(1.0 - limit);
    [(limit - half).min(weakest * limit), limit + half]
}

/// The fraction of the edge limit from which edges continue lines; 1 if none does.
fn weakest(s: &Outlines) -> f64 {
    if s.hysteresis > 0.0 {
        f64::from(s.hysteresis_ratio)
    } else {
        1.0
    }
}

/// Half of the smallest width of a line in physical pixels.
pub(super) const THINNEST: f64 = 0.3;

/// Ink and half width of a line whose edge has the fraction `amount` of the full response.
fn respond(response: LineResponse, amount: f64, half_width: f64, object: bool) -> [f64; 2] {
    if response == LineResponse::Ink || object {
        return [amount, half_width];
    }
    let thinnest = half_width.min(THINNEST);
    let thinner = half_width * amount;
    let fainter = (thinner / thinnest.max(1e-3)).min(1.0);
    let ink = match response {
        LineResponse::Both => amount * fainter,
        _ => fainter,
    };
    [ink, thinner.max(thinnest)]
}

/// Six values in a row: the pixel is the third, its neighbor the fourth. Places
/// outside the viewport are clamped to its border.
fn along<T>(view: &View, [x, y]: [i64; 2], v: [i64; 2], at: impl Fn(u32, u32) -> T) -> [T; 6] {
    let [x0, y0, w, h] = view.viewport.map(i64::from);
    std::array::from_fn(|i| {
        let n = i as i64 - 2;
        at(
            (x + n * v[0]).clamp(x0, x0 + w - 1) as u32,
            (y + n * v[1]).clamp(y0, y0 + h - 1) as u32,
        )
    })
}

/// World normal of a pixel; `None` for the sky and for a texel without a unit normal.
pub fn normal(view: &View, x: u32, y: u32) -> Normal {
    let n = view.normals.as_ref()?.pixels[(y * view.width + x) as usize].map(f64::from);
    let found = super::normal::there([n[0], n[1], n[2]]);
    found.filter(|_| !is_background(view.depth(x, y, 0)))
}

/// The jump in depth that separates two surfaces, as a fraction of the reference.
pub fn jump(s: &Outlines) -> f64 {
    let measured = s
        .silhouettes
        .filter(|s| s.equations == Equations::Corrected);
    f64::from(measured.unwrap_or_default().threshold)
}

/// The step in depth from which the samples of a pixel are of two surfaces, as a fraction of the
/// reference. `differ`: they are of two objects or sections.
pub fn separation(s: &Outlines, differ: bool) -> f64 {
    let measured = s
        .silhouettes
        .filter(|k| k.equations == Equations::Corrected);
    match measured {
        Some(k) if differ => {
            // The response whose ink is half of a step of eight bits, less what rounding may make.
            let [low, high] = ramp(k.edge_limit, k.softness, weakest(s));
            0.999 * f64::from(k.threshold) * (low + 0.0257 * (high - low)).sqrt()
        }
        _ => jump(s),
    }
}

/// 0 to 1 in eight bits. What is half way between two codes is rounded down.
pub fn stored_byte(value: f64) -> f64 {
    (255.0 * value.clamp(0.0, 1.0) + 0.499).floor() / 255.0
}

/// Whether ink is visible after it is stored in eight bits.
fn is_stored(ink: f64) -> bool {
    stored_byte(ink) > 0.0
}

/// A half width in twelve bits: three of exponent, nine of mantissa, of the half width
/// plus 1/8. What is half way between two of them is rounded down.
pub fn stored_width(half_width: f64) -> f64 {
    let moved = half_width.clamp(0.0, 31.0) + 0.125;
    let step = 2f64.powi(moved.log2().floor() as i32 - 9);
    (moved / step + 0.5 - 16.0 / 16384.0).floor() * step - 0.125
}

/// Whether two sections of an object meet there, and whether one of them has no creases.
/// Unless one of them was asked for (64 to 127), pixels must have `evidence`. Those that were found (1 to 63, and in groups 128 to 190) count only if the lines have
/// the edges of all meshes.
fn sections(
    view: &View,
    pixel: [i64; 2],
    v: [i64; 2],
    (source, evidence): (CreaseSource, bool),
) -> (bool, bool) {
    let Some(ids) = view.ids else {
        return (false, false);
    };
    let at = along(view, pixel, v, |x, y| {
        let [id, slot_section] = ids.pixels[(y * view.width + x) as usize];
        (id, slot_section >> 8)
    });
    let [(id, here), (other, there)] = [at[2], at[3]];
    let silent = here == 255 || there == 255;
    let [here, there] = [here, there].map(|section| match section {
        1..64 | 128..191 if source == CreaseSource::Normals => 0,
        section => section,
    });
    let asked = [here, there]
        .iter()
        .any(|section| (64..128).contains(section));
    let ends = asked || evidence;
    let border = here != there && here != 0 && there != 0 && id == other && ends;
    (border, silent)
}

/// Whether a hard line between two surfaces of which none hides the other belongs to the pixel,
/// not to its neighbor.
fn is_preferred(view: &View, pixel: [i64; 2], v: [i64; 2]) -> bool {
    let objects = along(view, pixel, v, |x, y| match view.ids {
        Some(ids) => ids.pixels[(y * view.width + x) as usize],
        None => [0; 2],
    });
    let [here, there] = [objects[2], objects[3]];
    if here[0] != there[0] {
        return here[0] > there[0];
    }
    // Above, towards the camera, and a little to its right.
    let [x, _, z] = view.right;
    let direction = [0.02 * x - 0.42 * z, 0.90, 0.02 * z + 0.42 * x];
    let normals = along(view, pixel, v, |x, y| normal(view, x, y));
    // 3 degrees.
    let bent = fold(normals[2], normals[3]).filter(|fold| *fold >= 0.0027);
    if let (Some(_), Some(here), Some(there)) = (bent, normals[2], normals[3]) {
        let more: f64 = (0..3).map(|i| direction[i] * (here[i] - there[i])).sum();
        return more > 0.0;
    }
    let depths = along(view, pixel, v, |x, y| view.depth(x, y, 0));
    let in_front = 3.0 * (depths[2] - depths[3]) - depths[1] + depths[4];
    let has_step = in_front.abs() > 2e-5 * view.jump_reference(depths[2].max(depths[3]));
    if has_step {
        in_front < 0.0
    } else {
        here[1] > there[1]
    }
}

/// How much raw depth bends at the crack between a pixel and its neighbor at a side, as a fraction of
/// the reference. Where one of both has one neighbor only, at the border of the viewport, it counts
/// as 0. What is outside of it is as the nearest pixel inside.
fn bend(view: &View, pixel: [i64; 2], side: usize) -> f64 {
    let depths = along(view, pixel, SIDES[side], |x, y| view.depth(x, y, 0));
    let [first, size] = [view.viewport[side], view.viewport[side + 2]].map(i64::from);
    let bend = |i: usize| {
        let at = pixel[side] + i as i64 - 2;
        let inside = at > first && at < first + size - 1;
        let bend = (depths[i - 1] - 2.0 * depths[i] + depths[i + 1]).abs();
        if inside { bend } else { 0.0 }
    };
    let near = depths[2].max(depths[3]);
    (bend(2) + bend(3)) / view.jump_reference(near).max(1e-30)
}

/// The largest bend of a crack, of the next ones on both sides of it, and of those that meet its ends at a
/// right angle.
fn bend_around(view: &View, [x, y]: [i64; 2], side: usize) -> f64 {
    let v = SIDES[side];
    let ends = [[0, 0], v].map(|[i, j]| [x + i, y + j]);
    let other = 1 - side;
    let back = |[x, y]: [i64; 2]| [x - SIDES[other][0], y - SIDES[other][1]];
    let meeting = (ends.into_iter()).flat_map(|end| [(end, other), (back(end), other)]);
    let row = [-1, 0, 1].map(|n| ([x + n * v[0], y + n * v[1]], side));
    let bends = meeting.chain(row).map(|(at, side)| bend(view, at, side));
    bends.fold(0.0, f64::max)
}

/// The crack between a pixel and its neighbor at a side, an entry of [`SIDES`].
/// `scale`: physical pixels per logical pixel. `OutlineStyle` and `NoOutlines` of
/// objects are not part of the reference.
pub fn crack(s: &Outlines, view: &View, pixel: [i64; 2], side: usize, scale: f64) -> Option<Crack> {
    let v = SIDES[side];
    let depths = along(view, pixel, v, |x, y| view.depth(x, y, 0));
    let [here, there] = [depths[2], depths[3]];
    let near = here.max(there);
    let reference = view.jump_reference(near);
    let excess = step_excess(depths);
    let jump = jump(s) * reference;
    let mut crack = Crack {
        kinds: [false; 3],
        mine: here >= there,
        ink: 0.0,
        opacity: 1.0,
        half_width: 0.0,
        certain: false,
        ledge: false,
        bend: [0.0; 2],
        shifts: true,
    };
    // Without continued lines, every crack is one by itself.
    let continues = s.hysteresis > 0.0;
    let is_certain = |p: f64, limit: f32| !continues || p >= f64::from(limit);
    let silhouettes = (s.silhouettes).filter(|k| k.equations == Equations::Corrected);
    let creases = s.creases.filter(|k| k.equations == Equations::Corrected);
    if let Some(k) = silhouettes {
        // Where a surface ends in front of the sky, there is a step, however small.
        let p = if here.min(there) <= 0.0 && near > 0.0 {
            1.0
        } else {
            step_response(excess, 0.5 * f64::from(k.threshold) * reference)
        };
        let amount = ink(k.edge_limit, k.softness, weakest(s), p);
        if near > 0.0 && is_stored(amount) && !is_outdone(depths) {
            crack.kinds[0] = true;
            crack.ink = amount;
            crack.certain = is_certain(p, k.edge_limit);
        }
    }
    if let Some(k) = creases {
        // Hard lines choose their side by normals.
        let by_edges = k.source == CreaseSource::Meshes;
        let without = by_edges && s.edge != LineEdge::Hard;
        let normals = along(view, pixel, v, |x, y| {
            normal(view, x, y).filter(|_| !without)
        });
        let folds = [1, 2, 3].map(|i: usize| fold(normals[i], normals[i + 1]));
        let kn = (0.5 * f64::from(k.angle)).to_radians().sin().max(0.02);
        // Whether depth bends as at planes that meet at an angle, of whose half this is the sine.
        let bends_by = |sine: f64| {
            let least = view.least_bend * sine / (1.0 - sine * sine).sqrt();
            by_edges || k.normal_maps || bend_around(view, pixel, side) > least
        };
        // The response whose ink is half of a step of eight bits.
        let [low, high] = ramp(k.edge_limit, k.softness, weakest(s));
        let folds_by_depth = bends_by(kn * (low + 0.0257 * (high - low)).sqrt().min(0.995));
        let [step, beside, turn] = departures(depths).map(|depth| depth / reference);
        let has_line = silhouettes.is_some_and(|k| {
            let p = step_response(beside, 0.5 * f64::from(k.threshold));
            let inked = is_stored(ink(k.edge_limit, k.softness, weakest(s), p));
            inked && is_certain(p, k.edge_limit)
        });
        let bends = if without {
            turn > 5e-5
        } else {
            let sine = 5f64.to_radians().sin();
            folds[1].unwrap_or(0.0) > (2.0 * sine).powi(2) && bends_by(sine)
        };
        let evidence =
            bends || step > 2e-5 || (beside > 2e-5 && beside * reference < jump && !has_line);
        let (border, silent) = sections(view, pixel, v, (k.source, evidence));
        let p = if border {
            1.0
        } else {
            fold_response(folds[1], kn)
        };
        let amount = ink(k.edge_limit, k.softness, weakest(s), p);
        let by_normals = !by_edges && folds_by_depth;
        let ridge = is_ridge(folds) && by_normals || border;
        let rim = is_rim_ridge(folds) && by_normals;
        let drawn = (ridge || rim) && !silent;
        let free = !crack.kinds[0] || border && !crack.certain;
        if border && !silent && crack.kinds[0] {
            crack.ink = crack.ink.max(amount);
        }
        if drawn && excess < jump && is_stored(amount) && free {
            crack.kinds[..2].copy_from_slice(&[false, true]);
            crack.ink = amount;
            crack.certain = ridge && is_certain(p, k.edge_limit);
        }
    }
    if let (Some(_), Some(ids)) = (s.objects, view.ids) {
        let object = |x, y| ids.pixels[(y * view.width + x) as usize][0];
        let objects = along(view, pixel, v, object);
        crack.kinds[2] = objects[2] != objects[3];
        crack.certain |= crack.kinds[2];
    }
    let is_free = here.min(there) > 0.0 && crack.kinds == [false; 3];
    let may_join = creases.is_some() && continues && is_free;
    if may_join && is_ledge(excess, jump) && !is_outdone(depths) {
        crack.kinds[1] = true;
        crack.ink = 1.0;
        crack.ledge = true;
    }
    let owner = if crack.mine { here } else { there };
    let d = view.frame.depth_map(owner)[0];
    crack.opacity = 1.0 - f64::from(s.opacity_fade) * d;
    let half_width = 0.5 * f64::from(s.width) * scale;
    let half_width = half_width * (1.0 - f64::from(s.width_fade) * d);
    let is_soft = crack.kinds[0] || crack.kinds[1];
    let amount = if is_soft { crack.ink } else { 1.0 };
    let [ink, half_width] = respond(s.response, amount, half_width, crack.kinds[2]);
    crack.ink = ink;
    let hides = crack.kinds[0] && !crack.kinds[2] || crack.kinds[2] && (here - there).abs() > jump;
    if s.edge == LineEdge::Hard && !hides {
        crack.mine = is_preferred(view, pixel, v);
    }
    crack.half_width = stored_width(half_width);
    crack.shifts = crack.kinds[0] || !s.smooth;
    (crack.kinds != [false; 3]).then_some(crack)
}
