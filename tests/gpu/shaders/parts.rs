//! The passes of a plan that is divided, and the areas that its last pass draws: `DrawnArea` of the
//! crate.

use super::{
    Definitions,
    covering::{fewest, has, push_if, rows},
    effects::{self, Modes, flag},
    flags,
    fused::of_pass,
    product,
};
use crate::prelude::*;

pub fn variants() -> Vec<Definitions> {
    [divided(), overlays(), bases(), masked()].concat()
}

/// The passes of a plan whose effects read the picture at other places: those of each effect, those
/// that draw the means over boxes or the numbers that it reads, and earlier ones, which have the
/// settings of the effect but not the effect.
fn divided() -> Vec<Definitions> {
    const FORMS: &[&str] = &[
        "| CONTINUED",
        "| EARLIER_PASS",
        "| INSIDE",
        "| COMPOSITE",
        "| MULTISAMPLED",
        "| UNSTYLED_COLORS",
        "| UNSTYLED_PRINT",
    ];
    let ids = flags(&["OBJECT_STYLES", "OBJECT_IDS", "UNSTYLED"]);
    let forms = rows(FORMS, |names| names);
    let effects = effects::all().iter().flat_map(passes_of).collect();
    let all = product(&[effects, forms]);
    all.iter().map(|parts| of_pass(&[parts, &ids])).collect()
}

fn passes_of(Modes { effect, modes }: &Modes) -> Vec<Definitions> {
    let name = format!("EFFECT_{}", effect.name.to_uppercase());
    let mut all = fewest(modes.clone());
    let reads = |mode: &Definitions, what| mode.contains(&(what, None));
    for mode in all.clone() {
        if reads(&mode, "BOX_STATISTICS") {
            let means = [
                flag("DRAWS_BOX_STATISTICS".into()),
                flag(format!("BOXES_{name}")),
            ];
            let down = [&means[..], &flags(&["BOX_STATISTICS_DOWN"])].concat();
            let mut across = [&mode[..], &means].concat();
            across.retain(|(name, _)| *name != "BOX_STATISTICS");
            for reach in [None, Some(1), Some(6)] {
                let steps = reach.map(reaches).unwrap_or_default();
                all.push([&across[..], &steps].concat());
                all.push([&mode[..], &down, &steps].concat());
            }
        }
        if reads(&mode, "AUX_SCALAR") {
            let mut numbers = mode;
            numbers.retain(|(name, _)| *name != "AUX_SCALAR");
            numbers.extend(flags(&["DRAWS_AUX_SCALAR"]));
            numbers.push(flag(format!("AUX_SCALAR_OF_{name}")));
            all.push(numbers);
        }
    }
    let mut earlier = modes[0].clone();
    earlier.extend([("EARLIER_PASS", None), flag(format!("WITHOUT_{name}"))]);
    all.push(earlier);
    all
}

/// The definitions of boxes that reach so many pixels.
fn reaches(pixels: usize) -> Definitions {
    let steps = ["ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX"];
    let steps = steps[..pixels]
        .iter()
        .map(|step| flag(format!("REACHES_{step}")));
    steps.chain([flag("BOX_REACH".into())]).collect()
}

/// Passes that are blended over the picture: all of their effects draw over it.
fn overlays() -> Vec<Definitions> {
    const LISTS: &[&str] = &[
        "EFFECT_OUTLINES LINES | EFFECT_CONTOURS | EFFECT_OUTLINES LINES EFFECT_CONTOURS \
         | EFFECT_FOCUS | EFFECT_FOCUS EFFECT_OUTLINES LINES EFFECT_CONTOURS",
        "EFFECT_CONTOURS_OPERATOR=0 | EFFECT_CONTOURS_OPERATOR=1 | EFFECT_CONTOURS_OPERATOR=2 \
         | EFFECT_CONTOURS_OPERATOR=3",
        "| EFFECT_CONTOURS_WHOLE | EFFECT_CONTOURS_WHOLE EFFECT_CONTOURS_SINGLE_RING",
        "| EFFECT_CONTOURS_STEADY",
        "EFFECT_FOCUS_PARALLEL=0 | EFFECT_FOCUS_PARALLEL=1",
        // The styles of lines, and objects that color effects leave alone.
        "| OBJECT_STYLES | OBJECT_STYLES OBJECT_IDS",
        "| INSIDE",
        "| SAME_SIZE",
        "| MULTISAMPLED",
        "| OBLIQUE",
        "| VISIBLE_RANGE",
        "MAP_FLAGS=0 | MAP_FLAGS=1 | MAP_FLAGS=2 | MAP_FLAGS=3",
    ];
    let rows = rows(LISTS, overlay);
    rows.iter().map(|row| of_pass(&[row])).collect()
}

fn overlay(mut names: Vec<&'static str>) -> Vec<&'static str> {
    let [contours, focus, lines, ids] =
        ["EFFECT_CONTOURS", "EFFECT_FOCUS", "LINES", "OBJECT_IDS"].map(|name| has(&names, name));
    names.retain(|name| match *name {
        "SAME_SIZE" | "MULTISAMPLED" => contours || ids,
        "OBLIQUE" | "VISIBLE_RANGE" => contours,
        "OBJECT_STYLES" => lines || ids,
        _ if name.starts_with("EFFECT_CONTOURS_") || name.starts_with("MAP_FLAGS") => contours,
        _ if name.starts_with("EFFECT_FOCUS_") => focus,
        _ => true,
    });
    names.push("OVERLAY");
    if contours {
        names.extend(["MAP", "DEPTH"]);
    }
    push_if(focus, &mut names, "EFFECT_FOCUS_STYLE=4");
    // Of these effects, the focus alone is one that changes colors.
    if ids && focus {
        names.extend(["UNSTYLED", "UNSTYLED_COLORS"]);
    }
    names
}

/// Passes that change only a part of each pixel, with all effects but a sketch, which replaces outlines.
fn masked() -> Vec<Definitions> {
    const FORMS: &[&str] = &[
        "| MASKED_BY_DEPTH DEPTH | MASKED_BY_IDS OBJECT_IDS MASK_REACH=3",
        "| BEYOND_PREPASS DEPTH | BEYOND_PREPASS BEYOND_PLAIN DEPTH",
        "| MULTISAMPLED",
        "| MASKED_COLORS MASKED_PRINT",
    ];
    let drawn = || effects::all().iter().filter(|m| m.effect.name != "sketch");
    let later = drawn().filter(|modes| modes.effect.stage > EffectStage::Print);
    let masks = later.enumerate().map(|(i, modes)| {
        let (name, _) = flag(format!(
            "MASKED_EFFECT_{}",
            modes.effect.name.to_uppercase()
        ));
        (name, Some(i as u32 % 2))
    });
    let masks: Definitions = masks.chain([("MASK", None)]).collect();
    let modes: Definitions = drawn().flat_map(|drawn| drawn.modes[0].clone()).collect();
    let forms = rows(FORMS, |names| names);
    let of_form = |form: &Definitions| of_pass(&[form, &masks, &modes]);
    let sketches = effects::all().iter().filter(|m| m.effect.name == "sketch");
    let mask = [("MASK", None), ("MASKED_EFFECT_SKETCH", Some(0))];
    let sketches = sketches.map(|sketch| of_pass(&[&mask, &sketch.modes[0]]));
    forms.iter().map(of_form).chain(sketches).collect()
}

/// All pixels, before tiles with all effects: without those effects that change only tiles.
fn bases() -> Vec<Definitions> {
    const LISTS: &[&str] = &[
        "EFFECT_SKETCH | EFFECT_SKETCH EFFECT_CONTOURS | EFFECT_CONTOURS EFFECT_TONE_BANDS \
         | EFFECT_CONTOURS EFFECT_OUTLINES",
        // An effect of a game may not know how far it reads lines.
        "| WITHOUT_LINES",
        "| EFFECT_SKETCH_FADES",
        "| OBJECT_STYLES",
        "| LINE_OWNERS | LINE_OWNERS IN_LAYERS | LINE_OWNERS IN_LAYERS DEPTH_BORDERS",
        "| CONTINUED",
        "| COMPOSITE",
        "| INSIDE",
        "| SAME_SIZE",
        "| MULTISAMPLED",
        "| OBLIQUE",
        "| VISIBLE_RANGE",
        "| STORED_SRGB | STORED_OKLAB",
    ];
    let rows = rows(LISTS, base);
    rows.iter().map(|row| of_pass(&[row])).collect()
}

fn base(mut names: Vec<&'static str>) -> Vec<&'static str> {
    let [contours, outlines, sketch] =
        ["EFFECT_CONTOURS", "EFFECT_OUTLINES", "EFFECT_SKETCH"].map(|name| has(&names, name));
    let lines = outlines || sketch;
    names.retain(|name| match *name {
        "EFFECT_SKETCH_FADES" => sketch,
        "OBJECT_STYLES" | "LINE_OWNERS" | "IN_LAYERS" | "DEPTH_BORDERS" => lines,
        // Jumps of the depth map are looked for where it has the pixels of the view.
        "MULTISAMPLED" => !contours,
        _ => true,
    });
    push_if(lines, &mut names, "LINES");
    push_if(sketch, &mut names, "LINES_ANYWHERE");
    push_if(outlines, &mut names, "WITHOUT_EFFECT_OUTLINES");
    if contours {
        names.extend(["WITHOUT_EFFECT_CONTOURS", "MAP", "DEPTH", "SAME_SIZE"]);
        names.push("EFFECT_CONTOURS_OPERATOR=1");
    } else {
        // Without jumps, tiles save nothing but the search for lines.
        names.push("WITHOUT_LINES");
    }
    if has(&names, "EFFECT_TONE_BANDS") {
        names.push("LIGHTNESS_CHANGE");
    }
    if has(&names, "IN_LAYERS") {
        names.extend(["EFFECT_DEPTH_LAYERS", "MAP", "DEPTH"]);
    }
    if !has(&names, "DEPTH") {
        names.retain(|name| !matches!(*name, "SAME_SIZE" | "MULTISAMPLED" | "OBLIQUE"));
    }
    if !has(&names, "MAP") {
        names.retain(|name| *name != "VISIBLE_RANGE");
    }
    names
}
