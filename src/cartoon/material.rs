//! The material and its settings.

use bevy::{
    asset::{Asset, AssetEvent, Assets},
    ecs::{message::MessageReader, system::ResMut},
    material::OpaqueRendererMethod,
    pbr::{ExtendedMaterial, MaterialExtension, StandardMaterial},
    reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault},
    render::render_resource::{AsBindGroup, ShaderType},
    shader::ShaderRef,
};
use serde::{Deserialize, Serialize};

use crate::settings::bounded;

/// A [`StandardMaterial`] that is lit like a cartoon:
///
/// ```text
/// image = ambient + sum over lights (1 - S) light (k_d + specular)
/// ```
///
/// (\[CL\] 2.3, Decaudin 1996). There is no N.L in it, so an area of one colour
/// that a light reaches is one colour. `S` is 1 where the surface faces away from
/// the light (backface shadow) or where the light's shadow map says so (projected
/// shadow): both with a hard, anti-aliased edge. Directional, point and spot
/// lights count, as many as there are.
///
/// Everything else is the standard material's: textures, normal maps, vertex
/// colours, alpha modes, emission, lightmaps, decals, fog, `unlit`. Reflected
/// environments, transmission, clearcoat and anisotropy are not: they have no flat
/// form. The light is computed in the forward pass; on a camera with a deferred
/// prepass these meshes are drawn forward among the deferred ones, and
/// `opaque_render_method` is set so.
pub type CartoonMaterial = ExtendedMaterial<StandardMaterial, CartoonLight>;

/// How a [`CartoonMaterial`] takes the light.
#[derive(Asset, AsBindGroup, Reflect, Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[uniform(100, CartoonLightUniform)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CartoonLight {
    /// Where the backface shadow begins: the cosine of the angle between normal
    /// and light. 0 is Decaudin's; a little more hides the facets of coarse
    /// meshes, which shade themselves there. Range 0 to 0.9, default 0.08.
    pub terminator: f32,
    /// Whether surfaces that face away from a light are in its shadow.
    /// Default: `true`.
    pub backface_shadows: bool,
    /// Whether the lights' shadow maps are drawn. Default: `true`.
    pub projected_shadows: bool,
    /// How much of a light its shadow takes away. Range 0 to 1, default 1.
    pub shadow_strength: f32,
    /// Strength of the highlight. It is the larger and fainter the rougher the
    /// material, hard-edged, and gone at a perceptual roughness of 0.72. Range 0
    /// (none) to 4, default 1.
    pub highlight: f32,
    /// The share of its peak at which a highlight ends: the lower, the larger
    /// it is. Range 0.01 to 0.99, default 0.5.
    pub highlight_edge: f32,
    /// Point and spot lights fall off in steps of this many stops, so that their
    /// light lies in flat rings; 0 lets them fall off smoothly. Range 0 to 4,
    /// default 1.
    pub falloff: f32,
}

impl Default for CartoonLight {
    fn default() -> Self {
        Self {
            terminator: 0.08,
            backface_shadows: true,
            projected_shadows: true,
            shadow_strength: 1.0,
            highlight: 1.0,
            highlight_edge: 0.5,
            falloff: 1.0,
        }
    }
}

impl CartoonLight {
    /// The settings that are used: every number in its documented range, what
    /// is not finite replaced by its default.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let default = Self::default();
        Self {
            terminator: bounded(self.terminator, default.terminator, 0.0, 0.9),
            shadow_strength: bounded(self.shadow_strength, default.shadow_strength, 0.0, 1.0),
            highlight: bounded(self.highlight, default.highlight, 0.0, 4.0),
            highlight_edge: bounded(self.highlight_edge, default.highlight_edge, 0.01, 0.99),
            falloff: bounded(self.falloff, default.falloff, 0.0, 4.0),
            ..self
        }
    }
}

/// `CartoonLight` of `cartoon.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct CartoonLightUniform {
    terminator: f32,
    backface: f32,
    projected: f32,
    highlight: f32,
    highlight_edge: f32,
    falloff: f32,
}

impl From<&CartoonLight> for CartoonLightUniform {
    fn from(light: &CartoonLight) -> Self {
        let light = light.sanitized();
        let strength = |on: bool| if on { light.shadow_strength } else { 0.0 };
        Self {
            terminator: light.terminator,
            backface: strength(light.backface_shadows),
            projected: strength(light.projected_shadows),
            highlight: light.highlight,
            highlight_edge: light.highlight_edge,
            falloff: light.falloff,
        }
    }
}

impl MaterialExtension for CartoonLight {
    fn fragment_shader() -> ShaderRef {
        "embedded://bevy_comics/cartoon/cartoon.wgsl".into()
    }
}

/// The deferred lighting pass knows the standard material's light alone.
pub(super) fn keep_forward(
    mut events: MessageReader<AssetEvent<CartoonMaterial>>,
    mut materials: ResMut<Assets<CartoonMaterial>>,
) {
    for event in events.read() {
        let (AssetEvent::Added { id } | AssetEvent::Modified { id }) = event else {
            continue;
        };
        let forward = OpaqueRendererMethod::Forward;
        if materials
            .get(*id)
            .is_some_and(|m| m.base.opaque_render_method != forward)
            && let Some(mut material) = materials.get_mut(*id)
        {
            material.base.opaque_render_method = forward;
        }
    }
}
