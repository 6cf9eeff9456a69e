//! Settings as RON text: what files of styles and of shadings have in common.

pub(crate) mod renamed;

use serde::Serialize;

/// How all settings are written.
pub(crate) fn ron_options() -> ron::Options {
    ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME)
}

/// The text of settings; an error says why they have none.
pub(crate) fn written<T: Serialize>(settings: &T) -> Result<String, String> {
    let pretty = ron::ser::PrettyConfig::default().indentor("    ");
    let text = ron_options().to_string_pretty(settings, pretty);
    let text = text.map_err(|error| error.to_string())?;
    Ok(text + "\n")
}
