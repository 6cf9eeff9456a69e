//! A ray against boxes and triangles.

use bevy::math::{Affine3A, DVec3, Ray3d, Vec3};

/// A ray. A distance is a multiple of the length of `direction`, so that it stays the same when
/// the ray is brought into another space.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    origin: DVec3,
    direction: DVec3,
}

impl From<Ray3d> for Ray {
    fn from(ray: Ray3d) -> Self {
        Self {
            origin: ray.origin.as_dvec3(),
            direction: ray.direction.as_vec3().as_dvec3(),
        }
    }
}

/// The sides of triangles that are drawn. The front is where their corners are counter-clockwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sides {
    Front,
    Back,
    #[default]
    Both,
}

impl Ray {
    /// The ray in the space that an object's transform brings into the world; `None` if the
    /// transform has no inverse.
    pub fn inside(self, transform: &Affine3A) -> Option<Self> {
        let matrix = transform.matrix3.as_dmat3();
        let translation = transform.translation.as_dvec3();
        let inverse = matrix.inverse();
        let ray = Self {
            origin: inverse * (self.origin - translation),
            direction: inverse * self.direction,
        };
        let is_sound = ray.origin.is_finite() && ray.direction.is_finite();
        is_sound.then_some(ray)
    }

    /// Where the ray enters and leaves a box; 0 where it begins in the box.
    pub fn through(self, center: Vec3, half_size: Vec3) -> Option<(f64, f64)> {
        let (center, half) = (center.as_dvec3(), half_size.as_dvec3());
        // Bounds are rounded.
        let half = half + 1e-6 * (center.abs() + half).max_element();
        let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
        for axis in 0..3 {
            let [low, high] =
                [-half[axis], half[axis]].map(|h| center[axis] + h - self.origin[axis]);
            if self.direction[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let [a, b] = [low, high].map(|side| side / self.direction[axis]);
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        (enter <= leave).then_some((enter, leave))
    }

    /// Where the ray meets a triangle (Möller and Trumbore 1997). Its border is part of it.
    pub fn meets(self, corners: [Vec3; 3], sides: Sides) -> Option<f64> {
        let [a, b, c] = corners.map(|corner| corner.as_dvec3());
        let (ab, ac) = (b - a, c - a);
        let across = self.direction.cross(ac);
        // Positive if the ray meets the front.
        let volume = ab.dot(across);
        let is_seen = match sides {
            Sides::Front => volume > 0.0,
            Sides::Back => volume < 0.0,
            Sides::Both => volume != 0.0,
        };
        if !is_seen {
            return None;
        }
        let from = self.origin - a;
        let u = from.dot(across) / volume;
        let over = from.cross(ab);
        let v = self.direction.dot(over) / volume;
        let at = ac.dot(over) / volume;
        let is_inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && at >= 0.0;
        is_inside.then_some(at)
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::{Dir3, Quat};

    use super::*;

    fn ray(origin: [f32; 3], direction: [f32; 3]) -> Ray {
        Ray::from(Ray3d {
            origin: origin.into(),
            direction: Dir3::new(direction.into()).expect("a direction"),
        })
    }

    /// In the plane z = 0; its front faces +z.
    const TRIANGLE: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

    #[test]
    fn a_triangle_is_met_inside_and_missed_outside() {
        let at = |x, y| ray([x, y, 5.0], [0.0, 0.0, -1.0]).meets(TRIANGLE, Sides::Both);
        for (x, y) in [(0.2, 0.2), (0.0, 0.0), (1.0, 0.0), (0.5, 0.5), (0.01, 0.98)] {
            assert_eq!(at(x, y), Some(5.0), "{x}, {y}");
        }
        for (x, y) in [(-0.01, 0.5), (0.5, -0.01), (0.51, 0.51), (1.01, 0.0)] {
            assert_eq!(at(x, y), None, "{x}, {y}");
        }
        // Behind the ray, beside it, and without an area.
        let away = ray([0.2, 0.2, 5.0], [0.0, 0.0, 1.0]);
        assert_eq!(away.meets(TRIANGLE, Sides::Both), None);
        let along = ray([-1.0, 0.2, 0.0], [1.0, 0.0, 0.0]);
        assert_eq!(along.meets(TRIANGLE, Sides::Both), None);
        let thin = [Vec3::ZERO, Vec3::X, 2.0 * Vec3::X];
        assert_eq!(
            ray([0.5, 0.0, 5.0], [0.0, 0.0, -1.0]).meets(thin, Sides::Both),
            None
        );
    }

    #[test]
    fn only_the_sides_that_are_drawn_are_met() {
        let down = ray([0.2, 0.2, 5.0], [0.0, 0.0, -1.0]);
        let up = ray([0.2, 0.2, -5.0], [0.0, 0.0, 1.0]);
        let hits = |sides| [down, up].map(|ray| ray.meets(TRIANGLE, sides).is_some());
        assert_eq!(hits(Sides::Front), [true, false]);
        assert_eq!(hits(Sides::Back), [false, true]);
        assert_eq!(hits(Sides::Both), [true, true]);
    }

    #[test]
    fn a_box_is_entered_and_left() {
        let (center, half) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(1.0, 0.5, 2.0));
        let near = |found: Option<(f64, f64)>, wanted: (f64, f64)| {
            let found = found.expect("met");
            // The box is a little larger than its bounds.
            (found.0 - wanted.0).abs() < 1e-4 && (found.1 - wanted.1).abs() < 1e-4
        };
        let along = |x, y| ray([x, y, 10.0], [0.0, 0.0, -1.0]).through(center, half);
        assert!(near(along(1.0, 2.0), (5.0, 9.0)));
        assert!(near(along(0.001, 2.499), (5.0, 9.0)));
        assert_eq!(along(2.01, 2.0), None);
        assert_eq!(along(1.0, 2.51), None);
        let behind = ray([1.0, 2.0, 10.0], [0.0, 0.0, 1.0]);
        assert_eq!(behind.through(center, half), None);
        let inside = ray([1.0, 2.0, 3.0], [0.0, 0.0, -1.0]);
        assert!(near(inside.through(center, half), (0.0, 2.0)));
        // Diagonally, and a box without height.
        let diagonal = ray([-3.0, 2.0, 3.0], [1.0, 0.0, 0.0]);
        assert!(near(diagonal.through(center, half), (3.0, 5.0)));
        let flat = Vec3::new(4.0, 0.0, 4.0);
        let down = ray([0.0, 3.0, 0.0], [0.6, -0.8, 0.0]);
        assert!(near(down.through(Vec3::ZERO, flat), (3.75, 3.75)));
    }

    /// The distance is that in the world, whatever the transform is.
    #[test]
    fn distances_stay_the_same_in_every_space() {
        let places = [
            Affine3A::from_scale(Vec3::new(3.0, 0.1, -7.0)),
            Affine3A::from_scale_rotation_translation(
                Vec3::new(-2.0, 5.0, 0.5),
                Quat::from_rotation_y(0.7) * Quat::from_rotation_x(-1.9),
                Vec3::new(40.0, -3.0, 9.0),
            ),
        ];
        for place in places {
            let corners = TRIANGLE.map(|corner| place.transform_point3(corner));
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            let eye = middle + Vec3::new(1.0, 2.0, 8.0);
            let world = ray(eye.to_array(), (middle - eye).to_array());
            let wanted = f64::from(eye.distance(middle));
            let local = world.inside(&place).expect("an inverse");
            for found in [
                world.meets(corners, Sides::Both),
                local.meets(TRIANGLE, Sides::Both),
            ] {
                let found = found.expect("met");
                assert!((found - wanted).abs() < 1e-4 * wanted, "{found}, {wanted}");
            }
            let beside = ray((eye + 30.0 * Vec3::X).to_array(), (middle - eye).to_array());
            let local = beside.inside(&place).expect("an inverse");
            assert_eq!(local.meets(TRIANGLE, Sides::Both), None);
        }
        // What has no extent is not met.
        let flat = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
        assert!(ray([0.0; 3], [1.0, 0.0, 0.0]).inside(&flat).is_none());
    }
}
