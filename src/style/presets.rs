//! Named looks that come with the crate: the files of `assets/styles/`, read at
//! compile time, so that a game has them without copying anything.

use super::{ComicStyle, ComicStyleError};

macro_rules! presets {
    ($($name:literal),* $(,)?) => {
        /// The names of the presets, in the order of the gallery.
        pub const NAMES: &[&str] = &[$($name),*];

        fn source(name: &str) -> Option<&'static str> {
            match name {
                $($name => Some(include_str!(concat!(
                    env!("CARGO_MANIFEST_DIR"), "/assets/styles/", $name, ".comic.ron"
                ))),)*
                _ => None,
            }
        }
    };
}

presets![
    "crimson-dusk",
    "museum-print",
    "emerald-ink",
    "sepia",
    "ligne-claire",
    "noir",
    "cobalt-night",
    "misty-morning",
    "golden-hour",
    "blueprint",
    "saturday-morning",
    "graphic-novel",
    "pencil-sketch",
    "figure-7a",
    "figure-7b",
    "figure-8a",
    "figure-8b",
    "figure-8c",
    "twilight-toon",
    "watercolor",
    "clear-bands",
    "silent-film",
];

/// The preset of this name; `None` if there is none.
///
/// # Errors
/// As [`ComicStyle::from_ron`]; a test reads every preset, so none is expected.
pub fn preset(name: &str) -> Option<Result<ComicStyle, ComicStyleError>> {
    source(name).map(ComicStyle::from_ron)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_reads_and_is_within_its_ranges() {
        for name in NAMES {
            let style = preset(name)
                .expect("listed")
                .unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_eq!(
                style,
                style.sanitized(),
                "{name} is changed by its own clamps"
            );
            assert!(!style.name.is_empty(), "{name} has no title");
        }
    }

    #[test]
    fn every_style_file_is_a_preset() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/styles");
        for entry in std::fs::read_dir(folder).expect("the folder of styles") {
            let file = entry.expect("entry").file_name();
            let file = file.to_string_lossy();
            let name = file.strip_suffix(".comic.ron").expect("only styles");
            assert!(NAMES.contains(&name), "{file} is not in the list");
        }
    }
}
