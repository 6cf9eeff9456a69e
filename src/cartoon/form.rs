//! Simpler forms that surfaces are shaded as.

use bevy::{
    camera::primitives::MeshAabb,
    math::Vec3,
    mesh::Mesh,
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
    render::render_resource::ShaderType,
};
use serde::{Deserialize, Serialize};

use crate::settings::{FieldRange, bounded};

/// Shades a mesh as if it had a simpler form, so that faces, bushes and clouds have large areas of
/// one tone (Barla, Thollot and Markosian 2006). Lines, shadow maps and the silhouette stay those
/// of the mesh.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ShadedForm {
    /// The simpler form. Default: [`FormShape::Up`].
    pub shape: FormShape,
    /// How much of its normals is used near the eye. Range 0 (the normals of the mesh) to 1,
    /// default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
    /// The same far away. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub far_amount: f32,
    /// Up to this distance along the axis of the view, `amount` counts. World units. Range 1e-4 to
    /// 1e6, default 1.
    #[reflect(@FieldRange::logarithmic(1e-4, 1e6).unit("units"))]
    pub near: f32,
    /// From this multiple of `near` on, `far_amount` counts; between, it changes with the
    /// logarithm of the distance. Range 1.01 to 1e6, default 10.
    #[reflect(@FieldRange::logarithmic(1.01, 1e6))]
    pub ratio: f32,
}

/// The shape of a [`ShadedForm`]. Sizes and places are in the space of the mesh; of skinned meshes,
/// in that of their entity.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub enum FormShape {
    /// An ellipsoid: heads, bushes, clouds.
    Ellipsoid {
        /// Its middle, in units of the mesh. Range -1e6 to 1e6.
        #[reflect(@FieldRange::linear(-1e6, 1e6))]
        center: Vec3,
        /// From the middle to the border along the three axes. Range 1e-4 to 1e6.
        #[reflect(@FieldRange::logarithmic(1e-4, 1e6))]
        half_size: Vec3,
    },
    /// A cylinder along the longest axis of this box: limbs, trunks.
    Cylinder {
        /// Its middle, in units of the mesh. Range -1e6 to 1e6.
        #[reflect(@FieldRange::linear(-1e6, 1e6))]
        center: Vec3,
        /// From the middle to the border along the three axes. Range 1e-4 to 1e6.
        #[reflect(@FieldRange::logarithmic(1e-4, 1e6))]
        half_size: Vec3,
    },
    /// A plane that faces upwards in the world: grass and leaves look like the ground.
    #[default]
    Up,
}

impl Default for ShadedForm {
    fn default() -> Self {
        Self {
            shape: FormShape::default(),
            amount: 1.0,
            far_amount: 1.0,
            near: 1.0,
            ratio: 10.0,
        }
    }
}

impl FormShape {
    /// The ellipsoid in the bounds of a mesh; `None` if it has no vertices.
    #[must_use]
    pub fn ellipsoid_of(mesh: &Mesh) -> Option<Self> {
        let bounds = mesh.compute_aabb()?;
        Some(Self::Ellipsoid {
            center: bounds.center.into(),
            half_size: bounds.half_extents.into(),
        })
    }

    /// The cylinder in the bounds of a mesh; `None` if it has no vertices.
    #[must_use]
    pub fn cylinder_of(mesh: &Mesh) -> Option<Self> {
        let bounds = mesh.compute_aabb()?;
        Some(Self::Cylinder {
            center: bounds.center.into(),
            half_size: bounds.half_extents.into(),
        })
    }

    fn sanitized(self) -> Self {
        let place = |v: Vec3| Vec3::from_array(v.to_array().map(|x| bounded(x, 0.0, -1e6, 1e6)));
        let size = |v: Vec3| Vec3::from_array(v.to_array().map(|x| bounded(x, 1.0, 1e-4, 1e6)));
        match self {
            Self::Ellipsoid { center, half_size } => Self::Ellipsoid {
                center: place(center),
                half_size: size(half_size),
            },
            Self::Cylinder { center, half_size } => Self::Cylinder {
                center: place(center),
                half_size: size(half_size),
            },
            Self::Up => Self::Up,
        }
    }

    /// The middle, and the factor of each axis.
    fn weights(self) -> (Vec3, Vec3) {
        match self {
            Self::Ellipsoid { center, half_size } => (center, (half_size * half_size).recip()),
            Self::Cylinder { center, half_size } => {
                let longest = half_size.max_position();
                let mut weights = (half_size * half_size).recip();
                weights[longest] = 0.0;
                (center, weights)
            }
            Self::Up => (Vec3::ZERO, Vec3::ZERO),
        }
    }

    pub(super) fn is_up(self) -> bool {
        self == Self::Up
    }
}

impl ShadedForm {
    /// Every number in its documented range; one that is not finite is replaced by its default.
    #[must_use]
    pub fn sanitized(self) -> Self {
        Self {
            shape: self.shape.sanitized(),
            amount: bounded(self.amount, 1.0, 0.0, 1.0),
            far_amount: bounded(self.far_amount, 1.0, 0.0, 1.0),
            near: bounded(self.near, 1.0, 1e-4, 1e6),
            ratio: bounded(self.ratio, 10.0, 1.01, 1e6),
        }
    }
}

/// `Form` in `form.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FormUniform {
    center: Vec3,
    amount: f32,
    weights: Vec3,
    far_amount: f32,
    distance: f32,
    per_log: f32,
}

impl From<&ShadedForm> for FormUniform {
    fn from(form: &ShadedForm) -> Self {
        let form = form.sanitized();
        let (center, weights) = form.shape.weights();
        Self {
            center,
            amount: form.amount,
            weights,
            far_amount: form.far_amount,
            distance: form.near,
            per_log: form.ratio.ln().recip(),
        }
    }
}
