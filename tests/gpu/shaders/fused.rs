//! The fused pass: modes of effects, combinations of effects, views.

use bevy_comics_testkit::wgsl::{check as check_text, module_with, written};

use super::{
    Definitions,
    covering::fewest,
    effects::{self, debug_views, line_effects, picture_effects},
    flags, optional, parts, subsets,
};
use crate::prelude::*;

/// The definitions that the plugin sets for a pass. Those about depth are left out where nothing
/// reads it; one number is always set.
pub fn of_pass(parts: &[&[Definition<'static>]]) -> Definitions {
    let mut all = parts.concat();
    let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
    let depth = names.contains(&"DEPTH");
    all.retain(|(name, _)| match *name {
        "VISIBLE_RANGE" => names.contains(&"MAP"),
        "OBLIQUE" => depth,
        "MULTISAMPLED" => depth || names.contains(&"NORMALS") || names.contains(&"OBJECT_IDS"),
        _ => true,
    });
    if !names.contains(&"MAP_FLAGS") {
        all.push(("MAP_FLAGS", Some(0)));
    }
    all
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

/// Everything that the tests of this file and of `parts` compose, but for texts that are read again.
pub fn variants() -> Vec<Definitions> {
    [
        modes(),
        vec![read()],
        combinations(),
        forms_of_views(),
        views_of_effects(),
        parts::variants(),
    ]
    .concat()
}

/// Storage of the picture and kind of projection, some of each.
fn views() -> Vec<Definitions> {
    let view = |names: &[&'static str], map_flags| {
        [flags(names), vec![("MAP_FLAGS", Some(map_flags))]].concat()
    };
    vec![
        view(&["SAME_SIZE"], 0),
        view(&["SAME_SIZE", "VISIBLE_RANGE", "STORED_SRGB"], 2),
        view(&["VISIBLE_RANGE", "MULTISAMPLED", "FINISH"], 0),
        view(
            &["SAME_SIZE", "OBLIQUE", "VISIBLE_RANGE", "STORED_OKLAB"],
            2,
        ),
        view(&["SAME_SIZE", "MULTISAMPLED", "OBLIQUE", "STORED_SRGB"], 1),
        view(&["VISIBLE_RANGE", "STORED_OKLAB", "FINISH"], 3),
    ]
}

/// Every mode of every effect, in every view.
fn modes() -> Vec<Definitions> {
    let views = views();
    let mut all = vec![of_pass(&[])];
    for (_, modes) in effects::all() {
        for mode in &modes {
            all.extend(views.iter().map(|view| of_pass(&[mode, view])));
        }
    }
    all
}

/// Effects without variants: their modes are read from the settings.
fn read() -> Definitions {
    let modes = effects::all().into_iter();
    let mut read: Definitions = modes.flat_map(|(_, modes)| modes[0].clone()).collect();
    read.retain(|(name, number)| number.is_none() && !name.starts_with("SKETCH"));
    read
}

/// Combinations of effects, with another mode each time.
fn combinations() -> Vec<Definitions> {
    let views = views();
    let pictures = picture_effects();
    let lines = line_effects();
    let mut all = Vec::new();
    let mut turn = 0;
    for chosen in subsets(&[0, 1, 2, 3, 4, 5, 6]) {
        for line in [None, Some(&lines[0]), Some(&lines[1])] {
            for view in &views {
                turn += 1;
                let more = [&[][..], &[7], &[8], &[9], &[7, 8, 9]][turn % 5];
                let chosen = chosen.iter().chain(more);
                let modes = chosen.map(|i| &pictures[*i]).chain(line);
                let mut parts: Vec<&[Definition]> = modes
                    .map(|(_, modes)| &modes[turn % modes.len()][..])
                    .collect();
                parts.push(view);
                all.push(of_pass(&parts));
            }
        }
    }
    all
}

fn forms_of_views() -> Vec<Definitions> {
    let pictures = picture_effects();
    let lines = line_effects();
    let mut all = Vec::new();
    let forms = [
        "MULTISAMPLED",
        "OBLIQUE",
        "VISIBLE_RANGE",
        "SAME_SIZE",
        "FINISH",
    ];
    let mut turn = 0;
    for form in optional(&forms) {
        for stored in [&[][..], &["STORED_SRGB"], &["STORED_OKLAB"]] {
            for line in &lines {
                turn += 1;
                let map = [("MAP_FLAGS", Some(turn as u32 % 4))];
                let stored = flags(stored);
                let modes = pictures.iter().chain([line]);
                let mut parts: Vec<&[Definition]> = modes
                    .map(|(_, modes)| &modes[turn % modes.len()][..])
                    .collect();
                parts.extend([&form[..], &stored, &map]);
                all.push(of_pass(&parts));
            }
        }
    }
    // What effects of a game may read in addition.
    for needs in optional(&[
        "NORMALS",
        "OBJECT_IDS",
        "DEPTH",
        "MULTISAMPLED",
        "SAME_SIZE",
    ]) {
        all.push(of_pass(&[&needs]));
    }
    all
}

/// Every debug view: on a camera without effects, with outlines, and with a sketch.
fn views_of_effects() -> Vec<Definitions> {
    let pictures = picture_effects();
    let lines = line_effects();
    let everything: Vec<&[Definition]> = pictures.iter().map(|(_, modes)| &modes[0][..]).collect();
    let mut all = Vec::new();
    for view in debug_views() {
        for form in optional(&["MULTISAMPLED", "OBLIQUE", "FINISH"]) {
            let view = [&view[..], &flags(&["DEBUG_VIEW"])].concat();
            all.push(of_pass(&[&view, &form]));
            for (_, modes) in &lines {
                let mut parts = everything.clone();
                parts.extend([&view[..], &form, &modes[modes.len() - 1]]);
                all.push(of_pass(&parts));
            }
        }
    }
    all
}

#[test]
fn every_effect_of_the_crate_is_composed() {
    let all = effects::all();
    let mut composed: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
    let types = EffectRegistry::built_in().types();
    let mut known: Vec<&str> = types.iter().map(|effect| effect.name).collect();
    composed.sort_unstable();
    known.sort_unstable();
    assert_eq!(composed, known);
    let of_effects = types.iter().filter(|effect| effect.view.is_some()).count();
    assert_eq!(debug_views().len(), DebugView::SHARED.len() + of_effects);
}

/// Each effect alone, with everything that its modes set, in some view; and all without variants at once.
#[test]
fn every_effect_composes_and_validates() {
    let views = views();
    let mut all = vec![of_pass(&[])];
    for (_, modes) in effects::all() {
        let chosen = fewest(modes);
        let of = |(k, mode): (usize, &Definitions)| of_pass(&[mode, &views[k % views.len()]]);
        all.extend(chosen.iter().enumerate().map(of));
    }
    check(&all);
    check(&[read()]);
}

#[test]
#[ignore = "long: some thousand shaders"]
fn every_mode_of_every_effect_composes_and_validates() {
    check(&modes());
}

/// Of all combinations, some of few and some of many effects.
#[test]
fn effects_compose_and_validate_together() {
    let all = combinations();
    let some: Vec<Definitions> = all.iter().step_by(97).chain(all.last()).cloned().collect();
    check(&some);
}

#[test]
#[ignore = "long: some thousand shaders"]
fn every_combination_of_effects_composes_and_validates() {
    check(&combinations());
}

/// Browsers get shaders as text again, without attributes of structs: some modes of each effect.
#[test]
fn shaders_that_are_written_as_text_are_valid() {
    let all = effects::all().into_iter();
    check_written(all.flat_map(|(_, modes)| [modes[0].clone(), modes[modes.len() - 1].clone()]));
}

#[test]
#[ignore = "long: every mode, written and read"]
fn shaders_of_every_mode_are_valid_as_text() {
    check_written(effects::all().into_iter().flat_map(|(_, modes)| modes));
}

fn check_written(modes: impl Iterator<Item = Definitions>) {
    let source = EffectRegistry::built_in().shader();
    let modes: Vec<Definitions> = modes.collect();
    // Each mode with the next: structs of all sizes follow one another.
    let mut pairs: Vec<Definitions> = modes.windows(2).map(<[_]>::concat).collect();
    pairs.extend(modes);
    // A sketch replaces the outlines.
    let has = |pair: &Definitions, name| pair.iter().any(|(own, _)| *own == name);
    pairs.retain(|pair| !(has(pair, "SKETCH") && has(pair, "OUTLINES")));
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

#[test]
fn forms_of_views_compose_and_validate() {
    let some: Vec<Definitions> = forms_of_views().into_iter().step_by(7).collect();
    check(&some);
}

#[test]
#[ignore = "long: every form, with all effects"]
fn every_form_of_a_view_composes_and_validates() {
    check(&forms_of_views());
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

#[test]
fn every_debug_view_composes_and_validates() {
    check(&views_of_effects());
}
