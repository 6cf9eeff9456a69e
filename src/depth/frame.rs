//! A view's projection: the relation of raw depth to distance.

use bevy::{
    camera::Projection,
    math::{Mat4, UVec4, Vec4},
    reflect::Reflect,
    render::render_resource::ShaderType,
};

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
    pub near: f32,
}

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

    /// Near distance in world units that scales the reciprocal distance of oblique views.
    fn oblique_near(&self) -> f64 {
        if self.near.is_finite() && self.near > 1e-6 {
            self.near
        } else {
            1e-3
        }
    }

    /// Raw depth at a distance in world units. For an oblique view: near / distance,
    /// which stands for raw depth (see `raw.wgsl`).
    pub fn raw_depth(&self, distance: f64) -> f64 {
        match self.kind {
            ProjectionKind::Perspective => self.shift / distance - self.scale,
            ProjectionKind::Orthographic => self.shift - self.scale * distance,
            ProjectionKind::Oblique => self.oblique_near() / distance,
        }
    }

    /// Distance in world units at a raw depth: the inverse of
    /// [`raw_depth`](Self::raw_depth).
    pub fn distance(&self, raw: f32) -> f64 {
        let raw = f64::from(raw);
        match self.kind {
            ProjectionKind::Perspective => self.shift / (raw + self.scale),
            ProjectionKind::Orthographic => (self.shift - raw) / self.scale,
            ProjectionKind::Oblique => self.oblique_near() / raw,
        }
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
                let height = 2.0 / f64::from(clip_from_view.y_axis.y).abs().max(1e-30);
                let distance = height / (2.0 * (std::f64::consts::FRAC_PI_8).tan());
                [0.0, (self.scale * distance) as f32]
            }
        }
    }

    /// What `raw_depth` of `raw.wgsl` reads: zeros unless the projection is oblique.
    /// `viewport` is x, y, width, height in pixels.
    pub fn raw(&self, clip_from_view: &Mat4, viewport: UVec4) -> RawDepth {
        if self.kind != ProjectionKind::Oblique {
            return RawDepth::default();
        }
        let rows = clip_from_view.inverse().transpose();
        let [x, y, width, height] = viewport.to_array().map(|v| v as f32);
        let (sx, sy) = (2.0 / width.max(1.0), -2.0 / height.max(1.0));
        RawDepth {
            view_z: rows.z_axis,
            view_w: rows.w_axis,
            ndc: Vec4::new(sx, sy, -1.0 - x * sx, 1.0 - y * sy),
            near: self.oblique_near() as f32,
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
            DepthMapping::Fixed { near, far } | DepthMapping::FixedLogarithmic { near, far } => {
                (f64::from(near), f64::from(far))
            }
        };
        let (raw_near, raw_far) = if map.mapping.follows_visible_range() {
            (0.0, 0.0)
        } else {
            (self.raw_depth(near), self.raw_depth(far))
        };
        let mut flags = 0;
        if orthographic {
            flags |= ORTHOGRAPHIC;
        }
        if map.mapping.is_logarithmic() {
            flags |= LOGARITHMIC;
        }
        DepthFrame {
            near: raw_near as f32,
            far: raw_far as f32,
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
