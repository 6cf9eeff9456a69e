//! The color and the gloss of a picked object: its standard material, or the base of its toon
//! material.

use bevy::prelude::*;
use bevy_egui::egui::Ui;

use super::{
    super::{
        Widgets,
        fields::{section, settings},
        history::{Exchange, Subject},
        note,
    },
    Objects, edits,
    steps::with_material,
};
use bevy_comics::{ToonMaterial, ToonScene, effect::FieldRange};

/// The path of the material in the panel.
const PATH: &str = "material";

/// What the panel edits of a material.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
struct Base {
    /// Color of the surface, by which its texture is multiplied. Alpha counts in transparent
    /// materials.
    base_color: Color,
    /// How rough the surface is: rough ones have large, weak highlights. Toon materials have none
    /// above 0.71. Range 0.089 to 1, default 0.5.
    #[reflect(@FieldRange::linear(0.089, 1.0))]
    perceptual_roughness: f32,
    /// How much of a metal the surface is: highlights of metals have the color of the surface.
    /// Range 0 to 1, default 0.
    #[reflect(@FieldRange::FRACTION)]
    metallic: f32,
}

impl Base {
    fn of(material: &StandardMaterial) -> Self {
        Self {
            base_color: material.base_color,
            perceptual_roughness: material.perceptual_roughness,
            metallic: material.metallic,
        }
    }

    fn write(self, material: &mut StandardMaterial) {
        material.base_color = self.base_color;
        material.perceptual_roughness = self.perceptual_roughness;
        material.metallic = self.metallic;
    }

    fn in_ranges(self) -> Self {
        let clamped = |value: f32, default, least| match value.is_finite() {
            true => value.clamp(least, 1.0),
            false => default,
        };
        Self {
            base_color: self.base_color,
            perceptual_roughness: clamped(self.perceptual_roughness, 0.5, 0.089),
            metallic: clamped(self.metallic, 0.0, 0.0),
        }
    }
}

/// Where the color and the gloss of a mesh are set last, so that an edit of them stays.
#[derive(Clone, Debug, PartialEq)]
enum Place {
    /// Also of meshes that a `ToonScene` draws: their copies follow.
    Standard(Handle<StandardMaterial>),
    Toon(Handle<ToonMaterial>),
}

impl Place {
    fn of(world: &World, mesh: Entity) -> Option<Self> {
        let mesh = world.get_entity(mesh).ok()?;
        if let Some((_, original, _)) = ToonScene::original(mesh) {
            return Some(Self::Standard(original.clone()));
        }
        if let Some(material) = mesh.get::<MeshMaterial3d<ToonMaterial>>() {
            return Some(Self::Toon(material.0.clone()));
        }
        let material = mesh.get::<MeshMaterial3d<StandardMaterial>>()?;
        Some(Self::Standard(material.0.clone()))
    }

    /// `None` if the material has not loaded.
    fn base(&self, world: &World) -> Option<Base> {
        match self {
            Self::Standard(material) => {
                let materials = world.get_resource::<Assets<StandardMaterial>>()?;
                materials.get(material).map(Base::of)
            }
            Self::Toon(material) => {
                let materials = world.get_resource::<Assets<ToonMaterial>>()?;
                materials.get(material).map(|own| Base::of(&own.base))
            }
        }
    }

    /// Sets the base. Returns what was there; `None` if the material is gone.
    fn set(&self, world: &mut World, base: Base) -> Option<Base> {
        let before = self.base(world)?;
        match self {
            Self::Standard(material) => {
                let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
                base.write(&mut *materials.get_mut(material)?);
            }
            Self::Toon(material) => {
                let mut materials = world.resource_mut::<Assets<ToonMaterial>>();
                base.write(&mut materials.get_mut(material)?.base);
            }
        }
        Some(before)
    }

    /// Which material an edit changes, and how many meshes have it.
    fn what_is_edited(&self, world: &mut World) -> String {
        let (what, path, count) = match self {
            Self::Standard(material) => (
                "standard material",
                material.path(),
                with_original(world, material),
            ),
            Self::Toon(material) => (
                "toon material",
                material.path(),
                with_material(world, material).len(),
            ),
        };
        let edited = match path {
            Some(path) => format!("the {what} {path}"),
            None => format!("the {what}, which is made by code"),
        };
        edits(&edited, count)
    }
}

/// The number of meshes with a standard material, or with a scene's copy of it.
fn with_original(world: &mut World, material: &Handle<StandardMaterial>) -> usize {
    let copies = world
        .query_filtered::<EntityRef, With<MeshMaterial3d<ToonMaterial>>>()
        .iter(world)
        .filter_map(ToonScene::original)
        .filter(|(_, original, _)| *original == material)
        .count();
    copies + with_material(world, material).len()
}

/// The base that was set in a place.
struct BaseStep {
    place: Place,
    base: Base,
}

impl Exchange for BaseStep {
    fn subject(&self) -> Subject {
        Subject::Asset(match &self.place {
            Place::Standard(material) => material.id().untyped(),
            Place::Toon(material) => material.id().untyped(),
        })
    }

    fn exchange(self: Box<Self>, world: &mut World) -> Option<Box<dyn Exchange>> {
        let before = self.place.set(world, self.base)?;
        Some(Box::new(Self {
            place: self.place,
            base: before,
        }))
    }
}

impl Objects {
    /// The color and the gloss of an object. Returns what was there before an edit.
    pub(super) fn base(
        &mut self,
        ui: &mut Ui,
        world: &mut World,
        object: Entity,
        widgets: &mut Widgets,
    ) -> Option<Box<dyn Exchange>> {
        let place = Place::of(world, object)?;
        let before = place.base(world)?;
        let edited = section(ui, "Material", |ui| {
            let label = ui.label(place.what_is_edited(world));
            note(widgets, "material.place", &label);
            let mut edited = before;
            let default = Base::of(&StandardMaterial::default());
            let step = BaseStep {
                place: place.clone(),
                base: before,
            };
            let mut editor = self.editor(&step.subject(), widgets);
            settings(ui, &mut edited, Some(&default), (PATH, None), &mut editor);
            edited.in_ranges()
        })?;
        // Values that the game has set out of range are not a change by the panel.
        if edited == before.in_ranges() {
            return None;
        }
        let step = BaseStep {
            place,
            base: edited,
        };
        Box::new(step).exchange(world)
    }
}
