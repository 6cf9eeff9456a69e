//! The sections of a style: the depth map and the effects, each of which is on or
//! off as a whole.

use bevy::reflect::{TypeInfo, Typed, structs::Struct};
use bevy_egui::egui::{RichText, Ui, collapsing_header::CollapsingState};

use super::{
    super::{
        note,
        search::{Found, Search},
    },
    Editor, explained, label, reset_button, settings,
};
use bevy_comics::{ComicStyle, DepthMap, effect::EffectType};

/// The depth map and every registered effect: whether it is on, and its
/// settings. A search leaves out what it does not find.
pub fn style(
    ui: &mut Ui,
    style: &mut ComicStyle,
    effects: &[&'static EffectType],
    search: Option<&Search>,
    editor: &mut Editor,
) {
    let mut found = false;
    if let Some(shown) = shown("depth_map", DepthMap::type_info(), search) {
        found = true;
        depth_map(ui, &mut style.depth_map, shown, editor);
    }
    for effect in effects {
        if let Some(shown) = shown(effect.name, (effect.type_info)(), search) {
            found = true;
            effect_section(ui, style, effect, shown, editor);
        }
    }
    if !found {
        ui.label("No setting has these words in its name or description.");
    }
}

/// How a section is shown.
#[derive(Clone, Copy)]
struct Shown<'a> {
    /// Whether a search is on, which opens every section that it finds.
    is_searched: bool,
    /// Leaves out settings of the section.
    search: Option<&'a Search>,
}

/// How a section is shown; `None` if a search does not find it.
fn shown<'a>(name: &str, info: &TypeInfo, search: Option<&'a Search>) -> Option<Shown<'a>> {
    let Some(search) = search else {
        return Some(Shown {
            is_searched: false,
            search: None,
        });
    };
    let found = search.section(name, info)?;
    Some(Shown {
        is_searched: true,
        search: (found == Found::Inside).then_some(search),
    })
}

fn depth_map(ui: &mut Ui, map: &mut Option<DepthMap>, shown: Shown, editor: &mut Editor) {
    let last = editor.stash.depth_map();
    whole(ui, map, last, ("depth_map", shown), editor);
}

/// A section of settings that are there or not, such as a component. `last`: those that come back
/// when it is turned on; `None` for the defaults.
#[cfg(feature = "objects")]
pub fn optional<T: Struct + Typed + Default + Clone + PartialEq>(
    ui: &mut Ui,
    value: &mut Option<T>,
    last: Option<T>,
    path: &'static str,
    editor: &mut Editor,
) {
    let shown = Shown {
        is_searched: false,
        search: None,
    };
    whole(ui, value, last, (path, shown), editor);
}

/// As [`optional`], in a search.
fn whole<T: Struct + Typed + Default + Clone + PartialEq>(
    ui: &mut Ui,
    value: &mut Option<T>,
    last: Option<T>,
    (path, shown): (&'static str, Shown),
    editor: &mut Editor,
) {
    let default = T::default();
    let last = last.unwrap_or_else(|| default.clone());
    let mut part = Part {
        path,
        docs: T::type_info().docs().unwrap_or_default(),
        on: value.is_some(),
        edited: value.as_ref().is_some_and(|value| *value != default),
        is_searched: shown.is_searched,
    };
    // The settings that it would have are shown while it is off, but not edited.
    let mut edited = value.clone().unwrap_or_else(|| last.clone());
    let change = part.head(ui, editor, |ui, editor| {
        let path = (path, shown.search);
        settings(ui, &mut edited, Some(&default), path, editor);
    });
    match change {
        Some(Change::On) => *value = Some(last),
        Some(Change::Reset) => *value = Some(default),
        Some(Change::Off) => *value = None,
        None if value.is_some() => *value = Some(edited),
        None => {}
    }
}

fn effect_section(
    ui: &mut Ui,
    style: &mut ComicStyle,
    effect: &'static EffectType,
    shown: Shown,
    editor: &mut Editor,
) {
    let default = (effect.default)();
    let own = style.remove_by_name(effect.name);
    let mut part = Part {
        path: effect.name,
        docs: (effect.type_info)().docs().unwrap_or_default(),
        on: own.is_some(),
        edited: own
            .as_ref()
            .is_some_and(|own| !own.equals(default.as_ref())),
        is_searched: shown.is_searched,
    };
    let was_on = part.on;
    let last = || editor.stash.effect(effect.name);
    let mut edited = own.or_else(last).unwrap_or_else(|| default.clone());
    let change = part.head(ui, editor, |ui, editor| {
        let default = Some(default.as_struct());
        settings(
            ui,
            edited.as_struct_mut(),
            default,
            (effect.name, shown.search),
            editor,
        );
    });
    match change {
        // The settings of an effect that is off are its last ones.
        Some(Change::On) => style.insert_any(edited),
        Some(Change::Reset) => style.insert_any(default),
        Some(Change::Off) => {}
        None if was_on => style.insert_any(edited),
        None => {}
    }
}

/// A part of a style that is turned on and off as a whole.
struct Part<'a> {
    path: &'a str,
    docs: &'static str,
    on: bool,
    /// Differs from its default.
    edited: bool,
    /// Whether a search is on.
    is_searched: bool,
}

/// A change of a part as a whole.
enum Change {
    On,
    Off,
    Reset,
}

impl Part<'_> {
    fn head(
        &mut self,
        ui: &mut Ui,
        editor: &mut Editor,
        body: impl FnOnce(&mut Ui, &mut Editor),
    ) -> Option<Change> {
        let path = self.path;
        // A search has its own states, so that afterwards the sections are as
        // they were before.
        let id = if self.is_searched {
            ui.make_persistent_id(("found effect", path))
        } else {
            ui.make_persistent_id(("effect", path))
        };
        let mut state = CollapsingState::load_with_default_open(ui.ctx(), id, self.is_searched);
        if !self.on && !self.is_searched {
            state.set_open(false);
        }
        let was_on = self.on;
        let mut change = None;
        let header = state.show_header(ui, |ui| {
            let check = ui.checkbox(&mut self.on, RichText::new(label(path)).strong());
            note(editor.widgets, path, &check);
            let check = explained(check, self.docs);
            if check.changed() {
                change = Some(if self.on { Change::On } else { Change::Off });
            }
            if self.edited && reset_button(ui, &format!("{path}.reset"), editor.widgets).clicked() {
                change = Some(Change::Reset);
            }
        });
        let (button, ..) = header.body(|ui| {
            ui.add_enabled_ui(was_on, |ui| body(ui, editor));
        });
        note(editor.widgets, format!("{path}.open"), &button);
        if matches!(change, Some(Change::On)) {
            let mut state = CollapsingState::load_with_default_open(ui.ctx(), id, true);
            state.set_open(true);
            state.store(ui.ctx());
        }
        change
    }
}
