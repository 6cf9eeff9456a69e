//! How lines fade into the engine's distance fog.

use bevy::{prelude::*, render::render_resource::ShaderType};
use serde::{Deserialize, Serialize};

use crate::{
    depth::{ProjectionKind, frame::DepthProjection},
    settings::{FieldRange, NotFinite, clamp_or_default},
};

/// What happens to lines in fog.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum LineFog {
    /// Nothing: lines are as strong in the fog as elsewhere.
    Ignore,
    /// They fade by the engine's `DistanceFog` in front of the surface that they belong to, if the
    /// camera has it. Lines of the faithful equations do not. Needs compute shaders, and the
    /// crate's feature `objects` or `toon`. Other kinds of fog are ignored, and so is
    /// `fog_enabled: false` of materials.
    #[default]
    Fade,
    /// They fade with distance, whatever fog there is: for `Atmosphere`, volumetric fog and fog of
    /// the game's own. Needs compute shaders.
    Visibility {
        /// Distance at which 2 % of a line is left, in world units (Koschmieder's visibility).
        /// Range 0.001 to 1e9; 1000 if it is not finite.
        #[reflect(@FieldRange::logarithmic(1e-3, 1e9).unit("units"), @NotFinite(1000.0))]
        distance: f32,
    },
}

impl LineFog {
    /// The fog that lines fade into. `distance_fog`: that of the camera.
    pub(crate) fn seen(self, distance_fog: Option<ViewFog>) -> Option<ViewFog> {
        match self {
            Self::Ignore => None,
            Self::Fade => distance_fog,
            Self::Visibility { distance } => Some(ViewFog {
                falloff: EXPONENTIAL,
                // The contrast that is left at the visibility is 2 %.
                numbers: Vec3::new(
                    -(0.02_f32.ln()) / clamp_or_default(distance, 1000.0, 1e-3, 1e9),
                    0.0,
                    0.0,
                ),
                most: 1.0,
            }),
        }
    }
}

/// [`ViewFog::falloff`] by one density.
const EXPONENTIAL: u32 = 1;

/// Whether a camera has the engine's distance fog.
pub(crate) fn has_fog(camera: EntityRef) -> bool {
    #[cfg(any(feature = "objects", feature = "toon"))]
    return camera.contains::<DistanceFog>();
    #[cfg(not(any(feature = "objects", feature = "toon")))]
    {
        let _ = camera;
        false
    }
}

/// The distance fog of a camera; by default one that hides nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ViewFog {
    /// 0: linear, 1: exponential, 2: exponential squared, 3: atmospheric.
    pub falloff: u32,
    /// Linear: start and end; exponential: density; atmospheric: extinction by channel.
    pub numbers: Vec3,
    /// Opacity of its color.
    pub most: f32,
}

impl ViewFog {
    /// The fog as shaders take it.
    pub fn uniform(&self, projection: &DepthProjection, clip_from_view: &Mat4) -> FogUniform {
        let m = clip_from_view;
        let orthographic = projection.kind() == ProjectionKind::Orthographic;
        let shift = if orthographic {
            -Vec2::new(m.w_axis.x, m.w_axis.y)
        } else {
            Vec2::new(m.z_axis.x, m.z_axis.y)
        };
        let scale = Vec2::new(m.x_axis.x, m.y_axis.y).recip();
        let scale = if scale.is_finite() { scale } else { Vec2::ZERO };
        let shift = shift * scale;
        FogUniform {
            ray: Vec4::new(scale.x, scale.y, shift.x, shift.y),
            axis: projection.axis(),
            orthographic: u32::from(orthographic),
            falloff: self.falloff,
            numbers: self.numbers,
            most: self.most,
        }
    }
}

/// `Fog` of `fog.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FogUniform {
    ray: Vec4,
    axis: Vec2,
    orthographic: u32,
    falloff: u32,
    numbers: Vec3,
    most: f32,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Positions on both sides of the middle, near and far, under projections of every kind:
    /// from the position in the picture and the raw depth follows the distance.
    #[test]
    fn the_uniform_gives_the_distance_of_points() {
        let infinite = Mat4::perspective_infinite_reverse_rh(1.0, 1.5, 0.1);
        // Shifted, with a far plane.
        let shifted = Mat4::from_cols_array_2d(&[
            [1.2, 0.0, 0.0, 0.0],
            [0.0, 1.7, 0.0, 0.0],
            [0.3, -0.2, 0.1 / 99.9, -1.0],
            [0.0, 0.0, 10.0 / 99.9, 0.0],
        ]);
        let parallel = Mat4::orthographic_rh(-30.0, 50.0, -20.0, 40.0, 100.0, 0.1);
        // The third row is that of a plane across the view: only `raw.wgsl` knows the depth.
        let mut oblique = infinite;
        oblique.x_axis.z = 0.2;
        oblique.y_axis.z = -0.1;
        for clip_from_view in [infinite, shifted, parallel, oblique] {
            let projection = DepthProjection::new(&clip_from_view, None);
            let fog = ViewFog::default().uniform(&projection, &clip_from_view);
            for point in [
                Vec3::new(0.3, 0.2, 1.0),
                Vec3::new(-7.0, 4.0, 20.0),
                Vec3::new(20.0, -13.0, 60.0),
            ] {
                let clip = clip_from_view * (point * Vec3::new(1.0, 1.0, -1.0)).extend(1.0);
                let seen = clip.truncate().xy() / clip.w;
                let d = projection.raw_depth(f64::from(point.z)) as f32;
                let across = seen * fog.ray.truncate().xy() + Vec2::new(fog.ray.z, fog.ray.w);
                let found = if fog.orthographic != 0 {
                    across.extend(fog.axis.x + fog.axis.y * d).length()
                } else {
                    fog.axis.x / (d + fog.axis.y) * across.extend(1.0).length()
                };
                let want = point.length();
                assert!(
                    (found / want - 1.0).abs() < 1e-3,
                    "{clip_from_view}, {point}: {found}, {want}"
                );
            }
        }
    }
}
