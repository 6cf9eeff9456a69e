//! Reference of `lines/settings/weight.wgsl`: how wide a line is at a crack.

use bevy_comics::{Outlines, lines::LineWeight};

use super::{
    crack::{Crack, SIDES, THINNEST, jump, normal, stored_byte, stored_width},
    map::{Frame, Projection, is_background},
    smoothstep,
    view::View,
};

/// The factor of a crack with these kinds. `outer`: there is sky or another object behind
/// it.
pub fn kind_weight(w: &LineWeight, kinds: [bool; 3], outer: bool) -> f64 {
    f64::from(match kinds {
        [true, ..] if outer => w.outer,
        [true, ..] => w.inner,
        [.., true] => w.object,
        _ => w.crease,
    })
}

/// `facing`: the cosine of the angle between the owner's normal and the light.
pub fn light_weight(w: &LineWeight, facing: f64) -> f64 {
    1.0 + f64::from(w.shade) * smoothstep(-0.3, 0.3, -facing)
        - f64::from(w.lit) * smoothstep(-0.1, 0.6, facing)
}

/// `d`: the raw depth of the owner.
pub fn perspective_weight(w: &LineWeight, frame: &Frame, d: f64) -> f64 {
    let (Projection::Perspective { offset }, Some([near, far])) = (frame.projection, frame.ends)
    else {
        return 1.0;
    };
    if is_background(d) {
        return 1.0;
    }
    let distance = |d: f64| 1.0 / (d + offset);
    let middle = 0.5 * (distance(near) + distance(far));
    (middle / distance(d))
        .clamp(0.125, 2.0)
        .powf(f64::from(w.perspective))
}

/// `along`: the direction of the line in the picture, y down.
pub fn nib_weight(w: &LineWeight, [x, y]: [f64; 2]) -> f64 {
    let line = (-y).atan2(x);
    let apart = line - f64::from(w.nib_angle).to_radians();
    apart.sin().hypot(f64::from(w.nib_roundness) * apart.cos())
}

/// `cracks`: those between the crack and the loose end of its line.
pub fn taper_weight(taper: f64, cracks: f64) -> f64 {
    smoothstep(0.0, taper, cracks + 0.5)
}

/// A crack whose width is multiplied by a factor; `None` if nothing is left of it.
pub fn weighted(crack: Crack, factor: f64) -> Option<Crack> {
    let thinnest = crack.half_width.min(THINNEST);
    let half_width = crack.half_width * factor;
    let opacity = stored_byte(stored_byte(crack.opacity) * (half_width / thinnest).min(1.0));
    let weighted = Crack {
        opacity,
        half_width: stored_width(half_width.max(thinnest)),
        ..crack
    };
    (opacity > 0.0).then_some(weighted)
}

/// The largest factor of any line, if no mesh says how wide its lines are.
pub fn largest_weight(w: &LineWeight) -> f64 {
    let kind = w.outer.max(w.inner).max(w.crease).max(w.object);
    let nearest = if w.perspective > 0.0 { 2.0 } else { 1.0 };
    let pressed = 1.0 + f64::from(w.pressure);
    (f64::from(kind) * (1.0 + f64::from(w.shade)) * nearest * pressed).max(1.0)
}

/// The factors that do not depend on the rest of the line: by kind, light, drawn width,
/// distance and nib. `pixel`: that of the crack, in the target.
pub fn local_weight(s: &Outlines, view: &View, crack: &Crack, pixel: [i64; 2], side: usize) -> f64 {
    let w = &s.weight;
    let [dx, dy] = SIDES[side];
    let here = pixel.map(|v| v as u32);
    let there = [pixel[0] + dx, pixel[1] + dy].map(|v| v as u32);
    let [owner, beyond] = if crack.mine {
        [here, there]
    } else {
        [there, here]
    };
    let depth = |[x, y]: [u32; 2]| view.depth(x, y, 0);
    let sky = is_background(depth(beyond));
    let object = |[x, y]: [u32; 2]| {
        view.ids
            .map(|ids| ids.pixels[(y * view.width + x) as usize][0])
    };
    let mut factor = kind_weight(w, crack.kinds, sky || object(owner) != object(beyond));
    if w.shade > 0.0 || w.lit > 0.0 || view.widths.is_some() {
        factor *= surface_weight(s, view, (pixel, side), crack.kinds[0]);
    }
    factor *= perspective_weight(w, &view.frame, depth(owner));
    if w.nib_roundness < 1.0 && s.smooth {
        let slope = crack.bend[1];
        let along = if side == 0 {
            [slope, 1.0]
        } else {
            [1.0, slope]
        };
        factor *= nib_weight(w, along);
    }
    factor
}

/// The factor of the light, times that of the drawn widths. Of a silhouette: the mean over
/// the pixels around the crack, three along it and two on both sides, except for those behind
/// a jump in depth. Of other lines: the mean over both sides.
fn surface_weight(
    s: &Outlines,
    view: &View,
    ([x, y], side): ([i64; 2], usize),
    silhouette: bool,
) -> f64 {
    let [x0, y0, width, height] = view.viewport.map(i64::from);
    let [ax, ay] = SIDES[side];
    let depth = |[x, y]: [i64; 2]| view.depth(x as u32, y as u32, 0);
    let near = depth([x, y]).max(depth([x + ax, y + ay]));
    let least = near - jump(s) * view.jump_reference(near);
    let places = (-1..=2).flat_map(|across| {
        (-1..=1).map(move |along| [x + across * ax + along * ay, y + across * ay + along * ax])
    });
    let beside = [[x, y], [x + ax, y + ay]];
    let counted = places.filter(|place| silhouette || beside.contains(place));
    let seen: Vec<[u32; 2]> = counted
        .filter(|[x, y]| {
            let inside = (x0..x0 + width).contains(x) && (y0..y0 + height).contains(y);
            inside && depth([*x, *y]) >= least
        })
        .map(|place| place.map(|v| v as u32))
        .collect();
    let lit = seen.iter().filter_map(|[x, y]| {
        let n = normal(view, *x, *y)?;
        let facing = (0..3).map(|i| n[i] * view.to_light[i]).sum();
        Some(light_weight(&s.weight, facing))
    });
    let lights = s.weight.shade > 0.0 || s.weight.lit > 0.0;
    let light = if lights { mean(lit.collect()) } else { 1.0 };
    let widths = view.widths.map(|widths| {
        let factor = |[x, y]: &[u32; 2]| widths.factors[(y * widths.width + x) as usize];
        mean(seen.iter().map(factor).collect())
    });
    light * widths.unwrap_or(1.0)
}

/// The mean of factors; 1 if there are none.
fn mean(factors: Vec<f64>) -> f64 {
    if factors.is_empty() {
        1.0
    } else {
        factors.iter().sum::<f64>() / factors.len() as f64
    }
}
