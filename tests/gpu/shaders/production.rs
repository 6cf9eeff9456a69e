//! The lists of variants have what the effects ask for, with many settings.

use bevy::reflect::{
    PartialReflect, ReflectMut,
    enums::{DynamicEnum, DynamicVariant, Enum, VariantInfo},
    structs::Struct,
};
use bevy_comics::{
    effect::{EffectType, FieldRange, Variants},
    lines::Sheet,
};

use super::{
    Definitions,
    effects::{self, NEEDS},
};
use crate::prelude::*;

/// Settings that are tried of every effect.
const TRIES: usize = 400;

/// A definition as the effect names it, with its number.
type Asked = (String, Option<u32>);

/// The entries of variants, which only their debug text shows:
/// `entries: [("", "MODE", Some(1)), ("", "FLAG", None)]`.
fn entries(variants: &Variants) -> Vec<Asked> {
    let text = format!("{variants:?}");
    let entry = |part: &str| {
        let (name, rest) = part.split_once('"').expect("a name in quotes");
        let number: Option<u32> = rest.strip_prefix(", Some(").map(|rest| {
            let digits = rest.split(')').next().unwrap_or_default();
            digits.parse().expect("a number")
        });
        (name.to_owned(), number)
    };
    text.split("(\"\", \"").skip(1).map(entry).collect()
}

#[test]
fn entries_of_variants_are_read() {
    let mut variants = Variants::default();
    variants.flag("FLAG", true);
    variants.flag("OFF", false);
    variants.number("MODE", 12);
    let wanted = [("FLAG".to_owned(), None), ("MODE".to_owned(), Some(12))];
    assert_eq!(entries(&variants), wanted);
}

/// What an effect asks for: its variants, and the definitions of its needs.
fn asked(effect: &dyn AnyEffect, facts: &EffectContext) -> Vec<Asked> {
    let mut variants = Variants::default();
    effect.any_variants(facts, &mut variants);
    let prefix = effect.effect_type().name.to_uppercase();
    let own = entries(&variants).into_iter();
    let mut all: Vec<Asked> = own
        .map(|(name, number)| (format!("{prefix}_{name}"), number))
        .collect();
    for (need, names) in NEEDS {
        // Of both, the means count.
        let counts =
            need != Needs::AUX_SCALAR || !effect.any_needs().contains(Needs::BOX_STATISTICS);
        if effect.any_needs().contains(need) && counts {
            all.extend(names.iter().map(|name| ((*name).to_owned(), None)));
        }
    }
    all
}

fn has(mode: &Definitions, (name, number): &Asked) -> bool {
    (mode.iter()).any(|(own, value)| own == name && value == number)
}

/// Every pair of what the effect asks for is in a listed mode.
fn assert_listed(effect: &dyn AnyEffect, modes: &[Definitions], facts: &EffectContext) {
    let asked = asked(effect, facts);
    for (i, first) in asked.iter().enumerate() {
        for second in &asked[i..] {
            let is_listed = (modes.iter()).any(|mode| has(mode, first) && has(mode, second));
            assert!(
                is_listed,
                "no listed mode has {first:?} and {second:?}: {effect:?}"
            );
        }
    }
}

/// Perspective and parallel views at several scales, on a smooth and on a rough sheet.
fn views() -> Vec<EffectContext> {
    let sheet = Sheet {
        ink_bleed: 1.0,
        dry_brush: 0.5,
        corner: Vec2::ZERO,
        scale: 1.0,
        unit: 1.0,
        seed: 1,
    };
    let mut all = Vec::new();
    for scale_factor in [1.0, 1.5, 2.0] {
        for (depth_reference, sheet) in [(None, None), (Some(3.0), Some(sheet))] {
            let mut facts = EffectContext::default();
            facts.scale_factor = scale_factor;
            facts.depth_reference = depth_reference;
            facts.sheet = sheet;
            all.push(facts);
        }
    }
    all
}

/// A number that settings often have, or an end of its range.
fn number(random: &mut Random, range: FieldRange) -> f64 {
    let common = [0.0, 0.5, 1.0, 2.0, 8.0, range.min, range.max];
    random.pick(&common).clamp(range.min, range.max)
}

/// Changes about half of the fields of a struct.
fn shuffle(value: &mut dyn Struct, random: &mut Random) {
    let Some(TypeInfo::Struct(info)) = value.get_represented_type_info() else {
        return;
    };
    for field in info.iter() {
        let range = FieldRange::of(field);
        if random.unit() < 0.5 {
            continue;
        }
        if let Some(value) = value.field_mut(field.name()) {
            change(value, range, random);
        }
    }
}

fn change(value: &mut dyn PartialReflect, range: Option<FieldRange>, random: &mut Random) {
    if let Some(range) = range {
        let number = number(random, range);
        if let Some(slot) = value.try_downcast_mut::<f32>() {
            *slot = number as f32;
        } else if let Some(slot) = value.try_downcast_mut::<u32>() {
            *slot = number as u32;
        } else if let Some(slot) = value.try_downcast_mut::<Option<f32>>() {
            *slot = (random.unit() < 0.7).then_some(number as f32);
        }
    } else if let Some(slot) = value.try_downcast_mut::<bool>() {
        *slot = random.unit() < 0.5;
    } else {
        match value.reflect_mut() {
            ReflectMut::Struct(inner) => shuffle(inner, random),
            ReflectMut::Enum(mode) => change_mode(mode, random),
            _ => {}
        }
    }
}

/// Sets a mode without fields, or changes the struct in an `Option`.
fn change_mode(value: &mut dyn Enum, random: &mut Random) {
    let Some(TypeInfo::Enum(info)) = value.get_represented_type_info() else {
        return;
    };
    let units = info.iter().filter_map(|variant| match variant {
        VariantInfo::Unit(unit) => Some(unit.name()),
        _ => None,
    });
    let mut names: Vec<&'static str> = units.collect();
    if let Some(inner) = value.field_at_mut(0)
        && let ReflectMut::Struct(inner) = inner.reflect_mut()
    {
        shuffle(inner, random);
        // It mostly stays.
        if random.unit() < 0.7 {
            names.clear();
        }
    }
    if !names.is_empty() {
        let name = random.pick(&names);
        value.apply(&DynamicEnum::new(name, DynamicVariant::Unit));
    }
}

/// The default, and many other settings that are used.
fn settings(effect: &EffectType) -> Vec<Box<dyn AnyEffect>> {
    let mut random = Random::new(effect.name.len() as u64);
    let mut all = vec![(effect.default)()];
    for _ in 0..TRIES {
        let mut value = (effect.default)();
        shuffle(value.as_struct_mut(), &mut random);
        all.push(value.any_sanitized());
    }
    let in_presets = presets::ALL.iter().filter_map(|preset| {
        let style = preset.style().sanitized();
        style.by_name(effect.name).map(AnyEffect::boxed)
    });
    all.extend(in_presets);
    // An effect without strength is not drawn.
    all.retain(|effect| effect.any_strength() > 0.0);
    all
}

#[test]
fn what_effects_ask_for_is_listed() {
    let views = views();
    let types = EffectRegistry::built_in().types();
    for (name, modes) in effects::all() {
        let effect = types.iter().find(|effect| effect.name == name);
        let all = settings(effect.unwrap_or_else(|| panic!("{name} is not an effect")));
        assert!(all.len() > TRIES / 10, "{name}: {} settings", all.len());
        for effect in &all {
            for facts in &views {
                assert_listed(effect.as_ref(), &modes, facts);
            }
        }
    }
}
