//! Reference of `toon/stylized_highlight.wgsl`.

use bevy_comics::toon::{HighlightShape, StylizedHighlight};

type V2 = [f64; 2];
type V3 = [f64; 3];

fn dot<const N: usize>(a: [f64; N], b: [f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn length<const N: usize>(a: [f64; N]) -> f64 {
    dot(a, a).sqrt()
}

/// `a + t * b`.
fn add<const N: usize>(a: [f64; N], t: f64, b: [f64; N]) -> [f64; N] {
    std::array::from_fn(|c| a[c] + t * b[c])
}

pub fn unit(a: V3) -> V3 {
    let long = length(a);
    a.map(|x| x / long)
}

pub fn cross(a: V3, b: V3) -> V3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Two unit vectors in the tangent plane, the first towards `right`.
pub fn frame_along(normal: V3, right: V3) -> [V3; 2] {
    let along = unit(add(right, -dot(normal, right), normal));
    [along, cross(normal, along)]
}

/// Tangent of the angle between normal and half vector at which the highlight falls to `edge` of
/// its peak, found by bisection; 0 if it does not.
pub fn stylized_highlight_radius(edge: f64, perceptual_roughness: f64) -> f64 {
    let roughness = (perceptual_roughness * perceptual_roughness).max(0.002);
    let is_lit = |cosine: f64| super::light::highlight_fraction(roughness, cosine) > edge;
    if is_lit(0.0) {
        return 0.0;
    }
    let (mut dark, mut lit) = (std::f64::consts::FRAC_PI_2, 0.0f64);
    for _ in 0..80 {
        let middle = 0.5 * (dark + lit);
        *if is_lit(middle.cos()) {
            &mut lit
        } else {
            &mut dark
        } = middle;
    }
    lit.tan()
}

pub fn place_of([right, up]: [V3; 2], normal: V3, half_vector: V3) -> V2 {
    let along = dot(half_vector, normal).max(1e-4);
    [
        -dot(half_vector, right) / along,
        -dot(half_vector, up) / along,
    ]
}

/// Distance from the border of a shape whose radius is 1.
pub fn shape_distance(g: &StylizedHighlight, y: V2) -> f64 {
    let (bar, square) = (f64::from(g.bar), f64::from(g.square));
    let rounded_box = || {
        let corner = 0.5 * (1.0 - square);
        let beyond = y.map(|y| y.abs() - (1.0 - corner));
        let outside = length(beyond.map(|b| b.max(0.0)));
        outside + beyond[0].max(beyond[1]).min(0.0) - corner
    };
    match g.shape {
        HighlightShape::Square => rounded_box(),
        HighlightShape::Window => {
            let from_bars = y[0].abs().min(y[1].abs()) - 0.5 * bar;
            rounded_box().max(-from_bars)
        }
        HighlightShape::Crescent => {
            let hole = length([y[0] - 2.0 * bar, y[1]]) - 1.0;
            (length(y) - 1.0).max(-hole)
        }
        HighlightShape::Star => {
            // The sector between a tip and a corner that the place is in, of all of them.
            let points = g.points as usize;
            let half = std::f64::consts::PI / points as f64;
            let angle = y[0].atan2(y[1]);
            let nearest = (0..points)
                .map(|k| {
                    let from = angle - 2.0 * half * k as f64;
                    from.sin().atan2(from.cos()).abs()
                })
                .fold(f64::INFINITY, f64::min);
            let place = [length(y) * nearest.cos(), length(y) * nearest.sin()];
            let corner = [bar * half.cos(), bar * half.sin()];
            let side = [corner[0] - 1.0, corner[1]];
            let away = [place[0] - 1.0, place[1]];
            (away[0] * side[1] - away[1] * side[0]) / length(side)
        }
        HighlightShape::Streak => {
            let end = 1.0 - bar;
            length([y[0] - y[0].clamp(-end, end), y[1]]) - bar
        }
        _ => {
            let power = 2.0 + 6.0 * square;
            (y[0].abs().powf(power) + y[1].abs().powf(power)).powf(power.recip()) - 1.0
        }
    }
}

fn turn(g: &StylizedHighlight) -> V2 {
    let angle = f64::from(g.rotation).to_radians();
    [angle.cos(), angle.sin()]
}

fn centre(g: &StylizedHighlight, radius: f64) -> V2 {
    let centre = [g.offset.x, g.offset.y].map(|c| f64::from(c) * radius);
    let long = length(centre);
    if long > 2.0 {
        centre.map(|c| 2.0 * c / long)
    } else {
        centre
    }
}

/// Distance of a place in the plane of half vectors from the border of the sign, in units of its
/// radius.
pub fn sign_distance(g: &StylizedHighlight, radius: f64, place: V2) -> f64 {
    let [c, s] = turn(g);
    let from = add(place, -1.0, centre(g, radius));
    let turned = [c * from[0] + s * from[1], c * from[1] - s * from[0]];
    let scale = [g.scale.x, g.scale.y].map(f64::from);
    let split = [g.split.x, g.split.y].map(f64::from);
    let y = std::array::from_fn(|k| {
        let y = turned[k] / (scale[k] * f64::from(g.size) * radius);
        if split[k] > 0.0 {
            y.abs() - split[k]
        } else {
            y
        }
    });
    shape_distance(g, y)
}

/// The half vector after the paper's five changes.
pub fn moved(g: &StylizedHighlight, [du, dv]: [V3; 2], radius: f64, half_vector: V3) -> V3 {
    let [c, s] = turn(g);
    let right = add(du.map(|x| c * x), s, dv);
    let up = add(dv.map(|x| c * x), -s, du);
    let mut h = half_vector;
    for (axis, scale) in [(right, g.scale.x), (up, g.scale.y)] {
        let shrink = 1.0 - 1.0 / f64::from(scale);
        h = unit(add(h, -shrink * dot(h, axis), axis));
    }
    let [x, y] = centre(g, radius);
    h = unit(add(add(h, x, du), y, dv));
    let side = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
    let apart = [
        f64::from(g.split.x) * radius * side(dot(h, right)),
        f64::from(g.split.y) * radius * side(dot(h, up)),
    ];
    h = unit(add(add(h, -apart[0], right), -apart[1], up));
    // The smaller angle to an axis.
    let angle = (dot(h, right).abs().min(1.0).acos()).min(dot(h, up).abs().min(1.0).acos());
    let pull = f64::from(g.square) * (2.0 * angle).sin().powi(g.sharpness as i32);
    let (x, y) = (dot(h, right), dot(h, up));
    unit(add(add(h, -pull * x, right), -pull * y, up))
}

pub fn faithful_distance(
    g: &StylizedHighlight,
    frame: [V3; 2],
    radius: f64,
    n: V3,
    half_vector: V3,
) -> f64 {
    let h = moved(g, frame, radius, half_vector);
    length(place_of(frame, n, h)) / (f64::from(g.size) * radius) - 1.0
}

pub fn stylized_highlight_coverage(
    g: &StylizedHighlight,
    here: f64,
    beside: f64,
    below: f64,
) -> f64 {
    let pixel = length([beside - here, below - here]).max(1e-5);
    let small = (2.0 / pixel).min(1.0);
    let width = pixel * f64::from(g.softness).max(1e-2);
    (0.5 - here / width).clamp(0.0, 1.0) * small * small
}
