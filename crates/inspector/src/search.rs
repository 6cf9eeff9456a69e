//! The search over the settings of all effects.

use bevy::{
    color::Color,
    reflect::{
        NamedField, TypeInfo,
        enums::{EnumInfo, VariantInfo},
    },
};

use super::fields::is_option;
use super::{
    fields::{label, label_of_mode},
    tooltip::plain,
};

/// What is searched for: a setting is found if every word of the search begins a
/// word of the setting's text, in any order and case.
pub struct Search {
    words: Vec<String>,
}

/// The words of a text in lower case. Parts of a path are words.
fn words(text: &str) -> impl Iterator<Item = String> {
    text.split(|c: char| !c.is_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(str::to_lowercase)
}

/// Which part of a section or setting a search finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// It is found itself, and shown with everything in it.
    Whole,
    /// Some of the settings in it are found.
    Inside,
}

impl Search {
    /// `None` if there is nothing to search for.
    pub fn of(text: &str) -> Option<Self> {
        let words: Vec<String> = words(text).collect();
        (!words.is_empty()).then_some(Self { words })
    }

    fn matches(&self, text: &str) -> bool {
        let text: Vec<String> = words(text).collect();
        let begins_a_word = |start: &String| text.iter().any(|word| word.starts_with(start));
        self.words.iter().all(begins_a_word)
    }

    /// What the search finds of an effect or the depth map, by its name in
    /// style files.
    pub fn section(&self, name: &str, info: &TypeInfo) -> Option<Found> {
        if self.matches(&format!("{name} {}", label(name))) {
            return Some(Found::Whole);
        }
        if self.is_inside(name, info) {
            return Some(Found::Inside);
        }
        self.matches(&plain(info.docs().unwrap_or_default()))
            .then_some(Found::Whole)
    }

    /// What the search finds of a setting, by its path in the style.
    pub fn setting(&self, path: &str, field: &NamedField) -> Option<Found> {
        if self.matches(&text_of(path, field)) {
            return Some(Found::Whole);
        }
        let is_inside = field
            .type_info()
            .is_some_and(|info| self.is_inside(path, info));
        is_inside.then_some(Found::Inside)
    }

    fn is_inside(&self, path: &str, info: &TypeInfo) -> bool {
        let found = |field: &NamedField| {
            let path = format!("{path}.{}", field.name());
            self.setting(&path, field).is_some()
        };
        match info {
            TypeInfo::Struct(info) => info.iter().any(found),
            TypeInfo::Enum(info) => match option_type(info) {
                Some(inner) => self.is_inside(path, inner),
                None => info
                    .iter()
                    .filter_map(|variant| variant.as_struct_variant().ok())
                    .any(|variant| variant.iter().any(found)),
            },
            _ => false,
        }
    }
}

/// The type in an `Option`.
pub fn option_type(info: &EnumInfo) -> Option<&'static TypeInfo> {
    if !is_option(info) {
        return None;
    }
    match info.variant("Some")? {
        VariantInfo::Tuple(some) => some.field_at(0)?.type_info(),
        _ => None,
    }
}

/// Everything by which a setting is found: its path with the name of its
/// effect, both as labels too, its documentation, and the modes to choose from.
fn text_of(path: &str, field: &NamedField) -> String {
    let mut text = format!(
        "{path} {} {} {}",
        label(path.split('.').next().unwrap_or(path)),
        label(field.name()),
        plain(field.docs().unwrap_or_default())
    );
    if let Some(TypeInfo::Enum(info)) = field.type_info()
        && !is_option(info)
        && !info.is::<Color>()
    {
        for variant in info.iter() {
            text += " ";
            text += &label_of_mode(variant.name());
            text += " ";
            text += &plain(variant.docs().unwrap_or_default());
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use bevy::reflect::Typed;

    use super::*;
    use bevy_comics::{Contours, DepthMap, Outlines, Vignette};

    fn section<T: Typed>(name: &str, text: &str) -> Option<Found> {
        Search::of(text)
            .expect("words")
            .section(name, T::type_info())
    }

    fn setting<T: Typed>(path: &str, text: &str) -> Option<Found> {
        let name = path.rsplit('.').next().expect("a name");
        let TypeInfo::Struct(info) = T::type_info() else {
            panic!("no struct");
        };
        let field = info.field(name).expect("the field");
        Search::of(text).expect("words").setting(path, field)
    }

    #[test]
    fn words_are_found_in_labels_paths_names_and_documentation() {
        assert!(Search::of(" \t").is_none());
        // The name of the effect finds all of it, in any case.
        assert_eq!(
            section::<Contours>("contours", "CONTOUR"),
            Some(Found::Whole)
        );
        assert_eq!(
            setting::<Contours>("contours.width", "contours"),
            Some(Found::Whole)
        );
        // The name of a setting finds that one.
        assert_eq!(
            section::<Contours>("contours", "width"),
            Some(Found::Inside)
        );
        assert_eq!(
            setting::<Contours>("contours.width", "Width"),
            Some(Found::Whole)
        );
        assert_eq!(setting::<Contours>("contours.opacity", "threshold"), None);
        // By path, by label, with words of both the effect and the setting.
        for text in ["contours.opacity_fade", "opacity fade", "fade contours"] {
            let found = setting::<Contours>("contours.opacity_fade", text);
            assert_eq!(found, Some(Found::Whole), "{text}");
        }
        // From the start of a word: not "increases".
        assert_eq!(
            section::<Outlines>("outlines", "crease"),
            Some(Found::Inside)
        );
        assert_eq!(section::<Outlines>("outlines", "rease"), None);
        // By the documentation of the setting and by the modes.
        assert_eq!(
            setting::<Contours>("contours.width", "pixels"),
            Some(Found::Whole)
        );
        assert_eq!(
            setting::<Contours>("contours.operator", "laplace"),
            Some(Found::Whole)
        );
        assert_eq!(section::<Vignette>("vignette", "laplace"), None);
        // But not by the color spaces of a color.
        assert_eq!(setting::<Contours>("contours.color", "oklab"), None);
        assert_eq!(section::<Contours>("contours", "contours zzz"), None);
    }

    #[test]
    fn settings_inside_options_and_modes_are_found() {
        assert_eq!(
            setting::<Outlines>("outlines.creases", "angle"),
            Some(Found::Inside)
        );
        assert_eq!(
            section::<Outlines>("outlines", "creases angle"),
            Some(Found::Inside)
        );
        assert_eq!(
            setting::<DepthMap>("depth_map.mapping", "near"),
            Some(Found::Whole)
        );
        assert_eq!(
            setting::<DepthMap>("depth_map.smoothing", "shrink"),
            Some(Found::Inside)
        );
        assert_eq!(setting::<DepthMap>("depth_map.locked", "shrink"), None);
    }
}
