//! The effects of this crate, in the order in which they apply to a pixel. Each
//! is a folder: settings, packing and one WGSL function.

use std::sync::LazyLock;

use bevy::{
    app::App,
    reflect::{Reflect, std_traits::ReflectDefault},
};
use serde::{Deserialize, Serialize};

use crate::effect::{EffectPlugin, EffectRegistry, EffectType};

/// One line for each effect: its module, its component, and its other types.
macro_rules! effects {
    ($($module:ident: $Effect:ident $(, $Other:ident)*;)*) => {
        $(
            mod $module;
            pub use $module::{$Effect $(, $Other)*};
        )*

        const TYPES: &[&EffectType] = &[$(EffectType::of::<$Effect>()),*];

        /// Registers them, by the plugin that games use for their own.
        pub(crate) fn add(app: &mut App) {
            $(app.add_plugins(EffectPlugin::<$Effect>::default());)*
        }
    };
}

effects! {
    tone_bands: ToneBands, ToneBandMethod;
    desaturation: Desaturation;
    colorization: Colorization, ColorizationMode;
    black_flats: BlackFlats;
    contours: Contours, ContourForm, ContourOperator;
    outlines: Outlines;
    sketch: Sketch;
    vignette: Vignette;
}

impl EffectRegistry {
    /// The effects of this crate, for what runs without an app.
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

/// Which form of a colour effect is computed.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash)]
pub enum ColorMethod {
    /// The paper's intention without its flaws: luminance is kept, hues blend
    /// without wrapping, greys take the atmosphere.
    #[default]
    Corrected,
    /// The paper's equations as printed, on HSV of the display codes.
    Faithful,
}
