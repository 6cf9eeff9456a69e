//! The head, and what is painted onto the face. The middle of the head is the origin; it is about
//! two units high, and looks along +z.

use std::f32::consts::{PI, TAU};

use bevy::prelude::*;

use super::clay::{bone, ellipsoid, join, outward, sheet, surface};
use crate::scenes::shape::Shape;

/// Middle of the eye on the side of +x.
const EYE: Vec2 = Vec2::new(0.35, -0.05);
/// Half of the width, and the height above and below the middle.
const EYE_SIZE: Vec3 = Vec3::new(0.185, 0.165, 0.165);
/// Half of the width and of the height.
const IRIS: Vec2 = Vec2::new(0.13, 0.168);

/// Distance to the skin of head and neck.
pub fn skin(p: Vec3) -> f32 {
    // Both sides are alike.
    let p = Vec3::new(p.x.abs(), p.y, p.z);
    let at = Vec3::new;
    let skull = ellipsoid(p, at(0.0, 0.2, -0.08), at(0.79, 0.84, 0.85));
    let jaw = ellipsoid(p, at(0.0, -0.32, 0.15), at(0.52, 0.56, 0.56));
    let chin = ellipsoid(p, at(0.0, -0.76, 0.42), at(0.17, 0.13, 0.15));
    let cheek = ellipsoid(p, at(0.33, -0.27, 0.36), at(0.3, 0.28, 0.3));
    let mut head = join(skull, jaw, 0.3);
    head = join(head, cheek, 0.2);
    head = join(head, chin, 0.28);
    let bridge = (at(0.0, -0.1, 0.69), at(0.0, -0.275, 0.8));
    let nose = bone(p, bridge, (0.03, 0.045));
    head = join(head, nose, 0.12);
    let ear = ellipsoid(p, at(0.76, -0.12, -0.08), at(0.1, 0.2, 0.13));
    head = join(head, ear, 0.05);
    let spine = (at(0.0, -0.5, -0.14), at(0.0, -1.6, -0.28));
    join(head, bone(p, spine, (0.3, 0.33)), 0.16)
}

pub fn head() -> Shape {
    let (low, high) = (Vec3::new(-0.95, -1.65, -1.0), Vec3::new(0.95, 1.1, 0.95));
    surface(low, high, 0.026, skin)
}

/// The place of the face in front of a point, and its normal.
fn on_face(at: Vec2) -> (Vec3, Vec3) {
    let mut place = at.extend(1.6);
    for _ in 0..40 {
        place.z -= 0.8 * skin(place);
    }
    (place, outward(&skin, place))
}

/// A painter of one side of the face, or of its middle.
struct Brush<'a> {
    shape: &'a mut Shape,
    /// 1 for the side of +x, -1 for the other one.
    side: f32,
    /// How far the paint is above the skin.
    lift: f32,
}

impl Brush<'_> {
    /// Paints where `at` says, for two numbers from 0 to 1.
    fn paint(&mut self, rows: u32, columns: u32, at: impl Fn(f32, f32) -> Vec2) {
        let (side, lift) = (self.side, self.lift);
        sheet(self.shape, rows, columns, |u, v| {
            let (place, normal) = on_face(at(u, v) * Vec2::new(side, 1.0));
            (place + normal * lift, normal)
        });
    }

    /// A stroke along a line, with a width for every place along it.
    fn stroke(&mut self, line: impl Fn(f32) -> Vec2, width: impl Fn(f32) -> f32) {
        self.paint(32, 3, |u, v| {
            let along = (line(u + 0.01) - line(u - 0.01)).normalize_or(Vec2::X);
            line(u) + along.perp() * (width(u) * (v - 0.5))
        });
    }

    fn ellipse(&mut self, center: Vec2, radii: Vec2, top: impl Fn(f32) -> f32) {
        self.paint(12, 40, |u, v| {
            let p = center + radii * u * Vec2::from_angle(TAU * v);
            Vec2::new(p.x, p.y.min(top(p.x)))
        });
    }
}

/// The upper edge of the eye, for a place across it from -1 (inner corner) to 1.
fn upper(across: f32) -> Vec2 {
    let bow = (1.0 - across * across).max(0.0).powf(0.62);
    let up = 0.035 * across + EYE_SIZE.y * bow * (1.0 + 0.1 * across);
    EYE + Vec2::new(EYE_SIZE.x * across, up)
}

/// The lower edge.
fn lower(across: f32) -> Vec2 {
    let bow = (1.0 - across * across).max(0.0).powf(0.55);
    EYE + Vec2::new(EYE_SIZE.x * across, 0.035 * across - EYE_SIZE.z * bow)
}

/// Height of the upper edge above a place.
fn lid(x: f32) -> f32 {
    upper(((x - EYE.x) / EYE_SIZE.x).clamp(-1.0, 1.0)).y
}

/// What is painted: its name, and the shape. Of both eyes, and of the rest of the face.
pub struct Paint {
    pub name: &'static str,
    pub shape: Shape,
}

fn painted(name: &'static str, sides: &[f32], lift: f32, draw: impl Fn(&mut Brush)) -> Paint {
    let mut shape = Shape::default();
    for &side in sides {
        let shape = &mut shape;
        draw(&mut Brush { shape, side, lift });
    }
    Paint { name, shape }
}

fn both_sides(name: &'static str, lift: f32, draw: impl Fn(&mut Brush)) -> Paint {
    painted(name, &[-1.0, 1.0], lift, draw)
}

fn middle(name: &'static str, lift: f32, draw: impl Fn(&mut Brush)) -> Paint {
    painted(name, &[1.0], lift, draw)
}

/// Open eyes.
pub fn eyes() -> Vec<Paint> {
    let gaze = EYE + Vec2::new(-0.012, 0.006);
    vec![
        both_sides("eye", 0.005, |brush| {
            brush.paint(24, 10, |u, v| {
                let across = -(PI * u).cos();
                lower(across).lerp(upper(across), v)
            });
        }),
        both_sides("iris", 0.01, |brush| {
            brush.ellipse(gaze, IRIS, |x| lid(x) - 0.01);
        }),
        // Its upper half is in the shade of the lid.
        both_sides("iris shade", 0.0115, |brush| {
            let high = |x: f32| lid(x) - 0.01;
            brush.paint(24, 10, |u, v| {
                let p = gaze + IRIS * Vec2::from_angle(PI * u);
                let low = gaze.y + 0.045 - 1.6 * (p.x - gaze.x).powi(2);
                Vec2::new(p.x, low + (p.y.min(high(p.x)) - low).max(0.0) * v)
            });
        }),
        both_sides("ink", 0.013, |brush| {
            let center = gaze - Vec2::new(0.0, 0.012);
            brush.ellipse(center, Vec2::new(0.056, 0.084), |x| lid(x) - 0.01);
            // The dark border of the iris.
            brush.paint(36, 4, |u, v| {
                let p = gaze + (IRIS - 0.018 * v) * Vec2::from_angle(TAU * u);
                Vec2::new(p.x, p.y.min(lid(p.x) - 0.01))
            });
            lashes(brush);
        }),
        both_sides("light", 0.017, |brush| {
            // On the same side of both eyes: that of the light.
            let spot = Vec2::new(-0.042 * brush.side, 0.06);
            brush.ellipse(gaze + spot, Vec2::new(0.037, 0.046), lid);
            let spot = Vec2::new(0.045 * brush.side, -0.075);
            brush.ellipse(gaze + spot, Vec2::splat(0.018), lid);
        }),
    ]
}

/// The line of the upper lid, which ends in a wing; a short lower one; and the fold above.
fn lashes(brush: &mut Brush) {
    brush.paint(40, 3, |u, v| {
        let across = -1.04 + 2.3 * u;
        let edge = upper(across.clamp(-1.0, 1.0));
        let beyond = (across - 1.0).max(0.0);
        let wing = Vec2::new(EYE_SIZE.x * beyond, 0.24 * beyond);
        let inner = (across + 1.04).clamp(0.0, 0.5) / 0.5;
        let outer = ((1.26 - across) / 0.5).clamp(0.0, 1.0);
        let thick = (0.042 + 0.036 * u) * inner * outer;
        edge + wing + Vec2::new(0.0, (v - 0.25) * thick)
    });
    let below = |u: f32| lower(0.3 + 0.72 * u) - Vec2::new(0.0, 0.004);
    brush.stroke(below, |u| 0.018 * (PI * (0.12 + 0.88 * u)).sin());
    let fold = |u: f32| upper(-0.55 + 1.4 * u) + Vec2::new(0.0, 0.062);
    brush.stroke(fold, |u| 0.011 * (PI * u).sin());
}

/// Eyes that are closed: two bows, with lashes.
pub fn closed_eyes() -> Paint {
    both_sides("ink", 0.013, |brush| {
        let line = |u: f32| {
            let across = -1.0 + 2.1 * u;
            let sag = (1.0 - across * across).max(-0.2);
            EYE + Vec2::new(EYE_SIZE.x * across, -0.04 - 0.08 * sag)
        };
        brush.stroke(line, |u| 0.034 * (PI * (0.06 + 0.88 * u)).sin());
    })
}

/// Brows, mouth and the blush of the cheeks.
pub fn features() -> Vec<Paint> {
    let lips = |across: f32| {
        let bow = 1.0 - across * across;
        Vec2::new(0.15 * across, -0.52 + 0.03 * across * across - 0.012 * bow)
    };
    let depth = |across: f32| 0.1 * (1.0 - across * across).max(0.0).powf(0.7);
    let open = move |u: f32, v: f32| {
        let across = -(PI * u).cos();
        lips(across) - Vec2::new(0.0, v * depth(across))
    };
    vec![
        both_sides("brow", 0.012, |brush| {
            let line = |u: f32| {
                let rise = (PI * (0.2 + 0.7 * u)).sin();
                Vec2::new(0.2 + 0.33 * u, 0.245 + 0.055 * rise)
            };
            brush.stroke(line, |u| 0.05 * (PI * (0.16 + 0.8 * u)).sin());
        }),
        both_sides("blush", 0.005, |brush| {
            let center = Vec2::new(0.47, -0.3);
            brush.ellipse(center, Vec2::new(0.1, 0.05), |_| 1.0);
        }),
        middle("mouth", 0.006, |brush| brush.paint(32, 8, open)),
        middle("tongue", 0.01, |brush| {
            brush.paint(24, 6, |u, v| {
                let narrow = open(0.2 + 0.6 * u, 1.0);
                let rise = 0.055 * (PI * u).sin();
                narrow + Vec2::new(0.0, 0.006 + v * rise)
            });
        }),
        middle("ink", 0.012, |brush| {
            let smile = |u: f32| lips(-1.12 + 2.24 * u) + Vec2::new(0.0, 0.004);
            brush.stroke(smile, |u| 0.026 * (PI * (0.1 + 0.8 * u)).sin());
            let nose = |u: f32| Vec2::new(0.02 - 0.035 * u, -0.317 - 0.012 * (PI * u).sin());
            brush.stroke(nose, |u| 0.014 * (PI * u).sin());
        }),
    ]
}
