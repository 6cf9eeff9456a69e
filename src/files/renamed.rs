//! Files of the previous format version, some of whose entries, fields and values had other names.

use std::{fmt::Write, ops::Range};

/// What was renamed: entry of the file, or innermost entry around the name, old name, new name.
pub(crate) type Renamed = &'static [(&'static str, &'static str, &'static str)];

/// What version 3 of style files renamed.
pub(crate) const STYLE: Renamed = &[
    ("abstraction", "near", "at_near"),
    ("abstraction", "far", "at_far"),
    ("abstraction", "by", "granularity"),
    ("tone_ramp", "far_dark", "distant_dark"),
    ("tone_ramp", "far_middle", "distant_middle"),
    ("tone_ramp", "far_light", "distant_light"),
    ("tone_ramp", "far_middle_at", "distant_middle_at"),
    ("tone_ramp", "far_light_at", "distant_light_at"),
    ("tone_ramp", "far_softness", "distant_softness"),
    ("tone_bands", "form", "equations"),
    ("desaturation", "near", "amount_near"),
    ("desaturation", "form", "equations"),
    ("colorization", "form", "equations"),
    ("colorization", "Hue", "KeepHue"),
    ("colorization", "Quadratic", "SquareRoot"),
    ("color_harmony", "form", "equations"),
    ("color_harmony", "Quadratic", "SquareRoot"),
    ("planes", "near", "foreground"),
    ("planes", "far", "background"),
    ("planes", "near_end", "foreground_end"),
    ("planes", "far_start", "background_start"),
    ("planes", "by", "granularity"),
    ("planes", "planes", "depth_layers"),
    ("paint", "form", "kernel"),
    ("paint", "near", "at_near"),
    ("paint", "far", "at_far"),
    ("focus", "period", "cell_size"),
    ("focus", "Centre", "Center"),
    ("print_offset", "print_offset", "misregistration"),
    ("halftone", "shadows", "solid_below"),
    ("halftone", "highlights", "bare_above"),
    ("halftone", "near", "at_near"),
    ("halftone", "far", "at_far"),
    ("halftone", "below", "shadows_only_below"),
    ("halftone", "period", "cell_size"),
    ("hatching", "shadows", "solid_below"),
    ("hatching", "highlights", "bare_above"),
    ("hatching", "near", "at_near"),
    ("hatching", "far", "at_far"),
    ("hatching", "calm", "simplify_small"),
    ("hatching", "marks", "kind"),
    ("contours", "form", "equations"),
    ("outlines", "continuity", "hysteresis"),
    ("outlines", "continuity_level", "hysteresis_ratio"),
    ("outlines", "specks", "min_length"),
    ("outlines", "bridge", "gap_closing"),
    ("outlines", "persistence", "hold_frames"),
    ("outlines", "budget", "ink_budget"),
    ("outlines", "nib", "nib_roundness"),
    ("outlines", "form", "equations"),
    ("iso_lines", "centre", "center"),
    ("speed_lines", "dry", "dry_brush"),
    ("paper", "spread", "ink_bleed"),
    ("depth_map", "near", "from"),
    ("depth_map", "far", "to"),
];

/// What version 2 of shading files renamed.
#[cfg(feature = "toon")]
pub(crate) const SHADING: Renamed = &[
    ("light", "terminator", "shadow_threshold"),
    ("light", "projected_shadows", "cast_shadows"),
    ("light", "backface_shadows", "form_shadows"),
    ("light", "form", "proxy"),
    ("light", "far_amount", "amount_at_far"),
    ("light", "Share", "LightFraction"),
    ("light", "share", "fraction"),
    ("light", "near", "from"),
    ("hatching", "shadows", "solid_below"),
    ("hatching", "highlights", "bare_above"),
    ("hatching", "near", "at_near"),
    ("hatching", "far", "at_far"),
    ("hatching", "calm", "simplify_small"),
    ("hatching", "marks", "kind"),
    ("light", "glint", "stylized_highlight"),
];

/// The text of a file with the current names.
pub(crate) struct Upgraded {
    pub text: String,
    edits: Vec<Edit>,
}

/// A word that was replaced.
struct Edit {
    /// Where the new word begins in the upgraded text, in bytes.
    at: usize,
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
        let lines = self.text.split_inclusive('\n').take(line.saturating_sub(1));
        let start: usize = lines.map(str::len).sum();
        let rest = &self.text[start..];
        let end = rest.char_indices().nth(column.saturating_sub(1));
        let end = start + end.map_or(rest.len(), |(length, _)| length);
        let before = self
            .edits
            .iter()
            .filter(|edit| (start..end).contains(&edit.at));
        let shift = before.map(|edit| edit.new.len() as isize - edit.old.len() as isize);
        column.saturating_add_signed(-shift.sum::<isize>())
    }

    /// What to change in the file; `None` if it is up to date.
    pub fn advice(&self) -> Option<String> {
        let version = self.edits.iter().find(|edit| edit.entry == "version")?;
        let mut advice = format!(
            "this file has format version {}: set `version: {}`",
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

/// The version that the text of a file states.
pub(crate) fn version(text: &str) -> Option<u32> {
    entry_words(text)
        .into_iter()
        .find(|word| word.entry == "version" && !word.is_key)
        .and_then(|word| text[word.range].parse().ok())
}

/// The text of a file of the version before `version` with the current names. Takes time in
/// proportion to the length of the text.
pub(crate) fn upgraded(text: &str, version: &'static str, renamed: Renamed) -> Upgraded {
    let mut upgraded = Upgraded {
        text: String::with_capacity(text.len()),
        edits: Vec::new(),
    };
    let mut copied = 0;
    for word in entry_words(text) {
        let old = &text[word.range.clone()];
        let new = if word.entry == "version" && !word.is_key {
            Some(version)
        } else {
            let within = |name: &str| {
                let found =
                    (renamed.iter()).find(|(entry, from, _)| *entry == name && *from == old);
                found.map(|(_, _, to)| *to)
            };
            within(word.within).or_else(|| within(word.entry))
        };
        let Some(new) = new else { continue };
        upgraded.text.push_str(&text[copied..word.range.start]);
        upgraded.edits.push(Edit {
            at: upgraded.text.len(),
            entry: word.entry.to_owned(),
            old: old.to_owned(),
            new,
        });
        upgraded.text.push_str(new);
        copied = word.range.end;
    }
    upgraded.text.push_str(&text[copied..]);
    upgraded
}

/// A name or number inside of an entry.
struct Word<'a> {
    /// Name of the entry of the file, such as `contours`.
    entry: &'a str,
    /// Name of the innermost entry around it.
    within: &'a str,
    /// Whether this is the entry's own name.
    is_key: bool,
    range: Range<usize>,
}

/// The words of a RON text, without those in strings and comments.
fn entry_words(text: &str) -> Vec<Word<'_>> {
    let mut words = Vec::new();
    let (mut at, mut entry, mut last_key) = (0, "", "");
    // The key in front of every bracket that is open.
    let mut open: Vec<&str> = Vec::new();
    while let Some(c) = text[at..].chars().next() {
        let rest = &text[at..];
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if c == '"' {
            string_length(rest)
        } else if let Some(length) = raw_string_length(rest) {
            length
        } else if c.is_alphanumeric() || c == '_' {
            let length = rest
                .find(|c: char| !(c.is_alphanumeric() || c == '_'))
                .unwrap_or(rest.len());
            let names_value = rest[length..].trim_start().starts_with(':');
            let is_key = open.len() == 1 && names_value;
            if is_key {
                entry = &rest[..length];
            }
            let range = at..at + length;
            words.push(Word {
                entry,
                within: open.last().copied().unwrap_or_default(),
                is_key,
                range,
            });
            if names_value {
                last_key = &rest[..length];
            }
            length
        } else {
            match c {
                '(' | '[' | '{' => open.push(last_key),
                ')' | ']' | '}' => {
                    open.pop();
                }
                _ => {}
            }
            c.len_utf8()
        };
        at += length;
    }
    words
}

/// The length of a raw string at the start of a text, such as `r#"..."#`.
fn raw_string_length(text: &str) -> Option<usize> {
    let hashes = text
        .strip_prefix('r')?
        .bytes()
        .take_while(|b| *b == b'#')
        .count();
    let start = 1 + hashes;
    text[start..].strip_prefix('"')?;
    let end = format!("\"{}", "#".repeat(hashes));
    let found = text[start + 1..].find(&end);
    Some(found.map_or(text.len(), |at| start + 1 + at + end.len()))
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
    use crate::{
        ColorHarmony, ComicStyle, DepthLayers, Outlines,
        effect::EffectRegistry,
        effects::{Equations, HarmonyCurve},
        style::{ComicStyleError, ReadStyle},
    };

    const OLD: &str = r##"// specks in a comment stays
(
    version: 2,
    name: "form: Faithful, \"specks\"",
    color_harmony: (curve: Quadratic, form: Faithful),
    planes: (near: (saturation: 0.5), near_end: 0.125),
    outlines: (specks: 3, silhouettes: (form: Faithful), color: Ink, weight: (nib: 0.5)),
    hatching: (calm: 0.5, marks: Dots),
)
"##;

    fn read(text: &str) -> Result<ReadStyle, ComicStyleError> {
        EffectRegistry::built_in().read_style(text)
    }

    #[test]
    fn a_file_of_the_previous_version_reads_and_says_what_to_rename() {
        let old = read(OLD).expect("readable");
        let style = old.style;
        assert_eq!(style.name, "form: Faithful, \"specks\"");
        let harmony = style.get::<ColorHarmony>().expect("harmony");
        assert_eq!(
            (harmony.equations, harmony.curve),
            (Equations::Faithful, HarmonyCurve::SquareRoot)
        );
        let layers = style.get::<DepthLayers>().expect("layers");
        assert_eq!(
            (layers.foreground.saturation, layers.foreground_end),
            (0.5, 0.125)
        );
        let outlines = style.get::<Outlines>().expect("outlines");
        assert_eq!(
            (outlines.min_length, outlines.weight.nib_roundness),
            (3, 0.5)
        );
        let advice = old.advice.as_deref().expect("an advice");
        for expected in [
            "format version 2: set `version: 3`",
            "rename `planes` to `depth_layers` in `planes`",
            "rename `near_end` to `foreground_end` in `planes`",
            "rename `Quadratic` to `SquareRoot` in `color_harmony`",
            "rename `nib` to `nib_roundness` in `outlines`",
            "rename `marks` to `kind` in `hatching`",
        ] {
            assert!(advice.contains(expected), "{advice}");
        }
        // The advice is right: the file that it leads to reads the same, silently.
        let new = style.to_ron().expect("writable");
        let again = read(&new).expect("readable");
        assert_eq!(again.style.to_ron().expect("writable"), new);
        assert_eq!(again.advice, None);
    }

    #[test]
    fn errors_in_a_file_of_the_previous_version_name_its_own_columns() {
        let text = "(version: 2, outlines: (specks: 3, widht: 1))";
        let at = text.find("widht").expect("there");
        let error = ComicStyle::from_ron(text).expect_err("a wrong field");
        let ComicStyleError::Syntax { line, column, .. } = error else {
            panic!("{error}");
        };
        assert_eq!((line, column), (1, at + 1));
    }

    #[test]
    fn new_names_in_old_files_and_old_names_in_new_files() {
        assert!(read("(version: 2, outlines: (min_length: 3))").is_ok());
        assert!(read("(version: 3, outlines: (specks: 3))").is_err());
        assert!(read("(version: 1)").is_err());
        assert!(read("(version: 4)").is_err());
        // Broken texts are errors, not panics.
        for text in [
            "",
            "(",
            "\"",
            "(version: 2, name: \"\\",
            "/*",
            "(version: 99999999999)",
        ] {
            assert!(read(text).is_err(), "{text}");
        }
    }

    #[test]
    fn raw_strings_are_no_names() {
        let text = "(name: r#\"5\" specks\"#, version: 2, outlines: (specks: 3))";
        let style = read(text).expect("readable").style;
        assert_eq!(style.name, "5\" specks");
        assert_eq!(style.get::<Outlines>().expect("outlines").min_length, 3);
    }

    #[test]
    #[cfg(feature = "toon")]
    fn the_innermost_entry_decides() {
        let text = "(version: 1, light: (hatching: (near: 0.875, calm: 1, marks: Dots), \
                    form: (near: 2)))";
        let light = crate::toon::ToonShading::from_ron(text)
            .expect("readable")
            .light;
        let hatching = light.hatching.expect("strokes");
        assert_eq!((hatching.at_near, hatching.simplify_small), (0.875, 1.0));
        assert_eq!(hatching.kind, crate::effects::HatchingKind::Dots);
        assert_eq!(light.proxy.expect("a proxy").from, 2.0);
    }
}
