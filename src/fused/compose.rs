//! Composes the WGSL of the fused pass from the registered effects.

use crate::effect::{EffectRegistry, EffectStage, EffectType, definition};

/// The template of the pass; lines that begin with `//@` are replaced.
const RECIPE: &str = include_str!("fused.wgsl");

/// Behind the effects that change colors: gives the objects with `NoStyle` theirs back.
const RESTORE: &str = "#ifdef UNSTYLED_COLORS
    p.color = mix(p.color, p.original, unstyled_fraction(pixel));
#endif
#ifdef MASKED_COLORS
    p.color = mix(p.original, p.color, changed_fractions(pixel).x);
#endif
";

impl EffectRegistry {
    /// The WGSL of the fused pass before preprocessing. The code of each effect is
    /// in an `#ifdef`: it runs only on cameras that have the effect.
    pub fn shader(&self) -> String {
        fused_pass(&self.types())
    }
}

/// The WGSL of the fused pass with these effects, in this order.
fn fused_pass(types: &[&EffectType]) -> String {
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
            "//@aux_scalars" => {
                let scalars = types.iter().filter(|e| e.aux_scalar);
                text.extend(scalars.map(|effect| aux_scalar(effect)));
            }
            "//@prints" => {
                let prints = types.iter().filter(|e| e.stage == EffectStage::Print);
                text.extend(prints.map(|effect| calls(effect)));
            }
            "//@calls" => {
                let later = types.iter().filter(|e| e.stage > EffectStage::Print);
                text.extend(later.map(|effect| masked_calls(effect)));
            }
            _ => {
                text.push_str(line);
                text.push('\n');
            }
        }
    }
    text
}

/// The member of `Comics` that holds an effect's settings. Its type has the full module path, so
/// that two effects may use the same struct name. The suffix `_settings` keeps the member's name
/// different from every name that the template imports: the composer would replace equal names. The
/// vector before it puts it at a multiple of 16 bytes.
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

/// The shader definition of an effect that changes only some pixels: the fraction of a pixel that it
/// changes, see `changed_fractions`.
pub(super) fn masked_by(name: &str) -> String {
    format!("MASKED_{}", definition(name))
}

/// The shader definition of the passes that draw means for an effect.
pub(super) fn boxes_of(name: &str) -> String {
    format!("BOXES_{}", definition(name))
}

/// The shader definition of the pass that draws the numbers of an effect.
pub(super) fn aux_scalar_of(name: &str) -> String {
    format!("AUX_SCALAR_OF_{}", definition(name))
}

/// The call of the function that says what the number of an effect is at a pixel.
fn aux_scalar(effect: &EffectType) -> String {
    let number = call(effect, "_aux_scalar");
    guarded(
        &aux_scalar_of(effect.name),
        &format!("    number = {number};\n"),
    )
}

/// The call of the function that says how large the boxes of an effect are.
fn boxes(effect: &EffectType) -> String {
    let half = call(effect, "_half_box");
    guarded(&boxes_of(effect.name), &format!("    half = {half};\n"))
}

fn guarded(definition: &str, code: &str) -> String {
    format!("#ifdef {definition}\n{code}#endif\n")
}

/// The call of a function of an effect, whose name ends so.
fn call(effect: &EffectType, suffix: &str) -> String {
    let (name, path) = (effect.name, effect.shader.path);
    match effect.shader.settings {
        Some(_) => format!("{path}::{name}{suffix}(comics.{name}_settings, p)"),
        None => format!("{path}::{name}{suffix}(p)"),
    }
}

/// The same as [`calls`], for an effect that may change only a fraction of the pixel.
fn masked_calls(effect: &EffectType) -> String {
    let masked = masked_by(effect.name);
    let before = guarded(&masked, "    before_effect = p;\n");
    let after = format!("    p = changed(before_effect, p, fractions[#{{{masked}}}]);\n");
    before + &calls(effect) + &guarded(&masked, &after)
}

/// The call of an effect's function, and of its debug view if it has one.
fn calls(effect: &EffectType) -> String {
    let definition = definition(effect.name);
    let (without, drawn) = (left_out(effect.name), call(effect, ""));
    let mut code = format!("#ifndef {without}\n    p = {drawn};\n#endif\n");
    if effect.view.is_some() {
        let shown = format!("    shown = {};\n", call(effect, "_view"));
        code.push_str(&guarded(&format!("VIEW_{definition}"), &shown));
    }
    guarded(&definition, &code)
}
