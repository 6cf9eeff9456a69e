//! The best time of each level, kept in a text file: a line for each, as in `village 98.4`.

use std::path::PathBuf;

use bevy::prelude::*;

/// Best times in seconds, by the keys of the levels.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct BestTimes {
    times: Vec<(String, f32)>,
    /// Where they are kept; `None` keeps them in memory only.
    file: Option<PathBuf>,
}

impl BestTimes {
    /// Reads the file. What cannot be read is no time.
    pub fn load(file: PathBuf) -> Self {
        let text = std::fs::read_to_string(&file).unwrap_or_default();
        Self {
            times: parse(&text),
            file: Some(file),
        }
    }

    pub fn get(&self, level: &str) -> Option<f32> {
        let found = self.times.iter().find(|(name, _)| name == level);
        found.map(|(_, seconds)| *seconds)
    }

    /// Keeps a time if it is the best one so far; returns whether it is.
    pub fn record(&mut self, level: &str, seconds: f32) -> bool {
        if self.get(level).is_some_and(|best| best <= seconds) {
            return false;
        }
        self.times.retain(|(name, _)| name != level);
        self.times.push((level.to_owned(), seconds));
        if let Some(file) = &self.file
            && let Err(error) = std::fs::write(file, write(&self.times))
        {
            warn!("{}: {error}", file.display());
        }
        true
    }
}

fn parse(text: &str) -> Vec<(String, f32)> {
    let line = |line: &str| {
        let (name, seconds) = line.rsplit_once(' ')?;
        let seconds: f32 = seconds.parse().ok()?;
        (seconds.is_finite() && seconds > 0.0).then(|| (name.to_owned(), seconds))
    };
    text.lines().filter_map(line).collect()
}

fn write(times: &[(String, f32)]) -> String {
    let line = |(name, seconds): &(String, f32)| format!("{name} {seconds:.1}\n");
    times.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_better_time_is_kept() {
        let mut best = BestTimes::default();
        assert!(best.record("village", 100.0));
        assert!(!best.record("village", 101.0));
        assert!(best.record("village", 99.5));
        assert!(best.record("street", 120.0));
        assert_eq!(best.get("village"), Some(99.5));
        assert_eq!(best.get("valley"), None);
    }

    #[test]
    fn what_is_written_is_read() {
        let times = vec![("village".to_owned(), 98.4), ("street".to_owned(), 101.0)];
        assert_eq!(parse(&write(&times)), times);
        assert_eq!(parse("village\nstreet -3\nvalley NaN\n\n"), []);
    }
}
