//! Camera distance and centering such that a model fills the frame.
//!
//! A frustum plane is a linear function of position. So all that framing needs
//! to know of a model is its support function: the largest value of `n . p` over
//! its points `p`. Distances and centers follow without iteration over frames.

use bevy::prelude::*;

/// Fraction of the limiting side of the frame that a model spans.
pub const FILL: f32 = 0.85;

/// Vertical field of view, radians. Narrow: a wide one distorts faces.
pub const FOV: f32 = 30.0 * std::f32::consts::PI / 180.0;

/// Direction from the model to the camera, world space; glTF models face `+Z`.
const FROM: Vec3 = Vec3::new(0.55, 0.33, 1.0);

/// The points of a model, relative to the center of their bounding box.
pub struct AffectedArea {
    points: Points,
    /// Center of the bounding box, world space.
    pub center: Vec3,
    /// Half the diagonal of the bounding box, world units.
    pub radius: f32,
}

enum Points {
    /// The model as it stands.
    Still(Vec<Vec3>),
    /// The solid that the model sweeps on a turntable: distance from the
    /// vertical axis, and height.
    Turned(Vec<Vec2>),
}

/// Position and clipping planes of a camera.
#[derive(Clone, Copy, Debug)]
pub struct Framing {
    pub eye: Vec3,
    pub target: Vec3,
    pub near: f32,
    pub far: f32,
    /// Height of an orthographic view, world units.
    pub height: f32,
}

impl AffectedArea {
    /// `None` if there is no point with finite coordinates.
    pub fn new(points: impl IntoIterator<Item = Vec3>, turned: bool) -> Option<Self> {
        let mut points: Vec<Vec3> = points.into_iter().filter(|p| p.is_finite()).collect();
        let first = *points.first()?;
        let (low, high) = points
            .iter()
            .fold((first, first), |(low, high), p| (low.min(*p), high.max(*p)));
        let center = low.midpoint(high);
        for point in &mut points {
            *point -= center;
        }
        let points = if turned {
            let profile = |p: &Vec3| Vec2::new(p.x.hypot(p.z), p.y);
            Points::Turned(points.iter().map(profile).collect())
        } else {
            Points::Still(points)
        };
        Some(Self {
            points,
            center,
            // A single point still needs a frame around it.
            radius: (0.5 * low.distance(high)).max(1e-5 * center.length().max(1e-3)),
        })
    }

    /// Largest `direction . p` over all points.
    fn support(&self, direction: Vec3) -> f32 {
        let values: &mut dyn Iterator<Item = f32> = match &self.points {
            Points::Still(points) => &mut points.iter().map(|p| direction.dot(*p)),
            Points::Turned(points) => {
                let profile = Vec2::new(direction.x.hypot(direction.z), direction.y);
                &mut points.iter().map(move |p| profile.dot(*p))
            }
        };
        values.fold(f32::NEG_INFINITY, f32::max)
    }

    /// The symmetric wedge of half angle `atan(tangent)` around the view
    /// direction that touches the model on both sides along `axis`: its apex as
    /// (position along `back`, position along `axis`).
    fn wedge(&self, axis: Vec3, back: Vec3, tangent: f32) -> (f32, f32) {
        let plus = self.support(axis + tangent * back);
        let minus = self.support(-axis + tangent * back);
        (0.5 * (plus + minus) / tangent, 0.5 * (plus - minus))
    }

    /// Position along `axis` from which the model is centerd, for a camera at
    /// `distance` along `back`. The narrower a wedge is, the farther is its apex.
    fn centerd(&self, axis: Vec3, back: Vec3, distance: f32, widest: f32) -> f32 {
        let (mut low, mut high) = (1e-4 * widest, widest);
        for _ in 0..24 {
            let middle = 0.5 * (low + high);
            if self.wedge(axis, back, middle).0 > distance {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.wedge(axis, back, high).1
    }

    /// The view from which the model spans [`FILL`] of the side of the frame
    /// that it meets first. `aspect` is width by height.
    pub fn perspective(&self, aspect: f32) -> Framing {
        let (right, up, back) = axes(FROM);
        let tangent = FILL * (0.5 * FOV).tan() * Vec2::new(aspect, 1.0);
        let distance = self
            .wedge(right, back, tangent.x)
            .0
            .max(self.wedge(up, back, tangent.y).0)
            .max(self.support(back) + 0.05 * self.radius);
        let x = self.centerd(right, back, distance, tangent.x);
        let y = self.centerd(up, back, distance, tangent.y);
        let target = self.center + x * right + y * up;
        self.with_planes(target + distance * back, target)
    }

    /// The same for an orthographic view.
    pub fn orthographic(&self, aspect: f32) -> Framing {
        let (right, up, back) = axes(FROM);
        let [across, along] = [right, up].map(|axis| {
            let (plus, minus) = (self.support(axis), self.support(-axis));
            (plus + minus, 0.5 * (plus - minus))
        });
        let height = (along.0 / FILL).max(across.0 / (FILL * aspect));
        let target = self.center + across.1 * right + along.1 * up;
        let distance = self.support(back) + self.radius;
        let mut framing = self.with_planes(target + distance * back, target);
        // A line that is seen end on has no height.
        framing.height = height.max(1e-3 * self.radius);
        framing
    }

    /// Clipping planes for any camera: near and far enough for the model,
    /// wherever the camera stands.
    pub fn with_planes(&self, eye: Vec3, target: Vec3) -> Framing {
        let (_, _, back) = axes(eye - target);
        let along = back.dot(eye - self.center);
        let nearest = along - self.support(back);
        let farthest = along + self.support(-back);
        let near = (0.5 * nearest).max(1e-3 * self.radius);
        Framing {
            eye,
            target,
            near,
            far: (2.0 * farthest).max(near + self.radius),
            height: 2.0 * self.radius / FILL,
        }
    }
}

/// Right, up and back of a camera that looks along `-back`, as
/// `Transform::looking_at` turns it.
fn axes(back: Vec3) -> (Vec3, Vec3, Vec3) {
    let rotation = Transform::default().looking_to(-back, Vec3::Y).rotation;
    (rotation * Vec3::X, rotation * Vec3::Y, rotation * Vec3::Z)
}
