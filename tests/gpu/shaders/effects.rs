//! The effects with all of their variants.

use super::{Definitions, flags, numbers, optional, product};
use crate::prelude::*;

/// An effect with all of its variants: the definitions that `variants` sets and
/// those of its needs.
pub type Modes = (&'static str, Vec<Definitions>);

/// The definitions of needs.
pub const NEEDS: [(Needs, &[&str]); 13] = [
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
    (Needs::OBJECT_DEPTHS, &["OBJECT_DEPTHS", "OBJECT_IDS"]),
];

/// Without the depth map, and with it.
fn maps() -> Vec<Definitions> {
    vec![Vec::new(), flags(&["MAP", "DEPTH"])]
}

/// The effects that read the picture, depth and normals.
pub fn picture_effects() -> [Modes; 10] {
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
        ("colorization", colorization()),
        ("halftone", halftone()),
        ("hatching", hatching()),
        ("black_flats", black_flats()),
        ("contours", contours()),
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
        ("depth_layers", planes()),
    ]
}

/// Mode 0 changes nothing and is never compiled.
fn colorization() -> Vec<Definitions> {
    let mapped = |mode| {
        let mode = vec![("COLORIZATION_MODE", Some(mode))];
        [flags(&["MAP", "DEPTH"]), mode].concat()
    };
    product(&[
        vec![flags(&["COLORIZATION"])],
        vec![vec![("COLORIZATION_MODE", Some(1))], mapped(2), mapped(3)],
        numbers("COLORIZATION_FAITHFUL", 0..2),
    ])
}

fn halftone() -> Vec<Definitions> {
    let grain = vec![vec![("HALFTONE_SHAPE", Some(5)), ("BLUE_NOISE", None)]];
    let shapes = [numbers("HALFTONE_SHAPE", 0..5), grain].concat();
    let mut all = product(&[
        vec![flags(&["HALFTONE"]), flags(&["HALFTONE", "MAP", "DEPTH"])],
        numbers("HALFTONE_MODE", 0..4),
        shapes,
        // Cells are read in a pass of their own.
        vec![Vec::new(), flags(&["HALFTONE_CELLS", "CONTINUED"])],
        followed(),
    ]);
    // Grains are read at their own pixels.
    all.retain(|mode| {
        !mode.contains(&("BLUE_NOISE", None)) || !mode.contains(&("HALFTONE_CELLS", None))
    });
    all
}

/// Every pair of whether screens spread, whether they are adjusted, and what they follow.
fn followed() -> Vec<Definitions> {
    let form = |names: &[&'static str], spreads, adjusted| {
        let numbers = vec![
            ("HALFTONE_SPREADS", Some(spreads)),
            ("HALFTONE_ADJUSTED", Some(adjusted)),
        ];
        [flags(names), numbers].concat()
    };
    let anchors = ["OBJECT_ANCHORS", "OBJECT_IDS", "OBJECT_STYLES"];
    let anchored = [&["HALFTONE_FOLLOWS"][..], &anchors[..]].concat();
    vec![
        form(&[], 0, 0),
        form(&[], 1, 1),
        form(&["HALFTONE_FOLLOWS"], 0, 1),
        form(&anchored, 1, 0),
    ]
}

/// Marks on the page, and on things.
fn hatching() -> Vec<Definitions> {
    let on_page = product(&[
        vec![flags(&["HATCHING"])],
        maps(),
        optional(&["HATCHING_DOTS"]),
    ]);
    let on_things = product(&[
        vec![flags(&["HATCHING", "HATCHING_ON_THINGS"])],
        vec![flags(&["DEPTH", "NORMALS"])],
        optional(&["HATCHING_DOTS", "HATCHING_CALM", "HATCHING_FACES", "MAP"]),
        vec![
            Vec::new(),
            flags(&["OBJECT_ANCHORS", "OBJECT_IDS", "OBJECT_STYLES"]),
        ],
    ]);
    [on_page, on_things].concat()
}

fn black_flats() -> Vec<Definitions> {
    product(&[
        vec![flags(&["BLACK_FLATS"])],
        vec![
            Vec::new(),
            flags(&["MAP", "DEPTH"]),
            flags(&["MAP", "DEPTH", "BLACK_FLATS_STEEP"]),
        ],
    ])
}

fn contours() -> Vec<Definitions> {
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
    ])
}

/// The curve and the form of the modes that have them.
fn color_harmony() -> Vec<Definitions> {
    let forms = numbers("COLOR_HARMONY_FAITHFUL", 0..2);
    let mode = |number| vec![("COLOR_HARMONY_MODE", Some(number))];
    let plain = vec![("COLOR_HARMONY_QUADRATIC", Some(0))];
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

fn planes() -> Vec<Definitions> {
    product(&[
        vec![flags(&["DEPTH_LAYERS", "MAP", "DEPTH"])],
        optional(&["DEPTH_BORDERS"]),
        vec![
            Vec::new(),
            flags(&["DEPTH_LAYERS_OBJECTS", "OBJECT_DEPTHS", "OBJECT_IDS"]),
        ],
        vec![
            vec![("DEPTH_LAYERS_BANDS", Some(0))],
            vec![("DEPTH_LAYERS_BANDS", Some(1)), ("LIGHTNESS_CHANGE", None)],
        ],
    ])
}

/// The effects that draw lines. Only one is compiled at a time, because the
/// sketch replaces the outlines.
pub fn line_effects() -> [Modes; 2] {
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
                    vec![flags(&["IN_LAYERS", "LAYER_INK"])],
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

/// The other effects with variants. Those that read the picture elsewhere begin a pass.
pub fn more_effects() -> [Modes; 6] {
    let field = |names: &[&'static str], number| {
        [flags(names), vec![("ISO_LINES_FIELD", Some(number))]].concat()
    };
    [
        ("focus", focus()),
        (
            "iso_lines",
            vec![
                field(&["ISO_LINES", "MAP", "DEPTH"], 0),
                field(&["ISO_LINES", "DEPTH"], 1),
                field(&["ISO_LINES", "DEPTH"], 2),
            ],
        ),
        ("paint", paint()),
        (
            "misregistration",
            product(&[
                vec![flags(&["MISREGISTRATION", "CONTINUED"])],
                optional(&["MISREGISTRATION_BLACK_STAYS"]),
            ]),
        ),
        (
            "speed_lines",
            product(&[
                vec![flags(&["SPEED_LINES"])],
                numbers("SPEED_LINES_KIND", 0..2),
                numbers("SPEED_LINES_DRY", 0..2),
            ]),
        ),
        (
            "tone_ramp",
            product(&[vec![flags(&["TONE_RAMP", "LIGHTNESS_CHANGE"])], maps()]),
        ),
    ]
}

fn focus() -> Vec<Definitions> {
    let style = |names: &[&'static str], number| {
        [flags(names), vec![("FOCUS_STYLE", Some(number))]].concat()
    };
    product(&[
        vec![
            style(&["FOCUS", "DEPTH", "AUX_SCALAR"], 0),
            style(&["FOCUS", "DEPTH", "AUX_SCALAR"], 1),
            style(&["FOCUS", "DEPTH", "CONTINUED", "BOX_STATISTICS"], 2),
            style(&["FOCUS", "DEPTH"], 3),
            style(&["FOCUS"], 4),
        ],
        numbers("FOCUS_PARALLEL", 0..2),
    ])
}

fn paint() -> Vec<Definitions> {
    product(&[
        vec![flags(&["PAINT", "CONTINUED"])],
        vec![flags(&["BOX_STATISTICS"]), flags(&["PAINT_ANISOTROPIC"])],
        vec![Vec::new(), flags(&["PAINT_FIGURES", "OBJECT_IDS"])],
        numbers("PAINT_EIGHTH", 0..2),
        // Brushes of one size may have a whole number of pixels.
        vec![
            Vec::new(),
            flags(&["PAINT_WHOLE"]),
            flags(&["MAP", "DEPTH"]),
        ],
    ])
}

/// The effects that are not listed above, with their defaults: they have no variants.
pub fn other_effects() -> Vec<Modes> {
    let listed: Vec<&str> = (picture_effects().iter())
        .chain(&line_effects())
        .chain(&more_effects())
        .map(|(name, _)| *name)
        .collect();
    let types = EffectRegistry::built_in().types();
    let others = types.iter().filter(|effect| !listed.contains(&effect.name));
    others
        .map(|effect| {
            let needs = (effect.default)().any_needs();
            let name: &'static str = effect.name.to_uppercase().leak();
            let of_needs = NEEDS.iter().filter(|(need, _)| needs.contains(*need));
            let names = of_needs.flat_map(|(_, names)| names.iter().copied());
            let mut mode: Definitions = [name].into_iter().chain(names).map(flag).collect();
            mode.dedup();
            (effect.name, vec![mode])
        })
        .collect()
}

fn flag(name: &'static str) -> Definition<'static> {
    (name, None)
}

/// All effects of the crate; those that draw lines last.
pub fn all() -> Vec<Modes> {
    let pictures = picture_effects().into_iter().chain(more_effects());
    let others = pictures.chain(other_effects());
    others.chain(line_effects()).collect()
}

/// Every debug view with its needs.
pub fn debug_views() -> Vec<Definitions> {
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
        flags(&[
            "VIEW_EFFECT",
            "VIEW_ABSTRACTION",
            "ABSTRACTION",
            "MAP",
            "DEPTH",
        ]),
        [
            flags(&[
                "VIEW_EFFECT",
                "VIEW_DEPTH_LAYERS",
                "DEPTH_LAYERS",
                "MAP",
                "DEPTH",
            ]),
            vec![("DEPTH_LAYERS_BANDS", Some(0))],
        ]
        .concat(),
    ]
}
