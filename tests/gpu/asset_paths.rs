//! Untrusted files name no file outside the folder of assets.

use std::fs;

use bevy::{
    asset::LoadState,
    ecs::message::MessageCursor,
    reflect::{NamedField, Typed, UnnamedField, enums::VariantInfo},
};

use crate::{
    prelude::*,
    styles::Folder,
    toon_shading::{load, messages, wait, watching},
};

/// Paths that lead out of the folder of assets, on some system.
const ELSEWHERE: [&str; 14] = [
    "../secret.png",
    "a/../../secret.png",
    "./../secret.png",
    "/etc/secret.png",
    "//server/secret.png",
    "http://a/b.png",
    "https://a/b.png",
    "file:///etc/secret.png",
    "embedded://bevy_comics/secret.png",
    "embedded://../secret.png",
    r"C:\secret.png",
    "C:/secret.png",
    r"..\secret.png",
    r"\\server\secret.png",
];

/// An untrusted shading reads nothing outside the folder of assets, whatever the app allows.
#[test]
fn a_shading_loads_no_image_from_elsewhere() {
    let folder = Folder::new("untrusted");
    let mut small = watching(&folder);
    for (k, path) in ELSEWHERE.into_iter().enumerate() {
        let name = format!("untrusted{k}.toon.ron");
        let text = format!("(version: 2, light: (ramp_map: {path:?}))");
        let read = ToonShading::from_ron(&text).expect("a path");
        let shown = read.light.ramp_map.path().expect("its path").to_string();
        fs::write(folder.0.join(&name), text).expect("written");
        let mut failures = MessageCursor::default();
        failures.clear(messages(small.world()));
        let shading = load(&mut small, name);
        let failed = |world: &mut World| {
            let server = world.resource::<AssetServer>();
            matches!(server.load_state(&shading), LoadState::Failed(_))
        };
        assert!(wait(&mut small, 400, failed), "{path} was read");
        let read = failures.read(messages(small.world()));
        let told: Vec<_> = read.map(|failure| failure.error.to_string()).collect();
        let is_named = told.iter().all(|text| text.contains(&shown));
        assert!(!told.is_empty() && is_named, "{told:?}");
    }
}

/// Paths that stay in the folder are read.
#[test]
fn a_shading_loads_an_image_of_its_assets() {
    let folder = Folder::new("own");
    fs::create_dir_all(folder.0.join("ramps")).expect("a folder");
    let tones = image::RgbaImage::from_pixel(4, 1, image::Rgba([90, 90, 90, 255]));
    tones.save(folder.0.join("ramps/a.png")).expect("written");
    let mut small = watching(&folder);
    let server = small.world().resource::<AssetServer>().clone();
    for (k, path) in ["ramps/a.png", "./ramps/a.png"].into_iter().enumerate() {
        let name = format!("own{k}.toon.ron");
        let text = format!("(version: 2, light: (ramp_map: {path:?}))");
        fs::write(folder.0.join(&name), text).expect("written");
        let shading = load(&mut small, name);
        let loaded = wait(&mut small, 400, |_| {
            server.is_loaded_with_dependencies(&shading)
        });
        assert!(loaded, "{path} was not read");
    }
}

/// A field: its name, the path of its type, and what is known of that.
type Field = (String, &'static str, Option<&'static TypeInfo>);

fn named(field: &'static NamedField) -> Field {
    let name = field.name().to_owned();
    (name, field.type_path(), field.type_info())
}

fn numbered(field: &'static UnnamedField) -> Field {
    let index = field.index().to_string();
    (index, field.type_path(), field.type_info())
}

fn of_variant(variant: &'static VariantInfo) -> Vec<Field> {
    match variant {
        VariantInfo::Struct(variant) => variant.iter().map(named).collect(),
        VariantInfo::Tuple(variant) => variant.iter().map(numbered).collect(),
        VariantInfo::Unit(_) => Vec::new(),
    }
}

fn fields(info: &'static TypeInfo) -> Vec<Field> {
    let item = |path, info| vec![("item".to_owned(), path, info)];
    match info {
        TypeInfo::Struct(info) => info.iter().map(named).collect(),
        TypeInfo::TupleStruct(info) => info.iter().map(numbered).collect(),
        TypeInfo::Tuple(info) => info.iter().map(numbered).collect(),
        TypeInfo::Enum(info) => info.iter().flat_map(of_variant).collect(),
        TypeInfo::List(info) => item(info.item_ty().path(), info.item_info()),
        TypeInfo::Array(info) => item(info.item_ty().path(), info.item_info()),
        _ => Vec::new(),
    }
}

/// What names of files and assets, and any text, have in the paths of their types.
const NAMES: [&str; 5] = ["bevy_asset::", "std::path::", "::String", "Cow<", "&str"];

/// The fields at and below a place that can name a file.
fn names(info: &'static TypeInfo, place: &str, found: &mut BTreeSet<String>) {
    for (name, path, info) in fields(info) {
        let place = format!("{place}.{name}");
        if NAMES.iter().any(|name| path.contains(name)) {
            found.insert(place);
        } else if let Some(info) = info {
            names(info, &place, found);
        }
    }
}

/// Of all settings of effects and materials, the image of a ramp is the only one by which a file
/// can name another one: the other images of a material cannot be in files.
#[test]
fn files_name_one_kind_of_file() {
    let mut found = BTreeSet::new();
    for effect in EffectRegistry::built_in().types() {
        names((effect.type_info)(), effect.name, &mut found);
    }
    names(DepthMap::type_info(), "depth_map", &mut found);
    assert!(found.is_empty(), "{found:?}");
    names(ToonLight::type_info(), "light", &mut found);
    let found: Vec<&str> = found.iter().map(String::as_str).collect();
    let wanted = [
        "light.art_map",
        "light.ramp_map.image",
        "light.ramp_map.path",
        "light.threshold_map",
    ];
    assert_eq!(found, wanted);
    for field in ["art_map", "threshold_map"] {
        let text = format!("(version: 2, light: ({field}: \"a.png\"))");
        let error = ToonShading::from_ron(&text).expect_err(field).to_string();
        assert!(error.contains(field), "{error}");
    }
}
