//! Measures error against run time, stability, what is left out, growth and flicker, and
//! writes the report.
//!
//! ```text
//! cargo run --release --example report                # writes docs/report in half an hour
//! cargo run --example report -- --quick --out target/report
//! cargo run --example report -- --render              # text and plots from the CSV files
//! ```

mod arguments;
mod bare;
mod capture;
mod costs;
mod document;
mod encodings;
mod flicker;
mod growth;
mod ink;
mod ladder;
mod lines;
mod meadow;
mod models;
mod page;
mod parts;
mod peers;
mod plots;
mod ranges;
mod rig;
mod scores;
mod soak;
mod stability;
mod steps;
mod straight;
mod table;
mod toon;

use std::{
    io::Write,
    path::{Path, PathBuf},
    process::ExitCode,
    time::Instant,
};

use arguments::Arguments;
use bevy_comics_testkit::{
    bench,
    headless::{self, Headless, HeadlessOptions},
};
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
}

impl Run {
    pub fn say(&self, what: &str) {
        let seconds = self.started.elapsed().as_secs();
        println!("{:3}:{:02}  {what}", seconds / 60, seconds % 60);
        let _ = std::io::stdout().flush();
    }

    /// The same with another number of rounds.
    pub fn with_rounds(&self, rounds: usize) -> Self {
        Self {
            rounds,
            folder: self.folder.clone(),
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
}

type Section = fn(&Run) -> Result<(), String>;

const SECTIONS: [(&str, Section); 21] = [
    ("machine", machine),
    ("ranges", ranges::measure),
    ("encodings", encodings::measure),
    ("lines", lines::measure),
    ("models", models::measure),
    ("steps", steps::measure),
    ("dashes", ink::dashes),
    ("dash-steps", ink::dash_steps),
    ("memory", ink::memory),
    ("meadow", meadow::measure),
    ("straight", straight::measure),
    ("page", page::measure),
    ("stability", stability::measure),
    ("ladder", ladder::measure),
    ("parts", parts::measure),
    ("scene-parts", parts::of_scenes),
    ("toon", toon::measure),
    ("growth", growth::measure),
    ("peers", peers::measure),
    ("flicker", flicker::measure),
    ("soak", soak::measure),
];

fn run() -> Result<(), String> {
    let Some(arguments) = Arguments::parse()? else {
        return Ok(());
    };
    let Arguments {
        quick, only, out, ..
    } = &arguments;
    let problem = |error| format!("{}: {error}", out.display());
    std::fs::create_dir_all(out).map_err(problem)?;
    if !arguments.render {
        let run = Run {
            quick: *quick,
            rounds: if *quick { 2 } else { 7 },
            frames: if *quick { 1 } else { 2 },
            folder: out.clone(),
            started: Instant::now(),
        };
        headless::adapter()?;
        for (name, measure) in SECTIONS {
            if only.as_deref().is_none_or(|o| o == name) {
                run.say(name);
                measure(&run)?;
            }
        }
        if !out.join("machine.csv").exists() {
            machine(&run)?;
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
            size: bevy::math::UVec2::new(16, 16),
            ..Default::default()
        },
        bevy_comics::ComicsPlugin,
    );
    let clean = |text: String| text.replace([',', '\n'], ";");
    let info = &adapter.info;
    let mut table = Table::new(&["what", "value"]);
    let cores = std::thread::available_parallelism().map_or(0, usize::from);
    for (what, value) in [
        ("adapter", info.name.clone()),
        ("kind", format!("{:?}", info.device_type)),
        ("backend", info.backend.to_string()),
        ("driver", format!("{} {}", info.driver, info.driver_info)),
        ("cores", cores.to_string()),
        ("operating system", std::env::consts::OS.to_owned()),
        ("architecture", std::env::consts::ARCH.to_owned()),
        (
            "build",
            if cfg!(debug_assertions) {
                "dev"
            } else {
                "release"
            }
            .to_owned(),
        ),
        ("times", bench::method(&headless).to_owned()),
        (
            "repetitions",
            format!(
                "{} rounds of {} frames; 3 rounds from 3 million pixels or a million vertices on",
                run.rounds, run.frames
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
