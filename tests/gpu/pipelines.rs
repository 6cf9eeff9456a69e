//! Dragging a slider compiles pipelines only where `docs/performance.md` says so.

use bevy::{
    reflect::{PartialReflect, ReflectMut, ReflectRef, structs::Struct},
    render::render_resource::{PipelineCache, PipelineDescriptor},
};
use bevy_comics::effect::FieldRange;

use crate::prelude::*;

/// A number of an effect: the names of the fields that lead to it, and its range.
struct Slider {
    path: Vec<&'static str>,
    range: FieldRange,
}

fn sliders_of(value: &dyn Struct, path: &[&'static str], found: &mut Vec<Slider>) {
    let Some(TypeInfo::Struct(info)) = value.get_represented_type_info() else {
        return;
    };
    for field in info.iter() {
        let mut path = path.to_vec();
        path.push(field.name());
        if let Some(range) = FieldRange::of(field) {
            found.push(Slider { path, range });
        } else if let Some(inner) = value.field(field.name()).and_then(present) {
            sliders_of(inner, &path, found);
        }
    }
}

/// The struct inside an `Option` that holds one.
fn present(value: &dyn PartialReflect) -> Option<&dyn Struct> {
    let ReflectRef::Enum(option) = value.reflect_ref() else {
        return None;
    };
    option.field_at(0)?.reflect_ref().as_struct().ok()
}

/// Sets a number of an effect; false if the path leads to none.
fn set(value: &mut dyn Struct, path: &[&str], number: f64) -> bool {
    let Some(field) = value.field_mut(path[0]) else {
        return false;
    };
    if path.len() > 1 {
        let ReflectMut::Enum(option) = field.reflect_mut() else {
            return false;
        };
        let inner = option.field_at_mut(0);
        return inner
            .and_then(|inner| inner.reflect_mut().as_struct().ok())
            .is_some_and(|inner| set(inner, &path[1..], number));
    }
    if let Some(slot) = field.try_downcast_mut::<f32>() {
        *slot = number as f32;
    } else if let Some(slot) = field.try_downcast_mut::<Option<f32>>() {
        *slot = Some(number as f32);
    } else if let Some(slot) = field.try_downcast_mut::<Vec2>() {
        *slot = Vec2::splat(number as f32);
    } else if let Some(slot) = field.try_downcast_mut::<u32>() {
        *slot = number as u32;
    } else {
        return false;
    }
    true
}

fn at(range: FieldRange, t: f64) -> f64 {
    if range.logarithmic && range.min > 0.0 {
        range.min * (range.max / range.min).powf(t)
    } else {
        range.min + (range.max - range.min) * t
    }
}

/// This crate's pipelines, but for the one that counts ids: some frames later, whatever is dragged.
fn pipelines(small: &Small) -> usize {
    let world = small.headless.app.sub_app(RenderApp).world();
    world
        .resource::<PipelineCache>()
        .pipelines()
        .filter(|pipeline| {
            let label = match &pipeline.descriptor {
                PipelineDescriptor::RenderPipelineDescriptor(d) => d.label.as_deref(),
                PipelineDescriptor::ComputePipelineDescriptor(d) => d.label.as_deref(),
            };
            label.is_some_and(|label| label.starts_with("comics_") && label != "comics_count_ids")
        })
        .count()
}

fn put(small: &mut Small, effect: &dyn AnyEffect) {
    let camera = small.camera;
    effect.insert_into(&mut small.world().entity_mut(camera));
    small.headless.step(1);
}

/// Pipelines that a slider may compile from one end to the other, as
/// `docs/performance.md` lists them. Other sliders compile none.
fn documented(slider: &str) -> usize {
    let page = include_str!("../../docs/performance.md");
    let row = page
        .lines()
        .find(|line| line.starts_with(&format!("| `{slider}` |")));
    let Some(row) = row else {
        return 0;
    };
    let most = row.split('|').nth(2).expect("a second column").trim();
    most.parse().expect("a number of pipelines")
}

/// Drags every slider over so many values, or only those of some effects. Gives the number of
/// sliders.
fn drag(steps: usize, is_dragged: impl Fn(&str) -> bool) -> usize {
    let mut small = Small::alone(options(UVec2::new(16, 12)), Msaa::Off);
    let mut seen = 0;
    let mut too_many = Vec::new();
    for effect in EffectRegistry::built_in().types() {
        if !is_dragged(effect.name) {
            continue;
        }
        let mut sliders = Vec::new();
        sliders_of((effect.default)().as_struct(), &[], &mut sliders);
        put(&mut small, (effect.default)().as_ref());
        // The first frame asks for prepasses.
        small.headless.step(1);
        for slider in sliders {
            let name = format!("{}.{}", effect.name, slider.path.join("."));
            let before = pipelines(&small);
            for step in 0..steps {
                let mut value = (effect.default)();
                let number = at(slider.range, step as f64 / (steps - 1) as f64);
                assert!(set(value.as_struct_mut(), &slider.path, number), "{name}");
                put(&mut small, value.as_ref());
            }
            put(&mut small, (effect.default)().as_ref());
            let compiled = pipelines(&small) - before;
            let documented = documented(&name);
            if compiled > documented {
                too_many.push(format!(
                    "{name}: {compiled} pipelines, {documented} documented"
                ));
            }
            seen += 1;
        }
        let camera = small.camera;
        let mut style = ComicStyle::new();
        style.depth_map = None;
        style.apply(&mut small.world().commands().entity(camera));
        small.world().flush();
        small.headless.step(2);
    }
    assert!(too_many.is_empty(), "{too_many:#?}");
    seen
}

/// Ends and middles of the sliders that compile most and least.
#[test]
fn a_dragged_slider_compiles_what_the_documentation_says() {
    let seen = drag(3, |effect| {
        ["contours", "paper", "tone_bands"].contains(&effect)
    });
    assert!(seen > 10, "only {seen} sliders were found");
}

#[test]
#[ignore = "long: every slider of every effect, in 13 steps"]
fn every_dragged_slider_compiles_what_the_documentation_says() {
    let seen = drag(13, |_| true);
    assert!(seen > 30, "only {seen} sliders were found");
}
