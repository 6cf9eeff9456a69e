//! The long run: 100,000 frames in which everything changes. It runs where `--only soak` asks for it.

use bevy_comics_testkit::soak::{CYCLE, Changes, Sample, Soak, WARM_UP};

use crate::{Run, table::Table};

/// Frames of the whole run, and of a quick one.
const FRAMES: [u64; 2] = [100_000, 2 * WARM_UP * CYCLE];
/// What changes, unless the environment variable `SOAK` names it: see [`Changes::of`].
const CHANGES: &str = "sizes,cameras,materials,objects,files";

pub fn measure(run: &Run) -> Result<(), String> {
    let folder = std::env::temp_dir().join(format!("bevy_comics_soak_{}", std::process::id()));
    let problem = |error| format!("{}: {error}", folder.display());
    let changes = std::env::var("SOAK").unwrap_or_else(|_| CHANGES.into());
    let frames = std::env::var("SOAK_FRAMES")
        .ok()
        .and_then(|n| n.parse().ok());
    let mut soak = Soak::new(&folder, Changes::of(&changes)).map_err(problem)?;
    let cycles = frames
        .unwrap_or(FRAMES[usize::from(run.quick)])
        .div_ceil(CYCLE);
    let mut table: Option<Table> = None;
    for cycle in 1..=cycles {
        let sample = soak.cycle().map_err(problem)?;
        if cycle.is_multiple_of(10) {
            run.say(&format!("{} frames", sample.frame));
        }
        let table = table.get_or_insert_with(|| header(&sample));
        let mut row = vec![
            sample.frame.to_string(),
            sample
                .resident
                .map_or_else(String::new, |kib| kib.to_string()),
            sample.errors.to_string(),
        ];
        row.extend(sample.resources.iter().map(|(_, count)| count.to_string()));
        let cells: Vec<&dyn std::fmt::Display> = row
            .iter()
            .map(|cell| cell as &dyn std::fmt::Display)
            .collect();
        table.push(&cells);
    }
    std::fs::remove_dir_all(&folder).map_err(problem)?;
    run.save("soak", &table.expect("at least one cycle"))
}

fn header(sample: &Sample) -> Table {
    let mut names = vec!["frame", "resident KiB", "errors"];
    names.extend(sample.resources.iter().map(|(name, _)| *name));
    Table::new(&names)
}
