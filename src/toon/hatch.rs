//! Strokes on the toon material.

use bevy::{render::render_resource::ShaderType, shader::ShaderDefVal};

use super::ToonLight;
use crate::{
    effect::{Effect, Strokes},
    effects::{Hatching, HatchingAnchor, HatchingKind},
    settings::clamp_or_default,
};

/// `Hatch` in `hatch.wgsl`.
#[derive(ShaderType, Clone, Copy, Debug, Default, PartialEq)]
pub struct HatchUniform {
    strokes: Strokes,
    factor: f32,
    rate: f32,
    repeat: f32,
    unused: f32,
}

/// The strokes of a material that are seen, in range.
fn seen(light: &ToonLight) -> Option<Hatching> {
    let hatching = light.hatching.map(Effect::sanitized);
    hatching.filter(|hatching| hatching.opacity > 0.0)
}

impl From<&ToonLight> for HatchUniform {
    fn from(light: &ToonLight) -> Self {
        let Some(hatching) = seen(light) else {
            return Self::default();
        };
        Self {
            // In its shader, lengths are multiplied by the scale of the view.
            strokes: hatching.strokes(1.0, 0),
            factor: hatching.at_near,
            rate: hatching.rate,
            repeat: clamp_or_default(light.art_map_repeat, 4.0, 0.01, 1000.0),
            unused: 0.0,
        }
    }
}

/// What strokes are drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum HatchKey {
    Page(HatchingKind),
    Rest(HatchingKind),
    ArtMap,
}

impl HatchKey {
    /// That of a material; `None` if it has no strokes.
    pub(super) fn of(light: &ToonLight) -> Option<Self> {
        let hatching = seen(light)?;
        if light.art_map.is_some() {
            return Some(Self::ArtMap);
        }
        Some(match hatching.anchor {
            HatchingAnchor::Page => Self::Page(hatching.kind),
            HatchingAnchor::Object => Self::Rest(hatching.kind),
        })
    }

    /// Whether the vertex shader outputs the position of a vertex at rest.
    /// `others`: the definitions of the mesh and the view.
    pub(super) fn needs_rest(self, others: &[ShaderDefVal]) -> bool {
        match self {
            Self::Page(_) => false,
            Self::Rest(_) => true,
            Self::ArtMap => !others.contains(&"VERTEX_UVS_A".into()),
        }
    }

    /// The shader definitions, in addition to others.
    pub(super) fn definitions(self, others: &[ShaderDefVal]) -> Vec<ShaderDefVal> {
        let mut all = vec!["HATCHED".into()];
        if self.needs_rest(others) {
            all.push("HATCH_REST".into());
        }
        match self {
            Self::ArtMap => {
                all.push("HATCH_ART_MAP".into());
                if others.contains(&"WEBGL2".into()) {
                    all.push("NO_TEXTURE_LEVELS".into());
                }
            }
            Self::Page(HatchingKind::Dots) | Self::Rest(HatchingKind::Dots) => {
                all.push("HATCH_DOTS".into());
            }
            _ => {}
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(hatching: Hatching) -> ToonLight {
        ToonLight {
            hatching: Some(hatching),
            ..ToonLight::default()
        }
    }

    #[test]
    fn strokes_that_are_not_seen_are_not_compiled() {
        assert_eq!(HatchKey::of(&ToonLight::default()), None);
        let unseen = Hatching {
            opacity: 0.0,
            ..Hatching::default()
        };
        assert_eq!(HatchKey::of(&with(unseen)), None);
        let map = ToonLight {
            art_map: Some(bevy::asset::Handle::default()),
            ..with(Hatching::default())
        };
        let key = HatchKey::of(&map).expect("strokes");
        // A map lies on texture coordinates, or on the mesh at rest.
        assert!(key.needs_rest(&[]));
        assert!(!key.needs_rest(&["VERTEX_UVS_A".into()]));
    }
}
