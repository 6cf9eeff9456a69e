//! The styles of the figure's materials, from files.

use bevy::prelude::*;
use bevy_comics::{ToonScene, toon::ToonShading};

macro_rules! files {
    ($($name:literal),*) => {
        [$(($name, include_str!(concat!("../../../../../assets/shading/", $name, ".toon.ron")))),*]
    };
}

/// Name and text of each file.
const FILES: [(&str, &str); 6] = files!["face", "skin", "hair", "iris", "paint", "cloth"];

/// Materials, and the style of each.
const STYLES: [(&str, &str); 15] = [
    ("face", "face"),
    ("blush", "face"),
    ("skin", "skin"),
    ("hair", "hair"),
    ("iris", "iris"),
    ("iris shade", "paint"),
    ("eye", "paint"),
    ("ink", "paint"),
    ("brow", "paint"),
    ("mouth", "paint"),
    ("tongue", "paint"),
    ("scarf", "cloth"),
    ("coat", "cloth"),
    ("button", "cloth"),
    ("cuff", "cloth"),
];

/// The figure with the toon material.
pub fn scene(styles: &mut Assets<ToonShading>) -> ToonScene {
    let handles = FILES.map(|(name, text)| {
        let style = ToonShading::from_ron(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        (name, styles.add(style))
    });
    let mut scene = ToonScene::default();
    for (material, style) in STYLES {
        let found = handles.iter().find(|(name, _)| *name == style);
        let (_, handle) = found.expect("a style of the figure");
        scene = scene.with_override(material, handle.clone());
    }
    scene
}
