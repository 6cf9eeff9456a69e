//! The looks of the figure's materials, from files.

use bevy::prelude::*;
use bevy_comics::{CartoonScene, ToonLook};

macro_rules! looks {
    ($($name:literal),*) => {
        [$(($name, include_str!(concat!("../../../../assets/looks/", $name, ".toon.ron")))),*]
    };
}

/// Name and text of each file.
const FILES: [(&str, &str); 6] = looks!["face", "skin", "hair", "iris", "paint", "cloth"];

/// Materials, and the look of each.
const LOOKS: [(&str, &str); 15] = [
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

/// The figure with the cartoon material.
pub fn scene(looks: &mut Assets<ToonLook>) -> CartoonScene {
    let handles = FILES.map(|(name, text)| {
        let look = ToonLook::from_ron(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        (name, looks.add(look))
    });
    let mut scene = CartoonScene::default();
    for (material, look) in LOOKS {
        let found = handles.iter().find(|(name, _)| *name == look);
        let (_, handle) = found.expect("a look of the figure");
        scene = scene.with_override(material, handle.clone());
    }
    scene
}
