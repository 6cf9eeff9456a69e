//! The widget of a list: its items, a button that removes each, and one that adds another.

use bevy::reflect::{PartialReflect, ReflectMut, TypeInfo};
use bevy_egui::egui::Ui;

#[cfg(feature = "toon")]
use super::ramp_bar;
use super::{
    super::note, Editor, Setting, button_with_tooltip, edit, explained, options::apply,
    reset_button, settings,
};

/// The items of a list, as many as its range allows.
pub(super) fn list(
    ui: &mut Ui,
    value: &mut dyn PartialReflect,
    default: Option<&dyn PartialReflect>,
    setting: &Setting,
    editor: &mut Editor,
) {
    let (least, most) = setting.range.map_or((0, usize::MAX), |range| {
        (range.min as usize, range.max as usize)
    });
    head(ui, value, default, (setting, most), editor);
    let ReflectMut::List(items) = value.reflect_mut() else {
        return;
    };
    let mut removed = None;
    ui.indent(setting.path, |ui| {
        for i in 0..items.len() {
            let path = format!("{}.{i}", setting.path);
            let can_be_removed = items.len() > least;
            if let Some(item) = items.get_mut(i)
                && item_row(ui, item, (i, &path), can_be_removed, editor)
            {
                removed = Some(i);
            }
        }
    });
    if let Some(i) = removed {
        items.remove(i);
    }
}

/// The name of the list, and the buttons that add an item and reset it.
fn head(
    ui: &mut Ui,
    value: &mut dyn PartialReflect,
    default: Option<&dyn PartialReflect>,
    (setting, most): (&Setting, usize),
    editor: &mut Editor,
) {
    #[cfg(feature = "toon")]
    ramp_bar::show(ui, value, setting, editor.widgets);
    ui.horizontal(|ui| {
        explained(ui.label(&setting.label), setting.docs);
        let path = format!("{}.add", setting.path);
        let count = match value.reflect_ref().as_list() {
            Ok(items) => items.len(),
            Err(_) => return,
        };
        let add = (path.as_str(), "+", "Adds another one");
        if button_with_tooltip(ui, editor.widgets, add, count < most) {
            let new = new_item(value, editor);
            if let (Some(new), ReflectMut::List(items)) = (new, value.reflect_mut()) {
                items.push(new);
            }
        }
        if let Some(default) = default
            && value.reflect_partial_eq(default) == Some(false)
            && reset_button(ui, &format!("{}.reset", setting.path), editor.widgets).clicked()
        {
            apply_list(value, default);
        }
    });
}

/// Sets a list. Applying one keeps items that the other one does not have.
fn apply_list(value: &mut dyn PartialReflect, new: &dyn PartialReflect) {
    if let ReflectMut::List(items) = value.reflect_mut() {
        while items.pop().is_some() {}
    }
    apply(value, new);
}

/// What is added to a list: a stop where a ramp has room for one, else the last item again, else
/// the default of the type.
fn new_item(list: &dyn PartialReflect, editor: &Editor) -> Option<Box<dyn PartialReflect>> {
    #[cfg(feature = "toon")]
    if let Some(stop) = ramp_bar::new_stop(list) {
        return Some(Box::new(stop));
    }
    let items = list.reflect_ref().as_list().ok()?;
    let last = items.len().checked_sub(1).and_then(|last| items.get(last));
    if let Some(last) = last {
        return last
            .reflect_clone()
            .ok()
            .map(|last| last.into_partial_reflect());
    }
    match list.get_represented_type_info()? {
        TypeInfo::List(info) => editor.new_value(info.item_info()?),
        _ => None,
    }
}

/// An item by its number and its path; whether it is to be removed.
fn item_row(
    ui: &mut Ui,
    item: &mut dyn PartialReflect,
    (i, path): (usize, &str),
    can_be_removed: bool,
    editor: &mut Editor,
) -> bool {
    let mut removed = false;
    ui.horizontal(|ui| {
        let number = ui.label(format!("{}", i + 1));
        note(editor.widgets, path, &number);
        let name = format!("{path}.remove");
        let remove = (name.as_str(), "✖", "Removes this one");
        removed = button_with_tooltip(ui, editor.widgets, remove, can_be_removed);
    });
    ui.indent(path, |ui| {
        if let ReflectMut::Struct(fields) = item.reflect_mut() {
            settings(ui, fields, None, (path, None), editor);
        } else {
            let setting = Setting {
                path,
                label: String::new(),
                docs: "",
                range: None,
                wheel: false,
            };
            edit(ui, item, None, (&setting, None), editor);
        }
    });
    removed
}
