//! The widgets of single values: numbers, colors and modes.

use bevy::{
    color::{Color, Hsva},
    reflect::{
        PartialReflect, ReflectMut, TypeInfo,
        enums::{DynamicEnum, DynamicVariant, Enum, EnumInfo, VariantInfo},
        structs::DynamicStruct,
        tuple::DynamicTuple,
    },
};
use bevy_egui::egui::{ComboBox, DragValue, Response, Slider, SliderClamping, Ui};

use super::{
    super::{Widgets, hue_wheel::hue_wheel, note},
    Editor, Setting, edit, explained, label_of_mode,
    options::apply,
    reset_button,
};
use bevy_comics::effect::FieldRange;

/// Whether a range is too wide for a slider; such a number is dragged or typed.
fn is_too_wide(range: FieldRange) -> bool {
    range.logarithmic && range.min > 0.0 && range.max / range.min > 1e10
}

pub(super) fn suffix(unit: &str) -> String {
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

/// A box of modes, and below it the settings of the chosen one.
pub(super) fn modes(
    ui: &mut Ui,
    value: &mut dyn PartialReflect,
    info: &'static EnumInfo,
    default: Option<&dyn PartialReflect>,
    setting: &Setting,
    editor: &mut Editor,
) {
    let ReflectMut::Enum(current) = value.reflect_mut() else {
        return;
    };
    let before = current.variant_index();
    let chosen = mode_box(ui, current, info, default, setting, editor.widgets);
    if let Some(variant) = info.variant_at(chosen).filter(|_| chosen != before) {
        choose_mode(
            current.as_partial_reflect_mut(),
            variant,
            setting.path,
            editor,
        );
        // Its numbers are not in their ranges yet, and a slider would clamp them.
        return;
    }
    mode_settings(ui, current, info, setting, editor);
}

/// The box of modes in its row; the index of the chosen mode.
fn mode_box(
    ui: &mut Ui,
    current: &mut dyn Enum,
    info: &'static EnumInfo,
    default: Option<&dyn PartialReflect>,
    setting: &Setting,
    widgets: &mut Widgets,
) -> usize {
    let mut chosen = current.variant_index();
    ui.horizontal(|ui| {
        let combo = ComboBox::from_id_salt(setting.path)
            .selected_text(label_of_mode(current.variant_name()))
            .show_ui(ui, |ui| {
                for (i, variant) in info.iter().enumerate() {
                    let item = ui.selectable_value(&mut chosen, i, label_of_mode(variant.name()));
                    let name = format!("{}.{}", setting.path, variant.name());
                    note(widgets, name, &item);
                    explained(item, variant.docs().unwrap_or_default());
                }
            });
        note(widgets, setting.path, &combo.response);
        explained(combo.response, setting.docs);
        explained(ui.label(&setting.label), setting.docs);
        if let Some(default) = default
            && current.reflect_partial_eq(default) == Some(false)
            && reset_button(ui, &format!("{}.reset", setting.path), widgets).clicked()
        {
            apply(current.as_partial_reflect_mut(), default);
            chosen = current.variant_index();
        }
    });
    chosen
}

/// Changes the mode: to the settings that it had last, else to its defaults. A
/// mode with a value that has no default is not chosen.
fn choose_mode(
    current: &mut dyn PartialReflect,
    variant: &'static VariantInfo,
    path: &str,
    editor: &Editor,
) {
    if let Some(last) = editor.stash.variant(path, variant.name()) {
        apply(current, last);
        return;
    }
    let new = |info: Option<&'static TypeInfo>| editor.new_value(info?);
    let fields = match variant {
        VariantInfo::Unit(_) => Some(DynamicVariant::Unit),
        VariantInfo::Struct(variant) => variant
            .iter()
            .try_fold(DynamicStruct::default(), |mut fields, field| {
                fields.insert_boxed(field.name(), new(field.type_info())?);
                Some(fields)
            })
            .map(DynamicVariant::Struct),
        VariantInfo::Tuple(variant) => variant
            .iter()
            .try_fold(DynamicTuple::default(), |mut fields, field| {
                fields.insert_boxed(new(field.type_info())?);
                Some(fields)
            })
            .map(DynamicVariant::Tuple),
    };
    if let Some(fields) = fields {
        apply(current, &DynamicEnum::new(variant.name(), fields));
    }
}

/// The settings of the current mode.
fn mode_settings(
    ui: &mut Ui,
    current: &mut dyn Enum,
    info: &'static EnumInfo,
    setting: &Setting,
    editor: &mut Editor,
) {
    let index = current.variant_index();
    let mut field = |ui: &mut Ui, i: usize, setting: &Setting| {
        if let Some(value) = current.field_at_mut(i) {
            edit(ui, value, None, (setting, None), editor);
        }
    };
    match info.variant_at(index) {
        Some(VariantInfo::Struct(variant)) => {
            ui.indent(setting.path, |ui| {
                for (i, named) in variant.iter().enumerate() {
                    let path = format!("{}.{}", setting.path, named.name());
                    field(ui, i, &Setting::of(named, &path));
                }
            });
        }
        Some(VariantInfo::Tuple(variant)) => {
            ui.indent(setting.path, |ui| {
                let count = variant.field_len();
                for (i, unnamed) in variant.iter().enumerate() {
                    let path = format!("{}.{i}", setting.path);
                    let setting = Setting::of_mode(unnamed, variant.name(), count, &path);
                    field(ui, i, &setting);
                }
            });
        }
        Some(VariantInfo::Unit(_)) | None => {}
    }
}
