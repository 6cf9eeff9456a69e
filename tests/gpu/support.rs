//! The table of support in `docs/support.md` is made from the facts of `facts.rs`, and every test that
//! it names exists.

mod facts;

use std::{fmt::Write, fs, sync::LazyLock};

use bevy_comics::effect::EffectType;
use facts::{FACTS, Feature, GROUPS, Group, Known, OF_LOOKS, OF_PRESETS, PAIRED};

use crate::{
    pairwise::{
        self,
        covering::{AntiAliasing, Area, Row, View},
        effects,
    },
    pictures::known_forms,
    prelude::*,
};

const HEAD: &str = "\
# What is supported

Each cell is about one effect and one feature, and says how the answer is known:

* **run**: a test draws this effect with this feature. The numbers are those of the tests at the end of this page. The
  adapter is lavapipe, a Vulkan driver that renders on the CPU; no GPU has run these tests.
* **translated**: `scripts/translate` translates the shaders of this effect for this platform. Nothing was drawn there.
* **not supported**: the text says what happens instead.
* **unknown**: no test draws this effect with this feature. It may work.

A cell says nothing about two features at once, or about two effects at once. Pairs are what the tests of
[`pairwise`](../tests/gpu/pairwise/mod.rs) are for: of the number of samples (1, 4), HDR, the renderer (forward, deferred),
the projection (perspective and the three below), anti-aliasing (none, FXAA, SMAA, TAA), the area (the whole target, a
viewport, a lower resolution) and nine groups of effects, every two are drawn together at least once, and compared with the
plainest camera. One of the groups is all effects on one camera, where `Sketch` takes the place of `Outlines`. Left out are
the pairs that the engine does not support: more than one sample with the deferred renderer or with TAA, and TAA with a
viewport. Three at once are drawn only where they happen to meet. The other columns are not paired with each other; where
they have numbers for every effect, all groups of effects are drawn with them.
";

const FOOT: &str = "
A test of `tests/gpu/support.rs` makes this page from the table in `tests/gpu/support/facts.rs`, and fails where the two
differ: a new effect has no row until the page is made again with
`UPDATE_DOCS=1 cargo test --test gpu -- support::`.
";

/// The sample counts of lavapipe, of whose rows the page tells.
const SAMPLES: &[u32] = &[1, 4];

/// The rows of the tests of pairs.
static ROWS: LazyLock<Vec<(&str, Vec<Row>)>> = LazyLock::new(|| {
    let tests = pairwise::TESTS.iter().enumerate();
    let rows = tests.map(|(k, test)| (*test, pairwise::rows_of(k, SAMPLES)));
    rows.collect()
});

/// Whether a row of the tests of pairs has a feature.
fn has(row: &Row, feature: Feature) -> bool {
    match feature {
        Feature::Msaa1 => row.samples == 1,
        Feature::Msaa4 => row.samples == 4,
        Feature::Hdr => row.hdr,
        Feature::Taa => row.anti_aliasing == AntiAliasing::Taa,
        Feature::Fxaa => row.anti_aliasing == AntiAliasing::Fxaa,
        Feature::Smaa => row.anti_aliasing == AntiAliasing::Smaa,
        Feature::Resolution => row.area == Area::SmallMainPass,
        Feature::Viewport => row.area == Area::Part,
        Feature::Deferred => row.deferred,
        Feature::Orthographic => row.view == View::Orthographic,
        Feature::Oblique => row.view == View::ClipPlane,
        Feature::OffCentre => row.view == View::OffCentre,
        _ => false,
    }
}

/// The tests of pairs that draw an effect with a feature.
fn pairs(feature: Feature, effect: &str) -> impl Iterator<Item = &'static str> {
    let draws = effects::GROUPS.map(|group| effects::draws(&group, effect));
    let is_drawn = move |row: &Row| has(row, feature) && draws[row.effects];
    let drawing = ROWS
        .iter()
        .filter(move |(_, rows)| rows.iter().any(is_drawn));
    drawing.map(|(test, _)| *test)
}

/// All tests that facts name, in the order of the table.
fn tests() -> Vec<&'static str> {
    let mut tests = Vec::new();
    for (_, _, known) in FACTS {
        let named = match known {
            Known::Run(test) => vec![*test],
            Known::Pairs => pairwise::TESTS.to_vec(),
            _ => Vec::new(),
        };
        for test in named {
            if !tests.contains(&test) {
                tests.push(test);
            }
        }
    }
    tests
}

/// The path of the file of a module of tests, from the root of the repository.
pub fn file_of(module: &str) -> String {
    let name = module.replace("::", "/");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let paths = ["", "/mod"].map(|end| format!("tests/gpu/{name}{end}.rs"));
    let path = paths.into_iter().find(|path| root.join(path).is_file());
    path.unwrap_or_else(|| panic!("{module}: there is no such module"))
}

/// The path of the file that has a test, from the root of the repository, and the name of the function.
fn source(test: &str) -> (String, &str) {
    let (module, function) = test.rsplit_once("::").expect("module::function");
    (file_of(module), function)
}

/// Panics if a test does not exist, or is not compiled.
pub fn assert_is_test(test: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let modules = fs::read_to_string(root.join("tests/gpu/main.rs")).expect("the list of modules");
    let (path, function) = source(test);
    let text = fs::read_to_string(root.join(&path)).expect("a source file");
    // Long tests are `#[ignore = "..."]`, on a line of its own.
    let lines: Vec<&str> = text.lines().collect();
    let wanted = format!("fn {function}(");
    let is_test = lines.iter().enumerate().any(|(i, line)| {
        let above = lines[..i].iter().rev();
        let mut attributes = above.take_while(|line| line.starts_with("#["));
        line.starts_with(&wanted) && attributes.any(|line| *line == "#[test]")
    });
    assert!(is_test, "{path} has no test `{function}`");
    let module = test.split("::").next().unwrap_or_default();
    let wanted = format!("mod {module};");
    assert!(modules.contains(&wanted), "{module} is not compiled");
}

/// What is known of a feature with an effect.
fn known(feature: Feature, effect: &str) -> Vec<Known> {
    let about = FACTS.iter().filter(|(features, effects, _)| {
        features.contains(&feature) && (effects.is_empty() || effects.contains(&effect))
    });
    let expanded = about.flat_map(|(_, _, known)| match known {
        Known::Pairs => pairs(feature, effect).map(Known::Run).collect(),
        known => vec![*known],
    });
    expanded.collect()
}

/// The kind of a cell, and its text: tests, or the strongest of the other facts.
fn cell(feature: Feature, effect: &str, tests: &[&str]) -> (&'static str, String) {
    let facts = known(feature, effect);
    let mut numbers = Vec::new();
    let mut instead = None;
    let mut translated = false;
    for fact in &facts {
        match fact {
            Known::Run(test) => {
                let at = tests.iter().position(|known| known == test);
                numbers.push(at.expect("listed") + 1);
            }
            Known::NotSupported(text) => instead = Some(*text),
            Known::Translated => translated = true,
            // Pairs are named by their tests.
            Known::Pairs | Known::Unknown => {}
        }
    }
    assert!(
        !facts.is_empty(),
        "`FACTS` does not say whether {effect} works with {feature:?}"
    );
    if !numbers.is_empty() {
        numbers.sort_unstable();
        let numbers: Vec<String> = numbers.iter().map(usize::to_string).collect();
        return ("run", format!("run {}", numbers.join(", ")));
    }
    match instead {
        Some(text) => ("not supported", format!("not supported: {text}")),
        None if translated => ("translated", "translated".to_owned()),
        None => ("unknown", "unknown".to_owned()),
    }
}

fn table(
    page: &mut String,
    group: &Group,
    effects: &[&EffectType],
    tests: &[&str],
    counts: &mut BTreeMap<&'static str, usize>,
) {
    let _ = write!(page, "\n## {}\n\n{}\n\n| effect |", group.title, group.note);
    for (_, title) in group.features {
        let _ = write!(page, " {title} |");
    }
    page.push_str("\n|---|");
    page.push_str(&"---|".repeat(group.features.len()));
    page.push('\n');
    for effect in effects {
        let name = (effect.type_info)().type_path_table().short_path();
        let _ = write!(page, "| `{name}` |");
        for (feature, _) in group.features {
            let (kind, text) = cell(*feature, effect.name, tests);
            *counts.entry(kind).or_default() += 1;
            let _ = write!(page, " {text} |");
        }
        page.push('\n');
    }
}

fn page() -> String {
    let effects = EffectRegistry::built_in().types();
    let tests = tests();
    let mut counts = BTreeMap::new();
    let mut tables = String::new();
    for group in GROUPS {
        table(&mut tables, group, &effects, &tests, &mut counts);
    }
    let all: usize = counts.values().sum();
    let counts: Vec<String> = (counts.iter())
        .map(|(kind, count)| format!("{count} {kind}"))
        .collect();
    let counts = counts.join(", ");
    let mut page = format!("{HEAD}\nOf {all} cells: {counts}.\n{tables}\n## Tests\n\n");
    for (i, test) in tests.iter().enumerate() {
        let (path, _) = source(test);
        let _ = writeln!(page, "{}. [`{test}`](../{path})", i + 1);
    }
    page + FOOT
}

#[test]
fn the_table_of_support_is_that_of_the_facts() {
    let made = page();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/support.md");
    if std::env::var_os("UPDATE_DOCS").is_some() {
        fs::write(&path, &made).expect("written");
    }
    assert_eq!(
        crate::guide::page("support.md"),
        made,
        "UPDATE_DOCS=1 cargo test --test gpu -- support::"
    );
}

#[test]
fn every_test_of_the_table_of_support_exists() {
    for test in tests() {
        assert_is_test(test);
    }
}

/// A fact about an effect or a feature that is not in the table would be lost.
#[test]
fn facts_of_the_table_of_support_are_about_what_there_is() {
    let registry = EffectRegistry::built_in();
    let shown = || GROUPS.iter().flat_map(|group| group.features);
    for (features, effects, known) in FACTS {
        for effect in *effects {
            assert!(registry.get(effect).is_some(), "{effect}: {known:?}");
        }
        for feature in *features {
            let columns = shown().filter(|(known, _)| known == feature).count();
            assert_eq!(columns, 1, "columns of {feature:?}");
        }
    }
}

/// Every effect is in a row of pairs with every feature that rows have, and cells name no test that has none.
#[test]
fn pairs_of_the_table_of_support_are_in_rows() {
    for effect in EffectRegistry::built_in().types() {
        for feature in PAIRED {
            let found = pairs(*feature, effect.name).count();
            assert!(found > 0, "{}, {feature:?}", effect.name);
        }
        assert_eq!(pairs(Feature::Skinned, effect.name).count(), 0);
    }
}

/// Every effect is drawn by a test that the table names, so that a new effect is not left at "unknown".
#[test]
fn every_effect_is_drawn_by_a_test_of_the_table_of_support() {
    for effect in EffectRegistry::built_in().types() {
        let facts = known(Feature::Vulkan, effect.name);
        let is_drawn = facts.iter().any(|fact| matches!(fact, Known::Run(_)));
        assert!(is_drawn, "`FACTS` has no test that draws {}", effect.name);
    }
}

/// The tests that draw all presets draw these effects.
#[test]
fn presets_have_the_effects_of_the_table_of_support() {
    let known: Vec<ComicStyle> = presets::ALL.iter().flat_map(known_forms).collect();
    let looks: Vec<ComicStyle> = presets::STYLES.iter().map(|look| look.style()).collect();
    for (effects, styles) in [(OF_PRESETS, known), (OF_LOOKS, looks)] {
        for effect in effects {
            let mut all = styles.iter();
            assert!(all.any(|style| style.by_name(effect).is_some()), "{effect}");
        }
    }
}
