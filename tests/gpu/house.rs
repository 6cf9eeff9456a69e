//! The layout of the crate: which module imports which.

use std::fs;

use crate::prelude::*;

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

fn files(folder: &Path, extension: &str, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder of the crate") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, extension, found);
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
}

/// The top-level module of a file.
fn room(path: &Path) -> String {
    let relative = path.strip_prefix(source()).expect("a file of the crate");
    let first = relative.components().next().expect("a name");
    let name = first.as_os_str().to_string_lossy();
    name.trim_end_matches(".rs").to_owned()
}

/// The code without comments and without its unit tests.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("a source file");
    let text = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    text.lines()
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
}

/// The first names of the paths inside `crate::...`: `a` and `B` of
/// `crate::{a::C, B}`, and `a` of `crate::a::C`.
fn heads(code: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for after in code.split("crate::").skip(1) {
        let Some(group) = after.strip_prefix('{') else {
            found.insert(identifier(after));
            continue;
        };
        let mut depth = 0;
        let mut start = true;
        for (at, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => start = true,
                c if depth == 0 && start && !c.is_whitespace() => {
                    found.insert(identifier(&group[at..]));
                    start = false;
                }
                _ => {}
            }
        }
    }
    found
}

fn identifier(text: &str) -> String {
    text.chars()
        .take_while(|c| c.is_alphanumeric() || *c == '_')
        .collect()
}

/// Which module each name at the crate's root comes from.
fn exports() -> BTreeMap<String, String> {
    let mut origin = BTreeMap::new();
    let root = code(&source().join("lib.rs"));
    for statement in root.split("pub use ").skip(1) {
        let statement = statement.split(';').next().unwrap_or_default();
        let module = identifier(statement);
        // `cameras`, `testing` and `prelude` export again what modules have.
        if module == "crate" {
            continue;
        }
        for name in statement[module.len()..].split(|c: char| !c.is_alphanumeric() && c != '_') {
            if !name.is_empty() {
                origin.entry(name.to_owned()).or_insert(module.clone());
            }
        }
    }
    origin
}

/// Module -> the modules that it imports, through the crate's root too.
fn imports() -> BTreeMap<String, BTreeSet<String>> {
    let mut sources = Vec::new();
    files(&source(), "rs", &mut sources);
    let rooms: BTreeSet<String> = sources.iter().map(|path| room(path)).collect();
    let exports = exports();
    let mut graph: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for path in &sources {
        let own = room(path);
        // The root and the plugin put everything together.
        let is_test =
            path.ends_with("tests.rs") || path.parent().is_some_and(|p| p.ends_with("tests"));
        if is_test || ["lib", "plugin"].contains(&own.as_str()) {
            continue;
        }
        for head in heads(&code(path)) {
            let module = exports.get(&head).cloned().unwrap_or(head);
            if rooms.contains(&module) && module != own {
                graph.entry(own.clone()).or_default().insert(module);
            }
        }
    }
    graph
}

/// A path from a module back to itself, if there is one.
fn circle(graph: &BTreeMap<String, BTreeSet<String>>) -> Option<Vec<String>> {
    fn walk(
        graph: &BTreeMap<String, BTreeSet<String>>,
        path: &mut Vec<String>,
        done: &mut BTreeSet<String>,
    ) -> Option<Vec<String>> {
        let here = path.last().expect("a module").clone();
        for next in graph.get(&here).into_iter().flatten() {
            if let Some(at) = path.iter().position(|known| known == next) {
                return Some(path[at..].to_vec());
            }
            if !done.contains(next) {
                path.push(next.clone());
                if let Some(found) = walk(graph, path, done) {
                    return Some(found);
                }
                path.pop();
            }
        }
        done.insert(here);
        None
    }
    let mut done = BTreeSet::new();
    graph
        .keys()
        .find_map(|start| walk(graph, &mut vec![start.clone()], &mut done))
}

#[test]
fn no_modules_import_each_other_in_a_circle() {
    let graph = imports();
    let imported: BTreeSet<&str> = graph.values().flatten().map(String::as_str).collect();
    for module in ["composite", "effects", "lines", "objects", "origin"] {
        let is_seen = imported.contains(module);
        assert!(is_seen, "the check sees no imports of {module}: {graph:#?}");
    }
    assert_eq!(circle(&graph), None, "{graph:#?}");
}

/// Shaders ask for the definitions of their own effect alone, and those of services for none.
#[test]
fn shaders_know_no_other_effect() {
    let mut shaders = Vec::new();
    files(&source(), "wgsl", &mut shaders);
    let mut asked = 0;
    for path in shaders {
        let folder = path.parent().and_then(Path::file_name).expect("a folder");
        let own = folder.to_string_lossy().to_uppercase();
        let text = fs::read_to_string(&path).expect("a shader");
        let words = text.split(|c: char| !c.is_ascii_uppercase() && c != '_');
        for name in words.filter_map(|word| Some(word.split_once("EFFECT_")?.1)) {
            asked += 1;
            let is_own = room(&path) == "effects" && name.starts_with(&own);
            assert!(is_own, "{} asks for {name}", path.display());
        }
    }
    assert!(asked > 0, "the check sees no definitions");
}

/// The test binary does not fail for a name that matches no test: `scripts/gpu` would test less
/// than it says, or run what it means to leave out.
#[test]
fn the_tests_that_the_script_for_gpus_names_exist() {
    let program = std::env::current_exe().expect("the path of the tests");
    let output = Command::new(program).arg("--list").output();
    let list = String::from_utf8(output.expect("they start").stdout).expect("names");
    let tests: Vec<&str> = list
        .lines()
        .filter_map(|line| line.strip_suffix(": test"))
        .collect();
    let script = fs::read_to_string(source().with_file_name("scripts/gpu")).expect("the script");
    let code = script.lines().filter(|line| !line.trim().starts_with('#'));
    let words = code.flat_map(|line| line.split([' ', '(', ')']));
    let names: Vec<&str> = words
        .filter(|word| word.contains("::") && !word.contains('"'))
        .collect();
    assert!(names.len() >= 10, "the check sees {names:?}");
    for name in names {
        let is_named =
            |test: &&str| *test == name || (name.ends_with("::") && test.starts_with(name));
        assert!(
            tests.iter().any(is_named),
            "scripts/gpu names {name}, which is no test"
        );
    }
}
