//! The widgets of the single values: numbers, colours, options, modes.

use bevy::{
    color::{Color, Hsva},
    reflect::{
        PartialReflect, ReflectMut, TypeInfo, Typed,
        enums::{DynamicEnum, DynamicVariant, Enum, EnumInfo, VariantInfo},
        structs::DynamicStruct,
    },
};
use bevy_egui::egui::{ComboBox, DragValue, Response, Slider, SliderClamping, Ui};

use super::{
    super::{Widgets, hue_wheel::hue_wheel, note},
    Setting, edit, label_of_mode, plain, reset_button, row, settings,
};
use crate::FieldRange;

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

pub(super) fn number(ui: &mut Ui, value: &mut f32, range: Option<FieldRange>) -> Response {
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

pub(super) fn whole_number(ui: &mut Ui, value: &mut u32, range: Option<FieldRange>) -> Response {
    match range {
        Some(range) => ui.add(
            Slider::new(value, range.min as u32..=range.max as u32).suffix(suffix(range.unit)),
        ),
        None => ui.add(DragValue::new(value)),
    }
}

pub(super) fn color(ui: &mut Ui, value: &mut Color, wheel: bool) -> Response {
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
pub(super) fn option<T: PartialReflect + PartialEq + Clone + Typed>(
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
pub(super) fn modes(
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
    if let Some(variant) = mode_box(ui, current, info, default, setting, widgets) {
        choose_mode(current, variant);
    }
    mode_settings(ui, current, info, setting, widgets);
}

/// The box of modes in its row; gives the mode that was chosen anew.
fn mode_box(
    ui: &mut Ui,
    current: &mut dyn Enum,
    info: &'static EnumInfo,
    default: Option<&dyn PartialReflect>,
    setting: &Setting,
    widgets: &mut Widgets,
) -> Option<&'static VariantInfo> {
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
    info.variant_at(chosen).filter(|_| chosen != before)
}

/// Puts a mode with its documented defaults in the place of the current one.
fn choose_mode(current: &mut dyn Enum, variant: &'static VariantInfo) {
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

/// The settings of the current mode.
fn mode_settings(
    ui: &mut Ui,
    current: &mut dyn Enum,
    info: &'static EnumInfo,
    setting: &Setting,
    widgets: &mut Widgets,
) {
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
