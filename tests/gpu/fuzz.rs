//! Untrusted files. `FUZZ_CASES=1000000` tries as many texts as are promised; without it, 2000.

use std::fmt::{Debug, Write};

use bevy::{
    ecs::world::{CommandQueue, World},
    prelude::Commands,
};
use bevy_comics_testkit::fuzz::{Counting, Texts, cases, check};

use crate::prelude::*;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A style with what no preset has.
const SCENE: &str = "(version: 3, camera: (dither: On, msaa: Sample8, tonemapping: Off), \
    scene: (light: (highlight: 0.5, ramp: (stops: [(at: 0.5, color: \"#336699\")], mode: PerLight)), \
    parts: [(names: \"eye*|*_eye\", light: (shadow_threshold: 0)), (names: \"skin\")], sections: 45, screens: true))";

/// Styles of the previous version, with its names.
const OLD: [&str; 3] = [
    r##"// specks in a comment stays
(
    version: 2,
    name: "form: Faithful, \"specks\"",
    color_harmony: (curve: Quadratic, form: Faithful),
    planes: (near: (saturation: 0.5), near_end: 0.125),
    outlines: (specks: 3, silhouettes: (form: Faithful), weight: (nib: 0.5)),
)
"##,
    "(version: 2, partial: true, contours: None, colorization: (form: Faithful))",
    "(version: 2, desaturation: (form: Corrected, amount: 0.5), depth_map: (mapping: Fixed(near: 1, far: 9)))",
];

/// The presets, in both versions, and older styles.
fn styles() -> impl Iterator<Item = String> {
    let presets = presets::STYLES.iter().chain(presets::PAPERS);
    let new = presets.map(|preset| preset.source().to_owned());
    // New names are read in old files, too.
    let aged = new
        .clone()
        .map(|text| text.replacen("version: 3", "version: 2", 1));
    let others = OLD.into_iter().chain([SCENE]);
    new.chain(aged).chain(others.map(str::to_owned))
}

/// Panics if a value has a number that is not finite. `text` is room for its debug text.
fn assert_finite(value: &impl Debug, text: &mut String) {
    text.clear();
    write!(text, "{value:?}").expect("written");
    let mut words = text.split(|c: char| !c.is_alphanumeric());
    assert!(!words.any(|word| matches!(word, "NaN" | "inf")), "{text}");
}

/// The word of the uniform of `SpeedLines` that is no number: the seed has all of its bits.
const SEED: (&str, usize) = ("speed_lines", 13);

/// Whatever a file says, what is used of it can be used: the numbers of all effects, of the lines
/// that they ask for, and of the depth map are finite, and so is what is packed for the GPU.
fn assert_usable(style: &ComicStyle, view: &EffectContext, text: &mut String) {
    let used = style.sanitized();
    assert!(used.sanitized() == used, "{used:?}");
    assert_finite(&(used.page, &used.depth_map), text);
    assert_finite(&used.scene, text);
    for effect in used.effects() {
        assert_finite(&effect, text);
        let lines = (effect.any_lines(), effect.any_line_modifiers(view));
        assert_finite(&lines, text);
        assert!((0.0..=1.0).contains(&effect.any_strength()), "{effect:?}");
        let name = effect.effect_type().name;
        for (k, word) in effect.uniform_bytes(view).chunks_exact(4).enumerate() {
            let x = f32::from_le_bytes([word[0], word[1], word[2], word[3]]);
            let is_right = x.is_finite() || (name, k) == SEED;
            assert!(is_right, "word {k} is {x}: {effect:?}");
        }
    }
}

/// Reads texts that are made of right ones. More than one in twenty must be right.
fn read_texts<T>(
    mut texts: Texts,
    read: impl Fn(&str) -> Option<T>,
    mut assert_right: impl FnMut(T),
) {
    let mut read_count = 0;
    for _ in 0..cases() {
        check(&texts.next_text(), |text| {
            if let Some(value) = read(text) {
                read_count += 1;
                assert_right(value);
            }
        });
    }
    assert!(read_count * 20 > cases(), "{read_count} texts are right");
}

/// A style that is read can be written, read again, used, and worn.
#[test]
fn parsing_a_style_never_panics() {
    // The first style that is read makes the tables of effects.
    let _ = presets::NOIR.style();
    let mut world = World::new();
    let camera = world.spawn_empty().id();
    let (view, mut shown) = (EffectContext::default(), String::new());
    let read = |text: &str| ComicStyle::from_ron(text).ok();
    read_texts(Texts::new(1, styles()), read, |style| {
        let written = style.to_ron().expect("what was read can be written");
        let again = ComicStyle::from_ron(&written).expect("what was written can be read");
        assert_eq!(again.to_ron().expect("again"), written);
        assert_usable(&style, &view, &mut shown);
        let mut queue = CommandQueue::default();
        style.apply(&mut Commands::new(&mut queue, &world).entity(camera));
        queue.apply(&mut world);
    });
}

/// All texts that others are made of are right, those of the previous version included.
#[test]
fn styles_of_both_versions_are_read() {
    for text in styles() {
        let read = ComicStyle::from_ron(&text);
        assert!(read.is_ok(), "{read:?}: {text}");
    }
}

/// A large file of the previous version with a name to replace in every few bytes.
#[test]
fn large_files_of_the_previous_version_are_read_in_time() {
    let fields = "form: Faithful, ".repeat(40_000);
    let text = format!("(version: 2, contours: ({fields}))");
    check(&text, |text| {
        let error = ComicStyle::from_ron(text).expect_err("fields are there twice");
        assert!(error.to_string().contains("equations"), "{error}");
    });
}

#[test]
fn parsing_a_shading_never_panics() {
    let kinds = crate::toon_shading::all_kinds();
    let written = kinds
        .iter()
        .map(|shading| shading.to_ron().expect("written"));
    let mut shown = String::new();
    let read = |text: &str| ToonShading::from_ron(text).ok();
    read_texts(Texts::new(2, written), read, |shading| {
        let used = shading.light.clone().sanitized();
        assert!(used.clone().sanitized() == used, "{used:?}");
        // The path of an image is no number, whatever it is.
        let numbers = ToonLight {
            ramp_map: RampMap::default(),
            ..used
        };
        assert_finite(&numbers, &mut shown);
        let written = shading.to_ron().expect("what was read can be written");
        let again = ToonShading::from_ron(&written).expect("what was written can be read");
        assert_eq!(again.to_ron().expect("again"), written);
    });
}
