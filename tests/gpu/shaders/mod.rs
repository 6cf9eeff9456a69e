//! Every shader variant that production can ask for composes and validates; where there are too
//! many of them, every pair of what selects them. `scripts/translate` translates what the tests of
//! this folder and of `toon_shaders` compose, and nothing else.

pub mod covering;
mod effects;
mod fused;
mod lines;
pub mod materials;
mod parts;
mod scene;

use std::fs;

use bevy_comics_testkit::wgsl::{files, module_with};

use crate::{prelude::*, toon_shaders};

/// Definitions that are set together.
pub type Definitions = Vec<Definition<'static>>;

/// An entry point, by the path of its file in `src/`, with its definitions.
pub type Variant = (&'static str, Definitions);

/// The text of a shader of the crate. `name`: the end of its path.
pub fn shader(name: &str) -> String {
    let path = files()
        .into_iter()
        .find(|path| path.ends_with(name))
        .expect("a shader of the crate");
    fs::read_to_string(path).expect("readable")
}

/// Composes entry points that need little of the engine.
fn check(variants: &[Variant]) {
    let mut texts = HashMap::new();
    for (file, definitions) in variants {
        let source: &String = texts.entry(*file).or_insert_with(|| shader(file));
        if let Err(error) = module_with(source, definitions) {
            panic!("{file}, {definitions:?}: {error}");
        }
    }
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

/// The definitions that the text of a shader asks for.
fn asked(text: &str) -> Vec<&str> {
    let conditions = text.lines().filter_map(|line| {
        let directive = line.trim_start().strip_prefix('#')?;
        let condition = directive.strip_prefix("else ").unwrap_or(directive);
        let mut words = condition.split_whitespace();
        matches!(words.next(), Some("ifdef" | "ifndef" | "if")).then(|| words.next())?
    });
    let values = text.split("#{").skip(1);
    let values = values.filter_map(|rest| rest.split('}').next());
    conditions.chain(values).collect()
}

/// What no list has is compiled by none of these tests.
#[test]
fn every_definition_that_shaders_ask_for_is_listed() {
    let entries = [lines::variants(), scene::variants(), materials::variants()].concat();
    let entries = entries.into_iter().map(|(_, definitions)| definitions);
    let fused = fused::variants().into_iter();
    let all = entries.chain(fused).chain([toon_shaders::listed()]);
    let mut listed: BTreeSet<&str> = all.flatten().map(|(name, _)| name).collect();
    // `wgsl::module_with` sets it.
    listed.insert("SAMPLES");
    let read = |path: PathBuf| fs::read_to_string(path).expect("a shader");
    let texts: Vec<String> = files().into_iter().map(read).collect();
    let names: BTreeSet<&str> = texts.iter().flat_map(|text| asked(text)).collect();
    assert!(names.len() > 100, "the check sees {names:?}");
    let missing: Vec<_> = names.difference(&listed).collect();
    assert!(missing.is_empty(), "no list has {missing:?}");
}
