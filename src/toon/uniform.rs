//! Settings of the toon material as its shader reads them.

use bevy::{render::render_resource::ShaderType, shader::ShaderDefVal};

use super::{
    DetailAxis, HighlightFrame, HighlightShape, RimWidth, ToonLight,
    detail::DetailUniform,
    hatch::HatchKey,
    proxy::{ProxyKey, ProxyUniform},
    ramp::{RampKey, RampUniform},
    rim::RimUniform,
    stylized_highlight::StylizedHighlightUniform,
};
use crate::{gpu::definitions, settings::clamp_or_default};

/// The uniform: `Toon` in `bindings.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct ToonUniform {
    detail: DetailUniform,
    light: ToonLightUniform,
    proxy: ProxyUniform,
    stylized_highlight: StylizedHighlightUniform,
    rim: RimUniform,
    ramp: RampUniform,
}

/// `ToonLight` in `light.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
struct ToonLightUniform {
    shadow_threshold: f32,
    form_shadow: f32,
    cast_shadow: f32,
    highlight: f32,
    highlight_edge: f32,
    falloff: f32,
    environment: f32,
}

impl From<&ToonLight> for ToonUniform {
    fn from(light: &ToonLight) -> Self {
        let light = light.clone().sanitized();
        let strength = |on: bool| if on { light.shadow_strength } else { 0.0 };
        let ramp = light.drawn_ramp();
        let detail = ramp.as_ref().and_then(|ramp| ramp.detail.as_ref());
        Self {
            light: ToonLightUniform {
                shadow_threshold: light.shadow_threshold,
                form_shadow: strength(light.form_shadows),
                cast_shadow: strength(light.cast_shadows),
                highlight: light.highlight,
                highlight_edge: light.highlight_edge,
                falloff: light.falloff,
                environment: light.flat_environment,
            },
            detail: detail.map(|d| d.axis.into()).unwrap_or_default(),
            proxy: light.proxy.as_ref().map(Into::into).unwrap_or_default(),
            stylized_highlight: light
                .stylized_highlight
                .as_ref()
                .map(Into::into)
                .unwrap_or_default(),
            rim: light.rim.as_ref().map(Into::into).unwrap_or_default(),
            ramp: ramp.as_deref().map(Into::into).unwrap_or_default(),
        }
    }
}

/// The settings that select a variant of the shader, in which all others are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ToonKey {
    ramp: Option<RampKey>,
    /// Normals of another form.
    proxy: Option<ProxyKey>,
    stylized_highlight: Option<(HighlightShape, HighlightFrame)>,
    vertex_threshold: bool,
    threshold_map: bool,
    pub(super) hatch: Option<HatchKey>,
    rim: bool,
    /// The rim has the same width everywhere.
    even_rim: bool,
    /// The ramp has detail by the visible range.
    visible: bool,
}

impl From<&ToonLight> for ToonKey {
    fn from(light: &ToonLight) -> Self {
        let highlight = clamp_or_default(light.highlight, 1.0, 0.0, 4.0);
        let stylized_highlight = light.stylized_highlight.filter(|_| highlight > 0.0);
        let ramp = light.drawn_ramp();
        let axis = ramp
            .as_ref()
            .and_then(|ramp| Some(ramp.detail.as_ref()?.axis));
        Self {
            ramp: ramp.map(|ramp| RampKey::new(&ramp, light.ramp_map.is_ready())),
            proxy: light.proxy.map(|proxy| proxy.shape.key()),
            stylized_highlight: stylized_highlight
                .map(|stylized_highlight| (stylized_highlight.shape, stylized_highlight.frame)),
            vertex_threshold: light.vertex_threshold,
            threshold_map: light.threshold_map.is_some(),
            hatch: HatchKey::of(light),
            rim: light.rim.is_some(),
            even_rim: (light.rim).is_some_and(|rim| matches!(rim.width, RimWidth::Pixels(_))),
            visible: axis == Some(DetailAxis::VisibleRange),
        }
    }
}

impl ToonKey {
    /// Whether lengths depend on the view.
    fn is_scaled(self) -> bool {
        self.hatch.is_some() || self.even_rim
    }

    pub(super) fn reads_smoothed(self) -> bool {
        self.proxy == Some(ProxyKey::Smoothed)
    }

    /// Outputs of the vertex shader besides those of the engine's. `smoothed`: normals of the
    /// mesh are smoothed.
    pub(super) fn vertex_definitions(
        self,
        others: &[ShaderDefVal],
        smoothed: bool,
    ) -> Vec<ShaderDefVal> {
        let rest = self.hatch.is_some_and(|hatch| hatch.needs_rest(others));
        let smoothed = smoothed && self.reads_smoothed();
        let other_normal = smoothed || self.proxy == Some(ProxyKey::Solid);
        let found = definitions([
            (rest, "HATCH_REST"),
            (smoothed, "PROXY_SMOOTHED"),
            (other_normal, "PROXY_NORMAL"),
            (self.visible, "DETAIL_VISIBLE"),
            (self.is_scaled(), "VIEW_SCALE"),
        ]);
        found.collect()
    }

    /// The shader definitions, in addition to those of the mesh and the view. `smoothed`: the mesh
    /// has smoothed normals.
    pub(super) fn definitions(self, others: &[ShaderDefVal], smoothed: bool) -> Vec<ShaderDefVal> {
        let has = |names: &[&str]| {
            let is_one = |d: &ShaderDefVal| matches!(d, ShaderDefVal::Bool(n, true) if names.contains(&n.as_str()));
            others.iter().any(is_one)
        };
        // The engine's other filters, and soft shadows, are read as they are. WebGL 2 cannot read
        // four texels at once.
        let unlike = has(&["WEBGL2", "PCSS_SAMPLERS_AVAILABLE"]);
        let sloped = has(&["SHADOW_FILTER_METHOD_GAUSSIAN"]) && !unlike;
        let of_vertices = self.vertex_threshold && has(&["VERTEX_COLORS"]);
        let of_map = self.threshold_map && has(&["VERTEX_UVS_A"]);
        let environment = has(&["ENVIRONMENT_MAP", "IRRADIANCE_VOLUME"]);
        let flags = definitions([
            (environment, "ENVIRONMENT"),
            (sloped, "SLOPED_SHADOWS"),
            (self.stylized_highlight.is_some() || self.rim, "KEY_LIGHT"),
            (of_vertices, "VERTEX_THRESHOLD"),
            (of_map, "THRESHOLD_MAP"),
            (of_vertices || of_map, "THRESHOLD"),
            (self.rim, "RIM"),
            (self.even_rim && has(&["DEPTH_PREPASS"]), "DEPTH_RIM"),
            (self.is_scaled(), "VIEW_SCALE"),
        ]);
        let ramp = self.ramp.into_iter().flat_map(RampKey::definitions);
        let shape_and_frame = self.stylized_highlight.map(|(shape, frame)| {
            let shape = ShaderDefVal::UInt("STYLIZED_HIGHLIGHT_SHAPE".into(), shape as u32);
            let flags = ["STYLIZED_HIGHLIGHT", frame.definition()];
            flags.map(ShaderDefVal::from).into_iter().chain([shape])
        });
        let proxy = self.proxy.map(|proxy| proxy.definitions(smoothed));
        let proxy = proxy
            .into_iter()
            .flatten()
            .map(|name| ShaderDefVal::from(*name));
        let hatch = self.hatch.map(|hatch| hatch.definitions(others));
        let modes = shape_and_frame.into_iter().flatten().chain(proxy);
        let modes = modes.chain(hatch.into_iter().flatten());
        flags.chain(ramp).chain(modes).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::toon::Ramp;

    #[test]
    fn what_is_not_used_is_not_compiled() {
        let plain = ToonKey::from(&ToonLight::default());
        assert!(plain.definitions(&[], true).is_empty());
        assert!(plain.vertex_definitions(&[], true).is_empty());
        let ramp = ToonLight {
            ramp: Some(Ramp::default()),
            ..ToonLight::default()
        };
        let stops = ShaderDefVal::UInt("RAMP_STOPS".into(), 2);
        let found = ToonKey::from(&ramp).definitions(&[], true);
        assert_eq!(found, ["RAMP_LIGHT_FRACTION".into(), stops]);
    }

    /// Borders of shadows come from the texels of shadow maps where the engine's filter is the one
    /// that the shader knows, and four texels can be read at once.
    #[test]
    fn shadows_have_slopes_where_their_filter_is_known() {
        let plain = ToonKey::from(&ToonLight::default());
        let is_sloped = |names: &[&str]| {
            let others: Vec<ShaderDefVal> = names.iter().map(|name| (*name).into()).collect();
            let found = plain.definitions(&others, false);
            found.contains(&"SLOPED_SHADOWS".into())
        };
        let gaussian = "SHADOW_FILTER_METHOD_GAUSSIAN";
        assert!(is_sloped(&[gaussian]));
        assert!(!is_sloped(&[]));
        assert!(!is_sloped(&["SHADOW_FILTER_METHOD_TEMPORAL"]));
        assert!(!is_sloped(&["SHADOW_FILTER_METHOD_HARDWARE_2X2"]));
        assert!(!is_sloped(&[gaussian, "PCSS_SAMPLERS_AVAILABLE"]));
        assert!(!is_sloped(&[gaussian, "WEBGL2"]));
    }
}
