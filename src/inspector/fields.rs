//! Widgets for the settings of a style, made from what its types say about
//! themselves: names, documentation, ranges, units, defaults. A new field shows
//! up without a line here.

use bevy::{
    color::{Color, Hsva},
    reflect::{
        NamedField, PartialReflect, ReflectMut, TypeInfo, Typed,
        enums::{DynamicEnum, DynamicVariant, VariantInfo},
        structs::{DynamicStruct, Struct},
    },
};
use bevy_egui::egui::{
    self, CollapsingHeader, ComboBox, DragValue, Response, RichText, Slider, SliderClamping, Ui,
    collapsing_header::CollapsingState,
};

use super::{Widgets, hue_wheel::hue_wheel, note};
use crate::{
    BlackFlats, Colorization, ComicStyle, Contours, Creases, DepthMap, Desaturation, FieldRange,
    HueWheel, ObjectEdges, Outlines, RangeSmoothing, Silhouettes, Sketch, ToneBands,
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

/// Every effect of a style: whether it is there, and its settings.
pub fn style(ui: &mut Ui, style: &mut ComicStyle, widgets: &mut Widgets) {
    effect::<DepthMap>(ui, &mut style.depth_map, "depth_map", widgets);
    effect::<ToneBands>(ui, &mut style.tone_bands, "tone_bands", widgets);
    effect::<Desaturation>(ui, &mut style.desaturation, "desaturation", widgets);
    effect::<Colorization>(ui, &mut style.colorization, "colorization", widgets);
    effect::<BlackFlats>(ui, &mut style.black_flats, "black_flats", widgets);
    effect::<Contours>(ui, &mut style.contours, "contours", widgets);
    effect::<Outlines>(ui, &mut style.outlines, "outlines", widgets);
    effect::<Sketch>(ui, &mut style.sketch, "sketch", widgets);
}

fn effect<T>(ui: &mut Ui, effect: &mut Option<T>, path: &str, widgets: &mut Widgets)
where
    T: Struct + Typed + Default + PartialEq,
{
    let docs = T::type_info().docs().unwrap_or_default();
    let id = ui.make_persistent_id(("effect", path));
    let mut state = CollapsingState::load_with_default_open(ui.ctx(), id, false);
    if effect.is_none() {
        state.set_open(false);
    }
    let header = state.show_header(ui, |ui| {
        let mut on = effect.is_some();
        let check = ui.checkbox(&mut on, RichText::new(label(path)).strong());
        note(widgets, path, &check);
        let check = check.on_hover_text(plain(docs));
        if check.changed() {
            *effect = on.then(T::default);
        }
        if effect.as_ref().is_some_and(|e| *e != T::default()) {
            let reset = reset_button(ui, &format!("{path}.reset"), widgets);
            if reset.clicked() {
                *effect = Some(T::default());
            }
        }
        check.changed() && on
    });
    let (button, header, _) = header.body(|ui| {
        if let Some(effect) = effect {
            let default = T::default();
            settings(ui, effect, Some(&default), path, widgets);
        }
    });
    note(widgets, format!("{path}.open"), &button);
    if header.inner {
        let mut state = CollapsingState::load_with_default_open(ui.ctx(), id, true);
        state.set_open(true);
        state.store(ui.ctx());
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

/// Numbers whose range is too wide for a slider are dragged and typed.
fn is_too_wide(range: FieldRange) -> bool {
    range.logarithmic && range.min > 0.0 && range.max / range.min > 1e10
}

fn suffix(unit: &str) -> String {
    match unit {
        "" | "°" => unit.to_owned(),
        _ => format!(" {unit}"),
    }
}

fn number(ui: &mut Ui, value: &mut f32, range: Option<FieldRange>) -> Response {
    let Some(range) = range else {
        return ui.add(DragValue::new(value));
    };
    let bounds = range.min as f32..=range.max as f32;
    if is_too_wide(range) {
        let speed = (f64::from(*value) * 0.01).max(range.min);
        let drag = DragValue::new(value).range(bounds).speed(speed);
        return ui.add(drag.suffix(suffix(range.unit)));
    }
    let slider = Slider::new(value, bounds)
        .logarithmic(range.logarithmic)
        .smallest_positive(1e-6)
        .clamping(SliderClamping::Edits)
        .suffix(suffix(range.unit));
    ui.add(slider)
}

fn whole_number(ui: &mut Ui, value: &mut u32, range: Option<FieldRange>) -> Response {
    match range {
        Some(range) => ui.add(
            Slider::new(value, range.min as u32..=range.max as u32).suffix(suffix(range.unit)),
        ),
        None => ui.add(DragValue::new(value)),
    }
}

fn color(ui: &mut Ui, value: &mut Color, wheel: bool) -> Response {
    let codes = |color: Color| {
        let srgba = color.to_srgba();
        [srgba.red, srgba.green, srgba.blue].map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)
    };
    let mut rgb = codes(*value);
    ui.vertical(|ui| {
        let mut response = None;
        if wheel {
            let hsva = Hsva::from(*value);
            let mut hsv = [hsva.hue / 360.0, hsva.saturation, hsva.value];
            let turned = hue_wheel(ui, &mut hsv, 120.0);
            if turned.changed() {
                *value = Color::hsv(hsv[0] * 360.0, hsv[1], hsv[2]);
            }
            response = Some(turned);
        }
        let button = ui.color_edit_button_srgb(&mut rgb);
        if button.changed() && rgb != codes(*value) {
            *value = Color::srgb_u8(rgb[0], rgb[1], rgb[2]);
        }
        response.map_or(button.clone(), |wheel| wheel.union(button))
    })
    .inner
}

/// A check box, and below it the settings of what is checked.
fn option<T: PartialReflect + PartialEq + Clone + Typed>(
    ui: &mut Ui,
    value: &mut Option<T>,
    default: Option<&Option<T>>,
    new: T,
    setting: &Setting,
    widgets: &mut Widgets,
) {
    let on_path = format!("{}.on", setting.path);
    let checked = Setting {
        path: &on_path,
        label: setting.label.clone(),
        docs: setting.docs,
        range: None,
        wheel: false,
    };
    row(ui, value, default, &checked, widgets, |ui, value| {
        let mut on = value.is_some();
        let response = ui.checkbox(&mut on, "");
        if response.changed() {
            *value = on.then(|| new.clone());
        }
        response
    });
    let Some(inner) = value else {
        return;
    };
    ui.indent(setting.path, |ui| {
        let default = default.and_then(Option::as_ref);
        if let TypeInfo::Struct(_) = T::type_info()
            && let ReflectMut::Struct(fields) = inner.reflect_mut()
        {
            let whole_default = new;
            let default = default.unwrap_or(&whole_default);
            let default = default.reflect_ref().as_struct().ok();
            settings(ui, fields, default, setting.path, widgets);
        } else {
            let default = default.map(PartialReflect::as_partial_reflect);
            edit(
                ui,
                inner.as_partial_reflect_mut(),
                default,
                setting,
                widgets,
            );
        }
    });
}

/// A box of modes, and below it the settings of the chosen one.
fn modes(
    ui: &mut Ui,
    value: &mut dyn PartialReflect,
    default: Option<&dyn PartialReflect>,
    setting: &Setting,
    widgets: &mut Widgets,
) {
    let Some(TypeInfo::Enum(info)) = value.get_represented_type_info() else {
        ui.label(format!("{}: no widget for this type", setting.label));
        return;
    };
    let ReflectMut::Enum(current) = value.reflect_mut() else {
        return;
    };
    let mut chosen = current.variant_index();
    let before = chosen;
    ui.horizontal(|ui| {
        let docs_of = |variant: &VariantInfo| plain(variant.docs().unwrap_or_default());
        let combo = ComboBox::from_id_salt(setting.path)
            .selected_text(label_of_mode(current.variant_name()))
            .show_ui(ui, |ui| {
                for (i, variant) in info.iter().enumerate() {
                    let item = ui.selectable_value(&mut chosen, i, label_of_mode(variant.name()));
                    note(
                        widgets,
                        format!("{}.{}", setting.path, variant.name()),
                        &item,
                    );
                    item.on_hover_text(docs_of(variant));
                }
            });
        note(widgets, setting.path, &combo.response);
        combo.response.on_hover_text(plain(setting.docs));
        ui.label(&setting.label).on_hover_text(plain(setting.docs));
        if let Some(default) = default
            && current.reflect_partial_eq(default) == Some(false)
            && reset_button(ui, &format!("{}.reset", setting.path), widgets).clicked()
        {
            current.apply(default);
            chosen = before;
        }
    });
    if chosen != before
        && let Some(variant) = info.variant_at(chosen)
    {
        let fields = match variant {
            VariantInfo::Struct(variant) => {
                let mut fields = DynamicStruct::default();
                for field in variant.iter() {
                    // What is not a number becomes the documented default.
                    fields.insert(field.name(), f32::NAN);
                }
                DynamicVariant::Struct(fields)
            }
            _ => DynamicVariant::Unit,
        };
        current.apply(&DynamicEnum::new(variant.name(), fields));
    }
    let index = current.variant_index();
    if let Some(VariantInfo::Struct(variant)) = info.variant_at(index) {
        ui.indent(setting.path, |ui| {
            for (i, field) in variant.iter().enumerate() {
                let path = format!("{}.{}", setting.path, field.name());
                let setting = Setting::of(field, &path);
                if let Some(value) = current.field_at_mut(i) {
                    edit(ui, value, None, &setting, widgets);
                }
            }
        });
    }
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
