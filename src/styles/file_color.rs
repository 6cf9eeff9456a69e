//! Colours in style files: `"#rrggbb"` where 8 bits say it all, else four sRGB
//! components.

use bevy::color::{Color, Srgba};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum FileColor {
    Hex(String),
    Components(f32, f32, f32, f32),
}

pub(super) fn serialize<S: Serializer>(color: &Color, serializer: S) -> Result<S::Ok, S::Error> {
    let srgba = color.to_srgba();
    let hex = srgba.to_hex();
    let file_color = match Srgba::hex(&hex) {
        Ok(same) if same == srgba => FileColor::Hex(hex),
        _ => FileColor::Components(srgba.red, srgba.green, srgba.blue, srgba.alpha),
    };
    file_color.serialize(serializer)
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Color, D::Error> {
    match FileColor::deserialize(deserializer) {
        Ok(FileColor::Hex(hex)) => Srgba::hex(&hex)
            .map(Color::Srgba)
            .map_err(|error| D::Error::custom(format!("colour {hex:?}: {error}"))),
        Ok(FileColor::Components(red, green, blue, alpha)) => {
            Ok(Color::srgba(red, green, blue, alpha))
        }
        Err(_) => Err(D::Error::custom(
            "a colour is \"#rrggbb\", \"#rrggbbaa\" or four sRGB components (red, green, blue, alpha)",
        )),
    }
}
