//! Translates shaders for all platforms, and holds them to the limits of WebGPU.
//!
//! `translate FOLDER`: every `*.wgsl` file of the folder becomes SPIR-V (checked by `spirv-val`),
//! MSL, HLSL and GLSL ES 3.10 (checked by `glslangValidator`). Prints a table, and what failed. The
//! exit status is 1 if something failed that is not among the known gaps of GLSL ES.
//!
//! `translate --browser FOLDER`: every file is compiled by Chromium's WebGPU.

mod browser;
mod limits;
mod writers;

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use writers::Language;

/// A composed shader: valid, with what it needs beyond WebGPU.
pub struct Shader {
    /// The names of its entry points.
    pub name: String,
    pub module: naga::Module,
    pub info: ModuleInfo,
    /// Capabilities that WebGPU has not by itself.
    pub needs: Capabilities,
}

impl Shader {
    fn read(text: &str) -> Result<Self, String> {
        let module =
            naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
        let valid =
            |capabilities| Validator::new(ValidationFlags::all(), capabilities).validate(&module);
        // WebGPU converts packed halves everywhere.
        let web = Capabilities::default() | Capabilities::SHADER_FLOAT16_IN_FLOAT32;
        let mut needs = Capabilities::empty();
        let info = match valid(web) {
            Ok(info) => info,
            Err(_) => {
                let info = valid(Capabilities::all()).map_err(|e| format!("{:?}", e.as_inner()))?;
                // The fewest of those that it needs.
                let others = Capabilities::all() & !web;
                for one in others.iter() {
                    if valid(Capabilities::all() & !one).is_err() {
                        needs |= one;
                    }
                }
                info
            }
        };
        let names = module.entry_points.iter().map(|entry| entry.name.clone());
        let name = names.collect::<Vec<_>>().join(", ");
        Ok(Self {
            name,
            module,
            info,
            needs,
        })
    }
}

/// What became of the shaders of a name.
#[derive(Default)]
struct Row {
    variants: usize,
    /// Failures of each language.
    failed: BTreeMap<Language, usize>,
    needs: Capabilities,
}

#[derive(Default)]
struct Results {
    rows: BTreeMap<String, Row>,
    /// What failed: the first example of each message.
    failures: BTreeMap<String, String>,
}

impl Results {
    fn fail(&mut self, what: &str, file: &Path, message: &str) {
        // Tools begin with the path of the file.
        let is_error = |line: &&str| line.to_lowercase().contains("error");
        let mut lines = message.lines().filter(|line| !line.trim().is_empty());
        let first = lines.clone().next();
        let line = lines.find(is_error).or(first);
        let line: String = line.unwrap_or("no message").chars().take(240).collect();
        let example = || format!("{}:\n{message}", file.display());
        self.failures
            .entry(format!("{what}: {line}"))
            .or_insert_with(example);
    }
}

fn check(file: &Path, results: &Mutex<Results>) {
    let lock = || results.lock().expect("no panic");
    let text = match fs::read_to_string(file) {
        Ok(text) => text,
        Err(error) => return lock().fail("read", file, &error.to_string()),
    };
    let shader = match Shader::read(&text) {
        Ok(shader) => shader,
        Err(error) => return lock().fail("WGSL", file, &error),
    };
    let over = limits::exceeded(&shader);
    let scratch = file.with_extension("");
    let outcomes =
        Language::ALL.map(|language| (language, writers::write(language, &shader, &scratch)));
    let mut results = lock();
    let empty = || Row {
        needs: Capabilities::empty(),
        ..Row::default()
    };
    let row = results
        .rows
        .entry(shader.name.clone())
        .or_insert_with(empty);
    row.variants += 1;
    row.needs |= shader.needs;
    for (language, outcome) in &outcomes {
        *row.failed.entry(*language).or_default() += usize::from(outcome.is_err());
    }
    for message in over {
        results.fail("limits of WebGPU", file, &message);
    }
    for (language, outcome) in outcomes {
        if let Err(message) = outcome {
            results.fail(language.name(), file, &message);
        }
    }
}

fn files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder)?.collect::<Result<Vec<_>, _>>()?;
    let mut files: Vec<_> = entries.into_iter().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "wgsl"));
    files.sort();
    Ok(files)
}

fn print(results: &Results) {
    let languages = Language::ALL.map(Language::name).join(" | ");
    println!("| entry points | variants | {languages} | beyond WebGPU |");
    println!("|---|---|---|---|---|---|---|");
    for (name, row) in &results.rows {
        let cell = |language| match row.failed.get(&language) {
            Some(0) | None => "all".to_owned(),
            Some(failed) => format!("{} of {}", row.variants - failed, row.variants),
        };
        let cells = Language::ALL.map(cell).join(" | ");
        let needs: Vec<_> = row.needs.iter_names().map(|(name, _)| name).collect();
        println!(
            "| `{name}` | {} | {cells} | {} |",
            row.variants,
            needs.join(", ")
        );
    }
}

fn main() -> ExitCode {
    let mut arguments: Vec<_> = std::env::args_os().skip(1).collect();
    let in_browser = arguments.first().is_some_and(|first| first == "--browser");
    arguments.drain(..usize::from(in_browser));
    let [folder] = &arguments[..] else {
        eprintln!("usage: translate [--browser] FOLDER");
        return ExitCode::from(2);
    };
    let files = match files(Path::new(folder)) {
        Ok(files) if !files.is_empty() => files,
        Ok(_) => {
            eprintln!("no *.wgsl files in {}", Path::new(folder).display());
            return ExitCode::from(2);
        }
        Err(error) => {
            eprintln!("cannot read {}: {error}", Path::new(folder).display());
            return ExitCode::from(2);
        }
    };
    if in_browser {
        return match browser::compile(&files) {
            Ok(all) => ExitCode::from(u8::from(!all)),
            Err(error) => {
                eprintln!("{error}");
                ExitCode::from(2)
            }
        };
    }
    let (next, results) = (AtomicUsize::new(0), Mutex::new(Results::default()));
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(file) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
                    check(file, &results);
                }
            });
        }
    });
    let results = results.into_inner().expect("no panic");
    print(&results);
    let unknown: Vec<_> = (results.failures.iter())
        .filter(|(what, _)| !writers::is_known_gap(what))
        .collect();
    println!(
        "\n{} files, {} kinds of failures, {} unknown",
        files.len(),
        results.failures.len(),
        unknown.len()
    );
    for (what, example) in &results.failures {
        println!("\n## {what}\n{example}");
    }
    ExitCode::from(u8::from(!unknown.is_empty()))
}
