//! The report's text: what each section asks, and how many of its targets are met.

use std::{fmt::Write, path::Path};

use super::{
    figures::figure,
    target::{Count, Target},
    targets,
};
use crate::{
    load,
    sections::{SECTIONS, Section},
    stamp::UNKNOWN,
    table::Table,
};

/// The part of a link after `#` that leads to a heading.
fn anchor(heading: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || " -_".contains(*c);
    let text: String = heading.to_lowercase().chars().filter(kept).collect();
    text.replace(' ', "-")
}

/// The sections of the index.
fn asked() -> impl Iterator<Item = Section> {
    SECTIONS
        .into_iter()
        .filter(|section| !section.question.is_empty())
}

/// Whether a stamp names a commit, without changes since.
fn is_exact(commit: &str) -> bool {
    commit != UNKNOWN && !commit.contains(' ')
}

/// When and at which commits all sections were measured.
fn runs(stamps: &Table) -> String {
    let is_alone = |row: &&Vec<String>| SECTIONS.iter().any(|s| s.is_alone && s.name == row[0]);
    let (alone, all): (Vec<_>, Vec<_>) = stamps.rows.iter().partition(is_alone);
    let commits = stamps.distinct(&all, "commit");
    let mut dates = stamps.distinct(&all, "date");
    dates.sort();
    let (Some(first), Some(last)) = (dates.first(), dates.last()) else {
        return String::new();
    };
    let days = if first == last {
        format!("on {first}")
    } else {
        format!("from {first} to {last}")
    };
    let seconds: f64 = stamps.numbers(&all, "seconds").iter().sum();
    let is_stamped = |section: &Section| all.iter().any(|row| row[0] == section.name);
    let is_whole = asked().all(|section| section.is_alone || is_stamped(&section));
    let when = match commits.as_slice() {
        [commit] if is_whole && is_exact(commit) => format!(
            "All sections but the long run were measured at one commit, {commit}, {days}; their times add up to {:.0} minutes.",
            seconds / 60.0
        ),
        _ => format!(
            "The sections were not measured at one commit: the last column says when, at which commit, and in how many \
             seconds ({days}). Where it is empty, that was not recorded."
        ),
    };
    let alone: Vec<String> = alone.iter().map(|row| stamp_of(stamps, row)).collect();
    if alone.is_empty() {
        when
    } else {
        format!("{when} The long run: {}.", alone.join("; "))
    }
}

/// When and of what everything was measured, as far as the tables say so.
pub fn measured(machine: &Table, stamps: Option<&Table>) -> String {
    let about = |what| {
        let rows = machine.matching(&[("what", what)]);
        let first = rows.first().copied();
        first.map(|row| machine.cell(row, "value"))
    };
    let when = match (stamps, about("date"), about("commit")) {
        (Some(stamps), ..) => runs(stamps),
        (None, Some(date), Some(commit)) => format!("Measured on {date}, at commit {commit}."),
        _ => String::new(),
    };
    match (about("adapter"), about("cores")) {
        (Some(adapter), Some(cores)) => {
            format!("{when} Adapter: {adapter}, on a machine with {cores} cores.")
        }
        _ => when,
    }
}

/// The dates of the sections, if they were written.
pub fn stamps(folder: &Path) -> Result<Option<Table>, String> {
    if folder.join("sections.csv").exists() {
        load(folder, "sections").map(Some)
    } else {
        Ok(None)
    }
}

/// The worst miss of a section; else its main figure, or what is nearest to its limit.
fn outcome(section: &Section, targets: &[&Target], folder: &Path) -> String {
    let nearest = (targets.iter()).max_by(|a, b| a.excess().total_cmp(&b.excess()));
    match nearest {
        Some(worst) if worst.count().missed > 0 => format!("worst: {}", worst.summary()),
        Some(nearest) => format!("nearest: {}", nearest.summary()),
        None => figure(section.name, folder).unwrap_or_else(|| "not measured".to_owned()),
    }
}

/// A row of the index.
fn row(section: &Section, targets: &[&Target], folder: &Path, body: &str) -> String {
    let name = if body.contains(&format!("# {}\n", section.heading)) {
        format!("[{}](#{})", section.name, anchor(section.heading))
    } else {
        section.name.to_owned()
    };
    let Count { met, missed, .. } = Count::of(targets.iter().copied());
    let [met, missed] = if targets.is_empty() {
        ["", ""].map(str::to_owned)
    } else {
        [met, missed].map(|count| count.to_string())
    };
    let outcome = outcome(section, targets, folder);
    let question = section.question;
    format!("| {name} | {question} | {met} | {missed} | {outcome} |")
}

/// When a section was measured, of what, and how long it took: a cell.
fn stamp(stamps: &Table, section: &str) -> String {
    let rows = stamps.matching(&[("section", section)]);
    let of = |row: &Vec<String>| stamp_of(stamps, row);
    rows.first().copied().map_or_else(String::new, of)
}

fn stamp_of(stamps: &Table, row: &[String]) -> String {
    let [date, commit, seconds] = ["date", "commit", "seconds"].map(|name| stamps.cell(row, name));
    format!("{date}, {commit}, {seconds} s")
}

/// The index of a report whose other text is `body`.
pub fn index(
    out: &mut String,
    folder: &Path,
    stamps: Option<&Table>,
    body: &str,
) -> Result<(), String> {
    let all = targets::all(folder)?;
    let Count {
        met,
        missed,
        nearly,
        unknown,
    } = Count::of(&all);
    let _ = writeln!(
        out,
        "## Index\n\n\
         Of {} limits, {met} are met and {missed} are missed, {nearly} of these by less than the noise of the measurement. \
         Targets that were not measured: {unknown}. A target with two limits counts twice. [Targets](#targets) and \
         [effects of the page](#effects-of-the-page) have them all. \"Worst\" is the largest miss, as a factor of its \
         limit; \"nearest\" is the closest call where all are met. A blit is the time of copying the picture.\n",
        met + missed
    );
    let [head, rule] = if stamps.is_some() {
        [" measured |", "---|"]
    } else {
        ["", ""]
    };
    let _ = writeln!(
        out,
        "| section | question | met | missed | worst miss, or main figure |{head}\n|---|---|---|---|---|{rule}"
    );
    for section in asked() {
        let own: Vec<&Target> = all
            .iter()
            .filter(|target| target.section == section.name)
            .collect();
        out.push_str(&row(&section, &own, folder, body));
        if let Some(stamps) = stamps {
            let _ = write!(out, " {} |", stamp(stamps, section.name));
        }
        out.push('\n');
    }
    out.push('\n');
    Ok(())
}
