//! The variants of every registered effect: what it asks for with many settings, in several views.

use bevy::reflect::{
    PartialReflect, ReflectMut,
    enums::{DynamicEnum, DynamicVariant, Enum, VariantInfo},
    structs::Struct,
};
use bevy_comics::{
    effect::{EffectType, FieldRange, Variants},
    lines::Sheet,
};

use super::{Definitions, flags, optional, product};
use crate::prelude::*;

/// Settings that are tried of every effect. Pairs of modes come up some dozen times.
const TRIES: usize = 1000;

/// An effect with its variants, that of its default first. Each has the definitions of its needs.
pub struct Modes {
    pub effect: &'static EffectType,
    pub modes: Vec<Definitions>,
}

/// All registered effects.
pub fn all() -> &'static [Modes] {
    static ALL: OnceLock<Vec<Modes>> = OnceLock::new();
    ALL.get_or_init(|| {
        let types = EffectRegistry::built_in().types().into_iter();
        types.map(modes).collect()
    })
}

pub fn flag(name: String) -> Definition<'static> {
    (name.leak(), None)
}

/// The definitions of needs.
const NEEDS: [(Needs, &[&str]); 16] = [
    (Needs::MAP, &["MAP", "DEPTH"]),
    (Needs::DEPTH, &["DEPTH"]),
    (Needs::NORMALS, &["NORMALS"]),
    (Needs::IDS, &["OBJECT_IDS"]),
    (Needs::LINES, &["LINES"]),
    (Needs::LINES_ANYWHERE, &["LINES", "LINES_ANYWHERE"]),
    (Needs::LIGHTNESS_CHANGE, &["LIGHTNESS_CHANGE"]),
    (Needs::PICTURE, &["CONTINUED"]),
    (Needs::BLUE_NOISE, &["BLUE_NOISE"]),
    (Needs::BOX_STATISTICS, &["CONTINUED", "BOX_STATISTICS"]),
    (Needs::AUX_SCALAR, &["AUX_SCALAR"]),
    (Needs::DEPTH_BORDERS, &["DEPTH_BORDERS"]),
    (Needs::MIDDLE_DEPTH, &["MIDDLE_DEPTH"]),
    (
        Needs::OBJECT_ANCHORS,
        &["OBJECT_ANCHORS", "OBJECT_IDS", "OBJECT_STYLES"],
    ),
    (Needs::OBJECT_DEPTHS, &["OBJECT_DEPTHS", "OBJECT_IDS"]),
    (Needs::WORLD_ORIGIN, &["WORLD_ORIGIN"]),
];

/// What the lines of a camera add to an effect that draws them.
fn line_forms() -> Vec<Definitions> {
    let in_layers = product(&[
        vec![flags(&[
            "LINE_OWNERS",
            "IN_LAYERS",
            "LAYER_INK",
            "MAP",
            "DEPTH",
        ])],
        optional(&["SURFACE_LINES", "DEPTH_BORDERS"]),
        vec![Vec::new(), flags(&["OBJECT_DEPTHS", "OBJECT_IDS"])],
    ]);
    let plain = vec![
        Vec::new(),
        flags(&["LINE_OWNERS", "SURFACE_LINES"]),
        flags(&["LINE_OWNERS", "EDGE_STYLES"]),
        flags(&["LINE_OWNERS", "EDGE_STYLES", "SURFACE_LINES"]),
    ];
    product(&[[plain, in_layers].concat(), optional(&["OBJECT_STYLES"])])
}

const MISSING: [Needs; 4] = [
    Needs::empty(),
    Needs::OBJECT_ANCHORS,
    Needs::WORLD_ORIGIN,
    Needs::OBJECT_ANCHORS.union(Needs::WORLD_ORIGIN),
];

fn modes(effect: &'static EffectType) -> Modes {
    let views = views();
    let (mut seen, mut modes) = (BTreeSet::new(), Vec::new());
    for settings in settings(effect) {
        for view in &views {
            let variants = variants(settings.as_ref(), view);
            // Whether or not some object has an anchor, and the app a `WorldOrigin`.
            for missing in MISSING {
                let mut asked = variants.clone();
                asked.extend(needs(settings.as_ref(), missing));
                if seen.insert(asked.clone()) {
                    modes.push(asked.into_iter().collect());
                }
            }
        }
    }
    if seen.iter().flatten().any(|(name, _)| *name == "LINES") {
        modes = product(&[modes, line_forms()]);
    }
    assert!(!modes.is_empty(), "{} is never drawn", effect.name);
    Modes { effect, modes }
}

/// The name of an effect, and its variants. Only their debug text shows them:
/// `entries: [("", "MODE", Some(1)), ("", "FLAG", None)]`.
fn variants(effect: &dyn AnyEffect, view: &EffectContext) -> BTreeSet<Definition<'static>> {
    let name = format!("EFFECT_{}", effect.effect_type().name.to_uppercase());
    let mut variants = Variants::default();
    effect.any_variants(view, &mut variants);
    let entry = |part: &str| {
        let (own, rest) = part.split_once('"').expect("a name in quotes");
        let number = rest.strip_prefix(", Some(").map(|rest| {
            let digits = rest.split(')').next().unwrap_or_default();
            digits.parse().expect("a number")
        });
        let name: &'static str = format!("{name}_{own}").leak();
        (name, number)
    };
    let text = format!("{variants:?}");
    let mut all: BTreeSet<_> = text.split("(\"\", \"").skip(1).map(entry).collect();
    all.insert(flag(name));
    all
}

/// The definitions of what an effect needs.
fn needs(effect: &dyn AnyEffect, missing: Needs) -> Definitions {
    let mut needs = effect.any_needs() - missing;
    // Of both, the means count.
    if needs.contains(Needs::BOX_STATISTICS) {
        needs.remove(Needs::AUX_SCALAR);
    }
    let needed = NEEDS.iter().filter(|(need, _)| needs.contains(*need));
    let tones = effect.any_tones().map(|_| ("TONE_RANGE", None));
    needed
        .flat_map(|(_, names)| flags(names))
        .chain(tones)
        .collect()
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
            let mut view = EffectContext::default();
            view.scale_factor = scale_factor;
            view.depth_reference = depth_reference;
            view.sheet = sheet;
            all.push(view);
        }
    }
    all
}

/// The default, those of presets, and many others. An effect without strength is not drawn.
fn settings(effect: &EffectType) -> Vec<Box<dyn AnyEffect>> {
    let mut random = Random::new(effect.name.len() as u64);
    let mut all = vec![(effect.default)()];
    let in_presets = presets::ALL.iter().filter_map(|preset| {
        let style = preset.style().sanitized();
        style.by_name(effect.name).map(AnyEffect::boxed)
    });
    all.extend(in_presets);
    for _ in 0..TRIES {
        let mut value = (effect.default)();
        shuffle(value.as_struct_mut(), &mut random);
        all.push(value.any_sanitized());
    }
    all.retain(|effect| effect.any_strength() > 0.0);
    all
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
        // Numbers that settings often have, and the ends of the range.
        let common = [0.0, 0.5, 1.0, 2.0, 8.0, range.min, range.max];
        let number = random.pick(&common).clamp(range.min, range.max);
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

/// Sets a mode without fields, or changes the struct in an `Option`, which mostly stays.
fn change_mode(value: &mut dyn Enum, random: &mut Random) {
    let Some(TypeInfo::Enum(info)) = value.get_represented_type_info() else {
        return;
    };
    if let Some(inner) = value.field_at_mut(0)
        && let ReflectMut::Struct(inner) = inner.reflect_mut()
    {
        shuffle(inner, random);
        if random.unit() < 0.7 {
            return;
        }
    }
    let units = info.iter().filter_map(|variant| match variant {
        VariantInfo::Unit(unit) => Some(unit.name()),
        _ => None,
    });
    let names: Vec<&'static str> = units.collect();
    if !names.is_empty() {
        let name = random.pick(&names);
        value.apply(&DynamicEnum::new(name, DynamicVariant::Unit));
    }
}
