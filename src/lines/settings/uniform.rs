//! The settings of lines as shaders take them.

use bevy::{math::Vec3, render::render_resource::ShaderType};

use super::{
    edges::EdgeUniform,
    kinds::{CreaseSource, ramp},
    outlines::Outlines,
};
use crate::settings::{Equations, linear_rgb};

impl Outlines {
    /// The jump in depth from which one surface hides another, instead of meeting it:
    /// the threshold of measured silhouettes. That of the faithful equations has another
    /// meaning.
    fn jump(&self) -> f32 {
        let measured = self
            .silhouettes
            .filter(|s| s.equations == Equations::Corrected);
        measured.unwrap_or_default().threshold
    }

    /// The settings as shaders take them. `scale` is physical pixels per logical
    /// pixel, `reference` that of `DepthProjection::jump_reference`, `bend` that of
    /// `DepthProjection::least_bend`, `right` a unit vector to the right of the camera.
    pub(crate) fn uniform(
        &self,
        scale: f32,
        reference: [f32; 2],
        bend: f32,
        right: Vec3,
    ) -> LinesUniform {
        let s = self.silhouettes.unwrap_or_default();
        let c = self.creases.unwrap_or_default();
        let o = self.objects.unwrap_or_default();
        let continues = self.hysteresis > 0.0;
        // The faithful lines do not know weak edges.
        let ends = |equations, limit, softness| {
            let weak = continues && equations == Equations::Corrected;
            ramp(
                limit,
                softness,
                weak.then_some(self.hysteresis_ratio * limit),
            )
        };
        let [silhouette_low, silhouette_high] = ends(s.equations, s.edge_limit, s.softness);
        let [crease_low, crease_high] = ends(c.equations, c.edge_limit, c.softness);
        let [ink_part, width_part] = self.response.parts();
        let [surface_darken, surface_saturate] = self.color.factors();
        let limit = |limit| if continues { limit } else { 0.0 };
        LinesUniform {
            silhouette_color: linear_rgb(s.color),
            silhouette_opacity: s.opacity,
            crease_color: linear_rgb(c.color),
            crease_opacity: c.opacity,
            object_color: linear_rgb(o.color),
            object_opacity: o.opacity,
            silhouette_low,
            silhouette_high,
            silhouette_k: s.k(),
            silhouette_faithful: u32::from(s.equations == Equations::Faithful),
            crease_low,
            crease_high,
            crease_k: c.k(),
            crease_faithful: u32::from(c.equations == Equations::Faithful),
            half_width: 0.5 * self.width * scale,
            scale,
            width_fade: self.width_fade,
            opacity_fade: self.opacity_fade,
            reference_factor: reference[0],
            reference_constant: reference[1],
            jump: self.jump(),
            ink_part,
            width_part,
            silhouette_limit: limit(s.edge_limit),
            crease_limit: limit(c.edge_limit),
            surface_darken,
            surface_saturate,
            found_sections: u32::from(self.divides_meshes()),
            normal_creases: u32::from(c.source != CreaseSource::Meshes),
            bend,
            owner_direction: owner_direction(right),
            convex: EdgeUniform::new(c.convex),
            concave: EdgeUniform::new(c.concave),
        }
    }
}

/// Above, and towards the camera: the same for a scene and its mirror image. Surfaces that are mirror
/// images of each other face both alike, so it is a little to the right.
fn owner_direction(right: Vec3) -> Vec3 {
    0.90 * Vec3::Y + 0.42 * right.cross(Vec3::Y) + 0.02 * right
}

/// `Lines` of `edge.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LinesUniform {
    silhouette_color: Vec3,
    silhouette_opacity: f32,
    crease_color: Vec3,
    crease_opacity: f32,
    object_color: Vec3,
    object_opacity: f32,
    silhouette_low: f32,
    silhouette_high: f32,
    silhouette_k: f32,
    silhouette_faithful: u32,
    crease_low: f32,
    crease_high: f32,
    crease_k: f32,
    crease_faithful: u32,
    half_width: f32,
    scale: f32,
    width_fade: f32,
    opacity_fade: f32,
    reference_factor: f32,
    reference_constant: f32,
    jump: f32,
    ink_part: f32,
    width_part: f32,
    silhouette_limit: f32,
    crease_limit: f32,
    surface_darken: f32,
    surface_saturate: f32,
    found_sections: u32,
    normal_creases: u32,
    bend: f32,
    owner_direction: Vec3,
    convex: EdgeUniform,
    concave: EdgeUniform,
}

#[cfg(test)]
mod tests {
    use super::{
        super::kinds::{Creases, Silhouettes},
        *,
    };

    /// Whether two surfaces meet at a crease does not depend on the equations of silhouettes,
    /// nor on the threshold of the faithful equations.
    #[test]
    fn creases_are_the_same_beside_faithful_silhouettes() {
        let jump = |silhouettes| {
            let settings = Outlines {
                silhouettes,
                creases: Some(Creases::default()),
                ..Outlines::NONE
            };
            settings.uniform(1.0, [1.0, 0.0], 0.0, Vec3::X).jump
        };
        let faithful = |threshold| Silhouettes {
            equations: Equations::Faithful,
            threshold,
            ..Silhouettes::default()
        };
        let want = jump(Some(Silhouettes::default()));
        assert_eq!(jump(None), want);
        for threshold in [1e-6, 1e-4, 0.5, 1.0] {
            assert_eq!(jump(Some(faithful(threshold))), want);
        }
    }
}
