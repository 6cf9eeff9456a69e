//! When a section was measured, and of which build.

use std::{
    path::Path,
    process::Command,
    time::{SystemTime, UNIX_EPOCH},
};

use crate::{sections::SECTIONS, table::Table};

/// The commit where git does not say it.
pub const UNKNOWN: &str = "unknown";

/// The date and the commit of a run.
#[derive(Clone)]
pub struct Stamp {
    /// In UTC, as 2026-01-31.
    pub date: String,
    pub commit: String,
}

impl Stamp {
    pub fn now() -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        let days = since.map_or(0, |time| time.as_secs() / 86_400);
        Self {
            date: civil(days),
            commit: commit(),
        }
    }

    /// Stores this as the stamp of a section in `sections.csv`.
    pub fn record(&self, folder: &Path, section: &str, seconds: f64) -> Result<(), String> {
        let path = folder.join("sections.csv");
        let mut table = if path.exists() {
            Table::load(&path)?
        } else {
            Table::new("section,date,commit,seconds")
        };
        table.rows.retain(|row| row[0] != section);
        let seconds = format!("{seconds:.0}");
        table.push(&[&section, &self.date, &self.commit, &seconds]);
        let place = |row: &Vec<String>| SECTIONS.iter().position(|known| known.name == row[0]);
        table.rows.sort_by_key(place);
        table
            .save(&path)
            .map_err(|error| format!("{}: {error}", path.display()))
    }
}

/// The date of a day, counted from 1970-01-01.
fn civil(day: u64) -> String {
    // Years begin with March here, so that a leap day is the last of its year.
    let day = day + 719_468;
    let (era, day) = (day / 146_097, day % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (month, later) = if month < 10 {
        (month + 3, 0)
    } else {
        (month - 9, 1)
    };
    format!("{:04}-{month:02}-{day:02}", 400 * era + year + later)
}

/// What git prints in the repository.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git")
        .args(["-C", env!("CARGO_MANIFEST_DIR")])
        .args(arguments)
        .output()
        .ok()?;
    let text = String::from_utf8_lossy(&output.stdout);
    output.status.success().then(|| text.trim().to_owned())
}

/// Files that matter to measurements: all but pages and the report's own tables.
const MEASURED: [&str; 4] = ["--", ".", ":(exclude)docs", ":(exclude)*.md"];

/// The last commit of files that matter, and whether one of them has changed since.
fn commit() -> String {
    let of = |command: &[&str]| git(&[command, &MEASURED].concat());
    let commit = of(&["log", "-1", "--format=%h"]).filter(|commit| !commit.is_empty());
    let Some(commit) = commit else {
        return UNKNOWN.to_owned();
    };
    let changed = of(&["status", "--porcelain", "--untracked-files=no"]);
    if changed.is_some_and(|files| files.is_empty()) {
        commit
    } else {
        format!("{commit} with changes")
    }
}
