//! The effects of the matrix, in groups.

use bevy_comics::effects::PaperAnchor;

use crate::prelude::*;

/// A group's name and style.
pub type Group = (&'static str, fn() -> ComicStyle);

/// Each effect is in one group and in the last one, which has all.
pub const GROUPS: [Group; 9] = [
    ("colours", colors),
    ("tones", tones),
    (LINES, lines),
    ("sketch", sketch),
    ("dots", dots),
    ("strokes", strokes),
    ("paint", paint),
    ("page", page),
    ("all", all),
];

/// Whether a group draws an effect: it has it, and no other that takes its place.
pub fn draws((_, style): &Group, name: &str) -> bool {
    let style = style();
    let is_replaced = (style.effects()).any(|e| e.effect_type().replaces.contains(&name));
    style.by_name(name).is_some() && !is_replaced
}

/// The group of which lines are looked for.
pub const LINES: &str = "lines";

/// A drawing that does not change with time.
fn still_sketch() -> Sketch {
    Sketch {
        rate: 0.0,
        ..Sketch::default()
    }
}

/// Lines that do not change with time.
fn still_speed_lines() -> SpeedLines {
    SpeedLines {
        rate: 0.0,
        ..SpeedLines::default()
    }
}

/// A sheet that is fixed to the viewport: that of a part of a target is that of a target of its size.
fn sheet() -> Paper {
    Paper {
        anchor: PaperAnchor::View,
        ..Paper::default()
    }
}

fn colors() -> ComicStyle {
    ComicStyle::new()
        .with(Desaturation::default())
        .with(Colorization {
            mode: ColorizationMode::Linear,
            ..Colorization::default()
        })
        .with(ColorHarmony::default())
}

fn tones() -> ComicStyle {
    ComicStyle::new()
        .with(ToneRamp::default())
        .with(ToneBands::default())
        .with(BlackFlats::default())
}

fn lines() -> ComicStyle {
    ComicStyle::new()
        .with(Outlines::default())
        .with(Contours::default())
}

fn sketch() -> ComicStyle {
    ComicStyle::new()
        .with(still_sketch())
        .with(IsoLines::default())
}

fn dots() -> ComicStyle {
    ComicStyle::new()
        .with(Halftone::default())
        .with(Misregistration::default())
}

fn strokes() -> ComicStyle {
    ComicStyle::new()
        .with(Hatching::default())
        .with(TwoTone::default())
}

fn paint() -> ComicStyle {
    let focus = Focus {
        at: FocusAt::Distance,
        distance: 6.0,
        ..Focus::default()
    };
    ComicStyle::new()
        .with(Abstraction::default())
        .with(DepthLayers::default())
        .with(Paint::default())
        .with(focus)
}

fn page() -> ComicStyle {
    ComicStyle::new()
        .with(still_speed_lines())
        .with(sheet())
        .with(Vignette::default())
}

fn all() -> ComicStyle {
    let mut style = ComicStyle::new();
    for effect in EffectRegistry::built_in().types() {
        style.insert_any((effect.default)());
    }
    style
        .with(still_sketch())
        .with(still_speed_lines())
        .with(sheet())
}

/// An effect that is added to the crate must be added to a group.
#[test]
fn every_effect_is_in_a_group_and_in_the_last_one() {
    let types = EffectRegistry::built_in().types();
    let known: BTreeSet<_> = types.iter().map(|effect| effect.name).collect();
    let names = |(_, style): &Group| -> BTreeSet<&'static str> {
        let style = style();
        style.effects().map(|e| e.effect_type().name).collect()
    };
    let (last, groups) = GROUPS.split_last().expect("groups");
    assert_eq!(names(last), known);
    let grouped: BTreeSet<_> = groups.iter().flat_map(names).collect();
    assert_eq!(grouped, known);
}
