//! What the shipped WGSL asks for: the definitions of each file, and the files of each entry point.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use naga_oil::compose::get_preprocessor_data;

use crate::{ROOT, wgsl};

/// A WGSL file of the crate.
pub struct File {
    /// Its path in `src/`.
    pub path: String,
    pub text: String,
    /// The import path that it defines, if it can be imported.
    module: Option<String>,
    imports: Vec<String>,
}

/// Every WGSL file of the crate.
pub fn files() -> Vec<File> {
    let folder = Path::new(ROOT).join("src");
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).expect("a WGSL file");
        let (module, imports, _) = get_preprocessor_data(&text);
        let inside = path.strip_prefix(&folder).expect("a file of the crate");
        File {
            path: inside.to_string_lossy().into_owned(),
            module,
            imports: imports.into_iter().map(|import| import.import).collect(),
            text,
        }
    };
    wgsl::files().into_iter().map(read).collect()
}

/// The files with modules that a text imports, and those that these import.
pub fn reached<'a>(files: &'a [File], source: &str) -> Vec<&'a File> {
    let (_, imports, _) = get_preprocessor_data(source);
    let mut wanted: Vec<String> = imports.into_iter().map(|import| import.import).collect();
    let mut found: Vec<&File> = Vec::new();
    while let Some(name) = wanted.pop() {
        let file = files
            .iter()
            .find(|file| file.module.as_ref() == Some(&name));
        if let Some(file) = file
            && !found.iter().any(|known| known.path == file.path)
        {
            wanted.extend(file.imports.iter().cloned());
            found.push(file);
        }
    }
    found
}

/// Whether a text has an entry point.
pub fn has_entry_point(text: &str) -> bool {
    let is_entry = |line: &str| {
        let stages = ["@compute", "@fragment", "@vertex"];
        stages
            .iter()
            .any(|stage| line.trim_start().starts_with(stage))
    };
    text.lines().any(is_entry)
}

/// The definitions that a text asks for, by `#ifdef`, `#ifndef`, `#if` and `#{NAME}`.
pub fn definitions(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for line in text.lines() {
        let line = line.split("//").next().unwrap_or_default();
        if let Some(directive) = line.trim_start().strip_prefix('#') {
            let mut words = directive.split_whitespace();
            let first = words.next();
            let word = if first == Some("else") {
                words.next()
            } else {
                first
            };
            if let Some("ifdef" | "ifndef" | "if") = word {
                found.extend(words.next().map(str::to_owned));
            }
        }
        for part in line.split("#{").skip(1) {
            found.extend(part.split('}').next().map(str::to_owned));
        }
    }
    found
}
