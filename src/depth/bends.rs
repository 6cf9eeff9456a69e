//! How much raw depth bends where two surfaces meet.

use bevy::math::{Mat4, UVec2, Vec2, Vec3};

use super::frame::{DepthProjection, ProjectionKind, reference_distance};

impl DepthProjection {
    /// How much raw depth bends at least where two planes meet, at a crack between two pixels that they
    /// separate, or at one that meets an end of this crack at a right angle: as a fraction of the reference of
    /// [`jump_reference`](Self::jump_reference) and of the tangent of half of the angle between the planes.
    /// The bend at a crack is the sum of the second differences at its two pixels. `size` is that of the view
    /// in pixels, of `samples` samples each.
    ///
    /// Raw depth is affine over a plane on the screen. Let r = (x, y, 1) be the ray through a pixel, and s the
    /// size of a pixel at distance 1. The slopes of raw depth at two planes that meet there differ by at least
    /// 2 s tan(angle / 2) / |r|^2 times the reference. The bend at a crack that separates the planes is the
    /// difference across it, and in one of the two directions that is sqrt(1/2) of it or more. The longest ray
    /// is at a corner of the view. With several samples, the depth of a pixel is that of the nearest one, and
    /// the bend may be 0.64 of that.
    pub fn least_bend(&self, clip_from_view: &Mat4, size: UVec2, samples: u32) -> f32 {
        let scale = Vec2::new(clip_from_view.x_axis.x, clip_from_view.y_axis.y).abs();
        let pixel = (2.0 / (scale * size.as_vec2()).max(Vec2::splat(1e-30))).min_element();
        let view_from_clip = clip_from_view.inverse();
        let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
        let squared = corners.map(|(x, y)| {
            let at = |z| view_from_clip.project_point3(Vec3::new(x, y, z));
            let ray = at(0.5) - at(1.0);
            ray.length_squared() / (ray.z * ray.z)
        });
        let parallel = clip_from_view.transpose().w_axis.truncate() == Vec3::ZERO;
        let unit = match self.kind() {
            ProjectionKind::Orthographic => pixel / reference_distance(clip_from_view) as f32,
            // Its raw depth is not affine over planes: every bend counts.
            ProjectionKind::Oblique if parallel => 0.0,
            _ => pixel,
        };
        let sampled = if samples > 1 { 0.64 } else { 1.0 };
        let longest = squared.into_iter().fold(1.0, f32::max);
        let bend = std::f32::consts::SQRT_2 * sampled * unit / longest;
        if bend.is_finite() { bend } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::{DMat4, DVec3, DVec4};

    use super::*;

    const SIZE: UVec2 = UVec2::new(320, 180);

    /// Numbers from 0 to 1 that look random.
    struct Random(u32);

    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(self.0 >> 8) / f64::from(1 << 24)
        }
    }

    fn project(matrix: DMat4, point: DVec4) -> DVec3 {
        (matrix * point).truncate() / (matrix * point).w
    }

    struct View {
        clip_from_view: DMat4,
        view_from_clip: DMat4,
    }

    impl View {
        fn new(matrix: &Mat4) -> Self {
            let clip_from_view = matrix.as_dmat4();
            Self {
                clip_from_view,
                view_from_clip: clip_from_view.inverse(),
            }
        }

        /// The point of a raw depth behind a place on the screen, in pixels.
        fn point(&self, [x, y]: [f64; 2], raw: f64) -> DVec3 {
            let [width, height] = SIZE.to_array().map(f64::from);
            let ndc = DVec4::new(2.0 * x / width - 1.0, 1.0 - 2.0 * y / height, raw, 1.0);
            project(self.view_from_clip, ndc)
        }

        /// Raw depth at a place of the plane through a point with a normal.
        fn raw_depth(&self, point: DVec3, normal: DVec3, at: [f64; 2]) -> f64 {
            let (a, b) = (self.point(at, 0.9), self.point(at, 0.4));
            let t = normal.dot(point - a) / normal.dot(b - a);
            project(self.clip_from_view, (a + t * (b - a)).extend(1.0)).z
        }
    }

    /// Two planes that meet at a point, seen from outside of the solid that they bound, or from inside.
    struct Edge {
        point: DVec3,
        normals: [DVec3; 2],
        outside: bool,
    }

    impl Edge {
        /// Planes that meet at a place; `None` if one of them is seen at less than 6 degrees.
        fn new(view: &View, random: &mut Random, at: [f64; 2]) -> Option<Self> {
            let point = view.point(at, 0.6);
            let away = (view.point(at, 0.3) - point).normalize();
            let normals = [0; 2].map(|_| {
                let n = DVec3::from([0; 3].map(|_| random.next() - 0.5)).normalize();
                if n.dot(away) < 0.0 { n } else { -n }
            });
            let is_seen = normals.iter().all(|n| n.dot(away) <= -0.1);
            let outside = random.next() < 0.5;
            is_seen.then_some(Self {
                point,
                normals,
                outside,
            })
        }

        /// Whether the first plane is the nearer one.
        fn is_first(&self, view: &View, at: [f64; 2]) -> bool {
            let [a, b] = self.normals.map(|n| view.raw_depth(self.point, n, at));
            a > b
        }

        /// Raw depth of the nearest sample of a pixel; samples are counted from its center.
        fn depth(&self, view: &View, [x, y]: [f64; 2], samples: &[[f64; 2]]) -> f64 {
            let depths = samples.iter().map(|[dx, dy]| {
                let at = [x + dx, y + dy];
                let [a, b] = self.normals.map(|n| view.raw_depth(self.point, n, at));
                if self.outside { a.min(b) } else { a.max(b) }
            });
            depths.fold(f64::NEG_INFINITY, f64::max)
        }
    }

    /// The least bend at a crack or beside it, as a multiple of `least_bend`, over edges between a pixel
    /// and the one to the east of it; and their number.
    fn lowest(matrix: &Mat4, samples: &[[f64; 2]]) -> (f64, u32) {
        let projection = DepthProjection::new(matrix, None);
        let [factor, constant] = projection.jump_reference(matrix).map(f64::from);
        let least = f64::from(projection.least_bend(matrix, SIZE, samples.len() as u32));
        let (view, mut random) = (View::new(matrix), Random(7));
        let (mut lowest, mut count) = (f64::INFINITY, 0);
        for _ in 0..5_000 {
            let [x, y] = SIZE.to_array().map(f64::from);
            let [x, y] = [x, y].map(|n| (random.next() * (n - 8.0)).floor() + 4.5);
            let place = [x + random.next(), y];
            let edge = Edge::new(&view, &mut random, place);
            // Normals are those of the first samples.
            let [dx, dy] = samples[0];
            let sides = |edge: &Edge| [x, x + 1.0].map(|x| edge.is_first(&view, [x + dx, y + dy]));
            let Some(edge) = edge.filter(|edge| sides(edge)[0] != sides(edge)[1]) else {
                continue;
            };
            let bend = |[x, y]: [f64; 2], [vx, vy]: [f64; 2]| {
                let at = [-1.0, 0.0, 1.0, 2.0].map(|n| [x + n * vx, y + n * vy]);
                let [a, b, c, d] = at.map(|at| edge.depth(&view, at, samples));
                ((a - 2.0 * b + c).abs() + (b - 2.0 * c + d).abs()) / (factor * b.max(c) + constant)
            };
            let ends = [[x, y - 1.0], [x, y], [x + 1.0, y - 1.0], [x + 1.0, y]];
            let beside = ends.map(|at| bend(at, [0.0, 1.0]));
            let largest = beside.into_iter().fold(bend([x, y], [1.0, 0.0]), f64::max);
            let half = 0.5 * edge.normals[0].angle_between(edge.normals[1]);
            lowest = lowest.min(largest / (least * half.tan()));
            count += 1;
        }
        (lowest, count)
    }

    #[test]
    fn raw_depth_bends_where_two_planes_meet() {
        let parallel = Mat4::orthographic_rh(-8.0, 8.0, -4.5, 4.5, 60.0, 0.0);
        let mut sheared = Mat4::IDENTITY;
        sheared.z_axis.x = 0.7;
        let four = [
            [-0.125, -0.375],
            [0.375, -0.125],
            [-0.375, 0.125],
            [0.125, 0.375],
        ];
        for matrix in [
            Mat4::perspective_infinite_reverse_rh(0.6, 16.0 / 9.0, 0.1),
            Mat4::perspective_infinite_reverse_rh(1.8, 16.0 / 9.0, 0.1),
            Mat4::perspective_rh(1.0, 16.0 / 9.0, 60.0, 0.1),
            parallel,
            parallel * sheared,
        ] {
            for samples in [&[[0.0; 2]][..], &four] {
                let (lowest, count) = lowest(&matrix, samples);
                let what = format!("{matrix}, {} samples: {lowest}, {count}", samples.len());
                assert!((0.99..2.5).contains(&lowest) && count > 1_000, "{what}");
            }
        }
    }
}
