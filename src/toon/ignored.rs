//! Names what toon materials ask for and do not get.

use bevy::{pbr::ScreenSpaceReflections, prelude::*};

use super::ToonMaterial;

/// The properties of a material that the toon material does not draw.
pub(super) fn ignored(material: &StandardMaterial) -> Vec<&'static str> {
    [
        ("clearcoat", material.clearcoat > 0.0),
        ("anisotropy_strength", material.anisotropy_strength != 0.0),
        ("diffuse_transmission", material.diffuse_transmission > 0.0),
        (
            "specular_transmission",
            material.specular_transmission > 0.0,
        ),
    ]
    .into_iter()
    .filter_map(|(name, is_used)| is_used.then_some(name))
    .collect()
}

/// Warns of the first material that has such properties.
pub(super) fn warn_of_ignored(
    mut events: MessageReader<AssetEvent<ToonMaterial>>,
    materials: Res<Assets<ToonMaterial>>,
) {
    for event in events.read() {
        let (AssetEvent::Added { id } | AssetEvent::Modified { id }) = event else {
            continue;
        };
        let names = materials
            .get(*id)
            .map_or_else(Vec::new, |material| ignored(&material.base));
        if !names.is_empty() {
            warn_once!(
                "a `ToonMaterial` sets {}, which toon materials do not draw",
                names.join(", ")
            );
        }
    }
}

/// Warns of a camera with reflections of the screen, which forward materials do not have.
pub(super) fn warn_of_reflections(
    cameras: Query<(), With<ScreenSpaceReflections>>,
    materials: Res<Assets<ToonMaterial>>,
) {
    if !cameras.is_empty() && !materials.is_empty() {
        warn_once!(
            "a camera has `ScreenSpaceReflections`, which a `ToonMaterial` does not draw: it is drawn \
             forward"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn properties_without_effect_are_named() {
        let none = StandardMaterial::default();
        assert!(ignored(&none).is_empty());
        let some = StandardMaterial {
            clearcoat: 0.5,
            specular_transmission: 1.0,
            ..none
        };
        assert_eq!(ignored(&some), ["clearcoat", "specular_transmission"]);
    }
}
