//! The effects of the matrix, in groups.

use bevy_comics::effects::PaperAnchor;

use crate::prelude::*;

/// A group's name and style.
pub type Group = (&'static str, fn() -> ComicStyle);

/// The group of which lines are looked for.
pub const LINES: &str = "lines";

/// Each effect is in one group and in the last one, which has all.
pub const GROUPS: [Group; 9] = [
    ("colors", colors),
    ("tones", || {
        of(&["tone_range", "tone_ramp", "tone_bands", "black_flats"])
    }),
    (LINES, || of(&["outlines", "contours"])),
    ("sketch", || of(&["sketch", "iso_lines"])),
    ("dots", || of(&["halftone", "misregistration"])),
    ("strokes", || of(&["hatching", "two_tone"])),
    ("paint", paint),
    ("page", || of(&["speed_lines", "paper", "vignette"])),
    ("all", || with_all(|_| true)),
];

fn of(names: &[&str]) -> ComicStyle {
    with_all(|name| names.contains(&name))
}

/// Effects with their defaults, but for drawings that do not change with time, and a sheet that is
/// fixed to the viewport: that of a part of a target is that of a target of its size.
fn with_all(is_in: impl Fn(&str) -> bool) -> ComicStyle {
    let still = ComicStyle::new()
        .with(Sketch {
            rate: 0.0,
            ..default()
        })
        .with(SpeedLines {
            rate: 0.0,
            ..default()
        })
        .with(Paper {
            anchor: PaperAnchor::View,
            ..default()
        });
    let mut style = ComicStyle::new();
    let types = EffectRegistry::built_in().types();
    for effect in types.into_iter().filter(|effect| is_in(effect.name)) {
        let own = still.by_name(effect.name).map(AnyEffect::boxed);
        style.insert_any(own.unwrap_or_else(effect.default));
    }
    style
}

fn colors() -> ComicStyle {
    of(&["desaturation", "color_harmony"]).with(Colorization {
        mode: ColorizationMode::Linear,
        ..default()
    })
}

fn paint() -> ComicStyle {
    of(&["abstraction", "depth_layers", "paint"]).with(Focus {
        at: FocusAt::Distance,
        distance: 6.0,
        ..default()
    })
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
