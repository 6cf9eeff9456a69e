//! What the widgets are made of is there, and looking changes nothing.

use bevy::reflect::{TypeInfo, Typed};

use super::*;

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
    check(ToneBands::type_info(), "ToneBands");
    check(Desaturation::type_info(), "Desaturation");
    check(Colorization::type_info(), "Colorization");
    check(BlackFlats::type_info(), "BlackFlats");
    check(Contours::type_info(), "Contours");
    check(Outlines::type_info(), "Outlines");
    check(Silhouettes::type_info(), "Silhouettes");
    check(Creases::type_info(), "Creases");
    check(ObjectEdges::type_info(), "ObjectEdges");
    check(Sketch::type_info(), "Sketch");
}

/// The panel of a style with everything in it, laid out without a window,
/// changes nothing that nobody touched.
#[test]
fn looking_changes_nothing() {
    let full = ComicStyle {
        version: ComicStyle::VERSION,
        depth_map: Some(DepthMap {
            mapping: crate::DepthMapping::Fixed {
                near: 1.0,
                far: 30.0,
            },
            ..DepthMap::default()
        }),
        tone_bands: Some(ToneBands::default()),
        desaturation: Some(Desaturation::default()),
        colorization: Some(Colorization::default()),
        black_flats: Some(BlackFlats::default()),
        contours: Some(Contours::default()),
        outlines: Some(Outlines::default()),
        sketch: Some(Sketch::default()),
        ..ComicStyle::default()
    };
    let context = egui::Context::default();
    let mut edited = full.clone();
    let mut widgets = Widgets::default();
    for _ in 0..3 {
        let _ = context.run_ui(egui::RawInput::default(), |ui| {
            for path in [
                "depth_map",
                "tone_bands",
                "desaturation",
                "colorization",
                "black_flats",
                "contours",
                "outlines",
                "sketch",
            ] {
                let id = ui.make_persistent_id(("effect", path));
                let mut state = CollapsingState::load_with_default_open(ui.ctx(), id, true);
                state.set_open(true);
                state.store(ui.ctx());
            }
            style(ui, &mut edited, &mut widgets);
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
