//! Brings the tones of the picture into a range, whatever the exposure.

pub use crate::tones::ToneRange;

use crate::effect::{Effect, EffectContext, EffectShader, EffectStage, NoUniform};

impl Effect for ToneRange {
    const NAME: &'static str = "tone_range";
    const STAGE: EffectStage = EffectStage::Tone;
    const SHADER: EffectShader = EffectShader {
        path: "bevy_comics::effects::tone_range",
        source: include_str!("tone_range.wgsl"),
        settings: None,
    };
    type Uniform = NoUniform;

    fades_by!(amount);

    fn tones(&self) -> Option<ToneRange> {
        Some(*self)
    }

    fn uniform(&self, _: &EffectContext) -> NoUniform {
        NoUniform::default()
    }

    /// Always true: what is not interpolated says how the range follows the picture, and changes
    /// halfway without a fade.
    fn same_modes(&self, _: &Self) -> bool {
        true
    }
}
