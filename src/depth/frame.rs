//! A view's projection: the relation of raw depth to distance.

use bevy::{prelude::*, render::render_resource::ShaderType};

use super::{DepthMap, DepthMapping};

/// How raw depth depends on distance under a camera's projection.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ProjectionKind {
    /// Raw depth plus a constant is proportional to the reciprocal of the view depth.
    Perspective,
    /// Raw depth is an affine function of the view depth.
    Orthographic,
    /// Raw depth also depends on the pixel (an oblique near plane, a custom
    /// matrix), so that distances are unprojected for every pixel.
    Oblique,
}

impl ProjectionKind {
    /// The kind of a projection matrix.
    pub fn of(clip_from_view: &Mat4) -> Self {
        let rows = clip_from_view.transpose();
        let (depth, w) = (rows.z_axis, rows.w_axis);
        if depth.x != 0.0 || depth.y != 0.0 {
            return Self::Oblique;
        }
        match (w.x, w.y, w.z, w.w) {
            (0.0, 0.0, -1.0, 0.0) => Self::Perspective,
            (0.0, 0.0, 0.0, 1.0) => Self::Orthographic,
            _ => Self::Oblique,
        }
    }
}

/// Bits of [`DepthFrame::flags`], as in `map.wgsl`.
const ORTHOGRAPHIC: u32 = 1;
const LOGARITHMIC: u32 = 2;

/// `DepthFrame` of `map.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DepthFrame {
    pub near: f32,
    pub far: f32,
    pub offset: f32,
    pub floor: f32,
    pub plane_far: f32,
    pub extent: f32,
    pub sky_gap: f32,
    pub flags: u32,
}

/// `RawDepth` of `raw.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct RawDepth {
    pub view_z: Vec4,
    pub view_w: Vec4,
    pub ndc: Vec4,
    pub nearest: f32,
    pub sky: f32,
}

/// The view depth in world units at which an oblique view has a raw depth of 1: smaller
/// ones count as this. It does not depend on the projection, whose near plane moves with
/// the camera, so that equal raw depths are equal distances in all frames. A power of
/// two loses no digits. The bins of a histogram reach 2^32 times as far, to 2^18 units.
const OBLIQUE_UNIT: f64 = 1.0 / 16384.0;

/// A view's projection in double precision: converts raw depth to distance and back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DepthProjection {
    kind: ProjectionKind,
    /// clip z = scale * view z + shift; view z is negative in front of the camera.
    scale: f64,
    shift: f64,
    /// Near and far plane in world units. An infinite or oblique matrix does not
    /// contain both.
    near: f64,
    far: f64,
}

impl DepthProjection {
    /// Of numbers that are no depths: their levels are logarithms of themselves.
    pub const NONE: Self = Self {
        kind: ProjectionKind::Perspective,
        scale: 0.0,
        shift: 1.0,
        near: 1.0,
        far: 1.0,
    };

    pub fn new(clip_from_view: &Mat4, projection: Option<&Projection>) -> Self {
        let kind = ProjectionKind::of(clip_from_view);
        let (near, far) = match projection {
            Some(Projection::Perspective(p)) => (p.near, p.far),
            Some(Projection::Orthographic(p)) => (p.near, p.far),
            Some(Projection::Custom(p)) => (custom_near(clip_from_view), p.far()),
            None => (0.1, 1000.0),
        };
        Self {
            kind,
            scale: f64::from(clip_from_view.z_axis.z),
            shift: f64::from(clip_from_view.w_axis.z),
            near: f64::from(near),
            far: f64::from(far),
        }
    }

    pub fn kind(&self) -> ProjectionKind {
        self.kind
    }

    /// The constant that makes raw depth proportional to the reciprocal distance
    /// when added to it; 0 unless the projection is a perspective.
    pub fn offset(&self) -> f32 {
        if self.kind == ProjectionKind::Perspective {
            self.scale as f32
        } else {
            0.0
        }
    }

    /// Whether raw depth (after `raw.wgsl`) has the same relation to distance under both
    /// projections. Under an oblique one the matrix is accounted for, wherever its near
    /// plane is.
    pub fn same_raw_depth(&self, other: &Self) -> bool {
        self.kind == other.kind
            && (self.kind == ProjectionKind::Oblique
                || (self.scale, self.shift) == (other.scale, other.shift))
    }

    /// Raw depth at a distance in world units. For an oblique view: a constant divided
    /// by the distance, which stands for raw depth (see `raw.wgsl`).
    pub fn raw_depth(&self, distance: f64) -> f64 {
        match self.kind {
            ProjectionKind::Perspective => self.shift / distance - self.scale,
            ProjectionKind::Orthographic => self.shift - self.scale * distance,
            ProjectionKind::Oblique => OBLIQUE_UNIT / distance,
        }
    }

    /// Distance in world units at a raw depth: the inverse of
    /// [`raw_depth`](Self::raw_depth).
    pub fn distance(&self, raw: f32) -> f64 {
        let raw = f64::from(raw);
        match self.kind {
            ProjectionKind::Perspective => self.shift / (raw + self.scale),
            ProjectionKind::Orthographic => (self.shift - raw) / self.scale,
            ProjectionKind::Oblique => OBLIQUE_UNIT / raw,
        }
    }

    /// Raw depth of another projection at the distance of a raw depth d of this one: factor * d + summand,
    /// or with a pole, factor / (d + pole) + summand.
    pub fn conversion(&self, to: &Self) -> (f64, f64, Option<f64>) {
        let [(a, b), (c, e)] = [self, to].map(|p| match p.kind {
            ProjectionKind::Oblique => (OBLIQUE_UNIT, 0.0),
            _ => (p.shift, p.scale),
        });
        let [is_parallel, to_parallel] = [self, to].map(|p| p.kind == ProjectionKind::Orthographic);
        match (is_parallel, to_parallel) {
            (false, false) => (c / a, c / a * b - e, None),
            (true, true) => (e / b, c - e / b * a, None),
            (false, true) => (-e * a, c, Some(b)),
            (true, false) => (-c * b, -e, Some(-a)),
        }
    }

    /// Two numbers that give the distance along the view's axis at a raw depth d: x / (d + y),
    /// under an orthographic projection x + y * d. See [`distance`](Self::distance).
    pub fn axis(&self) -> Vec2 {
        let numbers = match self.kind {
            ProjectionKind::Perspective => [self.shift, self.scale],
            ProjectionKind::Orthographic => [self.shift / self.scale, -1.0 / self.scale],
            ProjectionKind::Oblique => [OBLIQUE_UNIT, 0.0],
        };
        Vec2::from(numbers.map(|n| n as f32))
    }

    /// The reference that a jump in raw depth is measured against, as (factor,
    /// constant): factor * (largest raw depth nearby) + constant.
    ///
    /// In perspective it is proportional to the reciprocal distance. A jump is then
    /// a fraction of the distance, whatever the world's unit and the planes are.
    /// Raw depth of an orthographic projection does not tell how far away the camera
    /// is. There the reference is the raw depth of a length: the distance from which
    /// a perspective view of 45 degrees shows the same height (1.2 times the height).
    pub fn jump_reference(&self, clip_from_view: &Mat4) -> [f32; 2] {
        match self.kind {
            ProjectionKind::Perspective => [1.0, self.scale as f32],
            ProjectionKind::Oblique => [1.0, 0.0],
            ProjectionKind::Orthographic => {
                let distance = reference_distance(clip_from_view);
                [0.0, (self.scale * distance) as f32]
            }
        }
    }

    /// In an orthographic view: the distance from which a perspective view of 45 degrees shows
    /// the same height.
    pub fn reference(&self, clip_from_view: &Mat4) -> Option<f32> {
        let orthographic = self.kind == ProjectionKind::Orthographic;
        orthographic.then(|| reference_distance(clip_from_view) as f32)
    }

    /// What `raw_depth` of `raw.wgsl` reads. `viewport` is x, y, width, height in pixels; `sky` the distance
    /// from which on all counts as sky, in world units.
    pub fn raw(&self, clip_from_view: &Mat4, viewport: UVec4, sky: Option<f32>) -> RawDepth {
        let sky = sky.map_or(0.0, |sky| self.raw_depth(sky.into()).clamp(0.0, 1.0) as f32);
        if self.kind != ProjectionKind::Oblique {
            return RawDepth {
                sky,
                ..RawDepth::default()
            };
        }
        let rows = clip_from_view.inverse().transpose();
        let [x, y, width, height] = viewport.to_array().map(|v| v as f32);
        let (sx, sy) = (2.0 / width.max(1.0), -2.0 / height.max(1.0));
        RawDepth {
            view_z: rows.z_axis,
            view_w: rows.w_axis,
            ndc: Vec4::new(sx, sy, -1.0 - x * sx, 1.0 - y * sy),
            nearest: OBLIQUE_UNIT as f32,
            sky,
        }
    }

    /// The depth map's uniform. If the map spans the visible range, `near` and `far`
    /// are 0: the shader takes them from the reduction's buffer.
    pub fn frame(&self, map: &DepthMap) -> DepthFrame {
        let orthographic = self.kind == ProjectionKind::Orthographic;
        // The scale of an orthographic projection is 1 / (far - near).
        let extent = if orthographic { 1.0 / self.scale } else { 0.0 };
        let (near, far) = match map.mapping {
            DepthMapping::MinMax | DepthMapping::MinMaxLogarithmic => (0.0, 0.0),
            DepthMapping::Linear | DepthMapping::Logarithmic => {
                let near = self.plane(self.near, 1e-4);
                (near, self.plane(self.far, 1000.0).max(near * 1.001))
            }
            DepthMapping::Fixed { from, to } | DepthMapping::FixedLogarithmic { from, to } => {
                (f64::from(from), f64::from(to))
            }
        };
        let (raw_near, raw_far) = if map.mapping.follows_visible_range() {
            (0.0, 0.0)
        } else {
            (
                self.finite_end(self.raw_depth(near)),
                self.finite_end(self.raw_depth(far)),
            )
        };
        let mut flags = 0;
        if orthographic {
            flags |= ORTHOGRAPHIC;
        }
        if map.mapping.is_logarithmic() {
            flags |= LOGARITHMIC;
        }
        DepthFrame {
            near: raw_near,
            far: raw_far,
            offset: self.offset(),
            floor: if orthographic {
                (f64::from(map.orthographic_floor) * self.scale) as f32
            } else {
                map.floor
            },
            plane_far: (self.shift * extent) as f32,
            extent: extent as f32,
            sky_gap: map.sky_gap,
            flags,
        }
    }

    /// Raw depth of an end of the depth map, at a finite distance in single precision:
    /// the shader divides by the sum of raw depth and offset.
    fn finite_end(&self, raw: f64) -> f32 {
        let raw = raw as f32;
        match self.kind {
            ProjectionKind::Orthographic => raw,
            ProjectionKind::Perspective if self.offset() > 0.0 => {
                raw.max((-self.offset()).next_up())
            }
            _ => raw.max(f32::MIN_POSITIVE),
        }
    }

    /// The distance of a plane of the camera, for Eq. 2 and 3. In perspective,
    /// `default` replaces one that is not positive and finite.
    fn plane(&self, distance: f64, default: f64) -> f64 {
        if self.kind == ProjectionKind::Orthographic {
            return distance;
        }
        if distance.is_finite() && distance > 0.0 {
            distance
        } else {
            default
        }
    }
}

/// The distance from which a perspective view of 45 degrees shows the height of an orthographic
/// one.
pub(super) fn reference_distance(clip_from_view: &Mat4) -> f64 {
    let height = 2.0 / f64::from(clip_from_view.y_axis.y).abs().max(1e-30);
    height / (2.0 * (std::f64::consts::FRAC_PI_8).tan())
}

/// The near plane of a custom projection in world units: the distance at which its
/// matrix gives a reversed depth of 1 on the view axis; 0.1 if there is none.
fn custom_near(clip_from_view: &Mat4) -> f32 {
    let (a, b) = (clip_from_view.z_axis.z, clip_from_view.w_axis.z);
    let near = match ProjectionKind::of(clip_from_view) {
        ProjectionKind::Orthographic => (b - 1.0) / a,
        _ => b / (1.0 + a),
    };
    if near.is_finite() && near > 0.0 {
        near
    } else {
        0.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn finite(near: f32, far: f32) -> DepthProjection {
        let projection = Projection::Perspective(PerspectiveProjection {
            near,
            far,
            ..Default::default()
        });
        let matrix = Mat4::perspective_rh(1.0, 1.0, far, near);
        DepthProjection::new(&matrix, Some(&projection))
    }

    /// A matrix whose near plane is `plane` (normal into the view, distance), for an
    /// infinite reversed depth.
    fn mirror(plane: Vec4) -> Mat4 {
        let mut rows = Mat4::perspective_infinite_reverse_rh(1.0, 1.5, 0.1).transpose();
        rows.z_axis = rows.w_axis - plane / 1.6;
        rows.transpose()
    }

    #[test]
    fn only_another_meaning_of_raw_depth_is_another_projection() {
        let oblique = |plane| DepthProjection::new(&mirror(plane), None);
        let a = oblique(Vec4::new(0.1, 0.0, -1.0, -2.0));
        let b = oblique(Vec4::new(0.0, 0.3, -0.9, -3.0));
        assert_eq!(a.kind(), ProjectionKind::Oblique);
        assert!(a.same_raw_depth(&b), "the plane moved");
        for distance in [1e-3, 0.1, 7.0, 1e5] {
            assert_eq!(a.raw_depth(distance), b.raw_depth(distance));
            let back = a.distance(a.raw_depth(distance) as f32);
            assert!((back / distance - 1.0).abs() < 1e-7, "{distance}: {back}");
        }
        assert!(!a.same_raw_depth(&finite(0.1, 50.0)));
        assert!(finite(0.1, 50.0).same_raw_depth(&finite(0.1, 50.0)));
        assert!(!finite(0.1, 50.0).same_raw_depth(&finite(0.1, 60.0)));
        assert!(!finite(0.1, 50.0).same_raw_depth(&finite(0.2, 50.0)));
        let orthographic = |far| {
            let matrix = Mat4::orthographic_rh(-1.0, 1.0, -1.0, 1.0, far, 0.0);
            DepthProjection::new(&matrix, None)
        };
        assert!(!orthographic(10.0).same_raw_depth(&orthographic(20.0)));
        // The engine's perspective has no far plane.
        let culled = |far| {
            let projection = PerspectiveProjection {
                far,
                ..Default::default()
            };
            let matrix = Mat4::perspective_infinite_reverse_rh(1.0, 1.5, 0.1);
            DepthProjection::new(&matrix, Some(&Projection::Perspective(projection)))
        };
        assert!(culled(10.0).same_raw_depth(&culled(20.0)));
    }

    #[test]
    fn raw_depth_becomes_that_of_another_projection_at_the_same_distance() {
        let orthographic = |far: f32| {
            let matrix = Mat4::orthographic_rh(-1.0, 1.0, -1.0, 1.0, far, 0.0);
            DepthProjection::new(&matrix, None)
        };
        let infinite = Mat4::perspective_infinite_reverse_rh(1.0, 1.5, 0.3);
        let all = [
            finite(0.1, 50.0),
            DepthProjection::new(&infinite, None),
            DepthProjection::new(&mirror(Vec4::new(0.1, 0.0, -1.0, -2.0)), None),
            orthographic(40.0),
            orthographic(90.0),
        ];
        for (i, from) in all.iter().enumerate() {
            for (j, to) in all.iter().enumerate() {
                let (factor, summand, pole) = from.conversion(to);
                if i == j {
                    assert_eq!((factor, summand, pole), (1.0, 0.0, None), "{i}");
                }
                for distance in [0.5, 3.0, 37.0] {
                    let d = from.raw_depth(distance);
                    let value = pole.map_or(d, |pole| 1.0 / (d + pole));
                    let (got, want) = (factor * value + summand, to.raw_depth(distance));
                    assert!((got - want).abs() < 1e-9, "{i} to {j}: {got}, {want}");
                }
            }
        }
    }

    #[test]
    fn the_ends_of_a_fixed_range_are_at_finite_distances() {
        let infinite = DepthProjection::new(
            &Mat4::perspective_infinite_reverse_rh(1.0, 1.5, 1e-4),
            Some(&Projection::Orthographic(
                OrthographicProjection::default_3d(),
            )),
        );
        for (projection, what) in [
            (finite(0.1, 50.0), "finite"),
            (infinite, "infinite"),
            (
                DepthProjection::new(&mirror(Vec4::new(0.1, 0.0, -1.0, -2.0)), None),
                "oblique",
            ),
        ] {
            for far in [10.0, 50.0, 1e6, 1e36] {
                let map = DepthMap {
                    mapping: DepthMapping::Fixed { from: 1.0, to: far },
                    ..Default::default()
                };
                let frame = projection.frame(&map);
                // The shader divides by this; a subnormal number may be flushed to 0.
                let divisor = frame.far + frame.offset;
                assert!(divisor >= f32::MIN_POSITIVE, "{what}, {far}: {divisor}");
                assert!(frame.near > frame.far, "{what}, {far}");
            }
        }
    }
}
