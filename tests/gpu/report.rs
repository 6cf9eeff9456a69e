//! The text of the report matches its tables, and the counted work has not grown.

use std::fs;

use bevy_comics_testkit::{
    line_work,
    page_work::{self, PageCounter},
    work::{self, Work, WorkCounter},
};

use crate::{command_line::example, prelude::*};

fn folder() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/report"))
}

type Row = HashMap<String, String>;

/// The rows of a table, read without the report's own code.
fn csv(name: &str) -> Vec<Row> {
    let path = folder().join(format!("{name}.csv"));
    let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned));
    let header: Vec<String> = lines.next().expect("a header").collect();
    let row = |line| header.iter().cloned().zip(line).collect();
    lines.map(row).collect()
}

fn number(row: &Row, name: &str) -> f64 {
    let number = row[name].parse();
    number.unwrap_or_else(|_| panic!("{name} of {row:?}"))
}

#[test]
fn the_text_is_made_of_the_tables() {
    let copy = crate::command_line::folder("report");
    for entry in fs::read_dir(folder()).expect("docs/report") {
        let path = entry.expect("entry").path();
        let name = path.file_name().expect("a name").to_owned();
        if path.extension().is_some_and(|e| e == "csv" || e == "png") {
            fs::copy(&path, copy.join(name)).expect("copied");
        }
    }
    let output = Command::new(example("report"))
        .args(["--render", "--out"])
        .arg(&copy)
        .output()
        .expect("the example runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let plots = ["lines", "growth", "flicker"].map(|name| format!("{name}.svg"));
    for name in plots.into_iter().chain(["report.md".to_owned()]) {
        let made = fs::read_to_string(copy.join(&name)).expect("made");
        let kept = fs::read_to_string(folder().join(&name)).expect("kept");
        assert!(made == kept, "{name} is not what its tables make");
    }
    fs::remove_dir_all(copy).expect("removed");
}

/// The rows of the table of work, with the style of each.
fn work_rows() -> Vec<(Row, &'static str, ComicStyle)> {
    let rows = csv("work");
    let ladder = work::ladder();
    assert_eq!(rows.len(), ladder.len());
    let pairs = rows.into_iter().zip(ladder);
    pairs
        .map(|(row, (name, style))| {
            assert_eq!(row["style"], name.replace(',', ";"));
            (row, name, style)
        })
        .collect()
}

fn work_row(wanted: &str) -> (Row, &'static str, ComicStyle) {
    let mut rows = work_rows().into_iter();
    let row = rows.find(|(_, name, _)| *name == wanted);
    row.expect("a style of the ladder")
}

/// Passes, bindings, texels and bytes do not exceed those of a row of the table, on any machine.
fn assert_work_is(row: &Row, now: &Work) {
    let name = now.name;
    assert_eq!(row["ran"], now.ran.join(" + "), "{name}");
    assert_eq!(number(row, "left_out") as usize, now.left_out, "{name}");
    // Lines may move by a pixel between adapters: 2 % more is allowed.
    let about = |column| 1.02 * number(row, column) + 0.01;
    let is_no_more = now.bindings as f64 <= number(row, "bindings")
        && now.fetches[0] <= about("fetches")
        && now.fetches[1] <= number(row, "most")
        && now.bytes <= about("bytes");
    assert!(is_no_more, "{now:?}, the report says {row:?}");
}

/// A number of the passes of lines is that of a row of the table.
fn assert_near(row: &Row, column: &str, now: f64) {
    let said = number(row, column);
    let near = 0.98 * said - 0.01..=1.02 * said + 0.01;
    assert!(near.contains(&now), "{}: {column} {now}", row["style"]);
}

/// The style with every kind of pass.
#[test]
fn everything_does_no_more_work_than_the_report_says() {
    let (row, name, style) = work_row("everything");
    assert_work_is(&row, &work::count_without_lines(name, &style));
}

#[test]
fn lines_are_found_with_the_work_that_the_report_says() {
    let (row, _, style) = work_row("outlines");
    assert_near(&row, "find", line_work::count_find(&style));
}

#[ignore = "long: an app for each of 27 styles"]
#[test]
fn no_style_does_more_work_than_the_report_says() {
    let rows = work_rows();
    let mut counter = WorkCounter::default();
    for (row, name, style) in &rows {
        let now = counter.count(name, style);
        assert_work_is(row, &now);
        let lines = now.lines;
        for (now, column) in [
            (lines.walk, "walk"),
            (lines.find, "find"),
            (lines.columns, "columns"),
            (lines.draw, "draw"),
            (lines.bytes, "line_bytes"),
        ] {
            assert_near(row, column, now);
        }
    }
}

/// Whether counts are the same but for the rounding of sums over all pixels.
fn is_same(a: [f64; 3], b: [f64; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9)
}

/// Effects that read their own pixel in the picture and in the prepasses alone.
const FEW: [&str; 5] = [
    "focus, dots",
    "hatching",
    "color harmony",
    "depth layers",
    "depth layers of pixels",
];

/// Effects of the page do not fetch more than the committed report says, in all of their passes.
/// Those that read no more than their own pixel fetch what a tint does.
fn assert_page_work_of(is_counted: impl Fn(&str) -> bool) {
    let rows = csv("page_work");
    let effects = page_work::effects();
    assert_eq!(rows.len(), effects.len());
    let mut single = None;
    let mut counter = PageCounter::default();
    for (row, (name, style)) in rows.iter().zip(&effects) {
        assert_eq!(row["effect"], name.replace(',', ";"));
        // The others are compared with the tint.
        if *name != page_work::ONE_PASS && !is_counted(name) {
            continue;
        }
        let now = counter.count(name, style);
        assert!(now.texels[0] <= number(row, "texels") + 0.01, "{now:?}");
        assert!(now.texels[1] <= number(row, "most"), "{now:?}");
        assert!(now.bytes <= number(row, "bytes") + 0.01, "{now:?}");
        if *name == page_work::ONE_PASS {
            assert!(is_same(
                [now.texels[0], now.texels[1], now.bytes],
                [1.0, 1.0, 4.0]
            ));
            single = Some(now);
        } else if page_work::OWN_PIXEL.contains(name) {
            let single = single.as_ref().expect("it comes first");
            let all = |work: &page_work::PageWork| [work.texels[0], work.texels[1], work.bytes];
            assert!(is_same(all(&now), all(single)), "{name}: {now:?}");
        } else if FEW.contains(name) {
            // The picture, and what says where its pixels are.
            assert!(now.texels[1] > 1.0 && now.texels[1] <= 3.0, "{now:?}");
        } else {
            // The counter works: these read other places.
            assert!(now.texels[0] > 3.0, "{now:?}");
        }
    }
}

/// The effect with the most passes, and one that reads its own pixel.
#[test]
fn paint_and_halftone_fetch_no_more_than_the_report_says() {
    assert_page_work_of(|name| name == "paint" || name == page_work::OWN_PIXEL[0]);
}

#[ignore = "long: every effect of the page"]
#[test]
fn no_effect_of_the_page_fetches_more_than_the_report_says() {
    assert_page_work_of(|_| true);
}
