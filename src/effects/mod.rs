//! The effects of this crate and their modes, in the order in which they are registered.
//!
//! Each effect has a folder with its settings, their packing and one WGSL function.

/// The WGSL module of an effect, in the effect's folder, and the name of its struct of settings.
macro_rules! shader {
    ($name:literal, $settings:literal) => {
        EffectShader {
            path: concat!("bevy_comics::effects::", $name),
            source: include_str!(concat!($name, ".wgsl")),
            settings: Some($settings),
        }
    };
}

/// The strength of an effect is a field, which also fades it.
macro_rules! fades_by {
    ($field:ident) => {
        fn strength(&self) -> f32 {
            self.$field
        }

        fn faded(self, fraction: f32) -> Self {
            let $field = self.$field * fraction;
            Self { $field, ..self }
        }
    };
}

mod abstraction;
mod black_flats;
mod color_harmony;
mod colorization;
mod contours;
mod depth_layers;
mod desaturation;
mod focus;
mod halftone;
mod hatching;
mod iso_lines;
mod misregistration;
mod outlines;
mod paint;
mod paper;
mod sketch;
mod speed_lines;
mod tone_bands;
mod tone_ramp;
mod tone_range;
mod two_tone;
mod vignette;

use std::sync::LazyLock;

use bevy::app::App;

pub use crate::settings::Equations;

use crate::effect::{EffectPlugin, EffectRegistry, EffectType};

/// One line for each effect: its module, its component, and its other public types.
macro_rules! effects {
    ($($module:ident: $Effect:ident $(, $Other:ident)*;)*) => {
        $(
            pub use $module::{$Effect $(, $Other)*};
        )*

        const TYPES: &[&EffectType] = &[$(EffectType::of::<$Effect>()),*];

        /// Registers the effects, with the plugin that games use for theirs.
        pub(crate) fn add(app: &mut App) {
            $(app.add_plugins(EffectPlugin::<$Effect>::default());)*
        }
    };
}

effects! {
    tone_range: ToneRange;
    abstraction: Abstraction;
    tone_ramp: ToneRamp;
    tone_bands: ToneBands;
    desaturation: Desaturation;
    colorization: Colorization, ColorizationMode;
    color_harmony: ColorHarmony, HarmonyCurve, HarmonyMode;
    depth_layers: DepthLayers, DepthLayer, Granularity, LayerBorders;
    paint: Paint, PaintKernel;
    focus: Focus, FocusAt, FocusStyle;
    misregistration: Misregistration;
    halftone: Halftone, HalftoneMode, ScreenAnchor, ScreenSampling, ScreenShape;
    hatching: Hatching, HatchingAnchor, HatchingGround, HatchingKind, HatchingSource;
    black_flats: BlackFlats;
    contours: Contours, ContourOperator;
    outlines: Outlines;
    sketch: Sketch;
    iso_lines: IsoLines, IsoField;
    two_tone: TwoTone;
    speed_lines: SpeedLines, SpeedLineKind;
    paper: Paper, PaperAnchor;
    vignette: Vignette;
}

impl EffectRegistry {
    /// A registry of this crate's effects, for code that runs without an app.
    pub fn built_in() -> Self {
        static BUILT_IN: LazyLock<EffectRegistry> = LazyLock::new(|| {
            let registry = EffectRegistry::default();
            for effect in TYPES {
                registry.register(effect);
            }
            registry.seal();
            registry
        });
        BUILT_IN.clone()
    }
}

#[cfg(test)]
mod tests;
