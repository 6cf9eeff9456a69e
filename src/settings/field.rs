//! What tools may know about a setting: its range and unit, on the field itself.

use bevy::reflect::{NamedField, Reflect};

/// The documented range of a number: a reflection attribute of every number of
/// every style, so that a tool can make a slider of it.
///
/// ```
/// # use bevy::reflect::{TypeInfo, Typed};
/// # use bevy_comics::{Contours, FieldRange};
/// let TypeInfo::Struct(info) = Contours::type_info() else { panic!() };
/// let range = FieldRange::of(info.field("width").unwrap()).unwrap();
/// assert_eq!((range.min, range.max, range.unit), (0.5, 16.0, "px"));
/// ```
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
pub struct FieldRange {
    /// The least value that is used; less counts as this.
    pub min: f64,
    /// The greatest value that is used; more counts as this.
    pub max: f64,
    /// Whether equal ratios are equal steps for the eye.
    pub logarithmic: bool,
    /// The unit, as it stands behind a number; empty for a plain number.
    pub unit: &'static str,
}

impl FieldRange {
    /// Shares and amounts.
    pub const FRACTION: Self = Self::linear(0.0, 1.0);

    /// A range in which equal differences are equal steps.
    pub const fn linear(min: f64, max: f64) -> Self {
        Self {
            min,
            max,
            logarithmic: false,
            unit: "",
        }
    }

    /// A range in which equal ratios are equal steps.
    pub const fn logarithmic(min: f64, max: f64) -> Self {
        Self {
            logarithmic: true,
            ..Self::linear(min, max)
        }
    }

    /// The same range with a unit.
    pub const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// The range of a field, if it has one.
    pub fn of(field: &NamedField) -> Option<Self> {
        field.get_attribute::<Self>().copied()
    }
}

/// Marks a colour of which the hue is what matters: tools show a hue wheel.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq)]
pub struct HueWheel;

/// How a field is mixed when a style changes into another, where its type does
/// not say it: by default numbers and colours are interpolated, and everything
/// else is a mode (the effect fades out, changes its mode, and fades in).
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BlendField {
    /// Changes half of the way, without a fade.
    Switch,
}
