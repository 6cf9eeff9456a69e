//! The long run: 100,000 frames in which everything changes. It runs where `--only soak` asks for
//! it.

use bevy_comics_testkit::soak::{CYCLE, Changes, Sample, Soak, WARM_UP};

use crate::{Run, table::Table};

/// Frames of the whole run, and of a quick one.
const FRAMES: [u64; 2] = [100_000, 2 * WARM_UP * CYCLE];
/// What changes, unless the environment variable `SOAK` names it: see [`Changes::of`].
const CHANGES: &str = "sizes,cameras,materials,objects,files,looks=1";
/// Cycles of which the mean is taken at either end.
pub const END: usize = 10;
/// The run fails if memory grows by this percentage over its second half.
pub const MOST_GROWTH: f64 = 2.0;
/// Columns before those of the resources of the GPU.
pub const FIRST_RESOURCE: usize = 4;

/// Writes `soak.csv`. An error if memory or resources have grown, or the renderer has reported an
/// error.
pub fn measure(run: &Run) -> Result<(), String> {
    let folder = std::env::temp_dir().join(format!("bevy_comics_soak_{}", std::process::id()));
    let problem = |error| format!("{}: {error}", folder.display());
    let changes = std::env::var("SOAK").unwrap_or_else(|_| CHANGES.into());
    let frames = std::env::var("SOAK_FRAMES")
        .ok()
        .and_then(|n| n.parse().ok());
    let changes = Changes::of(&changes);
    let mut soak = Soak::new(&folder, changes).map_err(problem)?;
    let frames = frames.unwrap_or(FRAMES[usize::from(run.quick)]);
    let cycles = frames.div_ceil(CYCLE).max(1);
    let mut table: Option<Table> = None;
    for cycle in 1..=cycles {
        let sample = soak.cycle().map_err(problem)?;
        if cycle.is_multiple_of(10) {
            run.say(&format!("{} frames", sample.frame));
        }
        push(table.get_or_insert_with(|| header(&sample)), &sample);
    }
    let table = table.expect("at least one cycle");
    run.save("soak", &table)?;
    std::fs::remove_dir_all(&folder).map_err(problem)?;
    if settled(&table).len() < LEAST {
        run.say("too few frames to say whether resources or memory grow");
    }
    let mut faults = faults(&table);
    let is_plain = |row: &Vec<String>| table.cell(row, "styled") != "true";
    if changes.looks > 0 && settled(&table).iter().any(is_plain) {
        faults.push("the look is not always drawn".into());
    }
    if faults.is_empty() {
        Ok(())
    } else {
        Err(format!(
            "the long run (soak.csv) has failed: {}",
            faults.join("; ")
        ))
    }
}

fn header(sample: &Sample) -> Table {
    let mut names = vec!["frame", "resident KiB", "errors", "styled"];
    names.extend(sample.resources.iter().map(|(name, _)| *name));
    Table::new(&names.join(","))
}

fn push(table: &mut Table, sample: &Sample) {
    let resident = sample.resident.map(|kib| kib.to_string());
    let mut row = vec![
        sample.frame.to_string(),
        resident.unwrap_or_default(),
        sample.errors.to_string(),
        sample.styled.to_string(),
    ];
    row.extend(sample.resources.iter().map(|(_, count)| count.to_string()));
    let cells: Vec<&dyn std::fmt::Display> = row
        .iter()
        .map(|cell| cell as &dyn std::fmt::Display)
        .collect();
    table.push(&cells);
}

/// The kinds of the first camera, one for each cycle in turn.
const KINDS: usize = WARM_UP as usize;
/// Cycles after the warm-up from which growth can be told: each kind twice.
const LEAST: usize = 2 * KINDS;

/// The cycles after the warm-up, or the last one.
fn settled(table: &Table) -> &[Vec<String>] {
    &table.rows[KINDS.min(table.rows.len().saturating_sub(1))..]
}

/// The means of the first and of the last numbers.
pub fn ends(numbers: &[f64]) -> Option<[f64; 2]> {
    let count = END.min(numbers.len() / 2);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    (count > 0).then(|| {
        [
            mean(&numbers[..count]),
            mean(&numbers[numbers.len() - count..]),
        ]
    })
}

/// Memory of the process in MiB after each cycle since the warm-up. Empty where the system does not
/// say.
pub fn resident(table: &Table) -> Vec<f64> {
    let rows = settled(table).iter();
    let kib = rows.map(|row| table.number(row, "resident KiB"));
    kib.filter(|kib| kib.is_finite())
        .map(|kib| kib / 1024.0)
        .collect()
}

/// By how many percent the memory has grown over the second half of the run.
pub fn growth(table: &Table) -> Option<f64> {
    let resident = resident(table);
    let [first, last] = ends(&resident[resident.len() / 2..])?;
    Some(100.0 * (last / first - 1.0))
}

/// How much of a column there was at most in the first cycles after the warm-up, and in the last
/// ones: one of each kind.
pub fn counts(table: &Table, name: &str) -> [f64; 2] {
    let rows = settled(table).iter();
    let numbers: Vec<f64> = rows.map(|row| table.number(row, name)).collect();
    let most = |part: &[f64]| part.iter().copied().fold(0.0, f64::max);
    let kinds = KINDS.min(numbers.len());
    [
        most(&numbers[..kinds]),
        most(&numbers[numbers.len() - kinds..]),
    ]
}

/// What is wrong with a run.
fn faults(table: &Table) -> Vec<String> {
    let mut faults = Vec::new();
    let errors = table.rows.last().map(|row| table.cell(row, "errors"));
    if let Some(errors) = errors.filter(|errors| *errors != "0") {
        faults.push(format!("{errors} errors of the renderer"));
    }
    if settled(table).len() < LEAST {
        return faults;
    }
    if let Some(growth) = growth(table).filter(|growth| *growth >= MOST_GROWTH) {
        faults.push(format!("{growth:.2} % more memory in the second half"));
    }
    if table.header.len() <= FIRST_RESOURCE {
        faults.push("the resources of the GPU are not counted".into());
    }
    for name in table.header.iter().skip(FIRST_RESOURCE) {
        let [first, last] = counts(table, name);
        if last > first {
            faults.push(format!("{last:.0} {name} instead of {first:.0}"));
        }
    }
    faults
}
