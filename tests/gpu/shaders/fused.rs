//! The fused pass: modes of effects, combinations of effects, views.

use bevy_comics_testkit::wgsl::{check as check_text, module_with, written};

use super::{
    Definitions,
    covering::fewest,
    effects::{self, Modes, flag},
    flags, numbers, optional, parts, product,
};
use crate::prelude::*;

/// How many combinations of effects are composed; a quick test composes every 50th.
const COMBINATIONS: usize = 1000;

/// The definitions that the plugin sets for a pass. Those about depth are left out where nothing
/// reads it; one number is always set.
pub fn of_pass(parts: &[&[Definition<'static>]]) -> Definitions {
    let mut all = parts.concat();
    let has = |wanted: &[&str]| all.iter().any(|(name, _)| wanted.contains(name));
    let (map, depth) = (has(&["MAP"]), has(&["DEPTH"]));
    let samples = has(&["DEPTH", "NORMALS", "OBJECT_IDS"]);
    let has_flags = has(&["MAP_FLAGS"]);
    all.retain(|(name, _)| match *name {
        "VISIBLE_RANGE" => map,
        "OBLIQUE" => depth,
        "MULTISAMPLED" => samples,
        _ => true,
    });
    if !has_flags {
        all.push(("MAP_FLAGS", Some(0)));
    }
    all
}

/// Every mode of every effect, and what views and passes set.
pub fn variants() -> Vec<Definitions> {
    let modes = effects::all().iter().flat_map(|effect| &effect.modes);
    [
        modes.cloned().collect::<Vec<_>>(),
        views(),
        debug_views(),
        parts::variants(),
    ]
    .concat()
}

/// Composes the fused pass with each of these.
fn check(variants: &[Definitions]) {
    let source = EffectRegistry::built_in().shader();
    for definitions in variants {
        if let Err(error) = module_with(&source, definitions) {
            panic!("{definitions:?}: {error}");
        }
    }
}

/// Every storage of the picture and every projection, sampling and range of depth.
fn views() -> Vec<Definitions> {
    let stored = [&[][..], &["STORED_SRGB"], &["STORED_OKLAB"]].map(flags);
    product(&[
        optional(&[
            "MULTISAMPLED",
            "OBLIQUE",
            "VISIBLE_RANGE",
            "SAME_SIZE",
            "COMPOSITE",
        ]),
        stored.to_vec(),
        numbers("MAP_FLAGS", 0..4),
    ])
}

/// Some of the views, which have every choice, and the first one of a plain camera.
fn some_views() -> Vec<Definitions> {
    let named = |view: &Definitions, wanted: &str| view.iter().any(|(name, _)| *name == wanted);
    let plain = views().into_iter().find(|view| {
        named(view, "SAME_SIZE") && named(view, "VISIBLE_RANGE") && !named(view, "MULTISAMPLED")
    });
    let plain = plain.expect("a view of one sample with a range");
    views().into_iter().step_by(65).chain([plain]).collect()
}

/// Every mode of every effect, in some views.
fn modes() -> Vec<Definitions> {
    let modes = effects::all().iter().flat_map(|effect| &effect.modes);
    let modes: Vec<_> = modes.cloned().chain([Vec::new()]).collect();
    let all = product(&[modes, some_views()]);
    all.iter().map(|parts| of_pass(&[parts])).collect()
}

/// All effects without their variants: what these would set is read from the settings.
fn read() -> Definitions {
    let modes = effects::all()
        .iter()
        .flat_map(|effect| effect.modes[0].clone());
    let is_kept =
        |(name, number): &Definition| number.is_none() && !name.starts_with("EFFECT_SKETCH");
    of_pass(&[&modes.filter(is_kept).collect::<Definitions>()])
}

/// Random modes of about half of the effects in a random view, and with what effects of a game
/// may read in addition.
fn combinations() -> Vec<Definitions> {
    let mut random = Random::new(1);
    let views = views();
    let more = optional(&["NORMALS", "OBJECT_IDS", "DEPTH"]);
    let mut combination = |_| {
        let all = effects::all().iter();
        let chosen: Vec<&Modes> = all.filter(|_| random.unit() < 0.5).collect();
        let is_replaced = |name| {
            chosen
                .iter()
                .any(|other| other.effect.replaces.contains(&name))
        };
        let drawn = chosen
            .iter()
            .filter(|chosen| !is_replaced(chosen.effect.name));
        let modes: Vec<Definitions> = drawn.map(|drawn| random.pick(&drawn.modes)).collect();
        of_pass(&[&modes.concat(), &random.pick(&views), &random.pick(&more)])
    };
    (0..COMBINATIONS).map(&mut combination).collect()
}

/// Every debug view: on a camera without effects, and with all effects, among them outlines or a
/// sketch.
fn debug_views() -> Vec<Definitions> {
    let shared = DebugView::SHARED.iter().map(|view| match view {
        DebugView::DepthMap => flags(&["VIEW_DEPTH_MAP", "MAP", "DEPTH"]),
        DebugView::RawRange => flags(&["VIEW_RAW_RANGE", "MAP", "DEPTH"]),
        DebugView::Silhouettes => flags(&["VIEW_SILHOUETTES", "LINES"]),
        DebugView::Creases => flags(&["VIEW_CREASES", "LINES"]),
        DebugView::ObjectIds => flags(&["VIEW_OBJECT_IDS", "OBJECT_IDS"]),
        DebugView::Saturation => flags(&["VIEW_SATURATION"]),
        DebugView::Difference => flags(&["VIEW_DIFFERENCE"]),
        _ => panic!("{view:?} has no definitions here"),
    });
    let of_effects = effects::all()
        .iter()
        .filter(|modes| modes.effect.view.is_some());
    let of_effects = of_effects.map(|Modes { effect, modes }| {
        let view = flag(format!("VIEW_EFFECT_{}", effect.name.to_uppercase()));
        [&[("VIEW_EFFECT", None), view], &modes[0][..]].concat()
    });
    let views: Vec<Definitions> = shared.chain(of_effects).collect();
    let without = |left_out: &str| -> Definitions {
        let drawn = effects::all()
            .iter()
            .filter(|modes| modes.effect.name != left_out);
        drawn.flat_map(|drawn| drawn.modes[0].clone()).collect()
    };
    let all = product(&[
        views,
        vec![Vec::new(), without("outlines"), without("sketch")],
        optional(&["MULTISAMPLED", "OBLIQUE", "COMPOSITE"]),
    ]);
    let of_view = |parts: &Definitions| of_pass(&[parts, &[("DEBUG_VIEW", None)]]);
    all.iter().map(of_view).collect()
}

/// Each effect alone, with everything that its modes set, in some view; and all without variants at
/// once.
#[test]
fn every_effect_composes_and_validates() {
    let views = some_views();
    let mut all = vec![of_pass(&[]), read()];
    for effect in effects::all() {
        let modes = fewest(effect.modes.clone()).into_iter().enumerate();
        all.extend(modes.map(|(k, mode)| of_pass(&[&mode, &views[k % views.len()]])));
    }
    check(&all);
}

#[test]
#[ignore = "long: some thousand shaders"]
fn every_mode_of_every_effect_composes_and_validates() {
    check(&modes());
}

#[test]
fn effects_compose_and_validate_together() {
    let some: Vec<Definitions> = combinations().into_iter().step_by(50).collect();
    check(&some);
}

#[test]
#[ignore = "long: a thousand shaders"]
fn many_combinations_of_effects_compose_and_validate() {
    check(&combinations());
}

/// Browsers get shaders as text again, without attributes of structs: some modes of each effect.
#[test]
fn shaders_that_are_written_as_text_are_valid() {
    let all = effects::all().iter();
    check_written(all.flat_map(|Modes { modes, .. }| [&modes[0], &modes[modes.len() - 1]]));
}

#[test]
#[ignore = "long: every mode, written and read"]
fn shaders_of_every_mode_are_valid_as_text() {
    check_written(effects::all().iter().flat_map(|effect| &effect.modes));
}

fn check_written<'a>(modes: impl Iterator<Item = &'a Definitions>) {
    let source = EffectRegistry::built_in().shader();
    let modes: Vec<Definitions> = modes.cloned().collect();
    // Each mode with the next: structs of all sizes follow one another.
    let mut pairs: Vec<Definitions> = modes.windows(2).map(<[_]>::concat).collect();
    pairs.extend(modes);
    // A sketch replaces the outlines.
    let has = |pair: &Definitions, name| pair.iter().any(|(own, _)| *own == name);
    pairs.retain(|pair| !(has(pair, "EFFECT_SKETCH") && has(pair, "EFFECT_OUTLINES")));
    for mut definitions in pairs {
        definitions.sort_unstable();
        definitions.dedup_by_key(|(name, _)| *name);
        definitions.push(("MAP_FLAGS", Some(0)));
        let module = module_with(&source, &definitions);
        let module = module.unwrap_or_else(|error| panic!("{definitions:?}: {error}"));
        if let Err(error) = check_text(&written(&module)) {
            panic!("{definitions:?}: {error}");
        }
    }
}

/// Everything that passes and parts set.
#[test]
fn parts_and_passes_of_a_plan_compose_and_validate() {
    check(&fewest(parts::variants()));
}

#[test]
#[ignore = "long: every pass in every form"]
fn every_part_and_pass_of_a_plan_composes_and_validates() {
    check(&parts::variants());
}

/// Each view with some effects and in some forms, of which there are 3 and 8.
#[test]
fn debug_views_compose_and_validate() {
    let some: Vec<Definitions> = debug_views().into_iter().step_by(5).collect();
    check(&some);
}

#[test]
#[ignore = "long: every form; quick test shaders::fused::debug_views_compose_and_validate"]
fn every_debug_view_composes_and_validates() {
    check(&debug_views());
}
