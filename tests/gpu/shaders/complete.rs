//! Nothing of the shipped WGSL is left out: every entry point is composed, and every definition
//! that a file asks for is set for some entry point that the file is a part of.

use bevy_comics_testkit::asked::{File, definitions, files, has_entry_point, reached};

use super::{Definitions, fused, lines, materials, scene};
use crate::{prelude::*, toon_shaders};

/// The template of the fused pass; its text is that of the registry.
const FUSED: &str = "fused/fused.wgsl";

/// Definitions that the lists need not have.
const ALWAYS_SET: [(&str, &str); 1] = [("SAMPLES", "`wgsl::compose` sets it")];

/// The names of all definitions that each entry point is composed with, by file.
type Entries = BTreeMap<&'static str, BTreeSet<&'static str>>;

fn entries() -> Entries {
    let mut entries = Entries::new();
    let mut add = |file: &'static str, definitions: &Definitions| {
        let names = definitions.iter().map(|(name, _)| *name);
        entries.entry(file).or_default().extend(names);
    };
    for definitions in fused::variants() {
        add(FUSED, &definitions);
    }
    let variants = [lines::variants(), scene::variants(), materials::variants()].concat();
    for (file, definitions) in &variants {
        add(file, definitions);
    }
    for file in toon_shaders::FILES {
        add(file, &toon_shaders::all());
    }
    entries
}

/// The text that is composed.
fn source(file: &File) -> String {
    if file.path == FUSED {
        EffectRegistry::built_in().shader()
    } else {
        file.text.clone()
    }
}

#[test]
fn every_entry_point_is_composed_and_every_definition_that_a_file_asks_for_is_set() {
    let (files, entries) = (files(), entries());
    assert_all_composed(&files, &entries);
    assert_all_set(&files, entries);
}

fn assert_all_composed(files: &[File], entries: &Entries) {
    for file in files.iter().filter(|file| has_entry_point(&file.text)) {
        let path = file.path.as_str();
        assert!(entries.contains_key(path), "no test composes {path}");
    }
    for path in entries.keys() {
        let file = files.iter().find(|file| file.path == *path);
        assert!(
            file.is_some_and(|file| has_entry_point(&file.text)),
            "{path} has no entry point"
        );
    }
}

fn assert_all_set(files: &[File], entries: Entries) {
    let mut set = BTreeMap::<&str, BTreeSet<&str>>::new();
    for (path, names) in entries {
        let entry = files.iter().find(|file| file.path == path);
        let entry = entry.unwrap_or_else(|| panic!("{path} does not exist"));
        for file in [entry].into_iter().chain(reached(files, &source(entry))) {
            set.entry(&file.path).or_default().extend(&names);
        }
    }
    let none = BTreeSet::new();
    let mut missing = Vec::new();
    for file in files {
        let path = file.path.as_str();
        let set = set.get(path).unwrap_or(&none);
        let asked = definitions(&source(file));
        let is_set =
            |name: &str| set.contains(name) || ALWAYS_SET.iter().any(|(known, _)| *known == name);
        missing.extend(
            (asked.iter())
                .filter(|name| !is_set(name.as_str()))
                .map(|name| format!("{path}: {name}")),
        );
    }
    assert!(missing.is_empty(), "{missing:#?} are never set");
}

/// A file that no entry point imports is not compiled by anything.
#[test]
fn every_file_is_part_of_an_entry_point() {
    let files = files();
    let mut parts = BTreeSet::new();
    for file in files.iter().filter(|file| has_entry_point(&file.text)) {
        parts.insert(file.path.as_str());
        let reached = reached(&files, &source(file));
        parts.extend(reached.into_iter().map(|file| file.path.as_str()));
    }
    for file in &files {
        assert!(parts.contains(file.path.as_str()), "{}", file.path);
    }
}
