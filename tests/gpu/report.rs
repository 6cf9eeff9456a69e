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

/// A table as (header, rows), read without the report's own code.
fn csv(name: &str) -> (Vec<String>, Vec<HashMap<String, String>>) {
    let path = folder().join(format!("{name}.csv"));
    let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut lines = text.lines();
    let header: Vec<String> = lines
        .next()
        .expect("a header")
        .split(',')
        .map(str::to_owned)
        .collect();
    let rows = lines
        .map(|line| {
            header
                .iter()
                .cloned()
                .zip(line.split(',').map(str::to_owned))
                .collect()
        })
        .collect();
    (header, rows)
}

fn number(row: &HashMap<String, String>, name: &str) -> f64 {
    row[name]
        .parse()
        .unwrap_or_else(|_| panic!("{name} of {row:?}"))
}

/// Every effect is among the styles that are timed: on the ladder, or on the page.
#[test]
fn every_effect_is_timed() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let timed = ["tools/report/page_styles.rs", "crates/testkit/src/work.rs"]
        .map(|path| fs::read_to_string(root.join(path)).expect(path));
    for effect in EffectRegistry::built_in().types() {
        let name = (effect.type_info)().type_path_table().short_path();
        let wanted = format!("{name}::default()");
        assert!(
            timed.iter().any(|text| text.contains(&wanted)),
            "the report has no time of {name}"
        );
    }
}

/// The median.
fn middle(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    let n = numbers.len();
    0.5 * (numbers[(n - 1) / 2] + numbers[n / 2])
}

#[test]
fn the_text_is_made_of_the_tables() {
    let copy = tempfolder("report");
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
    for name in [
        "report.md",
        "range.svg",
        "encoding.svg",
        "lines.svg",
        "growth.svg",
        "flicker.svg",
    ] {
        let made = fs::read_to_string(copy.join(name)).expect("made");
        let kept = fs::read_to_string(folder().join(name)).expect("kept");
        assert!(made == kept, "{name} is not what its tables make");
    }
    fs::remove_dir_all(copy).expect("removed");
}

fn tempfolder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("bevy_comics_{name}_{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a temporary folder");
    folder
}

#[test]
fn ratios_and_exponents_come_out_again() {
    let text = fs::read_to_string(folder().join("report.md")).expect("the report");
    // The cost of the default comic in blits, paired in every round.
    let (_, rows) = csv("ladder_times");
    let laps = |variant: &str, round: usize, laps: &[&str]| -> f64 {
        let row = rows
            .iter()
            .find(|r| {
                r["section"] == "ladder"
                    && r["variant"] == variant
                    && r["round"] == round.to_string()
            })
            .expect("a row");
        laps.iter().map(|lap| number(row, lap)).sum()
    };
    let own = |variant, round| laps(variant, round, &["range", "lines", "post"]);
    let post = |variant, round| laps(variant, round, &["post"]);
    let rounds = rows
        .iter()
        .filter(|r| r["section"] == "ladder" && r["variant"] == "blit")
        .count();
    let ratio = middle(
        (0..rounds)
            .map(|round| {
                (own("default comic", round) - own("nothing", round))
                    / (post("blit", round) - post("nothing", round))
            })
            .collect(),
    );
    let line = text
        .lines()
        .find(|l| l.starts_with("| default comic, blits"))
        .expect("the target");
    assert!(line.contains(&format!("| {ratio:.2} |")), "{ratio}: {line}");

    // The exponent over pixels: least squares on the medians.
    let (_, rows) = csv("growth_times");
    let mut points: Vec<(f64, f64)> = Vec::new();
    for row in rows.iter().filter(|r| r["section"] == "pixels") {
        let pixels = number(row, "width") * number(row, "height");
        if points.iter().any(|(x, _)| *x == pixels.ln()) {
            continue;
        }
        let of = |variant: &str| -> Vec<f64> {
            rows.iter()
                .filter(|r| {
                    r["section"] == "pixels"
                        && r["scene"] == row["scene"]
                        && r["variant"] == variant
                })
                .map(|r| number(r, "range") + number(r, "lines") + number(r, "post"))
                .collect()
        };
        let over = of("default comic")
            .into_iter()
            .zip(of("nothing"))
            .map(|(a, b)| a - b)
            .collect();
        points.push((pixels.ln(), middle(over).ln()));
    }
    let n = points.len() as f64;
    let sum = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>();
    let (x, y) = (sum(|p| p.0), sum(|p| p.1));
    let slope = (n * sum(|p| p.0 * p.1) - x * y) / (n * sum(|p| p.0 * p.0) - x * x);
    assert!(
        text.contains(&format!("Fitted exponent: {slope:.3}.")),
        "{slope}"
    );

    // F1 of the silhouettes, from the counts.
    let (_, rows) = csv("line_scores");
    let mut sums = [0.0; 4];
    for row in rows
        .iter()
        .filter(|r| r["detector"] == "silhouettes" && r["truth"] == "silhouettes")
    {
        for (sum, name) in sums.iter_mut().zip(["found", "true", "right", "drawn"]) {
            *sum += number(row, name);
        }
    }
    let (recall, precision) = (sums[0] / sums[1], sums[2] / sums[3]);
    let f1 = 2.0 / (1.0 / recall + 1.0 / precision);
    let line = text
        .lines()
        .find(|l| l.starts_with("| silhouettes |"))
        .expect("the detector");
    assert!(line.contains(&format!("| {f1:.3} |")), "{f1}: {line}");
}

#[test]
fn nothing_in_the_report_is_not_finite() {
    let (_, rows) = csv("stability");
    assert!(rows.len() > 20);
    for row in &rows {
        assert_eq!(row["wild"], "0", "{row:?}");
    }
    // The textbook's form loses all precision here; ours stays within 5 ulp.
    let hard = rows
        .iter()
        .find(|r| r["case"] == "z 100 to 100.001")
        .expect("the case");
    assert!(number(hard, "textbook_ulp") > 1e5 && number(hard, "ulp") < 5.0);
    for row in rows.iter().filter(|r| r["kind"] == "depth map") {
        assert!(number(row, "ulp") <= 5.0, "{row:?}");
    }
    // Exact methods are exact.
    let (_, rows) = csv("range_errors");
    for row in &rows {
        if row["method"] == "full" || row["method"] == "ping-pong" {
            for name in ["near", "far", "map", "band", "flip"] {
                assert_eq!(number(row, name), 0.0, "{row:?}");
            }
        }
    }
}

/// The rows of the table of work, with the style of each.
fn work_rows() -> Vec<(HashMap<String, String>, &'static str, ComicStyle)> {
    let (_, rows) = csv("work");
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

/// The row of a style.
fn work_row(wanted: &str) -> (HashMap<String, String>, &'static str, ComicStyle) {
    let mut rows = work_rows().into_iter();
    rows.find(|(_, name, _)| *name == wanted)
        .expect("a style of the ladder")
}

/// Passes, bindings, texels and bytes do not exceed those of a row of the table, on any machine.
fn assert_work_is(row: &HashMap<String, String>, now: &Work) {
    let name = now.name;
    assert_eq!(row["ran"], now.ran.join(" + "), "{name}");
    assert_eq!(number(row, "left_out") as usize, now.left_out, "{name}");
    assert!(
        now.bindings as f64 <= number(row, "bindings"),
        "{name}: {now:?}"
    );
    // Lines may move by a pixel between adapters: 2 % more is allowed.
    assert!(
        now.fetches[0] <= 1.02 * number(row, "fetches") + 0.01,
        "{name}: {now:?}"
    );
    assert!(now.fetches[1] <= number(row, "most"), "{name}: {now:?}");
    assert!(
        now.bytes <= 1.02 * number(row, "bytes") + 0.01,
        "{name}: {now:?}"
    );
}

/// A number of the passes of lines is that of a row of the table.
fn assert_near(row: &HashMap<String, String>, column: &str, now: f64) {
    let said = number(row, column);
    let near = 0.98 * said - 0.01..=1.02 * said + 0.01;
    assert!(near.contains(&now), "{}: {column} {now}", row["style"]);
}

/// The style that the report's targets are set for.
#[test]
fn the_default_comic_does_no_more_work_than_the_report_says() {
    let (row, name, style) = work_row("default comic");
    assert_work_is(&row, &work::count_without_lines(name, &style));
}

/// The style with every kind of pass.
#[test]
fn the_largest_style_does_no_more_work_than_the_report_says() {
    let (row, name, style) = work_row("everything");
    assert_work_is(&row, &work::count_without_lines(name, &style));
}

#[test]
fn lines_are_found_with_no_more_work_than_the_report_says() {
    let (row, _, style) = work_row("everything");
    assert_near(&row, "find", line_work::count_find(&style));
}

#[test]
fn lines_are_drawn_with_no_more_work_than_the_report_says() {
    let (row, _, style) = work_row("everything");
    assert_near(&row, "draw", line_work::count_draw(&style));
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

/// The counter works: a pixel of the largest style fetches texels, no style none.
#[test]
fn the_table_of_work_has_the_work_of_lines() {
    let rows = work_rows();
    let (none, ..) = &rows[0];
    let (last, ..) = rows.last().expect("a style");
    assert!(number(last, "most") > 10.0 && number(none, "fetches") == 0.0);
    let wide = rows
        .iter()
        .find(|(_, name, _)| *name == "outlines, 8 pixels wide");
    let (wide, ..) = wide.expect("wide outlines");
    for column in ["walk", "find", "columns", "draw"] {
        assert!(number(wide, column) > 0.5 && number(none, column) == 0.0);
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
    let (_, rows) = csv("page_work");
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

/// The effect with the most passes.
#[test]
fn paint_fetches_no_more_than_the_report_says() {
    assert_page_work_of(|name| name == "paint");
}

#[test]
fn halftone_fetches_what_a_tint_does() {
    assert_page_work_of(|name| name == page_work::OWN_PIXEL[0]);
}

#[ignore = "long: every effect of the page"]
#[test]
fn no_effect_of_the_page_fetches_more_than_the_report_says() {
    assert_page_work_of(|_| true);
}
