//! A target of the crate: what is measured, its limits, and whether they are met.

use std::fmt::Write;

/// A target: what is measured, its limits, and the value, if it was measured.
pub struct Target {
    /// The section that measures it, as `--only` names it.
    pub section: &'static str,
    /// What it is about, where its row or cell does not repeat it.
    subject: Option<String>,
    what: String,
    limits: [f64; 2],
    /// A second limit, and what it is for.
    second: Option<(&'static str, f64)>,
    value: Option<f64>,
    /// Digits after the point; `None` for as many as the number needs.
    digits: Option<usize>,
    /// How far apart rounds of the same measurement are.
    noise: f64,
}

/// How many limits are met and missed.
#[derive(Clone, Copy, Default)]
pub struct Count {
    pub met: usize,
    pub missed: usize,
    /// Of the missed ones, those that are missed by less than the noise.
    pub nearly: usize,
    /// Targets without a value.
    pub unknown: usize,
}

impl Count {
    pub fn of<'a>(targets: impl IntoIterator<Item = &'a Target>) -> Self {
        let mut sum = Self::default();
        for target in targets {
            let count = target.count();
            sum.met += count.met;
            sum.missed += count.missed;
            sum.nearly += count.nearly;
            sum.unknown += count.unknown;
        }
        sum
    }
}

impl Target {
    pub fn at_most(
        section: &'static str,
        what: impl Into<String>,
        limit: f64,
        value: Option<f64>,
    ) -> Self {
        Self {
            section,
            subject: None,
            what: what.into(),
            limits: [f64::NEG_INFINITY, limit],
            second: None,
            value,
            digits: Some(2),
            noise: 0.0,
        }
    }

    pub fn at_least(
        section: &'static str,
        what: impl Into<String>,
        limit: f64,
        value: Option<f64>,
    ) -> Self {
        Self {
            limits: [limit, f64::INFINITY],
            ..Self::at_most(section, what, limit, value)
        }
    }

    pub fn within(
        section: &'static str,
        what: impl Into<String>,
        limits: [f64; 2],
        value: Option<f64>,
    ) -> Self {
        Self {
            limits,
            ..Self::at_most(section, what, limits[1], value)
        }
    }

    pub fn with_digits(self, digits: usize) -> Self {
        Self {
            digits: Some(digits),
            ..self
        }
    }

    /// With four digits after the point, and smaller values as a power of ten.
    pub fn with_small_values(self) -> Self {
        Self {
            digits: None,
            ..self
        }
    }

    pub fn with_noise(self, noise: f64) -> Self {
        Self { noise, ..self }
    }

    /// What it is about, for where it stands alone.
    pub fn about(self, subject: &str) -> Self {
        Self {
            subject: Some(subject.to_owned()),
            ..self
        }
    }

    /// With a second limit, and what it is for.
    pub fn and_at_most(self, case: &'static str, limit: f64) -> Self {
        Self {
            second: Some((case, limit)),
            ..self
        }
    }

    /// The value, if it was measured.
    fn known(&self) -> Option<f64> {
        self.value.filter(|value| value.is_finite())
    }

    /// Both ends of every limit.
    fn ranges(&self) -> Vec<[f64; 2]> {
        let second = self.second.map(|(_, limit)| [f64::NEG_INFINITY, limit]);
        std::iter::once(self.limits).chain(second).collect()
    }

    /// Whether each limit is met; empty where nothing was measured.
    fn verdicts(&self) -> Vec<bool> {
        let Some(value) = self.known() else {
            return Vec::new();
        };
        let is_met = |[low, high]: [f64; 2]| (low..=high).contains(&value);
        self.ranges().into_iter().map(is_met).collect()
    }

    /// For each limit, whether the value is as near to it as rounds are to each other.
    fn near(&self) -> Vec<bool> {
        let value = self.known().unwrap_or(f64::NAN);
        let is_near =
            |[low, high]: [f64; 2]| (value - low).abs().min((value - high).abs()) < self.noise;
        self.ranges().into_iter().map(is_near).collect()
    }

    pub fn count(&self) -> Count {
        let verdicts = self.verdicts();
        let met = verdicts.iter().filter(|is_met| **is_met).count();
        let nearly = |(is_met, is_near): &(&bool, bool)| !**is_met && *is_near;
        Count {
            met,
            missed: verdicts.len() - met,
            nearly: verdicts.iter().zip(self.near()).filter(nearly).count(),
            unknown: usize::from(verdicts.is_empty()),
        }
    }

    /// How many times as large, or as small, as a limit the value is: above 1 where one is missed.
    pub fn excess(&self) -> f64 {
        let Some(value) = self.known() else {
            return 0.0;
        };
        let beyond = |[low, high]: [f64; 2]| {
            let below = if low.is_finite() { low / value } else { 0.0 };
            (value / high).max(below)
        };
        self.ranges().into_iter().map(beyond).fold(0.0, f64::max)
    }

    fn limits(&self) -> String {
        let [low, high] = self.limits;
        let mut limits = if low == f64::NEG_INFINITY {
            format!("at most {high}")
        } else if high == f64::INFINITY {
            format!("at least {low}")
        } else {
            format!("{low} to {high}")
        };
        if let Some((case, limit)) = self.second {
            let _ = write!(limits, "; {case}: {limit}");
        }
        limits
    }

    fn shown(&self) -> String {
        match (self.known(), self.digits) {
            (Some(value), Some(digits)) => format!("{value:.digits$}"),
            (Some(value), None) if value != 0.0 && value.abs() < 1e-4 => format!("{value:.1e}"),
            (Some(value), None) => format!("{value:.4}"),
            (None, _) => "not measured".to_owned(),
        }
    }

    /// Whether it is met, as text; empty where nothing was measured.
    pub fn verdict(&self) -> String {
        let text = |(is_met, is_near)| {
            let text = if is_met { "met" } else { "**missed**" };
            let noise = if is_near { ", within the noise" } else { "" };
            format!("{text}{noise}")
        };
        let verdicts = self.verdicts().into_iter().zip(self.near());
        verdicts.map(text).collect::<Vec<String>>().join("; ")
    }

    /// A row of the table of targets.
    pub fn write(&self, out: &mut String) {
        let _ = writeln!(
            out,
            "| {} | {} | {} | {} |",
            self.what,
            self.limits(),
            self.shown(),
            self.verdict()
        );
    }

    /// The value with its limit and the verdict, without what it is about.
    pub fn phrase(&self) -> String {
        let verdict = self.verdict();
        let colon = if verdict.is_empty() { "" } else { ": " };
        format!(
            "{}: {}, {}{colon}{verdict}",
            self.what,
            self.shown(),
            self.limits()
        )
    }

    /// The value and the limit, for the index.
    pub fn summary(&self) -> String {
        let about = self.subject.as_ref();
        let about = about.map_or_else(String::new, |subject| format!("{subject}: "));
        format!("{about}{}: {} ({})", self.what, self.shown(), self.limits())
    }
}
