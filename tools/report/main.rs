//! Measures error against run time, stability, what is left out, growth and flicker, and
//! writes the report.
//!
//! ```text
//! cargo run --example report                # writes docs/report
//! cargo run --example report -- --only soak # the long run, which runs apart
//! cargo run --example report -- --quick --out target/report
//! cargo run --example report -- --render    # text and plots from the CSV files
//! ```

mod arguments;
mod capture;
mod costs;
mod document;
mod flicker;
mod growth;
mod ink;
mod ladder;
mod lines;
mod many_objects;
mod models;
mod page;
mod page_styles;
mod parts;
mod peers;
mod plots;
mod ranges;
mod rig;
mod scores;
mod sections;
mod soak;
mod stability;
mod stamp;
mod straight;
mod table;
mod toon;

use std::{
    io::Write,
    num::NonZero,
    path::{Path, PathBuf},
    process::ExitCode,
    sync::Mutex,
    thread::ScopedJoinHandle,
    time::Instant,
};

use arguments::Arguments;
use bevy::math::UVec2;
use bevy_comics_testkit::{
    bench,
    headless::{self, Headless, HeadlessOptions},
};
use sections::{MACHINE, SECTIONS, Section};
use stamp::Stamp;
use table::Table;

/// How much is measured, and where the results go.
struct Run {
    pub quick: bool,
    /// Repetitions of every variant.
    pub rounds: usize,
    /// Timed frames of a repetition.
    pub frames: usize,
    folder: PathBuf,
    started: Instant,
    stamp: Stamp,
}

impl Run {
    pub fn say(&self, what: &str) {
        let seconds = self.started.elapsed().as_secs();
        println!("{:3}:{:02}  {what}", seconds / 60, seconds % 60);
        let _ = std::io::stdout().flush();
    }

    /// All of what a section measures, or the first `few` in a quick run, which shows only that the
    /// section works.
    pub fn some<T>(&self, few: usize, all: impl IntoIterator<Item = T>) -> Vec<T> {
        let count = if self.quick { few } else { usize::MAX };
        all.into_iter().take(count).collect()
    }

    /// What a quick run has, or any other.
    pub fn pick<T>(&self, quick: T, all: T) -> T {
        if self.quick { quick } else { all }
    }

    /// The size of pictures in a quick run, or in any other.
    pub fn size(&self, quick: [u32; 2], size: [u32; 2]) -> UVec2 {
        self.pick(quick, size).into()
    }

    /// The same with another number of rounds.
    pub fn with_rounds(&self, rounds: usize) -> Self {
        Self {
            rounds,
            folder: self.folder.clone(),
            stamp: self.stamp.clone(),
            ..*self
        }
    }

    pub fn folder(&self) -> &Path {
        &self.folder
    }

    pub fn save(&self, name: &str, table: &Table) -> Result<(), String> {
        let path = self.folder.join(format!("{name}.csv"));
        table
            .save(&path)
            .map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Measures sections, one after another. A quick run, whose times count for nothing, measures
    /// as many at once as there are cores. The first failure ends the run; the error names its
    /// section.
    fn measure_all(&self, sections: Vec<&Section>) -> Result<(), String> {
        let queue = Mutex::new(sections.into_iter());
        let record = Mutex::new(());
        let work = || {
            let next = || queue.lock().ok()?.next();
            while let Some(section) = next() {
                self.say(section.name);
                let started = Instant::now();
                let failed = |error| {
                    if let Ok(mut queue) = queue.lock() {
                        *queue = Vec::new().into_iter();
                    }
                    format!("section {}: {error}", section.name)
                };
                (section.measure)(self).map_err(failed)?;
                let seconds = started.elapsed().as_secs_f64();
                let _alone = record.lock();
                self.stamp.record(&self.folder, section.name, seconds)?;
            }
            Ok(())
        };
        if !self.quick {
            return work();
        }
        let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
        let results: Vec<Result<(), String>> = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
            let end = |worker: ScopedJoinHandle<Result<(), String>>| match worker.join() {
                Ok(result) => result,
                Err(_) => Err("a section panicked; its message is above".to_owned()),
            };
            workers.into_iter().map(end).collect()
        });
        let errors: Vec<String> = results.into_iter().filter_map(Result::err).collect();
        if errors.is_empty() {
            return Ok(());
        }
        Err(errors.join("\n"))
    }
}

fn run() -> Result<(), String> {
    let Some(arguments) = Arguments::parse()? else {
        return Ok(());
    };
    let Arguments {
        quick,
        rounds,
        only,
        out,
        ..
    } = &arguments;
    let problem = |error| format!("{}: {error}", out.display());
    std::fs::create_dir_all(out).map_err(problem)?;
    if !arguments.render {
        let run = Run {
            quick: *quick,
            rounds: rounds.map_or(if *quick { 1 } else { 7 }, NonZero::get),
            frames: if *quick { 1 } else { 2 },
            folder: out.clone(),
            started: Instant::now(),
            stamp: Stamp::now(),
        };
        headless::adapter()?;
        let is_wanted = |section: &&Section| {
            if only.is_empty() {
                !section.is_alone
            } else {
                only.iter().any(|name| name == section.name)
            }
        };
        run.measure_all(SECTIONS.iter().filter(is_wanted).collect())?;
        if !out.join("machine.csv").exists() {
            run.measure_all(vec![&MACHINE])?;
        }
    }
    if arguments.tables {
        return Ok(());
    }
    let text = document::render(out)?;
    std::fs::write(out.join("report.md"), text).map_err(problem)?;

    plots::draw(out)?;
    println!("{}", out.join("report.md").display());
    Ok(())
}

/// Writes what the report was measured on.
fn machine(run: &Run) -> Result<(), String> {
    let adapter = headless::adapter()?;
    let headless = Headless::new(
        HeadlessOptions {
            size: UVec2::new(16, 16),
            ..Default::default()
        },
        bevy_comics::ComicsPlugin,
    );
    let clean = |text: String| text.replace([',', '\n'], ";");
    let info = &adapter.info;
    let mut table = Table::new("what,value");
    let is_dev = cfg!(debug_assertions);
    let build = if is_dev { "dev" } else { "release" };
    let cores = std::thread::available_parallelism().map_or(0, usize::from);
    for (what, value) in [
        ("date", run.stamp.date.clone()),
        ("commit", run.stamp.commit.clone()),
        ("adapter", info.name.clone()),
        ("kind", format!("{:?}", info.device_type)),
        ("backend", info.backend.to_string()),
        ("driver", format!("{} {}", info.driver, info.driver_info)),
        ("cores", cores.to_string()),
        ("operating system", std::env::consts::OS.to_owned()),
        ("architecture", std::env::consts::ARCH.to_owned()),
        ("build", build.to_owned()),
        ("times", bench::method(&headless).to_owned()),
        (
            "repetitions",
            format!(
                "{} rounds of {} frames; {} rounds from 3 million pixels or a million vertices on",
                run.rounds,
                run.frames,
                run.rounds.min(3)
            ),
        ),
    ] {
        table.push(&[&what, &clean(value)]);
    }
    run.save("machine", &table)
}

/// Loads a CSV file of a report, by its name without the extension.
fn load(folder: &Path, name: &str) -> Result<Table, String> {
    Table::load(&folder.join(format!("{name}.csv")))
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
