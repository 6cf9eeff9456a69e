//! Simpler forms that surfaces are shaded as.

use bevy::{camera::primitives::MeshAabb, prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::settings::{FieldRange, NotFinite, impl_sanitized};

/// Shades a mesh as if it had a simpler form, so that faces, bushes and clouds have large areas of
/// one tone (Barla, Thollot and Markosian 2006). Lines, shadow maps and the silhouette stay those
/// of the mesh.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ShadingProxy {
    /// The simpler form. Default: [`ProxyShape::Up`].
    pub shape: ProxyShape,
    /// How much of its normals is used near the eye. Range 0 (the normals of the mesh) to 1,
    /// default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount: f32,
    /// The same far away. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub amount_at_far: f32,
    /// Distance along the view's axis up to which `amount` applies, in world units. Range 1e-4 to
    /// 1e6, default 1.
    #[reflect(@FieldRange::logarithmic(1e-4, 1e6).unit("units"))]
    pub from: f32,
    /// Multiple of `from` from which on `amount_at_far` applies; in between, the amount changes
    /// with the logarithm of the distance. Range 1.01 to 1e6, default 10.
    #[reflect(@FieldRange::logarithmic(1.01, 1e6))]
    pub ratio: f32,
}

/// The shape of a [`ShadingProxy`]. Sizes and places are in the space of the mesh; of skinned
/// meshes, in that of their entity.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub enum ProxyShape {
    /// An ellipsoid: heads, bushes, clouds.
    Ellipsoid {
        /// Its middle, in units of the mesh. Range -1e6 to 1e6.
        #[reflect(@FieldRange::linear(-1e6, 1e6), @NotFinite(0.0))]
        center: Vec3,
        /// From the middle to the border along the three axes. Range 1e-4 to 1e6.
        #[reflect(@FieldRange::logarithmic(1e-4, 1e6), @NotFinite(1.0))]
        half_size: Vec3,
    },
    /// A cylinder along the longest axis of this box: limbs, trunks.
    Cylinder {
        /// Its middle, in units of the mesh. Range -1e6 to 1e6.
        #[reflect(@FieldRange::linear(-1e6, 1e6), @NotFinite(0.0))]
        center: Vec3,
        /// From the middle to the border along the three axes. Range 1e-4 to 1e6.
        #[reflect(@FieldRange::logarithmic(1e-4, 1e6), @NotFinite(1.0))]
        half_size: Vec3,
    },
    /// A plane that faces upwards in the world: grass and leaves look like the ground.
    #[default]
    Up,
    /// The mesh without its details: faces, hair and cloth.
    ///
    /// The normals of the triangles around each vertex are averaged, and then repeatedly with those
    /// of its neighbors. Vertices at the same place are treated as one, so that seams and hard
    /// edges disappear. Neighbors are weighted so that it does not matter how an area is divided
    /// into triangles, and a ball keeps its normals. Normals follow bones and morph targets.
    ///
    /// They are made in a task when a mesh first has such a material, and kept in a vertex
    /// attribute of the mesh, of 4 bytes a vertex; until then, and for meshes without normals or
    /// whose data is only on the GPU, the mesh's own normals are used; the log says so of the first
    /// one of these. If several materials share a mesh, the largest number of rounds is used.
    Smoothed {
        /// How often neighbors are averaged: 0 is smooth shading, more remove larger details, as
        /// wide as so many edges of the mesh. Range 0 to 50.
        #[reflect(@FieldRange::linear(0.0, 50.0))]
        rounds: u32,
    },
}

impl Default for ShadingProxy {
    fn default() -> Self {
        Self {
            shape: ProxyShape::default(),
            amount: 1.0,
            amount_at_far: 1.0,
            from: 1.0,
            ratio: 10.0,
        }
    }
}

impl ProxyShape {
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
            Self::Up | Self::Smoothed { .. } => (Vec3::ZERO, Vec3::ZERO),
        }
    }

    /// What of it is compiled.
    pub(super) fn key(self) -> ProxyKey {
        match self {
            Self::Up => ProxyKey::Up,
            Self::Ellipsoid { .. } | Self::Cylinder { .. } => ProxyKey::Solid,
            Self::Smoothed { .. } => ProxyKey::Smoothed,
        }
    }
}

/// The part of a form that selects a variant of the shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum ProxyKey {
    Up,
    Solid,
    Smoothed,
}

impl ProxyKey {
    /// The shader definitions. `is_smoothed`: the mesh has smoothed normals.
    pub(super) fn definitions(self, is_smoothed: bool) -> &'static [&'static str] {
        match self {
            Self::Up => &["PROXY", "PROXY_UP"],
            Self::Solid => &["PROXY", "PROXY_NORMAL"],
            Self::Smoothed if is_smoothed => &["PROXY", "PROXY_NORMAL", "PROXY_SMOOTHED"],
            Self::Smoothed => &[],
        }
    }
}

impl_sanitized!(ShadingProxy);

/// `Proxy` in `proxy.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ProxyUniform {
    center: Vec3,
    amount: f32,
    weights: Vec3,
    amount_at_far: f32,
    distance: f32,
    per_log: f32,
}

impl From<&ShadingProxy> for ProxyUniform {
    fn from(proxy: &ShadingProxy) -> Self {
        let proxy = proxy.sanitized();
        let (center, weights) = proxy.shape.weights();
        Self {
            center,
            amount: proxy.amount,
            weights,
            amount_at_far: proxy.amount_at_far,
            distance: proxy.from,
            per_log: proxy.ratio.ln().recip(),
        }
    }
}
