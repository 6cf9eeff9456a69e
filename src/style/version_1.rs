//! Style files of format version 1, whose fields had other names.

use std::{fmt::Write, ops::Range};

/// What was renamed in version 2: entry of the file, old name, new name.
const RENAMED: &[(&str, &str, &str)] = &[
    ("tone_bands", "method", "form"),
    ("tone_bands", "Levels", "Corrected"),
    ("tone_bands", "feather", "softness"),
    ("desaturation", "method", "form"),
    ("colorization", "method", "form"),
    ("black_flats", "feather", "softness"),
    ("contours", "PlaneAware", "Corrected"),
    ("contours", "fade", "opacity_fade"),
    ("outlines", "Measured", "Corrected"),
];

/// The text of a style file with the names of version 2.
pub(super) struct Upgraded {
    pub text: String,
    edits: Vec<Edit>,
}

/// A word that was replaced.
struct Edit {
    line: usize,
    /// Column of the new word, from 1.
    column: usize,
    entry: String,
    old: String,
    new: &'static str,
}

impl Upgraded {
    /// A text that needs no change.
    pub fn unchanged(text: &str) -> Self {
        Self {
            text: text.to_owned(),
            edits: Vec::new(),
        }
    }

    /// The column in the file of a column in the upgraded text.
    pub fn original_column(&self, line: usize, column: usize) -> usize {
        let shift: isize = self
            .edits
            .iter()
            .filter(|edit| edit.line == line && edit.column < column)
            .map(|edit| edit.new.len() as isize - edit.old.len() as isize)
            .sum();
        column.saturating_add_signed(-shift)
    }

    /// What to change in the file; `None` if it is up to date.
    pub fn advice(&self) -> Option<String> {
        let version = self.edits.iter().find(|edit| edit.entry == "version")?;
        let mut advice = format!(
            "this style file has format version {}: set `version: {}`",
            version.old, version.new
        );
        let mut told: Vec<(&str, &str)> = Vec::new();
        for edit in &self.edits {
            let rename = (edit.entry.as_str(), edit.old.as_str());
            if edit.entry != "version" && !told.contains(&rename) {
                told.push(rename);
                let _ = write!(
                    advice,
                    ", rename `{}` to `{}` in `{}`",
                    edit.old, edit.new, edit.entry
                );
            }
        }
        Some(advice)
    }
}

/// The version that the text of a style file states.
pub(super) fn version(text: &str) -> Option<u32> {
    entry_words(text)
        .into_iter()
        .find(|word| word.entry == "version" && !word.is_key)
        .and_then(|word| text[word.range].parse().ok())
}

/// The end of a text that grows: line and column from 1.
struct End {
    line: usize,
    column: usize,
}

impl End {
    /// Moves behind `more`.
    fn pass(&mut self, more: &str) {
        for c in more.chars() {
            if c == '\n' {
                self.line += 1;
                self.column = 1;
            } else {
                self.column += 1;
            }
        }
    }
}

/// The text of a version 1 file with the names of version 2. Takes time in proportion to the text.
pub(super) fn upgraded(text: &str) -> Upgraded {
    let mut upgraded = Upgraded {
        text: String::with_capacity(text.len()),
        edits: Vec::new(),
    };
    let mut end = End { line: 1, column: 1 };
    let mut copied = 0;
    for word in entry_words(text) {
        let old = &text[word.range.clone()];
        let new = if word.entry == "version" && !word.is_key {
            Some("2")
        } else {
            RENAMED
                .iter()
                .find(|(entry, from, _)| *entry == word.entry && *from == old)
                .map(|(_, _, to)| *to)
        };
        let Some(new) = new else { continue };
        let before = &text[copied..word.range.start];
        upgraded.text.push_str(before);
        end.pass(before);
        upgraded.edits.push(Edit {
            line: end.line,
            column: end.column,
            entry: word.entry.to_owned(),
            old: old.to_owned(),
            new,
        });
        upgraded.text.push_str(new);
        end.pass(new);
        copied = word.range.end;
    }
    upgraded.text.push_str(&text[copied..]);
    upgraded
}

/// A name or number inside of an entry.
struct Word<'a> {
    /// Name of the entry of the style, such as `contours`.
    entry: &'a str,
    /// Whether this is the entry's own name.
    is_key: bool,
    range: Range<usize>,
}

/// The words of a RON text, without those in strings and comments.
fn entry_words(text: &str) -> Vec<Word<'_>> {
    let mut words = Vec::new();
    let (mut at, mut depth, mut entry) = (0, 0usize, "");
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if c == '"' {
            string_length(rest)
        } else if c.is_alphanumeric() || c == '_' {
            let length = rest
                .find(|c: char| !(c.is_alphanumeric() || c == '_'))
                .unwrap_or(rest.len());
            let is_key = depth == 1 && rest[length..].trim_start().starts_with(':');
            if is_key {
                entry = &rest[..length];
            }
            let range = at..at + length;
            words.push(Word {
                entry,
                is_key,
                range,
            });
            length
        } else {
            match c {
                '(' | '[' | '{' => depth += 1,
                ')' | ']' | '}' => depth = depth.saturating_sub(1),
                _ => {}
            }
            c.len_utf8()
        };
        at += length;
    }
    words
}

/// The length of a string in quotes at the start of a text.
fn string_length(text: &str) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use crate::{BlackFlats, ComicStyle, Contours, Form, Outlines, ToneBands, style::format};

    const OLD: &str = r##"// feather in a comment stays
(
    version: 1,
    name: "method: Levels, \"feather\"",
    tone_bands: (method: Levels, feather: 3),
    black_flats: (feather: 0.25),
    contours: (form: PlaneAware, fade: 0.5, color: "#102030"),
    outlines: (silhouettes: (form: Measured, threshold: 0.05), creases: (form: Measured)),
)
"##;

    fn read(text: &str) -> Result<format::Read, crate::ComicStyleError> {
        format::read(text, &crate::EffectRegistry::built_in().types())
    }

    #[test]
    fn a_file_of_version_1_reads_and_says_what_to_rename() {
        let old = read(OLD).expect("readable");
        let style = old.style;
        assert_eq!(style.name, "method: Levels, \"feather\"");
        let bands = style.get::<ToneBands>().expect("bands");
        assert_eq!((bands.form, bands.softness), (Form::Corrected, 3.0));
        assert_eq!(style.get::<BlackFlats>().expect("flats").softness, 0.25);
        assert_eq!(style.get::<Contours>().expect("contours").opacity_fade, 0.5);
        let silhouettes = style.get::<Outlines>().expect("outlines").silhouettes;
        assert_eq!(silhouettes.expect("silhouettes").threshold, 0.05);
        assert_eq!(
            old.advice.as_deref(),
            Some(
                "this style file has format version 1: set `version: 2`, rename `method` to \
                 `form` in `tone_bands`, rename `Levels` to `Corrected` in `tone_bands`, rename \
                 `feather` to `softness` in `tone_bands`, rename `feather` to `softness` in \
                 `black_flats`, rename `PlaneAware` to `Corrected` in `contours`, rename `fade` \
                 to `opacity_fade` in `contours`, rename `Measured` to `Corrected` in `outlines`"
            )
        );
        // The advice is right: the file that it leads to reads the same, silently.
        let new = style.to_ron().expect("writable");
        let again = read(&new);
        let again = again.expect("readable");
        assert_eq!(again.style.to_ron().expect("writable"), new);
        assert_eq!(again.advice, None);
    }

    #[test]
    fn errors_in_a_file_of_version_1_name_its_own_columns() {
        let text = "(version: 1, contours: (fade: 0.5, widht: 1))";
        let at = text.find("widht").expect("there");
        let error = ComicStyle::from_ron(text).expect_err("a wrong field");
        let crate::ComicStyleError::Syntax { line, column, .. } = error else {
            panic!("{error}");
        };
        assert_eq!(line, 1);
        assert_eq!(column, at + 1);
    }

    #[test]
    fn new_names_in_old_files_and_old_names_in_new_files() {
        assert!(read("(version: 1, contours: (opacity_fade: 0.5))").is_ok());
        assert!(read("(version: 2, contours: (fade: 0.5))").is_err());
        assert!(read("(version: 3)").is_err());
        // Broken texts are errors, not panics.
        for text in [
            "",
            "(",
            "\"",
            "(version: 1, name: \"\\",
            "/*",
            "(version: 99999999999)",
        ] {
            assert!(read(text).is_err(), "{text}");
        }
    }
}
