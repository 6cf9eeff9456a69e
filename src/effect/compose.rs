//! Composes the WGSL of the fused pass from the registered effects.

use naga_oil::compose::get_preprocessor_data;

use super::{EffectStage, EffectType};

/// The template of the pass; lines that begin with `//@` are replaced.
const RECIPE: &str = include_str!("fused.wgsl");

/// The keys of a style file that do not name an effect.
pub(crate) const FILE_KEYS: [&str; 4] = ["version", "name", "partial", "depth_map"];

/// The modules of this crate that an effect may import.
const MODULES: [&str; 23] = [
    "bevy_comics::depth::map",
    "bevy_comics::depth::normal",
    "bevy_comics::depth::raw",
    "bevy_comics::depth::view",
    "bevy_comics::depth::window",
    "bevy_comics::effect::blue_noise",
    "bevy_comics::effect::color",
    "bevy_comics::effect::footprint",
    "bevy_comics::effect::means",
    "bevy_comics::effect::nested",
    "bevy_comics::effect::noise",
    "bevy_comics::effect::numbered",
    "bevy_comics::effect::picture",
    "bevy_comics::effect::pixel",
    "bevy_comics::effect::screen",
    "bevy_comics::effect::sheet",
    "bevy_comics::effect::similarity",
    "bevy_comics::effect::stipple",
    "bevy_comics::effect::strokes",
    "bevy_comics::lines::edge",
    "bevy_comics::lines::read",
    "bevy_comics::lines::surface",
    "bevy_comics::objects",
];

/// Shader definitions of the fused pass that do not name an effect, in lower case.
const DEFINITIONS: [&str; 38] = [
    "depth",
    "depth_borders",
    "map",
    "map_flags",
    "visible_range",
    "multisampled",
    "samples",
    "oblique",
    "same_size",
    "normals",
    "object_ids",
    "object_styles",
    "object_anchors",
    "object_depths",
    "lines",
    "lines_anywhere",
    "line_owners",
    "surface_lines",
    "plane_ink",
    "in_planes",
    "lightness_change",
    "blue_noise",
    "finish",
    "overlay",
    "stored_srgb",
    "stored_oklab",
    "unstyled",
    "unstyled_colors",
    "unstyled_print",
    "continued",
    "layer",
    "means",
    "draws_means",
    "means_down",
    "box_reach",
    "numbered",
    "draws_numbers",
    "inside",
];

/// The shader definition of the effect with this name.
pub(super) fn definition(name: &str) -> String {
    name.to_uppercase()
}

/// Why an effect cannot be registered beside the `known` ones; `None` if it can.
pub(super) fn refuses(effect: &EffectType, known: &[&EffectType]) -> Option<&'static str> {
    let name = effect.name;
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    // The shader composer reserves names that end with a digit or underscore.
    if !name.starts_with(|c: char| c.is_ascii_lowercase())
        || !name.ends_with(|c: char| c.is_ascii_lowercase())
        || !name.chars().all(plain)
    {
        Some("its name is not in snake_case, or ends with a digit or an underscore")
    } else if DEFINITIONS.contains(&name)
        || FILE_KEYS.contains(&name)
        || ["view_", "without_", "boxes_", "numbers_", "reaches_"]
            .iter()
            .any(|prefix| name.starts_with(prefix))
    {
        Some("its name is reserved")
    } else if !defines(effect.shader.source, effect.shader.path) {
        Some("its WGSL does not define the import path in SHADER.path")
    } else if MODULES.contains(&effect.shader.path)
        || known
            .iter()
            .any(|other| other.shader.path == effect.shader.path)
    {
        Some("another module has the same import path")
    } else if imports_unknown(effect, known) {
        Some("its WGSL imports a module of bevy_comics that does not exist")
    } else if known.iter().any(|other| other.name == name) {
        Some("another effect has the same name")
    } else {
        None
    }
}

/// Whether a module defines this import path.
fn defines(source: &str, path: &str) -> bool {
    get_preprocessor_data(source).0.as_deref() == Some(path)
}

/// Whether an effect imports a module of this crate that does not exist. The
/// engine waits for all imports of a shader, so such an effect would keep the
/// fused pass of every camera from compiling.
fn imports_unknown(effect: &EffectType, known: &[&EffectType]) -> bool {
    let (_, imports, _) = get_preprocessor_data(effect.shader.source);
    imports.iter().any(|import| {
        let path = import.import.as_str();
        path.starts_with("bevy_comics::")
            && !MODULES.contains(&path)
            && !known.iter().any(|other| other.shader.path == path)
    })
}

/// Behind the effects that change colours: gives the objects with `NoStyle` theirs back.
const RESTORE: &str = "#ifdef UNSTYLED_COLORS
    p.color = mix(p.color, p.original, unstyled_fraction(pixel));
#endif
";

/// The WGSL of the fused pass with these effects, in this order.
pub(super) fn fused_pass(types: &[&EffectType]) -> String {
    let colors = |effect: &&&EffectType| effect.stage <= EffectStage::Color;
    let mut text = String::from("// Composed by bevy_comics.\n");
    for line in RECIPE.lines() {
        match line.trim() {
            "//@members" => text.extend(types.iter().map(|effect| members(effect))),
            "//@colors" => {
                text.extend(types.iter().filter(colors).map(|effect| calls(effect)));
                text.push_str(RESTORE);
            }
            "//@boxes" => text.extend(types.iter().filter(|e| e.half_box).map(|e| boxes(e))),
            "//@numbers" => text.extend(types.iter().filter(|e| e.number).map(|e| numbers(e))),
            "//@prints" => {
                let prints = types.iter().filter(|e| e.stage == EffectStage::Print);
                text.extend(prints.map(|effect| calls(effect)));
            }
            "//@calls" => {
                let later = types.iter().filter(|e| e.stage > EffectStage::Print);
                text.extend(later.map(|effect| calls(effect)));
            }
            _ => {
                text.push_str(line);
                text.push('\n');
            }
        }
    }
    text
}

/// The member of `Comics` that holds an effect's settings. Its type has the full
/// module path, so that two effects may use the same struct name. The suffix
/// `_settings` keeps the member's name different from every name that the template
/// imports: the composer would replace equal names. The vector before it puts it at a multiple of 16 bytes.
fn members(effect: &EffectType) -> String {
    let Some(settings) = effect.shader.settings else {
        return String::new();
    };
    let (name, definition) = (effect.name, definition(effect.name));
    let path = effect.shader.path;
    format!(
        "#ifdef {definition}\n    {name}_before: vec4<u32>,\n    {name}_settings: {path}::{settings},\n\
         #endif\n"
    )
}

/// The shader definition that leaves out an effect, with the settings kept in the uniform.
pub(super) fn left_out(name: &str) -> String {
    format!("WITHOUT_{}", definition(name))
}

/// The shader definition of the passes that draw means for an effect.
pub(super) fn boxes_of(name: &str) -> String {
    format!("BOXES_{}", definition(name))
}

/// The shader definition of the pass that draws numbers for an effect.
pub(super) fn numbers_of(name: &str) -> String {
    format!("NUMBERS_{}", definition(name))
}

/// The call of the function that says what the numbers of an effect are.
fn numbers(effect: &EffectType) -> String {
    let (name, definition) = (effect.name, numbers_of(effect.name));
    let path = effect.shader.path;
    let arguments = arguments(effect);
    format!("#ifdef {definition}\n    number = {path}::{name}_number({arguments});\n#endif\n")
}

/// The call of the function that says how large the boxes of an effect are.
fn boxes(effect: &EffectType) -> String {
    let (name, definition) = (effect.name, boxes_of(effect.name));
    let path = effect.shader.path;
    let arguments = arguments(effect);
    format!("#ifdef {definition}\n    half = {path}::{name}_half_box({arguments});\n#endif\n")
}

/// The arguments of an effect's functions.
fn arguments(effect: &EffectType) -> String {
    match effect.shader.settings {
        Some(_) => format!("comics.{}_settings, p", effect.name),
        None => "p".to_owned(),
    }
}

/// The call of an effect's function, and of its debug view if it has one.
fn calls(effect: &EffectType) -> String {
    let (name, definition) = (effect.name, definition(effect.name));
    let path = effect.shader.path;
    let arguments = arguments(effect);
    let without = left_out(name);
    let mut call = format!(
        "#ifdef {definition}\n#ifndef {without}\n    p = {path}::{name}({arguments});\n#endif\n"
    );
    if effect.view.is_some() {
        call.push_str(&format!(
            "#ifdef VIEW_{definition}\n    shown = {path}::{name}_view({arguments});\n#endif\n"
        ));
    }
    call.push_str("#endif\n");
    call
}
