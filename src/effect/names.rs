//! Names of effects: which are free.

use naga_oil::compose::get_preprocessor_data;

use super::EffectType;

/// The keys of a style file that do not name an effect.
pub(crate) const FILE_KEYS: [&str; 7] = [
    "version",
    "name",
    "partial",
    "depth_map",
    "page",
    "camera",
    "scene",
];

/// The modules of this crate that an effect may import.
const MODULES: [&str; 24] = [
    "bevy_comics::depth::map",
    "bevy_comics::depth::normal",
    "bevy_comics::depth::raw",
    "bevy_comics::depth::view",
    "bevy_comics::depth::window",
    "bevy_comics::effect::blue_noise",
    "bevy_comics::effect::color",
    "bevy_comics::effect::footprint",
    "bevy_comics::effect::box_statistics",
    "bevy_comics::effect::nested",
    "bevy_comics::effect::noise",
    "bevy_comics::effect::aux_scalar",
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
    "bevy_comics::tones",
];

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
    } else if FILE_KEYS.contains(&name) {
        Some("its name is a key of style files")
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
