//! What holds for every effect.

use crate::{
    effect::{AnyEffect, EffectContext, EffectRegistry},
    presets,
    settings::tests::non_finite::{Numbers, cases, in_time, scramble, wrong},
};

/// Every effect, with its default settings and with those of the presets.
fn effects() -> Vec<Box<dyn AnyEffect>> {
    let types = EffectRegistry::built_in().types();
    let mut all: Vec<Box<dyn AnyEffect>> = types.iter().map(|effect| (effect.default)()).collect();
    for preset in presets::ALL {
        let style = preset.style();
        all.extend(style.effects().map(|effect| effect.boxed()));
    }
    all
}

/// The word of the uniform of `SpeedLines` that is no number: the seed has all of its bits.
const SEED: (&str, usize) = ("speed_lines", 13);

fn assert_packed(effect: &dyn AnyEffect, view: &EffectContext) {
    let name = effect.name();
    for (k, word) in effect.uniform_bytes(view).chunks_exact(4).enumerate() {
        let x = f32::from_le_bytes([word[0], word[1], word[2], word[3]]);
        let is_right = x.is_finite() || (name, k) == SEED;
        assert!(is_right, "word {k} is {x}: {effect:?}");
    }
}

/// Whatever the numbers of an effect are, those that are used are in their ranges, and those that
/// are packed for the GPU are finite.
#[test]
fn any_number_of_an_effect_is_clamped() {
    let (effects, view) = (effects(), EffectContext::default());
    let mut numbers = Numbers::new(1);
    for case in 0..cases() {
        let mut effect = effects[case % effects.len()].clone();
        scramble(
            effect.as_struct_mut().as_partial_reflect_mut(),
            &mut numbers,
        );
        let used = in_time(&effect, || effect.any_sanitized());
        let found = wrong(used.as_struct().as_partial_reflect(), None);
        assert_eq!(found, None, "{effect:?}");
        let again = used.any_sanitized();
        assert!(again.equals(&*used), "{used:?} became {again:?}");
        assert!((0.0..=1.0).contains(&used.any_strength()), "{used:?}");
        assert_packed(&*used, &view);
    }
}
