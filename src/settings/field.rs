//! Attributes on the fields of an effect: range, unit, what replaces a number that is not finite,
//! and how a field is blended.

use bevy::reflect::{NamedField, Reflect};

/// The documented range of a number: a reflection attribute of every numeric field
/// of every effect, of the toon material, and of the components of objects. Tools make
/// sliders from it. Of a vector, it is the range of each component; of a list, that of its
/// length.
///
/// ```
/// # use bevy::reflect::{TypeInfo, Typed};
/// # use bevy_comics::{Contours, effect::FieldRange};
/// let TypeInfo::Struct(info) = Contours::type_info() else { panic!() };
/// let range = FieldRange::of(info.field("width").unwrap()).unwrap();
/// assert_eq!((range.min, range.max, range.unit), (0.5, 16.0, "px"));
/// ```
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
pub struct FieldRange {
    /// Least value; a smaller one is clamped to it.
    pub min: f64,
    /// Greatest value; a larger one is clamped to it.
    pub max: f64,
    /// Whether equal ratios, not equal differences, look like equal steps. Sliders
    /// are then logarithmic, and transitions interpolate by ratio.
    pub logarithmic: bool,
    /// Unit that is written after the number; empty if it has none. `px` are logical pixels, or page
    /// pixels on a camera with a [`PageHeight`](crate::style::PageHeight).
    pub unit: &'static str,
}

impl FieldRange {
    /// 0 to 1: fractions, amounts and opacities.
    pub const FRACTION: Self = Self::linear(0.0, 1.0);

    /// A range with a linear scale: equal differences are equal steps.
    pub const fn linear(min: f64, max: f64) -> Self {
        Self {
            min,
            max,
            logarithmic: false,
            unit: "",
        }
    }

    /// A range with a logarithmic scale: equal ratios are equal steps.
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

/// What a number becomes that is not finite, each component of a vector. Without this attribute, it
/// becomes that of the default of the type that is clamped, which has no number for a field of
/// another variant, nor of an option that is `None`.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
pub(crate) struct NotFinite(pub f32);

/// Marks a color field whose hue matters most: tools show a hue wheel for it.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq)]
pub struct HueWheel;

/// How a field changes during a transition between two styles.
///
/// Without this attribute, `f32`, `Vec2`, `Vec3` and colors are interpolated, and a field
/// of any other type is a mode: the effect fades out, changes the mode halfway, and
/// fades in again.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BlendField {
    /// The field takes its new value halfway through the transition, without a fade.
    Switch,
    /// The fields of the field are blended, each as its own attributes say. An enum or option that
    /// changes its variant is a mode. The field of a variant that has no attributes, such as that
    /// of `Some`, is blended by those of the enum.
    Fields,
}
