//! Widgets for the settings of a style, made from what its types say about
//! themselves: names, documentation, ranges, units, defaults. A new field shows
//! up without a line here.

mod widgets;

use bevy::{
    color::Color,
    reflect::{NamedField, PartialReflect, Typed, structs::Struct},
};
use bevy_egui::egui::{
    self, CollapsingHeader, Response, RichText, Ui, collapsing_header::CollapsingState,
};

use self::widgets::{color, modes, number, option, whole_number};
use super::{Widgets, note};
use crate::{
    ComicStyle, Creases, DepthMap, EffectType, FieldRange, HueWheel, ObjectEdges, RangeSmoothing,
    Silhouettes,
};

/// What a setting is called and says about itself.
struct Setting<'a> {
    path: &'a str,
    label: String,
    docs: &'static str,
    range: Option<FieldRange>,
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
}

fn label(name: &str) -> String {
    let mut words = name.replace('_', " ");
    if let Some(first) = words.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    words
}

/// `MinMaxLogarithmic` as words.
fn label_of_mode(name: &str) -> String {
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

/// Documentation without its markup.
fn plain(docs: &str) -> String {
    let joined = docs
        .trim()
        .lines()
        .map(str::trim)
        .collect::<Vec<_>>()
        .join(" ");
    joined.replace(['[', ']', '`', '\\'], "")
}

/// The depth map and every registered effect: whether it is there, and its
/// settings.
pub fn style(
    ui: &mut Ui,
    style: &mut ComicStyle,
    types: &[&'static EffectType],
    widgets: &mut Widgets,
) {
    depth_map(ui, &mut style.depth_map, widgets);
    for effect in types {
        effect_section(ui, style, effect, widgets);
    }
}

fn depth_map(ui: &mut Ui, map: &mut Option<DepthMap>, widgets: &mut Widgets) {
    let default = DepthMap::default();
    let mut part = Part {
        path: "depth_map",
        docs: DepthMap::type_info().docs().unwrap_or_default(),
        on: map.is_some(),
        edited: map.is_some_and(|map| map != default),
    };
    match part.head(ui, widgets, |ui, widgets| {
        if let Some(map) = map {
            settings(ui, map, Some(&default), "depth_map", widgets);
        }
    }) {
        Some(Change::On | Change::Reset) => *map = Some(default),
        Some(Change::Off) => *map = None,
        None => {}
    }
}

fn effect_section(
    ui: &mut Ui,
    style: &mut ComicStyle,
    effect: &'static EffectType,
    widgets: &mut Widgets,
) {
    let default = (effect.default)();
    let mut own = style.remove_by_name(effect.name);
    let mut part = Part {
        path: effect.name,
        docs: (effect.type_info)().docs().unwrap_or_default(),
        on: own.is_some(),
        edited: own
            .as_ref()
            .is_some_and(|own| !own.equals(default.as_ref())),
    };
    let change = part.head(ui, widgets, |ui, widgets| {
        if let Some(own) = &mut own {
            let default = Some(default.as_struct());
            settings(ui, own.as_struct_mut(), default, effect.name, widgets);
        }
    });
    match change {
        Some(Change::On | Change::Reset) => own = Some(default),
        Some(Change::Off) => own = None,
        None => {}
    }
    if let Some(own) = own {
        style.insert_any(own);
    }
}

/// A part of a style, with a check box.
struct Part<'a> {
    path: &'a str,
    docs: &'static str,
    on: bool,
    /// Differs from its default.
    edited: bool,
}

/// What was done to a part as a whole.
enum Change {
    On,
    Off,
    Reset,
}

impl Part<'_> {
    fn head(
        &mut self,
        ui: &mut Ui,
        widgets: &mut Widgets,
        body: impl FnOnce(&mut Ui, &mut Widgets),
    ) -> Option<Change> {
        let path = self.path;
        let id = ui.make_persistent_id(("effect", path));
        let mut state = CollapsingState::load_with_default_open(ui.ctx(), id, false);
        if !self.on {
            state.set_open(false);
        }
        let mut change = None;
        let header = state.show_header(ui, |ui| {
            let check = ui.checkbox(&mut self.on, RichText::new(label(path)).strong());
            note(widgets, path, &check);
            let check = check.on_hover_text(plain(self.docs));
            if check.changed() {
                change = Some(if self.on { Change::On } else { Change::Off });
            }
            if self.edited && reset_button(ui, &format!("{path}.reset"), widgets).clicked() {
                change = Some(Change::Reset);
            }
        });
        let (button, ..) = header.body(|ui| body(ui, widgets));
        note(widgets, format!("{path}.open"), &button);
        if matches!(change, Some(Change::On)) {
            let mut state = CollapsingState::load_with_default_open(ui.ctx(), id, true);
            state.set_open(true);
            state.store(ui.ctx());
        }
        change
    }
}

fn reset_button(ui: &mut Ui, path: &str, widgets: &mut Widgets) -> Response {
    let button = ui.small_button("↺");
    note(widgets, path, &button);
    button.on_hover_text("Back to the default")
}

/// The fields of a struct, one below the other.
fn settings(
    ui: &mut Ui,
    value: &mut dyn Struct,
    default: Option<&dyn Struct>,
    path: &str,
    widgets: &mut Widgets,
) {
    let Some(info) = value.get_represented_struct_info() else {
        return;
    };
    for (i, field) in info.iter().enumerate() {
        let path = format!("{path}.{}", field.name());
        let setting = Setting::of(field, &path);
        let default = default.and_then(|default| default.field(field.name()));
        if let Some(value) = value.field_at_mut(i) {
            edit(ui, value, default, &setting, widgets);
        }
    }
}

/// A row: the widget, its name, and the way back to the default.
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
        response.on_hover_text(plain(setting.docs));
        ui.label(&setting.label).on_hover_text(plain(setting.docs));
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
    setting: &Setting,
    widgets: &mut Widgets,
) {
    macro_rules! typed {
        ($($T:ty => $widget:expr),* $(,)?) => {
            $(if let Some(value) = value.try_downcast_mut::<$T>() {
                let default = default.and_then(|default| default.try_downcast_ref::<$T>());
                return row(ui, value, default, setting, widgets, $widget);
            })*
        };
    }
    typed! {
        f32 => |ui, value| number(ui, value, setting.range),
        u32 => |ui, value| whole_number(ui, value, setting.range),
        bool => |ui, value| ui.checkbox(value, ""),
        Color => |ui, value| color(ui, value, setting.wheel),
    }
    macro_rules! optional {
        ($($T:ty => $new:expr),* $(,)?) => {
            $(if let Some(value) = value.try_downcast_mut::<Option<$T>>() {
                let default = default.and_then(|default| default.try_downcast_ref::<Option<$T>>());
                return option(ui, value, default, $new, setting, widgets);
            })*
        };
    }
    optional! {
        // What is not a number becomes the documented default.
        f32 => f32::NAN,
        Silhouettes => Silhouettes::default(),
        Creases => Creases::default(),
        ObjectEdges => ObjectEdges::default(),
        RangeSmoothing => RangeSmoothing::default(),
    }
    modes(ui, value, default, setting, widgets);
}

/// A section that opens and closes.
pub fn section<R>(ui: &mut Ui, title: &str, contents: impl FnOnce(&mut Ui) -> R) {
    CollapsingHeader::new(title)
        .default_open(true)
        .show(ui, contents);
}

/// What an error looks like.
pub fn error(ui: &mut Ui, text: &str) -> Response {
    ui.colored_label(ui.visuals().error_fg_color, text)
}

/// A button that is noted.
pub fn button(ui: &mut Ui, widgets: &mut Widgets, name: &str, text: &str, enabled: bool) -> bool {
    let button = ui.add_enabled(enabled, egui::Button::new(text));
    note(widgets, name, &button);
    button.clicked()
}

#[cfg(test)]
mod tests;
