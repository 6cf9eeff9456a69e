//! The widget of a setting that can be off: an `Option` of any type.

use bevy::reflect::{
    PartialReflect, ReflectMut, ReflectRef, TypeInfo,
    enums::{DynamicEnum, DynamicVariant},
    tuple::DynamicTuple,
};
use bevy_egui::egui::Ui;

use super::{
    super::{
        note,
        search::{Search, option_type},
    },
    Editor, Setting, as_struct, edit, explained, reset_button, settings,
};

/// A check box, and below it the settings of what is on.
pub(super) fn option(
    ui: &mut Ui,
    value: &mut dyn PartialReflect,
    default: Option<&dyn PartialReflect>,
    (setting, search): (&Setting, Option<&Search>),
    editor: &mut Editor,
) {
    let mut on = some(value).is_some();
    let on_path = format!("{}.on", setting.path);
    let mut is_new = false;
    ui.horizontal(|ui| {
        let check = ui.checkbox(&mut on, "");
        note(editor.widgets, on_path.as_str(), &check);
        if check.changed() {
            turn(value, on, default, setting.path, editor);
            is_new = on;
        }
        explained(check, setting.docs);
        explained(ui.label(&setting.label), setting.docs);
        if let Some(default) = default
            && value.reflect_partial_eq(default) == Some(false)
            && reset_button(ui, &format!("{on_path}.reset"), editor.widgets).clicked()
        {
            apply(value, default);
        }
    });
    let ReflectMut::Enum(variant) = value.reflect_mut() else {
        return;
    };
    // The numbers of a new value are not in their ranges yet, and a slider would clamp them.
    if is_new {
        return;
    }
    let Some(inner) = variant.field_at_mut(0) else {
        return;
    };
    let default = default.and_then(some);
    ui.indent(setting.path, |ui| {
        let info = inner.get_represented_type_info();
        if let ReflectMut::Struct(fields) = inner.reflect_mut() {
            let own = info.and_then(|info| editor.default_of(info));
            let default = default.or(own.as_deref().map(|own| own.as_partial_reflect()));
            let default = default.and_then(as_struct);
            settings(ui, fields, default, (setting.path, search), editor);
        } else {
            edit(ui, inner, default, (setting, search), editor);
        }
    });
}

/// The value in an option, if it has one.
fn some(value: &dyn PartialReflect) -> Option<&dyn PartialReflect> {
    match value.reflect_ref() {
        ReflectRef::Enum(variant) => variant.field_at(0),
        _ => None,
    }
}

/// Turns an option on or off: on with its last value, else with the value that
/// it has by default, else with the default of its type.
fn turn(
    value: &mut dyn PartialReflect,
    on: bool,
    default: Option<&dyn PartialReflect>,
    path: &str,
    editor: &Editor,
) {
    if !on {
        apply(value, &DynamicEnum::new("None", DynamicVariant::Unit));
    } else if let Some(last) = editor.stash.variant(path, "Some") {
        apply(value, last);
    } else if let Some(default) = default.filter(|default| some(*default).is_some()) {
        apply(value, default);
    } else if let Some(TypeInfo::Enum(info)) = value.get_represented_type_info()
        && let Some(new) = option_type(info).and_then(|info| editor.new_value(info))
    {
        let mut fields = DynamicTuple::default();
        fields.insert_boxed(new);
        apply(value, &DynamicEnum::new("Some", fields));
    }
}

/// Sets a value. One of another type changes nothing: a field of a game's effect
/// whose reflection does not allow it keeps its value.
pub(super) fn apply(value: &mut dyn PartialReflect, new: &dyn PartialReflect) {
    if let Err(error) = value.try_apply(new) {
        bevy::log::warn_once!(
            "the panel cannot set {}: {error}",
            value.reflect_type_path()
        );
    }
}
