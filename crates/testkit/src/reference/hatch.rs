//! Reference of `toon/hatch.wgsl`.

use bevy_comics::Hatching;

use super::hatching::Hatch;

/// The darkness of strokes where a fraction of all light arrives.
pub fn hatch_tone(settings: &Hatching, arriving: f64, all: f64) -> f64 {
    let fraction = if all > 0.0 { arriving / all } else { 0.0 };
    let tone = Hatch::new(settings).tone(fraction.clamp(0.0, 1.0).sqrt());
    tone * f64::from(settings.at_near)
}
