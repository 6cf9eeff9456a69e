//! What the widgets are made of is there, and looking changes nothing.

use bevy::reflect::{TypeInfo, Typed};

use super::*;
use crate::EffectRegistry;

/// Every number has a documented range and every field a documentation, or
/// its widget would have neither.
#[test]
fn every_field_says_what_it_is() {
    fn check(info: &'static TypeInfo, name: &str) {
        let fields: Vec<&NamedField> = match info {
            TypeInfo::Struct(info) => info.iter().collect(),
            TypeInfo::Enum(info) => info
                .iter()
                .filter_map(|variant| variant.as_struct_variant().ok())
                .flat_map(|variant| variant.iter())
                .collect(),
            _ => panic!("{name} is neither struct nor enum"),
        };
        for field in fields {
            let name = format!("{name}.{}", field.name());
            assert!(
                !plain(field.docs().unwrap_or_default()).is_empty(),
                "{name}"
            );
            let path = field.type_path();
            let is_number = ["f32", "u32"].iter().any(|t| path.contains(t));
            assert_eq!(FieldRange::of(field).is_some(), is_number, "{name}: {path}");
        }
    }
    check(DepthMap::type_info(), "DepthMap");
    check(crate::DepthMapping::type_info(), "DepthMapping");
    check(RangeSmoothing::type_info(), "RangeSmoothing");
    for effect in EffectRegistry::built_in().types() {
        check((effect.type_info)(), effect.name);
    }
    check(Silhouettes::type_info(), "Silhouettes");
    check(Creases::type_info(), "Creases");
    check(ObjectEdges::type_info(), "ObjectEdges");
}

/// The panel of a style with everything in it, laid out without a window,
/// changes nothing that nobody touched.
#[test]
fn looking_changes_nothing() {
    let types = EffectRegistry::built_in().types();
    let mut full = ComicStyle {
        depth_map: Some(DepthMap {
            mapping: crate::DepthMapping::Fixed {
                near: 1.0,
                far: 30.0,
            },
            ..DepthMap::default()
        }),
        ..ComicStyle::default()
    };
    for effect in &types {
        full.insert_any((effect.default)());
    }
    let context = egui::Context::default();
    let mut edited = full.clone();
    let mut widgets = Widgets::default();
    for _ in 0..3 {
        let _ = context.run_ui(egui::RawInput::default(), |ui| {
            for path in types.iter().map(|effect| effect.name).chain(["depth_map"]) {
                let id = ui.make_persistent_id(("effect", path));
                let mut state = CollapsingState::load_with_default_open(ui.ctx(), id, true);
                state.set_open(true);
                state.store(ui.ctx());
            }
            style(ui, &mut edited, &types, &mut widgets);
        });
    }
    assert_eq!(edited, full);
    for path in [
        "contours.width",
        "contours.operator",
        "colorization.color",
        "black_flats.slope.on",
        "outlines.creases.angle",
        "depth_map.mapping.far",
        "depth_map.smoothing.shrink",
        "tone_bands.levels",
        "depth_map.flip",
    ] {
        assert!(widgets.rects.contains_key(path), "{path} has no widget");
    }
}

#[test]
fn words() {
    assert_eq!(label("edge_limit"), "Edge limit");
    assert_eq!(label_of_mode("MinMaxLogarithmic"), "Min max logarithmic");
    assert_eq!(plain(" A [`Link`]\n to \\[CS\\]. "), "A Link to CS.");
}
