//! Colors in style files: `"#rrggbb"` or `"#rrggbbaa"` where 8 bits per component
//! are exact, otherwise four sRGB components (red, green, blue, alpha).
//!
//! A color field of an effect uses it with
//! `#[serde(with = "bevy_comics::effect::color_serde")]`.

use bevy::color::{Color, LinearRgba, Srgba};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum FileColor {
    Hex(String),
    Components(f32, f32, f32, f32),
}

/// Writes a color in its shortest exact form.
///
/// # Errors
/// If the serializer fails.
pub fn serialize<S: Serializer>(color: &Color, serializer: S) -> Result<S::Ok, S::Error> {
    let srgba = color.to_srgba();
    let hex = srgba.to_hex();
    // The way from linear light and back rounds.
    let is_same = |same: &Srgba| match color {
        Color::LinearRgba(linear) => LinearRgba::from(*same) == *linear,
        _ => *same == srgba,
    };
    let color_serde = match Srgba::hex(&hex) {
        Ok(same) if is_same(&same) => FileColor::Hex(hex),
        _ => FileColor::Components(srgba.red, srgba.green, srgba.blue, srgba.alpha),
    };
    color_serde.serialize(serializer)
}

/// Reads a color.
///
/// # Errors
/// If the value is neither a hexadecimal string nor four numbers.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Color, D::Error> {
    match FileColor::deserialize(deserializer) {
        Ok(FileColor::Hex(hex)) => Srgba::hex(&hex)
            .map(Color::Srgba)
            .map_err(|error| D::Error::custom(format!("invalid color {hex:?}: {error}"))),
        Ok(FileColor::Components(red, green, blue, alpha)) => {
            Ok(Color::srgba(red, green, blue, alpha))
        }
        Err(_) => Err(D::Error::custom(
            "a color is \"#rrggbb\", \"#rrggbbaa\" or four sRGB components (red, green, blue, alpha)",
        )),
    }
}
