//! What lies between two styles.

use super::ComicStyle;
use crate::{
    depth::{DepthMap, RangeSmoothing},
    effect::EffectSet,
    settings::{blend_fields, blend_ratio},
};

impl ComicStyle {
    /// The style that lies `t` of the way from this one to another: this one
    /// at 0 and below, the other at 1 and above. As a picture it is continuous
    /// in `t`.
    ///
    /// * Numbers are interpolated, colors in `OKLab`; an effect that only one
    ///   of the two has fades in or out.
    /// * An effect whose mode changes (an operator, the equations, the number of tone bands) fades
    ///   out until `t = 0.5`, changes there, and fades in.
    /// * When the mapping of the depth map changes, every effect that reads
    ///   the map does so.
    /// * Between two pages, the height is interpolated by ratio. Between a page and none, the unit of
    ///   lengths switches at `t = 0.5`: there, lines and dots jump to another size.
    /// * Settings that cannot be interpolated switch at `t = 0.5`: the strokes of a sketch and
    ///   their rate, `despike`, `locked`.
    /// * What a style does besides is no part of this: settings of the camera switch at `t = 1`, and
    ///   so do parts of a scene other than numbers and colors of lights.
    ///
    /// Both styles count as complete. Lay a partial one [`over`](Self::over) the camera's own style
    /// first.
    #[must_use]
    pub fn blend(&self, other: &Self, t: f32) -> Self {
        if t.is_nan() || t <= 0.0 {
            return self.clone();
        }
        if t >= 1.0 {
            return other.clone();
        }
        let (a, b) = (self.sanitized(), other.sanitized());
        let (map_a, map_b) = (
            a.depth_map.unwrap_or_default(),
            b.depth_map.unwrap_or_default(),
        );
        let remapped = map_a.flip != map_b.flip
            || std::mem::discriminant(&map_a.mapping) != std::mem::discriminant(&map_b.mapping);
        let named = if t < 0.5 { &a } else { &b };
        let (from, to) = (a.with_implied(), b.with_implied());
        let mut effects = EffectSet::default();
        for effect in from.iter().chain(to.iter()) {
            let effect = effect.effect_type();
            if effects.by_name(effect.name).is_none()
                && let Some(blended) = (effect.blend)(
                    from.by_name(effect.name),
                    to.by_name(effect.name),
                    t,
                    remapped,
                )
            {
                effects.insert(blended);
            }
        }
        Self {
            name: named.name.clone(),
            depth_map: (a.depth_map.is_some() || b.depth_map.is_some())
                .then(|| mixed_map(map_a, map_b, t)),
            page: match (a.page, b.page) {
                (Some(a), Some(b)) => Some(blend_ratio(a, b, t)),
                _ => named.page,
            },
            effects,
            camera: a.camera,
            #[cfg(feature = "toon")]
            scene: match (&a.scene, &b.scene) {
                (Some(a), Some(b)) => Some(a.mixed(b, t)),
                (scene, _) => scene.clone(),
            },
            ..Self::new()
        }
        // Rounding takes interpolated numbers out of their ranges, and what is left of a faded
        // setting can be nothing.
        .sanitized()
    }

    /// The effects, those among them that others draw with.
    fn with_implied(&self) -> EffectSet {
        let mut all = self.effects.clone();
        for effect in self.effects.iter().filter_map(|e| e.any_implied()) {
            if all.by_name(effect.name()).is_none() {
                all.insert(effect);
            }
        }
        all
    }
}

/// Without smoothing, a map is blended as with one that changes nothing.
fn mixed_map(a: DepthMap, b: DepthMap, t: f32) -> DepthMap {
    let is_smoothed = a.smoothing.is_some() || b.smoothing.is_some();
    let [from, to] = [a, b].map(|map| map.smoothing.unwrap_or(RangeSmoothing::OFF));
    DepthMap {
        smoothing: is_smoothed.then(|| blend_fields(&from, &to, t)),
        ..blend_fields(&a, &b, t)
    }
}
