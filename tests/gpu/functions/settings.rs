//! The settings of an effect as WGSL text, from the bytes of its uniform.

use bevy::math::UVec4;

use crate::prelude::*;

/// A view of this size in physical pixels, at a scale factor, `seconds` after the start.
pub fn view(size: [u32; 2], scale_factor: f32, seconds: f64) -> EffectContext {
    let mut facts = EffectContext::default();
    facts.viewport = UVec4::new(0, 0, size[0], size[1]);
    facts.scale_factor = scale_factor;
    facts.seconds = seconds;
    facts
}

/// A WGSL expression of the struct `name`. `fields`: the type of each field, one of `vec3`,
/// `vec2`, `f32`, `i32` and `u32`.
pub fn expression(
    name: &str,
    fields: &[&str],
    effect: &dyn AnyEffect,
    view: &EffectContext,
) -> String {
    let bytes = effect.uniform_bytes(view);
    let word = |at: usize| bytes[at..at + 4].try_into().expect("four bytes");
    let float = |at| format!("{:?}", f32::from_le_bytes(word(at)));
    let mut at = 0usize;
    let mut values = Vec::new();
    for field in fields {
        let (align, size, value): (usize, usize, fn(Vec<String>) -> String) = match *field {
            "vec3" => (16, 3, |v| format!("vec3<f32>({})", v.join(", "))),
            "vec2" => (8, 2, |v| format!("vec2<f32>({})", v.join(", "))),
            _ => (4, 1, |v| v[0].clone()),
        };
        at = at.next_multiple_of(align);
        let parts = (0..size).map(|i| match *field {
            "i32" => format!("{}i", i32::from_le_bytes(word(at))),
            "u32" => format!("{}u", u32::from_le_bytes(word(at))),
            _ => float(at + 4 * i),
        });
        values.push(value(parts.collect()));
        at += 4 * size;
    }
    assert!(
        bytes.len() < at + 16,
        "the uniform of {name} has more fields"
    );
    format!("{name}({})", values.join(", "))
}
