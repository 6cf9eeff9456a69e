//! Composes the WGSL of the fused pass from the registered effects.

use super::EffectType;

/// The recipe; lines that begin with `//@` are replaced.
const RECIPE: &str = include_str!("fused.wgsl");

/// The keys of a style file that are no effects.
const FILE_KEYS: [&str; 3] = ["version", "name", "depth_map"];

/// Definitions of the fused pass that are no effects, in lower case.
const DEFINITIONS: [&str; 18] = [
    "depth",
    "map",
    "map_flags",
    "visible_range",
    "multisampled",
    "oblique",
    "same_size",
    "normals",
    "object_ids",
    "object_styles",
    "lines",
    "lines_anywhere",
    "line_reach",
    "flood",
    "lightness_change",
    "finish",
    "stored_srgb",
    "stored_oklab",
];

/// The shader definition of an effect.
pub(super) fn definition(name: &str) -> String {
    name.to_uppercase()
}

/// Why an effect cannot join those that are registered; `None` if it can.
pub(super) fn refuses(effect: &EffectType, known: &[&EffectType]) -> Option<&'static str> {
    let name = effect.name;
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    // The shader composer reserves names that end with a digit or underscore.
    if !name.starts_with(|c: char| c.is_ascii_lowercase())
        || !name.ends_with(|c: char| c.is_ascii_lowercase())
        || !name.chars().all(plain)
    {
        Some("its name is not in snake_case, or ends with a digit")
    } else if DEFINITIONS.contains(&name) || FILE_KEYS.contains(&name) || name.starts_with("view_")
    {
        Some("its name is reserved")
    } else if known.iter().any(|other| other.name == name) {
        Some("another effect has its name")
    } else {
        None
    }
}

/// The text of the fused pass.
pub(super) fn fused_pass(types: &[&EffectType]) -> String {
    let mut text = String::from("// Composed by bevy_comics.\n");
    for line in RECIPE.lines() {
        let entries: fn(&EffectType) -> String = match line.trim() {
            "//@imports" => imports,
            "//@members" => members,
            "//@calls" => calls,
            _ => {
                text.push_str(line);
                text.push('\n');
                continue;
            }
        };
        for effect in types {
            text.push_str(&entries(effect));
        }
    }
    text
}

fn imports(effect: &EffectType) -> String {
    let name = effect.name;
    let path = effect.shader.path;
    let mut items: Vec<String> = effect.shader.settings.iter().map(ToString::to_string).collect();
    items.push(name.to_owned());
    if effect.view.is_some() {
        items.push(format!("{name}_view"));
    }
    format!("#import {path}::{{{}}}\n", items.join(", "))
}

/// The member must not be called like the function, which is imported: the
/// composer would take one for the other.
fn members(effect: &EffectType) -> String {
    let Some(settings) = effect.shader.settings else {
        return String::new();
    };
    let (name, definition) = (effect.name, definition(effect.name));
    format!("#ifdef {definition}\n    @align(16) {name}_settings: {settings},\n#endif\n")
}

fn calls(effect: &EffectType) -> String {
    let (name, definition) = (effect.name, definition(effect.name));
    let arguments = match effect.shader.settings {
        Some(_) => format!("comics.{name}_settings, p"),
        None => "p".to_owned(),
    };
    let mut call = format!("#ifdef {definition}\n    p = {name}({arguments});\n");
    if effect.view.is_some() {
        call.push_str(&format!(
            "#ifdef VIEW_{definition}\n    let shown = {name}_view({arguments});\n#endif\n"
        ));
    }
    call.push_str("#endif\n");
    call
}
