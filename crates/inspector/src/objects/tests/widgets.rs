//! A widget for every kind of value of a light.

use bevy::reflect::ReflectRef;

use super::*;
use bevy_comics::{
    Hatching, ToonLight, ToonMaterial,
    toon::{
        DetailAxis, ProxyShape, Ramp, RampDetail, RampStop, Rim, RimWidth, ShadingProxy,
        StylizedHighlight,
    },
};

/// A picked mesh with a light, and its material.
fn page_of(extension: ToonLight) -> (Page, Handle<ToonMaterial>) {
    let mut page = Page::new();
    let base = StandardMaterial::default();
    let material = page.add(ToonMaterial { base, extension });
    let mesh = page.world.spawn(MeshMaterial3d(material.clone())).id();
    page.pick(mesh);
    (page, material)
}

fn light(page: &Page, material: &Handle<ToonMaterial>) -> ToonLight {
    let materials = page.world.resource::<Assets<ToonMaterial>>();
    materials
        .get(material)
        .expect("a material")
        .extension
        .clone()
}

/// A light with everything that it can have.
fn full() -> ToonLight {
    ToonLight {
        ramp: Some(Ramp {
            detail: Some(RampDetail {
                plain: vec![RampStop::default(), RampStop::new(0.5, Color::WHITE)],
                axis: DetailAxis::Constant(0.5),
            }),
            ..Ramp::new([0.9, 0.0, 0.4].map(|at| RampStop::new(at, Color::srgb(0.2, at, 0.5))))
        }),
        stylized_highlight: Some(StylizedHighlight::default()),
        proxy: Some(ShadingProxy {
            shape: ProxyShape::Ellipsoid {
                center: Vec3::new(0.0, 1.0, 2.0),
                half_size: Vec3::ONE,
            },
            ..ShadingProxy::default()
        }),
        rim: Some(Rim {
            width: RimWidth::Pixels(5.0),
            ..Rim::default()
        }),
        hatching: Some(Hatching::default()),
        art_map: Some(Handle::default()),
        ..ToonLight::default()
    }
}

/// The paths of all values without parts of their own, as the panel names their widgets.
fn leaves(path: &str, value: &dyn PartialReflect, found: &mut Vec<String>) {
    let is_whole = value.try_downcast_ref::<Color>().is_some()
        || value.try_downcast_ref::<Vec2>().is_some()
        || value.try_downcast_ref::<Vec3>().is_some()
        || value.try_downcast_ref::<Option<Handle<Image>>>().is_some();
    match value.reflect_ref() {
        _ if is_whole => found.push(path.into()),
        ReflectRef::Struct(fields) => {
            for (name, field) in fields.iter_fields() {
                leaves(&format!("{path}.{name}"), field, found);
            }
        }
        ReflectRef::List(items) => {
            found.push(format!("{path}.add"));
            for (i, item) in items.iter().enumerate() {
                leaves(&format!("{path}.{i}"), item, found);
                found.push(format!("{path}.{i}.remove"));
            }
        }
        ReflectRef::Enum(variant) if value.reflect_type_path().contains("option::Option") => {
            found.push(format!("{path}.on"));
            if let Some(inner) = variant.field_at(0) {
                leaves(path, inner, found);
            }
        }
        ReflectRef::Enum(variant) => {
            found.push(path.into());
            for (i, field) in variant.iter_fields().enumerate() {
                let name = field.name().map_or_else(|| i.to_string(), Into::into);
                leaves(&format!("{path}.{name}"), field.value(), found);
            }
        }
        _ => found.push(path.into()),
    }
}

#[test]
fn every_value_of_a_light_has_a_widget_and_showing_it_changes_nothing() {
    let light_before = full();
    let (page, material) = page_of(light_before.clone());
    assert_eq!(light(&page, &material), light_before);
    assert_eq!(page.history.steps(CAMERA), (0, 0));
    let mut paths = Vec::new();
    leaves("light", &light_before, &mut paths);
    assert!(paths.len() > 60, "{} paths", paths.len());
    for path in paths {
        assert!(page.has(&path), "{path} has no widget");
    }
    assert!(page.has("light.ramp.stops.bar"));
}

fn places(light: &ToonLight) -> Vec<f32> {
    let ramp = light.ramp.as_ref().expect("a ramp");
    ramp.stops.iter().map(|stop| stop.at).collect()
}

#[test]
fn stops_are_added_removed_and_moved() {
    let (mut page, material) = page_of(full());
    let now = |page: &Page| places(&light(page, &material));
    // The widest gap is from 0.4 to 0.9.
    page.click("light.ramp.stops.add");
    assert_eq!(now(&page), [0.9, 0.0, 0.4, 0.65]);
    page.click("light.ramp.stops.1.remove");
    assert_eq!(now(&page), [0.9, 0.4, 0.65]);
    // One that is dragged past the others keeps its row, while it is dragged and after.
    page.drag("light.ramp.stops.0.at", 0.55, 0.02);
    let moved = now(&page);
    assert!(moved[0] < 0.2, "{moved:?}");
    assert_eq!(moved[1..], [0.4, 0.65]);
    assert!(page.take(Way::Undo));
    assert_eq!(now(&page), [0.9, 0.4, 0.65], "a drag is one step");
    assert!(page.take(Way::Undo));
    assert!(page.take(Way::Undo));
    assert_eq!(light(&page, &material), full());
    // At most eight, and at least one.
    for _ in 0..10 {
        page.click("light.ramp.stops.add");
    }
    assert_eq!(now(&page).len(), Ramp::MOST_STOPS);
    for _ in 0..10 {
        page.click("light.ramp.stops.0.remove");
    }
    assert_eq!(now(&page).len(), 1);
    // Back to the stops of a new ramp.
    page.click("light.ramp.stops.reset");
    let ramp = light(&page, &material).ramp.expect("a ramp");
    assert_eq!(ramp.stops, Ramp::default().stops);
    assert!(ramp.detail.is_some(), "the rest stays");
}

#[test]
fn options_come_with_their_defaults_and_come_back_with_their_last_values() {
    let (mut page, material) = page_of(ToonLight::default());
    for path in [
        "ramp",
        "stylized_highlight",
        "proxy",
        "rim",
        "hatching",
        "ramp.detail",
    ] {
        page.click(&format!("light.{path}.on"));
    }
    let on = light(&page, &material);
    let ramp = Ramp {
        detail: Some(RampDetail::default()),
        ..Ramp::default()
    };
    let wanted = ToonLight {
        ramp: Some(ramp),
        stylized_highlight: Some(StylizedHighlight::default()),
        proxy: Some(ShadingProxy::default()),
        rim: Some(Rim::default()),
        hatching: Some(Hatching::default()),
        ..ToonLight::default()
    };
    assert_eq!(on, wanted);
    page.drag("light.stylized_highlight.bar", 0.2, 0.5);
    let before = light(&page, &material);
    assert!(
        before.stylized_highlight.expect("a sign").bar > 0.4,
        "{before:?}"
    );
    page.click("light.stylized_highlight.on");
    assert_eq!(light(&page, &material).stylized_highlight, None);
    page.click("light.stylized_highlight.on");
    assert_eq!(light(&page, &material), before);
}

#[test]
fn modes_with_a_number_and_vectors_are_edited() {
    let (mut page, material) = page_of(full());
    let rim = |page: &Page| light(page, &material).rim.expect("a rim").width;
    page.drag("light.rim.width.0", 0.05, 0.4);
    let RimWidth::Pixels(wide) = rim(&page) else {
        panic!("another mode");
    };
    assert!(wide > 10.0 && wide <= 64.0, "{wide}");
    page.click("light.rim.width");
    page.click("light.rim.width.Facing");
    assert_eq!(rim(&page), RimWidth::default());
    page.click("light.rim.width");
    page.click("light.rim.width.Pixels");
    assert_eq!(rim(&page), RimWidth::Pixels(wide), "its last width");
    // A mode that was never chosen has its documented defaults.
    page.click("light.proxy.shape");
    page.click("light.proxy.shape.Cylinder");
    let form = light(&page, &material).proxy.expect("a form");
    let (center, half_size) = (Vec3::ZERO, Vec3::ONE);
    assert_eq!(form.shape, ProxyShape::Cylinder { center, half_size });
    page.click("light.ramp.detail.axis");
    page.click("light.ramp.detail.axis.Rim");
    let axis = |page: &Page| {
        let ramp = light(page, &material).ramp.expect("a ramp");
        ramp.detail.expect("a second ramp").axis
    };
    assert_eq!(axis(&page), DetailAxis::Rim { power: 1.0 });
    // The first number of a vector.
    page.drag("light.stylized_highlight.offset", 0.2, 0.8);
    let offset = light(&page, &material)
        .stylized_highlight
        .expect("a sign")
        .offset;
    assert!(
        offset.x > 0.0 && offset.x <= 8.0 && offset.y == 0.0,
        "{offset}"
    );
}

#[test]
fn images_are_shown_and_not_edited() {
    let (mut page, material) = page_of(full());
    assert!(!page.has("light.art_map.on") && !page.has("light.art_map.reset"));
    page.click("light.art_map");
    assert_eq!(light(&page, &material), full());
}
