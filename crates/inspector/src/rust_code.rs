//! Styles as Rust source.

use bevy::{
    prelude::*,
    reflect::{
        ReflectRef, TypeInfo, TypeRegistry,
        enums::{Enum, VariantType},
    },
};

use super::fields::is_option;
#[cfg(feature = "toon")]
use bevy_comics::toon::StyleScene;
use bevy_comics::{ComicStyle, DepthMap, effect::AnyEffect, style::StyleCamera};

/// The types of [`bevy_comics::prelude`] that a style can hold.
const PRELUDE: &[&str] = &[
    "Abstraction",
    "BlackFlats",
    "ColorHarmony",
    "Colorization",
    "Contours",
    "DepthLayers",
    "DepthMap",
    "DepthMapping",
    "Desaturation",
    "Focus",
    "Halftone",
    "Hatching",
    "Outlines",
    "Paint",
    "Paper",
    "Sketch",
    "SpeedLines",
    "ToneBands",
    "ToneRamp",
    "Vignette",
];

/// A Rust expression that builds a style, to compile a tuned style into a game.
/// Fields that have their default value are left out.
///
/// The expression compiles where `bevy::prelude::*` and
/// `bevy_comics::prelude::*` are imported. Types of other crates are written
/// by their reflected type path, and all their fields have to be visible
/// where the code is put. A value that reflection cannot read, such as a
/// map, is replaced by `Default::default()` and a comment.
///
/// ```
/// # use bevy_comics::{ComicStyle, Contours};
/// use bevy_comics_inspector::rust_code;
///
/// let style = ComicStyle::new().with(Contours { width: 3.0, ..Default::default() });
/// let code = "\
/// ComicStyle::new().with(Contours {
///     width: 3.0,
///     ..default()
/// })";
/// assert_eq!(rust_code(&style), code);
/// ```
pub fn rust_code(style: &ComicStyle) -> String {
    let mut types = TypeRegistry::default();
    types.register::<DepthMap>();
    types.register::<StyleCamera>();
    #[cfg(feature = "toon")]
    types.register::<StyleScene>();
    for effect in style.effects() {
        (effect.effect_type().register)(&mut types);
    }
    let writer = Writer { types };
    let mut fields = Vec::new();
    if !style.name.is_empty() {
        fields.push(format!("name: {:?}.into(),", style.name));
    }
    if !style.off.is_empty() {
        // By name: the types of the effects are not known here.
        fields.push(format!("off: {:?}.into(),", Vec::from_iter(&style.off)));
    }
    if style.camera != StyleCamera::default() {
        fields.push(format!("camera: {},", writer.value(&style.camera)));
    }
    #[cfg(feature = "toon")]
    if let Some(scene) = &style.scene {
        fields.push(format!("scene: Some({}),", writer.value(scene)));
    }
    let mut code = String::from("ComicStyle::new()");
    if !fields.is_empty() {
        fields.push(format!("..{code}"));
        code = format!("ComicStyle {}", block(&fields));
    }
    let mut calls = Vec::new();
    if style.partial {
        calls.push(".partial()".to_owned());
    }
    if let Some(map) = &style.depth_map {
        calls.push(format!(".with_depth_map({})", writer.value(map)));
    }
    if let Some(height) = &style.page {
        calls.push(format!(".with_page({})", writer.value(height)));
    }
    for effect in style.effects() {
        calls.push(format!(".with({})", writer.effect(effect)));
    }
    code + &chain(&calls, fields.is_empty())
}

/// The calls after the start of an expression, laid out as rustfmt does: one
/// call stays on the line of a short start, more are put below each other, and
/// indented unless the start ends in a brace.
fn chain(calls: &[String], is_short: bool) -> String {
    match calls {
        [call] if is_short => call.clone(),
        calls if is_short => calls
            .iter()
            .map(|call| format!("\n    {}", indented(call)))
            .collect(),
        calls => calls.iter().map(|call| format!("\n{call}")).collect(),
    }
}

/// Lines in braces.
fn block(lines: &[String]) -> String {
    let lines: String = lines
        .iter()
        .map(|line| format!("    {}\n", indented(line)))
        .collect();
    format!("{{\n{lines}}}")
}

/// Code one level deeper. String literals hold no line breaks, because `Debug`
/// escapes them.
fn indented(code: &str) -> String {
    code.replace('\n', "\n    ")
}

/// Writes reflected values as Rust expressions.
struct Writer {
    /// The types of the values, for the defaults of structs.
    types: TypeRegistry,
}

impl Writer {
    fn effect(&self, effect: &dyn AnyEffect) -> String {
        let default = (effect.effect_type().default)();
        self.structure(effect.as_struct(), Some(default.as_struct()))
    }

    fn value(&self, value: &dyn PartialReflect) -> String {
        if let Some(code) = literal(value) {
            return code;
        }
        match value.reflect_ref() {
            ReflectRef::Struct(fields) => {
                let default = self.default_of(value);
                let default = default
                    .as_deref()
                    .and_then(|d| d.reflect_ref().as_struct().ok());
                self.structure(fields, default)
            }
            ReflectRef::Enum(variant) => self.variant(variant),
            ReflectRef::TupleStruct(fields) => {
                let items: Vec<_> = fields.iter_fields().map(|f| self.value(f)).collect();
                format!("{}({})", path_of(value), items.join(", "))
            }
            ReflectRef::Tuple(fields) => {
                let items: String = fields
                    .iter_fields()
                    .map(|field| self.value(field) + ", ")
                    .collect();
                format!("({})", items.trim_end())
            }
            ReflectRef::Array(items) => {
                let items: Vec<_> = items.iter().map(|item| self.value(item)).collect();
                format!("[{}]", items.join(", "))
            }
            ReflectRef::List(items) => {
                let items: Vec<_> = items.iter().map(|item| self.value(item)).collect();
                format!("vec![{}]", items.join(", "))
            }
            _ => format!(
                "Default::default() /* no Rust form of {} */",
                value.reflect_type_path()
            ),
        }
    }

    fn default_of(&self, value: &dyn PartialReflect) -> Option<Box<dyn Reflect>> {
        let id = value.get_represented_type_info()?.type_id();
        let default = self.types.get_type_data::<ReflectDefault>(id)?;
        Some(default.default())
    }

    /// A struct literal of the fields that differ from the default.
    fn structure(&self, value: &dyn Struct, default: Option<&dyn Struct>) -> String {
        let path = path_of(value.as_partial_reflect());
        let Some(default) = default else {
            return format!("{path} {}", block(&self.fields(value, |_, _| true)));
        };
        let differs = |name: &str, field: &dyn PartialReflect| {
            let same = default
                .field(name)
                .and_then(|d| field.reflect_partial_eq(d));
            same != Some(true)
        };
        let mut fields = self.fields(value, differs);
        if fields.is_empty() {
            return format!("{path}::default()");
        }
        if fields.len() < value.field_len() {
            fields.push("..default()".into());
        }
        format!("{path} {}", block(&fields))
    }

    fn fields(
        &self,
        value: &dyn Struct,
        is_written: impl Fn(&str, &dyn PartialReflect) -> bool,
    ) -> Vec<String> {
        value
            .iter_fields()
            .filter(|(name, field)| is_written(name, *field))
            .map(|(name, field)| format!("{name}: {},", self.value(field)))
            .collect()
    }

    fn variant(&self, value: &dyn Enum) -> String {
        let is_option = match value.get_represented_type_info() {
            Some(TypeInfo::Enum(info)) => is_option(info),
            _ => false,
        };
        let name = if is_option {
            value.variant_name().to_owned()
        } else {
            let path = path_of(value.as_partial_reflect());
            format!("{path}::{}", value.variant_name())
        };
        match value.variant_type() {
            VariantType::Unit => name,
            VariantType::Tuple => {
                let items: Vec<_> = value.iter_fields().map(|f| self.value(f.value())).collect();
                format!("{name}({})", items.join(", "))
            }
            VariantType::Struct => {
                let fields: Vec<_> = value
                    .iter_fields()
                    .filter_map(|field| {
                        Some(format!("{}: {},", field.name()?, self.value(field.value())))
                    })
                    .collect();
                format!("{name} {}", block(&fields))
            }
        }
    }
}

/// The code of a value that is written as a literal or by a constructor.
fn literal(value: &dyn PartialReflect) -> Option<String> {
    macro_rules! debug {
        ($($T:ty),*) => {
            $(if let Some(value) = value.try_downcast_ref::<$T>() {
                return Some(format!("{value:?}"));
            })*
        };
    }
    debug!(bool, char, u8, u16, u32, u64, u128, usize);
    debug!(i8, i16, i32, i64, i128, isize, &'static str);
    if let Some(value) = value.try_downcast_ref::<f32>() {
        return Some(float("f32", f64::from(*value), &format!("{value:?}")));
    }
    if let Some(value) = value.try_downcast_ref::<f64>() {
        return Some(float("f64", *value, &format!("{value:?}")));
    }
    if let Some(value) = value.try_downcast_ref::<String>() {
        return Some(format!("{value:?}.into()"));
    }
    value.try_downcast_ref::<Color>().copied().map(color)
}

/// A float literal, or the constant for what has no literal.
fn float(name: &str, value: f64, debug: &str) -> String {
    if value.is_finite() {
        debug.to_owned()
    } else if value.is_nan() {
        format!("{name}::NAN")
    } else if value > 0.0 {
        format!("{name}::INFINITY")
    } else {
        format!("{name}::NEG_INFINITY")
    }
}

/// The constructor of a color, in its own color space.
fn color(color: Color) -> String {
    if color == Color::BLACK {
        return "Color::BLACK".into();
    }
    if color == Color::WHITE {
        return "Color::WHITE".into();
    }
    if let Color::Srgba(srgba) = color
        && let Some([red, green, blue]) = codes(srgba)
    {
        return format!("Color::srgb_u8({red}, {green}, {blue})");
    }
    let (space, components) = match color {
        Color::Srgba(color) => ("srgb", color.to_f32_array()),
        Color::LinearRgba(color) => ("linear_rgb", color.to_f32_array()),
        Color::Hsla(color) => ("hsl", color.to_f32_array()),
        Color::Hsva(color) => ("hsv", color.to_f32_array()),
        Color::Hwba(color) => ("hwb", color.to_f32_array()),
        Color::Laba(color) => ("lab", color.to_f32_array()),
        Color::Lcha(color) => ("lch", color.to_f32_array()),
        Color::Oklaba(color) => ("oklab", color.to_f32_array()),
        Color::Oklcha(color) => ("oklch", color.to_f32_array()),
        Color::Xyza(color) => ("xyz", color.to_f32_array()),
    };
    let is_opaque = components[3] == 1.0;
    let parts: Vec<String> = components[..if is_opaque { 3 } else { 4 }]
        .iter()
        .map(|part| float("f32", f64::from(*part), &format!("{part:?}")))
        .collect();
    let alpha = if is_opaque { "" } else { "a" };
    format!("Color::{space}{alpha}({})", parts.join(", "))
}

/// The 8-bit components of an opaque color, if they are exact.
fn codes(color: Srgba) -> Option<[u8; 3]> {
    let codes = [color.red, color.green, color.blue].map(|part| (part * 255.0).round() as u8);
    let [red, green, blue] = codes;
    (Srgba::rgb_u8(red, green, blue) == color).then_some(codes)
}

/// The path by which a game names a value's type.
fn path_of(value: &dyn PartialReflect) -> String {
    let path = value.reflect_type_path();
    // Rust infers the parameters of a generic type.
    let path = path.split('<').next().unwrap_or(path);
    let (module, name) = path.rsplit_once("::").unwrap_or(("", path));
    let mut parts = module.split("::");
    match parts.next() {
        Some("bevy_comics") if PRELUDE.contains(&name) => name.to_owned(),
        // Each public module re-exports what its private modules define.
        Some("bevy_comics") => match parts.next() {
            Some("settings") | None => format!("bevy_comics::effects::{name}"),
            Some(public) => format!("bevy_comics::{public}::{name}"),
        },
        Some("glam") => format!("bevy::math::{name}"),
        _ => match path.strip_prefix("bevy_") {
            Some(rest) => format!("bevy::{rest}"),
            None => path.to_owned(),
        },
    }
}

#[cfg(test)]
mod tests;
