//! The toon material and its settings.

use std::borrow::Cow;

use bevy::{
    material::OpaqueRendererMethod,
    mesh::MeshVertexBufferLayoutRef,
    pbr::{ExtendedMaterial, MaterialExtension, MaterialExtensionKey, MaterialExtensionPipeline},
    prelude::*,
    render::render_resource::{
        AsBindGroup, RenderPipelineDescriptor, SpecializedMeshPipelineError,
    },
    shader::{ShaderDefVal, ShaderRef},
};
use serde::{Deserialize, Serialize};

use super::{
    Ramp, RampMap, Rim, ShadingProxy, StylizedHighlight,
    hatch::HatchUniform,
    uniform::{ToonKey, ToonUniform},
    vertex,
    view_range::ViewRanges,
};
use crate::{
    effect::Effect,
    effects::Hatching,
    settings::{FieldRange, clamp_fields},
};

/// A [`StandardMaterial`] with the lighting of a toon:
///
/// ```text
/// image = ambient + sum over lights of (1 - S) * light * (k_d + specular)
/// ```
///
/// `k_d` is the base color. `S` is the shadow, with a hard, anti-aliased edge: it is
/// [`shadow_strength`](ToonLight::shadow_strength) where the surface faces away from the light
/// (form shadow) or where the light's shadow map says that the light does not reach it (cast
/// shadow), otherwise 0. The formula has no N·L term, so lit areas of one base color are uniform;
/// a [`Ramp`] gives them more tones. All directional, point, spot and rectangular lights are used,
/// with light textures and contact shadows (\[CL\] 2.2, 2.3; Decaudin 1996).
///
/// `ambient` includes lightmaps, irradiance volumes and the diffuse part of environment
/// maps, in two tones unless [`flat_environment`](ToonLight::flat_environment) is
/// lower. On meshes with a lightmap, lights that do not affect lightmapped meshes only draw
/// highlights.
///
/// Textures, normal maps, vertex colors, alpha modes, emission, decals, fog and `unlit` work as in
/// the standard material. Metals are drawn as paint of their base color, with highlights of that
/// color. Reflections of environment maps and of the screen, transmission, clearcoat and
/// anisotropy are not drawn; a warning names the first material that asks for one of the last
/// three, and the first camera with `ScreenSpaceReflections`. The light is computed in the forward
/// pass:
/// [`opaque_render_method`] is always set to forward, so that on a camera with a
/// deferred prepass these meshes are drawn forward.
///
/// [`opaque_render_method`]: StandardMaterial::opaque_render_method
pub type ToonMaterial = ExtendedMaterial<StandardMaterial, ToonLight>;

/// The lighting of a [`ToonMaterial`].
#[derive(Asset, AsBindGroup, Reflect, Clone, Debug, PartialEq, Serialize, Deserialize)]
#[uniform(100, ToonUniform)]
#[uniform(103, HatchUniform)]
#[bind_group_data(ToonKey)]
#[reflect(Default, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ToonLight {
    /// Moves the edge of the form shadow towards the light: the cosine of the angle between the
    /// normal and the direction to the light at which the shadow begins. Range 0 to 0.9, default
    /// 0.08. Decaudin uses 0; a little more hides the facets of coarse meshes, which shade
    /// themselves near the edge.
    #[reflect(@FieldRange::linear(0.0, 0.9))]
    pub shadow_threshold: f32,
    /// Darkens surfaces that face away from a light. Default: `true`.
    pub form_shadows: bool,
    /// Draws the shadows of other surfaces, from the shadow maps of the lights.
    /// Default: `true`.
    pub cast_shadows: bool,
    /// Fraction of a light that its shadows remove. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub shadow_strength: f32,
    /// Strength of the highlights. Range 0 (none) to 4, default 1. A highlight has a
    /// hard edge. The rougher the material, the larger and fainter it is; above a
    /// perceptual roughness of 0.71 there is none.
    #[reflect(@FieldRange::linear(0.0, 4.0))]
    pub highlight: f32,
    /// Fraction of its peak at which a highlight ends: the lower, the larger the
    /// highlight. Range 0.01 to 0.99, default 0.5.
    #[reflect(@FieldRange::linear(0.01, 0.99))]
    pub highlight_edge: f32,
    /// Size of the steps, in stops (factors of 2), in which the light of point and
    /// spot lights falls off with distance, so that it forms flat rings. Range 0 (no
    /// steps) to 4, default 1.
    #[reflect(@FieldRange::linear(0.0, 4.0).unit("stops"))]
    pub falloff: f32,
    /// How flat the light of environment maps, light probes and irradiance volumes is. 1: it
    /// has two tones, of the brightest side and of the side that faces away from it, with
    /// the same mean as the original. 0: it changes with every normal, as on the standard
    /// material. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub flat_environment: f32,
    /// Whether the alpha of vertex colors, painted by an artist, says how easily a vertex is lit:
    /// 0.5 is neutral, 0 is never lit, 1 is lit except where it faces away or lies in a cast
    /// shadow. For opaque materials; in others, alpha is still opacity. Default: `false`.
    pub vertex_threshold: bool,
    /// How easily places are lit, as an image: its red channel means what the alpha of vertices
    /// does for `vertex_threshold` (Motomura 2015). Default: `None`. It is not part of files.
    ///
    /// The image lies on the texture coordinates of the base color and is read with the sampler of
    /// its texture; meshes without coordinates do not read it. Load it with `is_srgb: false`: in
    /// images in sRGB, 188 of 255 is neutral. Its format must be one that can be filtered, which
    /// 32-bit floating-point numbers cannot. With `vertex_threshold`, what both add to the cosine
    /// between normal and light is added up.
    #[texture(104, visibility(fragment))]
    #[serde(skip)]
    pub threshold_map: Option<Handle<Image>>,
    /// Tones between shade and light. Default: `None`, which is all of the light or none of it.
    pub ramp: Option<Ramp>,
    /// The tones of `ramp`, painted in an image, in place of its stops. Default: none. Files have
    /// the path of the image among the assets, as in `ramp_map: "ramps/skin.png"`.
    ///
    /// If `ramp` is `None`, its other settings are those of [`Ramp::default`].
    #[texture(105, visibility(fragment), filterable = false)]
    pub ramp_map: RampMap,
    /// A stylized shape for the highlight of the brightest light. Default: `None`, a plain
    /// highlight.
    pub stylized_highlight: Option<StylizedHighlight>,
    /// A simpler form that the surface is shaded as. Default: `None`.
    pub proxy: Option<ShadingProxy>,
    /// A rim of light. Default: `None`.
    pub rim: Option<Rim>,
    /// Strokes on the surface, as dark as the light that does not arrive. Default: `None`.
    ///
    /// They are those of the effect [`Hatching`], but stay on the mesh while it moves, is skinned
    /// and is morphed, and know shadows from dark paint. Their darkness is that of a white surface,
    /// whose lightness is the square root of the fraction of all light that arrives, in the tones
    /// of a ramp. Ambient light and lightmaps always arrive.
    ///
    /// [`spacing`](Hatching::spacing) and [`length`](Hatching::length) are in physical pixels, or in
    /// page pixels on a camera with a [`PageHeight`](crate::style::PageHeight).
    /// [`ink`](Hatching::ink) and [`paper`](Hatching::paper) are colors before tonemapping, and
    /// [`at_near`](Hatching::at_near) is the factor of the darkness at all distances.
    /// Dots stay on meshes as strokes do. [`at_far`](Hatching::at_far),
    /// [`source`](Hatching::source) and [`simplify_small`](Hatching::simplify_small) have no
    /// meaning here.
    pub hatching: Option<Hatching>,
    /// The strokes of `hatching`, as a tonal art map. Default: `None`, strokes by planes. It is not
    /// part of files.
    ///
    /// A map lies on the texture coordinates of the mesh, with its strokes along the first one; on
    /// meshes without any, it lies on the three planes of coordinates of the mesh at rest. A stroke
    /// has its width on the screen, as far as the map has mip levels: that of [`TonalArtMap`] has.
    /// It replaces the settings of `hatching` that say how strokes are drawn: `anchor`, and those
    /// from `spacing` to `rate`.
    ///
    /// Other images may be used: each texel of the red channel is the tone from which it is ink, in
    /// linear light (`is_srgb: false`), and every mip level is drawn, not averaged.
    ///
    /// [`TonalArtMap`]: super::TonalArtMap
    #[texture(101)]
    #[serde(skip)]
    pub art_map: Option<Handle<Image>>,
    /// How often `art_map` repeats over texture coordinates from 0 to 1, or over a unit of the
    /// world. Range 0.01 to 1000, default 4.
    #[reflect(@FieldRange::logarithmic(0.01, 1000.0))]
    pub art_map_repeat: f32,
    /// Of all views: no setting.
    #[doc(hidden)]
    #[texture(107, sample_type = "u_int", visibility(vertex))]
    #[serde(skip)]
    #[reflect(ignore)]
    pub view_ranges: ViewRanges,
}

impl Default for ToonLight {
    fn default() -> Self {
        Self {
            shadow_threshold: 0.08,
            form_shadows: true,
            cast_shadows: true,
            shadow_strength: 1.0,
            highlight: 1.0,
            highlight_edge: 0.5,
            falloff: 1.0,
            flat_environment: 1.0,
            vertex_threshold: false,
            threshold_map: None,
            ramp: None,
            ramp_map: RampMap::default(),
            stylized_highlight: None,
            proxy: None,
            rim: None,
            hatching: None,
            art_map: None,
            art_map_repeat: 4.0,
            view_ranges: ViewRanges,
        }
    }
}

impl ToonLight {
    pub(super) fn drawn_ramp(&self) -> Option<Cow<'_, Ramp>> {
        let painted = self.ramp_map.is_ready();
        let default = painted.then(|| Cow::Owned(Ramp::default()));
        self.ramp.as_ref().map(Cow::Borrowed).or(default)
    }

    /// The settings that are used: every number is clamped to its documented range,
    /// and a number that is not finite is replaced by its default.
    #[must_use]
    pub fn sanitized(self) -> Self {
        // These first: the default of the light has none of them.
        clamp_fields(Self {
            ramp: self.ramp.map(Ramp::sanitized),
            stylized_highlight: self.stylized_highlight.map(StylizedHighlight::sanitized),
            proxy: self.proxy.map(ShadingProxy::sanitized),
            rim: self.rim.map(Rim::sanitized),
            hatching: self.hatching.map(Effect::sanitized),
            ..self
        })
    }
}

impl MaterialExtension for ToonLight {
    fn fragment_shader() -> ShaderRef {
        "embedded://bevy_comics/toon/toon.wgsl".into()
    }

    fn specialize(
        _: &MaterialExtensionPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        key: MaterialExtensionKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let key = key.bind_group_data;
        vertex::specialize(&mut descriptor.vertex, layout, key)?;
        if let Some(fragment) = &mut descriptor.fragment {
            let smoothed = vertex::is_smoothed(layout);
            if fragment.shader_defs.contains(&"LIGHTMAP".into()) {
                // A lightmap takes the place of light from the surroundings. With both, and without
                // arrays of textures, the engine's shader is not valid (Bevy 0.19.1: a number is
                // used as a truth value), and the mesh would not be drawn.
                let surroundings = ["ENVIRONMENT_MAP", "IRRADIANCE_VOLUME"].map(ShaderDefVal::from);
                (fragment.shader_defs).retain(|definition| !surroundings.contains(definition));
            }
            let definitions = key.definitions(&fragment.shader_defs, smoothed);
            fragment.shader_defs.extend(definitions);
            let samples = descriptor.multisample.count;
            (fragment.shader_defs).push(ShaderDefVal::UInt("SAMPLES".into(), samples));
        }
        Ok(())
    }
}

/// Sets every toon material to forward rendering: the engine's deferred lighting
/// pass can compute only the standard material's lighting.
pub(super) fn keep_forward(
    mut events: MessageReader<AssetEvent<ToonMaterial>>,
    mut materials: ResMut<Assets<ToonMaterial>>,
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
