//! Tables of raw numbers, stored as CSV files.

use std::{fs, path::Path};

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    pub header: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// `header`: the names of the columns, as in the file.
    pub fn new(header: &str) -> Self {
        Self {
            header: header.split(',').map(str::to_owned).collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row; no cell may hold a comma or a line break.
    pub fn push(&mut self, cells: &[&dyn std::fmt::Display]) {
        let row: Vec<String> = cells.iter().map(ToString::to_string).collect();
        assert_eq!(row.len(), self.header.len(), "{row:?} in {:?}", self.header);
        assert!(row.iter().all(|c| !c.contains([',', '\n'])), "{row:?}");
        self.rows.push(row);
    }

    /// A program that is stopped leaves a whole file, or the file that was there.
    pub fn save(&self, path: &Path) -> std::io::Result<()> {
        let lines: Vec<String> = std::iter::once(&self.header)
            .chain(&self.rows)
            .map(|row| row.join(","))
            .collect();
        let part = path.with_extension("part");
        fs::write(&part, lines.join("\n") + "\n")?;
        fs::rename(part, path)
    }

    pub fn load(path: &Path) -> Result<Self, String> {
        let text =
            fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
        let mut rows = text
            .lines()
            .map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        let header = rows
            .next()
            .ok_or_else(|| format!("{} is empty", path.display()))?;
        let rows: Vec<_> = rows.collect();
        match rows.iter().position(|row| row.len() != header.len()) {
            Some(at) => Err(format!("{}: line {} is incomplete", path.display(), at + 2)),
            None => Ok(Self { header, rows }),
        }
    }

    fn column(&self, name: &str) -> usize {
        self.header
            .iter()
            .position(|h| h == name)
            .unwrap_or_else(|| panic!("no column {name:?} in {:?}", self.header))
    }

    /// A cell by the name of its column.
    pub fn cell<'a>(&self, row: &'a [String], name: &str) -> &'a str {
        &row[self.column(name)]
    }

    /// A number; NaN where the cell is empty.
    pub fn number(&self, row: &[String], name: &str) -> f64 {
        self.cell(row, name).parse().unwrap_or(f64::NAN)
    }

    /// The rows that have these cells, given as (column, cell).
    pub fn matching<'a>(&'a self, wanted: &[(&str, &str)]) -> Vec<&'a Vec<String>> {
        self.rows
            .iter()
            .filter(|row| {
                wanted
                    .iter()
                    .all(|(name, cell)| self.cell(row, name) == *cell)
            })
            .collect()
    }

    /// The different cells of a column in some rows, in order of first appearance.
    pub fn distinct(&self, rows: &[&Vec<String>], name: &str) -> Vec<String> {
        let mut found: Vec<String> = Vec::new();
        for row in rows {
            let cell = self.cell(row, name);
            if !found.iter().any(|f| f == cell) {
                found.push(cell.to_owned());
            }
        }
        found
    }

    /// The different cells of a column, in order of first appearance.
    pub fn values(&self, name: &str) -> Vec<String> {
        self.distinct(&self.matching(&[]), name)
    }

    /// The sum of a column in some rows.
    pub fn sum(&self, rows: &[&Vec<String>], name: &str) -> f64 {
        self.numbers(rows, name).iter().sum()
    }

    pub fn numbers(&self, rows: &[&Vec<String>], name: &str) -> Vec<f64> {
        rows.iter().map(|row| self.number(row, name)).collect()
    }
}

/// The value below which this fraction of the finite numbers lies, interpolated between two
/// of them; NaN without any.
pub fn quantile(numbers: &[f64], fraction: f64) -> f64 {
    let mut sorted: Vec<f64> = numbers.iter().copied().filter(|n| n.is_finite()).collect();
    if sorted.is_empty() {
        return f64::NAN;
    }
    sorted.sort_by(f64::total_cmp);
    let at = fraction * (sorted.len() - 1) as f64;
    let (low, part) = (at.floor() as usize, at.fract());
    let high = (low + 1).min(sorted.len() - 1);
    sorted[low] * (1.0 - part) + sorted[high] * part
}

pub fn median(numbers: &[f64]) -> f64 {
    quantile(numbers, 0.5)
}

pub fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().copied().fold(f64::NAN, f64::max)
}

/// Exponent p of y = c x^p, by least squares of the logarithms.
pub fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points
        .iter()
        .filter(|(x, y)| *x > 0.0 && *y > 0.0)
        .map(|(x, y)| (x.ln(), y.ln()))
        .collect();
    let n = logs.len() as f64;
    let (mx, my) = logs
        .iter()
        .fold((0.0, 0.0), |(a, b), (x, y)| (a + x / n, b + y / n));
    let (cross, square) = logs.iter().fold((0.0, 0.0), |(c, s), (x, y)| {
        (c + (x - mx) * (y - my), s + (x - mx) * (x - mx))
    });
    cross / square
}
