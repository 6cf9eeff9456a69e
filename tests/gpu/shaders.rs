//! Every entry point composes and validates with every combination of flags.

use std::{fs, ops::Range};

use bevy_comics::{DebugView, EffectRegistry, Needs};

use bevy_comics_testkit::wgsl::{Definition, check, files, module, module_with, written};

fn shader(name: &str) -> String {
    let path = files()
        .into_iter()
        .find(|path| path.ends_with(name))
        .expect("a shader of the crate");
    fs::read_to_string(path).expect("readable")
}

/// Every subset of `choices`.
fn subsets<T: Copy>(choices: &[T]) -> Vec<Vec<T>> {
    (0..1u32 << choices.len())
        .map(|bits| {
            choices
                .iter()
                .enumerate()
                .filter(|(i, _)| bits >> i & 1 == 1)
                .map(|(_, c)| *c)
                .collect()
        })
        .collect()
}

/// Definitions that are set together.
type Definitions = Vec<Definition<'static>>;

fn flags(names: &[&'static str]) -> Definitions {
    names.iter().map(|name| (*name, None)).collect()
}

/// A definition that is always one of these numbers.
fn numbers(name: &'static str, values: Range<u32>) -> Vec<Definitions> {
    values.map(|value| vec![(name, Some(value))]).collect()
}

/// Flags that each may be set or not.
fn optional(names: &[&'static str]) -> Vec<Definitions> {
    subsets(names).iter().map(|names| flags(names)).collect()
}

/// One choice of every list, in all combinations.
fn product(lists: &[Vec<Definitions>]) -> Vec<Definitions> {
    let all = |found: Vec<Definitions>, list: &Vec<Definitions>| {
        let with = |before: &Definitions| {
            let before = before.clone();
            list.iter().map(move |one| [&before[..], one].concat())
        };
        found.iter().flat_map(with).collect()
    };
    lists.iter().fold(vec![Vec::new()], all)
}

/// An effect with all of its variants: the definitions that `variants` sets and
/// those of its needs.
type Modes = (&'static str, Vec<Definitions>);

/// The effects that read the picture, depth and normals.
fn picture_effects() -> [Modes; 10] {
    let mapped = |more: Definition<'static>| [flags(&["MAP", "DEPTH"]), vec![more]].concat();
    [
        (
            "tone_bands",
            product(&[
                vec![flags(&["TONE_BANDS", "LIGHTNESS_CHANGE"])],
                numbers("TONE_BANDS_FAITHFUL", 0..2),
            ]),
        ),
        (
            "desaturation",
            product(&[
                vec![flags(&["DESATURATION", "MAP", "DEPTH"])],
                numbers("DESATURATION_CURVE", 0..3),
                numbers("DESATURATION_FAITHFUL", 0..2),
            ]),
        ),
        (
            "colorization",
            // Mode 0 changes nothing and is never compiled.
            product(&[
                vec![flags(&["COLORIZATION"])],
                vec![
                    vec![("COLORIZATION_MODE", Some(1))],
                    mapped(("COLORIZATION_MODE", Some(2))),
                    mapped(("COLORIZATION_MODE", Some(3))),
                ],
                numbers("COLORIZATION_FAITHFUL", 0..2),
            ]),
        ),
        (
            "halftone",
            product(&[
                vec![flags(&["HALFTONE"]), flags(&["HALFTONE", "MAP", "DEPTH"])],
                numbers("HALFTONE_MODE", 0..4),
                [
                    numbers("HALFTONE_SHAPE", 0..5),
                    vec![vec![("HALFTONE_SHAPE", Some(5)), ("BLUE_NOISE", None)]],
                ]
                .concat(),
                // Cells are read in a pass of their own.
                vec![Vec::new(), flags(&["HALFTONE_CELLS", "CONTINUED"])],
                vec![
                    Vec::new(),
                    vec![("HALFTONE_SPREADS", Some(1))],
                    flags(&["HALFTONE_FOLLOWS"]),
                    [
                        flags(&["HALFTONE_FOLLOWS", "OBJECT_ANCHORS"]),
                        flags(&["OBJECT_IDS", "OBJECT_STYLES"]),
                        vec![
                            ("HALFTONE_ADJUSTED", Some(0)),
                            ("HALFTONE_SPREADS", Some(0)),
                        ],
                    ]
                    .concat(),
                ],
            ]),
        ),
        (
            "hatching",
            [
                vec![flags(&["HATCHING"]), flags(&["HATCHING", "MAP", "DEPTH"])],
                product(&[
                    vec![flags(&[
                        "HATCHING",
                        "HATCHING_ON_THINGS",
                        "DEPTH",
                        "NORMALS",
                    ])],
                    optional(&["HATCHING_FACES"]),
                    vec![
                        Vec::new(),
                        flags(&["OBJECT_ANCHORS", "OBJECT_IDS", "OBJECT_STYLES"]),
                    ],
                ]),
            ]
            .concat(),
        ),
        (
            "black_flats",
            product(&[
                vec![flags(&["BLACK_FLATS"])],
                vec![
                    Vec::new(),
                    flags(&["MAP", "DEPTH"]),
                    mapped(("BLACK_FLATS_STEEP", None)),
                ],
            ]),
        ),
        (
            "contours",
            product(&[
                vec![flags(&["CONTOURS", "MAP", "DEPTH"])],
                numbers("CONTOURS_OPERATOR", 0..4),
                numbers("CONTOURS_FAITHFUL", 0..2),
                vec![
                    Vec::new(),
                    flags(&["CONTOURS_WHOLE"]),
                    flags(&["CONTOURS_WHOLE", "CONTOURS_SINGLE_RING"]),
                ],
                optional(&["CONTOURS_STEADY"]),
            ]),
        ),
        ("color_harmony", color_harmony()),
        (
            "abstraction",
            product(&[
                vec![flags(&["ABSTRACTION", "MAP", "DEPTH"])],
                vec![
                    Vec::new(),
                    flags(&["ABSTRACTION_OBJECTS", "OBJECT_DEPTHS", "OBJECT_IDS"]),
                ],
            ]),
        ),
        (
            "planes",
            product(&[
                vec![flags(&["PLANES", "MAP", "DEPTH"])],
                vec![Vec::new(), flags(&["DEPTH_BORDERS"])],
                vec![
                    Vec::new(),
                    flags(&["PLANES_OBJECTS", "OBJECT_DEPTHS", "OBJECT_IDS"]),
                ],
                vec![
                    vec![("PLANES_BANDS", Some(0))],
                    vec![("PLANES_BANDS", Some(1)), ("LIGHTNESS_CHANGE", None)],
                ],
            ]),
        ),
    ]
}

/// The curve and the form of the modes that have them.
fn color_harmony() -> Vec<Definitions> {
    let forms = numbers("COLOR_HARMONY_FAITHFUL", 0..2);
    let mode = |number| vec![("COLOR_HARMONY_MODE", Some(number))];
    let plain = vec![("COLOR_HARMONY_QUADRATIC", Some(0))];
    let maps = || vec![Vec::new(), flags(&["MAP", "DEPTH"])];
    let harmony = || vec![flags(&["COLOR_HARMONY"])];
    [
        product(&[
            harmony(),
            vec![mode(0)],
            vec![plain.clone()],
            forms[..1].to_vec(),
            maps(),
        ]),
        product(&[
            harmony(),
            vec![mode(1), mode(2)],
            numbers("COLOR_HARMONY_QUADRATIC", 0..2),
            forms.clone(),
            maps()[1..].to_vec(),
        ]),
        product(&[harmony(), vec![mode(3)], vec![plain], forms]),
    ]
    .concat()
}

/// The effects that draw lines. Only one is compiled at a time, because the
/// sketch replaces the outlines.
fn line_effects() -> [Modes; 2] {
    [
        (
            "outlines",
            [
                product(&[
                    vec![flags(&["OUTLINES", "LINES"])],
                    optional(&["OBJECT_STYLES"]),
                ]),
                product(&[
                    vec![flags(&["OUTLINES", "LINES", "LINE_OWNERS", "MAP", "DEPTH"])],
                    vec![flags(&["IN_PLANES", "PLANE_INK"])],
                    optional(&["OBJECT_STYLES", "SURFACE_LINES", "DEPTH_BORDERS"]),
                    vec![Vec::new(), flags(&["OBJECT_DEPTHS", "OBJECT_IDS"])],
                ]),
            ]
            .concat(),
        ),
        (
            "sketch",
            product(&[
                vec![flags(&["SKETCH", "LINES", "LINES_ANYWHERE"])],
                optional(&["OBJECT_STYLES", "SKETCH_FADES"]),
            ]),
        ),
    ]
}

/// Every debug view with its needs.
fn debug_views() -> Vec<Definitions> {
    let lines = |view| vec![(view, None), ("LINES", None)];
    vec![
        flags(&["VIEW_DEPTH_MAP", "MAP", "DEPTH"]),
        flags(&["VIEW_RAW_RANGE", "MAP", "DEPTH"]),
        lines("VIEW_SILHOUETTES"),
        lines("VIEW_CREASES"),
        flags(&["VIEW_OBJECT_IDS", "OBJECT_IDS"]),
        flags(&["VIEW_SATURATION"]),
        flags(&["VIEW_DIFFERENCE"]),
        vec![
            ("VIEW_EFFECT", None),
            ("VIEW_TONE_BANDS", None),
            ("TONE_BANDS", None),
            ("TONE_BANDS_FAITHFUL", Some(0)),
            ("LIGHTNESS_CHANGE", None),
        ],
        [
            flags(&[
                "VIEW_EFFECT",
                "VIEW_ABSTRACTION",
                "ABSTRACTION",
                "MAP",
                "DEPTH",
            ]),
            Vec::new(),
        ]
        .concat(),
        [
            flags(&["VIEW_EFFECT", "VIEW_PLANES", "PLANES", "MAP", "DEPTH"]),
            vec![("PLANES_BANDS", Some(0))],
        ]
        .concat(),
    ]
}

/// Composes the fused pass with the definitions that the plugin sets. Definitions
/// about depth are left out where nothing reads it; one number is always set.
fn compose(source: &str, parts: &[&[Definition<'static>]]) {
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
    if let Err(error) = module_with(source, &all) {
        panic!("{all:?}: {error}");
    }
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

/// The effects that are not listed above, with their defaults.
fn other_effects() -> Vec<Modes> {
    let tables: Vec<&str> = picture_effects()
        .iter()
        .chain(&line_effects())
        .map(|(name, _)| *name)
        .collect();
    let types = EffectRegistry::built_in().types();
    let others = types.iter().filter(|effect| !tables.contains(&effect.name));
    others
        .map(|effect| {
            let needs = (effect.default)().any_needs();
            let name: &'static str = effect.name.to_uppercase().leak();
            let mut mode = flags(&[name]);
            for (need, definition) in [
                (Needs::MAP, "MAP"),
                (Needs::MAP | Needs::DEPTH, "DEPTH"),
                (Needs::NORMALS, "NORMALS"),
                (Needs::IDS, "OBJECT_IDS"),
                (Needs::LINES, "LINES"),
                (Needs::LIGHTNESS_CHANGE, "LIGHTNESS_CHANGE"),
                (Needs::BLUE_NOISE, "BLUE_NOISE"),
            ] {
                if needs.intersects(need) {
                    mode.push((definition, None));
                }
            }
            (effect.name, vec![mode])
        })
        .collect()
}

#[test]
fn every_effect_of_the_crate_is_composed() {
    let mut composed: Vec<&str> = picture_effects()
        .iter()
        .chain(&line_effects())
        .chain(&other_effects())
        .map(|(name, _)| *name)
        .collect();
    let types = EffectRegistry::built_in().types();
    let mut known: Vec<&str> = types.iter().map(|effect| effect.name).collect();
    composed.sort_unstable();
    known.sort_unstable();
    assert_eq!(composed, known);
    let of_effects = types.iter().filter(|effect| effect.view.is_some()).count();
    assert_eq!(debug_views().len(), DebugView::SHARED.len() + of_effects);
}

#[test]
fn every_mode_of_every_effect_composes_and_validates() {
    let source = EffectRegistry::built_in().shader();
    let views = views();
    compose(&source, &[]);
    let others = other_effects();
    for (_, modes) in picture_effects()
        .iter()
        .chain(&line_effects())
        .chain(&others)
    {
        for mode in modes {
            for view in &views {
                compose(&source, &[mode, view]);
            }
        }
    }
    // A mode that selects no variant is read from the settings.
    let modes = picture_effects().into_iter().chain(line_effects());
    let mut read: Definitions = modes.flat_map(|(_, modes)| modes[0].clone()).collect();
    read.retain(|(name, number)| number.is_none() && !name.starts_with("SKETCH"));
    module_with(&source, &read).unwrap_or_else(|error| panic!("{read:?}: {error}"));
}

#[test]
fn every_combination_of_effects_composes_and_validates() {
    let source = EffectRegistry::built_in().shader();
    let views = views();
    let pictures = picture_effects();
    let lines = line_effects();
    let mut turn = 0;
    for chosen in subsets(&[0, 1, 2, 3, 4, 5, 6]) {
        for line in [None, Some(&lines[0]), Some(&lines[1])] {
            for view in &views {
                // Another mode each time.
                turn += 1;
                let more = [&[][..], &[7], &[8], &[9], &[7, 8, 9]][turn % 5];
                let chosen = chosen.iter().chain(more);
                let modes = chosen.map(|i| &pictures[*i]).chain(line);
                let mut parts: Vec<&[Definition]> = modes
                    .map(|(_, modes)| &modes[turn % modes.len()][..])
                    .collect();
                parts.push(view);
                compose(&source, &parts);
            }
        }
    }
}

/// Browsers get shaders as text again, without attributes of structs.
#[test]
fn shaders_that_are_written_as_text_are_valid() {
    let source = EffectRegistry::built_in().shader();
    let others = other_effects();
    let [outlines, sketch] = line_effects();
    let all = picture_effects().into_iter().chain(others);
    let mut modes: Vec<Definitions> = all.flat_map(|(_, modes)| modes).collect();
    modes.extend([outlines.1, sketch.1].concat());
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
        if let Err(error) = check(&written(&module)) {
            panic!("{definitions:?}: {error}");
        }
    }
}

#[test]
fn every_form_of_a_view_composes_and_validates() {
    let source = EffectRegistry::built_in().shader();
    let pictures = picture_effects();
    let lines = line_effects();
    let mut turn = 0;
    let forms = [
        "MULTISAMPLED",
        "OBLIQUE",
        "VISIBLE_RANGE",
        "SAME_SIZE",
        "FINISH",
    ];
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
                compose(&source, &parts);
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
        compose(&source, &[&needs]);
    }
}

/// The definitions of boxes that reach so many pixels.
fn reaches(pixels: usize) -> Definitions {
    let steps = [
        "REACHES_ONE",
        "REACHES_TWO",
        "REACHES_THREE",
        "REACHES_FOUR",
        "REACHES_FIVE",
        "REACHES_SIX",
    ];
    [flags(&["BOX_REACH"]), flags(&steps[..pixels])].concat()
}

/// The passes of a plan whose effects read the picture at other places.
#[test]
fn every_pass_of_a_divided_plan_composes_and_validates() {
    let source = EffectRegistry::built_in().shader();
    let forms = [
        "CONTINUED",
        "LAYER",
        "INSIDE",
        "FINISH",
        "UNSTYLED_COLORS",
        "UNSTYLED_PRINT",
    ];
    let focus = |style| {
        let style = vec![("FOCUS_STYLE", Some(style))];
        [flags(&["FOCUS", "DEPTH"]), style].concat()
    };
    let effects = [
        vec![],
        flags(&["PRINT_OFFSET"]),
        flags(&["PRINT_OFFSET", "PRINT_OFFSET_BLACK_STAYS"]),
        flags(&["PRINT_OFFSET", "WITHOUT_PRINT_OFFSET", "TONE_BANDS"]),
        flags(&["HALFTONE", "HALFTONE_CELLS", "LINES", "OUTLINES"]),
        flags(&[
            "OUTLINES",
            "LINES",
            "LINE_OWNERS",
            "SURFACE_LINES",
            "PRINT_OFFSET",
        ]),
        flags(&["PAINT", "MEANS"]),
        flags(&["PAINT", "MEANS", "PAINT_FIGURES", "MULTISAMPLED"]),
        flags(&["PAINT", "PAINT_ANISOTROPIC", "PAINT_FIGURES"]),
        focus(0),
        [focus(0), flags(&["NUMBERED", "MULTISAMPLED"])].concat(),
        [focus(0), flags(&["DRAWS_NUMBERS", "NUMBERS_FOCUS"])].concat(),
        [
            focus(1),
            flags(&["NUMBERED"]),
            vec![("FOCUS_PARALLEL", Some(1))],
        ]
        .concat(),
        focus(3),
        focus(4),
        [focus(2), flags(&["MEANS", "MULTISAMPLED"])].concat(),
        [
            focus(2),
            flags(&["DRAWS_MEANS", "MEANS_DOWN", "MEANS", "BOXES_FOCUS"]),
        ]
        .concat(),
        flags(&["PAINT", "DRAWS_MEANS", "BOXES_PAINT", "MAP", "DEPTH"]),
        [
            flags(&["PAINT", "MEANS", "PAINT_WHOLE", "PAINT_FIGURES"]),
            vec![("PAINT_EIGHTH", Some(1))],
        ]
        .concat(),
        [flags(&["PAINT", "DRAWS_MEANS", "BOXES_PAINT"]), reaches(1)].concat(),
        [
            flags(&["PAINT", "MEANS", "DRAWS_MEANS", "MEANS_DOWN", "BOXES_PAINT"]),
            reaches(6),
        ]
        .concat(),
        flags(&["PAINT", "MEANS", "DRAWS_MEANS", "MEANS_DOWN", "BOXES_PAINT"]),
    ];
    for form in optional(&forms) {
        for effects in &effects {
            let ids = flags(&["OBJECT_STYLES", "OBJECT_IDS", "UNSTYLED"]);
            compose(&source, &[&form, effects, &ids]);
        }
    }
}

#[test]
fn every_debug_view_composes_and_validates() {
    let source = EffectRegistry::built_in().shader();
    let pictures = picture_effects();
    let lines = line_effects();
    let everything: Vec<&[Definition]> = pictures.iter().map(|(_, modes)| &modes[0][..]).collect();
    for view in debug_views() {
        for form in optional(&["MULTISAMPLED", "OBLIQUE", "FINISH"]) {
            // On a camera without effects, with a sketch, and with outlines.
            let view = [&view[..], &flags(&["DEBUG_VIEW"])].concat();
            compose(&source, &[&view, &form]);
            for (_, modes) in &lines {
                let mut parts = everything.clone();
                parts.extend([&view[..], &form, &modes[modes.len() - 1]]);
                compose(&source, &parts);
            }
        }
    }
}

#[test]
fn every_shape_of_the_reduction_composes_and_validates() {
    let source = shader("depth/range.wgsl");
    for shape in [&[][..], &["BARRIER_FREE"], &["SUBGROUP"]] {
        for view in subsets(&["MULTISAMPLED", "OBLIQUE", "HISTOGRAM", "ORTHOGRAPHIC"]) {
            let defs: Vec<_> = shape.iter().chain(&view).copied().collect();
            module(&source, &defs).unwrap_or_else(|error| panic!("{defs:?}: {error}"));
        }
    }
    let source = shader("depth/smoothing.wgsl");
    for defs in subsets(&["HISTOGRAM"]) {
        module(&source, &defs).unwrap_or_else(|error| panic!("{defs:?}: {error}"));
    }
    let source = shader("depth/borders.wgsl");
    module(&source, &[]).unwrap_or_else(|error| panic!("{error}"));
    let source = shader("objects/depths.wgsl");
    for defs in subsets(&["VISIBLE_RANGE"]) {
        module(&source, &defs).unwrap_or_else(|error| panic!("{defs:?}: {error}"));
    }
    let source = shader("depth/ping_pong.wgsl");
    for defs in subsets(&["FIRST", "MULTISAMPLED", "OBLIQUE"]) {
        module(&source, &defs).unwrap_or_else(|error| panic!("{defs:?}: {error}"));
    }
}

#[test]
fn every_kind_of_outline_composes_and_validates() {
    let [walk, cells, find, faithful] = ["walk", "cells", "find", "faithful"].map(|name| {
        let path = format!("lines/{name}.wgsl");
        shader(&path)
    });
    let check = |source: &str, defs: &[&str]| {
        module(source, defs).unwrap_or_else(|error| panic!("{defs:?}: {error}"));
    };
    for view in subsets(&["OBLIQUE", "SAME_SIZE", "FADING"]) {
        let mut view = [&["DEPTH"], &view[..]].concat();
        if view.contains(&"FADING") {
            view.push("VISIBLE_RANGE");
        }
        for kinds in subsets(&["SILHOUETTES", "CREASES", "OBJECT_EDGES", "OBJECT_STYLES"]) {
            let mut defs = [&view[..], &kinds].concat();
            if kinds.contains(&"CREASES") {
                defs.push("NORMALS");
            }
            if kinds.contains(&"OBJECT_EDGES") || kinds.contains(&"OBJECT_STYLES") {
                defs.push("OBJECT_IDS");
            }
            check(&walk, &[&defs[..], &["CRACKS"]].concat());
            if kinds.contains(&"SILHOUETTES") || kinds.contains(&"CREASES") {
                defs.push("EXCESS");
            }
            check(&find, &defs);
            check(&cells, &defs);
            check(&cells, &[&defs[..], &["COMPLETED"]].concat());
            check(
                &cells,
                &[&defs[..], &["COMPLETED", "ABSTRACT_LINES"]].concat(),
            );
            if kinds.contains(&"CREASES") {
                check(&cells, &[&defs[..], &["COMPLETED", "LEDGES"]].concat());
                check(&walk, &[&defs[..], &["CRACKS", "LEDGES"]].concat());
            }
            check(&walk, &[&defs[..], &["CRACKS", "JUMPS"]].concat());
        }
        for forms in subsets(&["FAITHFUL_SILHOUETTES", "FAITHFUL_CREASES", "OBJECT_STYLES"]) {
            let mut defs = [&view[..], &forms].concat();
            if forms.contains(&"FAITHFUL_CREASES") {
                defs.push("NORMALS");
            }
            if forms.contains(&"OBJECT_STYLES") {
                defs.push("OBJECT_IDS");
            }
            check(&faithful, &defs);
        }
    }
    let (columns, draw) = (shader("lines/columns.wgsl"), shader("lines/draw.wgsl"));
    check(&columns, &[]);
    check(&columns, &["BLOCKS"]);
    check(&columns, &["BLOCKS", "COMPLETED"]);
    check(&columns, &["BLOCKS", "COMPLETED", "SMOOTH"]);
    for last in [&[][..], &["LAST"]] {
        check(&shader("lines/link.wgsl"), last);
    }
    check(&shader("lines/join.wgsl"), &[]);
    check(&shader("lines/bridge.wgsl"), &[]);
    for motion in [
        &[][..],
        &["MOTION", "DEPTH"],
        &["MOTION", "DEPTH", "OBLIQUE"],
    ] {
        check(&shader("lines/persist.wgsl"), motion);
    }
    for varied in subsets(&["VARIED", "BRIDGED"]) {
        check(
            &shader("lines/ends.wgsl"),
            &[&["BLOCKS", "SMOOTH"], &varied[..]].concat(),
        );
    }
    for styles in [&[][..], &["OBJECT_IDS", "OBJECT_STYLES"]] {
        for more in [&[][..], &["SURFACE"], &["SURFACE", "INWARD"]] {
            for line in subsets(&["BOIL", "TAPER", "SPREAD", "STREAKS"]) {
                check(
                    &shader("lines/strokes.wgsl"),
                    &[styles, more, &line[..]].concat(),
                );
            }
        }
    }
    for smooth in [&[][..], &["SMOOTH"], &["SMOOTH", "FOLDS", "DEPTH"]] {
        for weight in [&[][..], &["WEIGHT", "DEPTH", "BUDGET"]] {
            for bridged in subsets(&["BRIDGED", "LEDGES", "RIMS"]) {
                let mut flags = [smooth, weight, &bridged[..]].concat();
                if !weight.is_empty() || flags.contains(&"FOLDS") || flags.contains(&"RIMS") {
                    flags.extend(["DEPTH", "EDITS"]);
                }
                check(&shader("lines/settle.wgsl"), &flags);
            }
        }
        for planes in [
            &["IN_PLANES"][..],
            &["IN_PLANES", "DEPTH_BORDERS"],
            &["IN_PLANES", "VISIBLE_RANGE", "DEPTH_BORDERS"],
            &["IN_PLANES", "VISIBLE_RANGE", "OBJECT_DEPTHS", "OBJECT_IDS"],
            &["ABSTRACT_CREASES", "VISIBLE_RANGE"],
            &["ABSTRACT_CREASES", "OBJECT_DEPTHS", "OBJECT_IDS"],
            &[
                "ABSTRACT_CREASES",
                "IN_PLANES",
                "OBJECT_DEPTHS",
                "OBJECT_IDS",
            ],
        ] {
            let weight = &["WEIGHT", "EDITS", "DEPTH"];
            check(
                &shader("lines/settle.wgsl"),
                &[smooth, weight, planes].concat(),
            );
        }
        for surface in [
            &["WIDTH_MAP"][..],
            &["LIGHT_WEIGHT", "NORMALS"],
            &["WIDTH_MAP", "LIGHT_WEIGHT", "NORMALS"],
        ] {
            let weight = &["WEIGHT", "EDITS", "DEPTH", "SURFACE_WEIGHT"];
            check(
                &shader("lines/settle.wgsl"),
                &[smooth, weight, surface].concat(),
            );
        }
    }
    check(&shader("lines/tiles.wgsl"), &[]);
    for styles in [&[][..], &["OBJECT_IDS", "OBJECT_STYLES"]] {
        for search in [&[][..], &["NEIGHBOURS"], &["COLUMNS"]] {
            for store in [
                &[][..],
                &["BLOCKS"],
                &["BLOCKS", "COMPLETED"],
                &["BLOCKS", "COMPLETED", "SMOOTH"],
            ] {
                for sheet in subsets(&["SPREAD", "STREAKS"]) {
                    check(&draw, &[styles, search, store, &sheet[..]].concat());
                }
                let bridged = &["OWNERS", "BRIDGED", "SURFACE", "INWARD"];
                if !store.is_empty() {
                    check(&draw, &[styles, search, store, bridged].concat());
                }
            }
        }
    }
    let resolve = shader("lines/resolve.wgsl");
    for view in subsets(&["OBLIQUE", "NORMALS", "OBJECT_IDS", "WIDTH_MAP"]) {
        check(&resolve, &[&["DEPTH", "MULTISAMPLED"], &view[..]].concat());
    }
    for widths in [&[][..], &["LINE_WIDTHS"], &["LINE_WIDTHS", "VERTEX_WIDTHS"]] {
        for depth in [
            &[][..],
            &["TOLERANT"],
            &["TOLERANT", "TOLERANT_MULTISAMPLED"],
        ] {
            let defs = [widths, depth].concat();
            // Both are built by `IdVariant` and `ObjectIdSpecializer` of `objects/items.rs`.
            for name in ["objects/ids.wgsl", "objects/sections.wgsl"] {
                check(&shader(name), &defs);
            }
        }
    }
    for view in subsets(&["MULTISAMPLED"]) {
        check(&shader("objects/depth_test/count.wgsl"), &view);
    }
}
