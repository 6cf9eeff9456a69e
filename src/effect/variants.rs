//! Modes of effects as shader definitions.

use bevy::shader::ShaderDefVal;

/// Modes of an effect that select a shader variant. Each becomes a shader definition, whose name is
/// `EFFECT_`, the effect's name in capitals, an underscore, and the variant's name: `MODE` of the
/// effect `rain` becomes `EFFECT_RAIN_MODE`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Variants {
    pub(crate) effect: &'static str,
    entries: Vec<(&'static str, &'static str, Option<u32>)>,
}

impl Variants {
    /// Adds a definition without a value if `on` is true.
    pub fn flag(&mut self, name: &'static str, on: bool) {
        if on {
            self.entries.push((self.effect, name, None));
        }
    }

    /// Adds a definition with a number as its value.
    pub fn number(&mut self, name: &'static str, value: u32) {
        self.entries.push((self.effect, name, Some(value)));
    }

    pub(crate) fn shader_defs(&self) -> impl Iterator<Item = ShaderDefVal> {
        self.entries.iter().map(|(effect, name, value)| {
            let name = format!("{}_{name}", definition(effect));
            match value {
                Some(value) => ShaderDefVal::UInt(name, *value),
                None => name.into(),
            }
        })
    }
}

/// The shader definition of the effect with this name.
pub(crate) fn definition(name: &str) -> String {
    format!("EFFECT_{}", name.to_uppercase())
}
