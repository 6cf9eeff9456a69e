//! Widgets for the settings of a style, made by reflection from the names,
//! documentation, ranges, units and defaults of its fields. New fields and the
//! effects of games need no code here.

mod images;
mod lists;
mod options;
#[cfg(feature = "toon")]
mod ramp_bar;
mod sections;
mod vectors;
mod widgets;

use bevy::{
    prelude::*,
    reflect::{
        NamedField, ReflectMut, ReflectRef, TypeInfo, TypeRegistry, UnnamedField, enums::EnumInfo,
    },
};
use bevy_egui::egui::{self, CollapsingHeader, Response, Ui};

#[cfg(feature = "objects")]
pub use self::sections::optional;
pub use self::sections::style;
use self::{
    images::image,
    lists::list,
    options::option,
    vectors::vector,
    widgets::{color, modes, number, whole_number},
};
use super::{
    Widgets, note,
    search::{Found, Search},
    stash::Stash,
    tooltip::tooltip,
};
use bevy_comics::{
    DepthMap,
    effect::{EffectType, FieldRange, HueWheel},
};

/// What the widgets of a style share.
pub struct Editor<'a> {
    pub widgets: &'a mut Widgets,
    /// Settings that come back when something is turned on again.
    pub stash: &'a Stash,
    /// The types of the style's values, for their defaults.
    pub types: &'a TypeRegistry,
}

impl Editor<'_> {
    /// The default of a type, if it is registered with one.
    fn default_of(&self, info: &TypeInfo) -> Option<Box<dyn Reflect>> {
        let default = self.types.get_type_data::<ReflectDefault>(info.type_id())?;
        Some(default.default())
    }

    /// A value of a type that the settings did not have before. Floats are NaN,
    /// which becomes the documented default when the style is brought into its
    /// ranges.
    fn new_value(&self, info: &TypeInfo) -> Option<Box<dyn PartialReflect>> {
        if info.is::<f32>() {
            return Some(Box::new(f32::NAN));
        }
        if info.is::<f64>() {
            return Some(Box::new(f64::NAN));
        }
        if info.is::<Vec2>() {
            return Some(Box::new(Vec2::NAN));
        }
        if info.is::<Vec3>() {
            return Some(Box::new(Vec3::NAN));
        }
        Some(self.default_of(info)?.into_partial_reflect())
    }
}

/// Whether an enum is the standard library's `Option`.
pub fn is_option(info: &EnumInfo) -> bool {
    let path = info.type_path_table();
    path.module_path() == Some("core::option") && path.ident() == Some("Option")
}

/// The types of a style's values.
pub fn types(effects: &[&'static EffectType]) -> TypeRegistry {
    let mut types = TypeRegistry::default();
    types.register::<DepthMap>();
    for effect in effects {
        (effect.register)(&mut types);
    }
    types
}

/// The name, documentation and range of a setting.
struct Setting<'a> {
    /// In the style, such as `contours.width`.
    path: &'a str,
    label: String,
    docs: &'static str,
    range: Option<FieldRange>,
    /// Whether a hue wheel is shown.
    wheel: bool,
}

impl<'a> Setting<'a> {
    fn of(field: &'static NamedField, path: &'a str) -> Self {
        Self {
            path,
            label: label(field.name()),
            docs: field.docs().unwrap_or_default(),
            range: FieldRange::of(field),
            wheel: field.has_attribute::<HueWheel>(),
        }
    }

    /// The only value of a mode, with the mode's name, or one of several, with its number.
    fn of_mode(field: &'static UnnamedField, mode: &str, count: usize, path: &'a str) -> Self {
        let mode = label_of_mode(mode);
        let label = match count {
            1 => mode,
            _ => format!("{mode} {}", field.index() + 1),
        };
        Self {
            path,
            label,
            docs: field.docs().unwrap_or_default(),
            range: field.get_attribute::<FieldRange>().copied(),
            wheel: field.has_attribute::<HueWheel>(),
        }
    }
}

/// `edge_limit` as words: "Edge limit".
pub fn label(name: &str) -> String {
    let mut words = name.replace('_', " ");
    if let Some(first) = words.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    words
}

/// `MinMaxLogarithmic` as words: "Min max logarithmic".
pub fn label_of_mode(name: &str) -> String {
    let mut words = String::new();
    for (i, c) in name.char_indices() {
        if i > 0 && c.is_ascii_uppercase() {
            words.push(' ');
            words.push(c.to_ascii_lowercase());
        } else {
            words.push(c);
        }
    }
    words
}

/// Shows a tooltip over a widget. Its text is made only when it is shown.
fn explained(response: Response, docs: &'static str) -> Response {
    if docs.is_empty() {
        return response;
    }
    response.on_hover_ui(|ui| {
        ui.set_max_width(360.0);
        ui.label(tooltip(docs));
    })
}

fn reset_button(ui: &mut Ui, path: &str, widgets: &mut Widgets) -> Response {
    let button = ui.small_button("↺");
    note(widgets, path, &button);
    button.on_hover_text("Reset to the default")
}

/// The fields of a struct, one below the other, by the path of the struct and
/// the search that leaves some of them out.
pub fn settings(
    ui: &mut Ui,
    value: &mut dyn Struct,
    default: Option<&dyn Struct>,
    (path, search): (&str, Option<&Search>),
    editor: &mut Editor,
) {
    let Some(info) = value.get_represented_struct_info() else {
        return;
    };
    for (i, field) in info.iter().enumerate() {
        let path = format!("{path}.{}", field.name());
        let search = match search.map(|search| (search, search.setting(&path, field))) {
            Some((_, None)) => continue,
            Some((search, Some(Found::Inside))) => Some(search),
            Some((_, Some(Found::Whole))) | None => None,
        };
        let setting = Setting::of(field, &path);
        let default = default.and_then(|default| default.field(field.name()));
        if let Some(value) = value.field_at_mut(i) {
            edit(ui, value, default, (&setting, search), editor);
        }
    }
}

/// A row: the widget, its name, and the button that resets it.
fn row<T: PartialEq + Clone>(
    ui: &mut Ui,
    value: &mut T,
    default: Option<&T>,
    setting: &Setting,
    widgets: &mut Widgets,
    widget: impl FnOnce(&mut Ui, &mut T) -> Response,
) {
    ui.horizontal(|ui| {
        let response = widget(ui, value);
        note(widgets, setting.path, &response);
        explained(response, setting.docs);
        explained(ui.label(&setting.label), setting.docs);
        if let Some(default) = default.filter(|default| *default != value)
            && reset_button(ui, &format!("{}.reset", setting.path), widgets).clicked()
        {
            value.clone_from(default);
        }
    });
}

fn edit(
    ui: &mut Ui,
    value: &mut dyn PartialReflect,
    default: Option<&dyn PartialReflect>,
    (setting, search): (&Setting, Option<&Search>),
    editor: &mut Editor,
) {
    macro_rules! typed {
        ($($T:ty => $widget:expr),* $(,)?) => {
            $(if let Some(value) = value.try_downcast_mut::<$T>() {
                let default = default.and_then(|default| default.try_downcast_ref::<$T>());
                return row(ui, value, default, setting, editor.widgets, $widget);
            })*
        };
    }
    typed! {
        f32 => |ui, value| number(ui, value, setting.range),
        u32 => |ui, value| whole_number(ui, value, setting.range),
        bool => |ui, value| ui.checkbox(value, ""),
        Color => |ui, value| color(ui, value, setting.wheel),
        Vec2 => |ui, value| vector(ui, value.as_mut(), setting.range),
        Vec3 => |ui, value| vector(ui, value.as_mut(), setting.range),
    }
    if let Some(handle) = value.try_downcast_ref::<Option<Handle<Image>>>() {
        return image(ui, handle.as_ref(), setting, editor.widgets);
    }
    match value.get_represented_type_info() {
        Some(TypeInfo::Enum(info)) if is_option(info) => {
            option(ui, value, default, (setting, search), editor);
        }
        Some(TypeInfo::Enum(info)) => modes(ui, value, info, default, setting, editor),
        Some(TypeInfo::List(_)) => list(ui, value, default, setting, editor),
        Some(TypeInfo::Struct(_)) => nested(ui, value, default, (setting, search), editor),
        _ => {
            ui.label(format!("{}: no widget for this type", setting.label));
        }
    }
}

/// The settings of a struct in a struct, below its name.
fn nested(
    ui: &mut Ui,
    value: &mut dyn PartialReflect,
    default: Option<&dyn PartialReflect>,
    (setting, search): (&Setting, Option<&Search>),
    editor: &mut Editor,
) {
    explained(ui.label(&setting.label), setting.docs);
    ui.indent(setting.path, |ui| {
        let default = default.and_then(as_struct);
        if let ReflectMut::Struct(value) = value.reflect_mut() {
            settings(ui, value, default, (setting.path, search), editor);
        }
    });
}

fn as_struct(value: &dyn PartialReflect) -> Option<&dyn Struct> {
    match value.reflect_ref() {
        ReflectRef::Struct(fields) => Some(fields),
        _ => None,
    }
}

/// A section that opens and closes.
pub fn section<R>(ui: &mut Ui, title: &str, contents: impl FnOnce(&mut Ui) -> R) -> Option<R> {
    CollapsingHeader::new(title)
        .default_open(true)
        .show(ui, contents)
        .body_returned
}

/// The text of an error.
pub fn error(ui: &mut Ui, text: &str) -> Response {
    ui.colored_label(ui.visuals().error_fg_color, text)
}

/// A button whose place is published under a name; whether it was clicked.
pub fn button(ui: &mut Ui, widgets: &mut Widgets, name: &str, text: &str, enabled: bool) -> bool {
    button_with_tooltip(ui, widgets, (name, text, ""), enabled)
}

/// As [`button`], of a name, a text and a tooltip.
pub fn button_with_tooltip(
    ui: &mut Ui,
    widgets: &mut Widgets,
    (name, text, explanation): (&str, &str, &'static str),
    enabled: bool,
) -> bool {
    let button = ui.add_enabled(enabled, egui::Button::new(text));
    note(widgets, name, &button);
    let clicked = button.clicked();
    if !explanation.is_empty() {
        button.on_hover_text(explanation);
    }
    clicked
}

#[cfg(test)]
mod tests;
