//! Levels of detail that fade into each other ([`VisibilityRange`]).
//!
//! The engine draws them with a pattern of pixels, in the prepass too: each pixel shows one of both levels. There, every
//! pixel would be a border between objects. So both levels are one object, and while they fade, both are drawn whole into
//! the depth that effects read.

use std::ops::Range;

use bevy::{
    app::{App, PostUpdate},
    camera::visibility::{ViewVisibility, VisibilityRange},
    ecs::{
        component::Component,
        entity::{Entity, EntityHashMap},
        hierarchy::ChildOf,
        lifecycle::RemovedComponents,
        query::{Added, Changed, Or, With},
        resource::Resource,
        system::{Query, ResMut},
    },
    math::Vec3,
    mesh::Mesh3d,
    platform::collections::HashMap,
    render::sync_world::MainEntityHashSet,
    transform::components::{GlobalTransform, Transform},
};

use super::{changes::Follow, shared::Shared, table::ObjectStyles};

/// The margins of a range, at whose distances a mesh fades; `None` where it does not.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Margins {
    start: [f32; 2],
    end: [f32; 2],
}

impl Margins {
    /// `None` for a range that fades nowhere.
    fn new(range: &VisibilityRange) -> Option<Self> {
        let margin = |margin: &Range<f32>| [margin.start, margin.end];
        (!range.is_abrupt()).then(|| Self {
            start: margin(&range.start_margin),
            end: margin(&range.end_margin),
        })
    }

    fn is_inside(&self, distance: f32) -> bool {
        let inside = |[from, to]: [f32; 2]| (from..to).contains(&distance);
        inside(self.start) || inside(self.end)
    }

    /// Whether this level is followed by another one.
    fn fades_into(&self, next: &Self) -> bool {
        self.end == next.start && self.end[0] < self.end[1]
    }
}

/// The parent of a mesh and the bits of its place there: levels of one thing have the same.
type Place = (Option<Entity>, [u32; 3]);

/// The meshes that fade at some distance. Both worlds have a copy.
#[derive(Resource, Default)]
pub(crate) struct Levels {
    /// Empty in the render world.
    margins: EntityHashMap<Margins>,
    /// Of levels that fade into each other, the one whose id they have.
    first: Shared<Entity>,
}

impl Levels {
    /// The mesh whose id this one has.
    pub fn object(&self, mesh: Entity) -> Entity {
        self.first.get(mesh).copied().unwrap_or(mesh)
    }

    /// The meshes that fade, seen from a point.
    pub fn fading(&self, eye: Vec3, places: &LevelPlaces) -> MainEntityHashSet {
        let fades = |(mesh, margins): &(&Entity, &Margins)| {
            // As the engine's pattern, also with `VisibilityRange::use_aabb`.
            let place = places.get(**mesh);
            place.is_ok_and(|(at, visible)| {
                visible.get() && margins.is_inside(at.translation().distance(eye))
            })
        };
        let fading = self.margins.iter().filter(fades);
        fading.map(|(mesh, _)| (*mesh).into()).collect()
    }
}

/// Where levels are.
pub(crate) type LevelPlaces<'w, 's> =
    Query<'w, 's, (&'static GlobalTransform, &'static ViewVisibility), With<VisibilityRange>>;

/// On a view: the meshes that fade in this frame.
#[derive(Component, Clone, Debug, PartialEq)]
pub(crate) struct FadingMeshes(pub MainEntityHashSet);

/// The levels at each place, by which those of one thing are found.
#[derive(Resource, Default)]
struct LevelsByPlace {
    places: EntityHashMap<Place>,
    levels: HashMap<Place, Vec<Entity>>,
}

type Changes = Or<(
    Changed<VisibilityRange>,
    Changed<ChildOf>,
    Changed<Transform>,
    Added<Mesh3d>,
)>;

fn find_levels(
    changed: Query<
        (Entity, &VisibilityRange, Option<&ChildOf>, &Transform),
        (With<Mesh3d>, Changes),
    >,
    mut removed: RemovedComponents<VisibilityRange>,
    mut levels: ResMut<Levels>,
    mut by_place: ResMut<LevelsByPlace>,
    mut styles: ResMut<ObjectStyles>,
) {
    let mut touched = Vec::new();
    if changed.is_empty() && removed.is_empty() {
        return;
    }
    levels.first.begin();
    for gone in removed.read() {
        if !changed.contains(gone) {
            touched.extend(by_place.put(gone, None));
            levels.margins.remove(&gone);
            levels.first.set(gone, None);
        }
    }
    for (mesh, range, parent, at) in &changed {
        let margins = Margins::new(range);
        let place = (
            parent.map(ChildOf::parent),
            at.translation.to_array().map(f32::to_bits),
        );
        touched.extend(by_place.put(mesh, margins.map(|_| place)));
        match margins {
            Some(margins) => levels.margins.insert(mesh, margins),
            None => {
                levels.first.set(mesh, None);
                levels.margins.remove(&mesh)
            }
        };
    }
    for place in touched {
        let Some(meshes) = by_place.levels.get(&place) else {
            continue;
        };
        levels.chain(meshes);
    }
    if styles.fades == levels.margins.is_empty() {
        styles.fades = !levels.margins.is_empty();
    }
}

impl LevelsByPlace {
    /// Sets where a level is; returns the places that have changed.
    fn put(&mut self, mesh: Entity, place: Option<Place>) -> impl Iterator<Item = Place> + use<> {
        let before = match place {
            Some(place) => self.places.insert(mesh, place),
            None => self.places.remove(&mesh),
        };
        if before != place {
            if let Some(levels) = before.and_then(|before| self.levels.get_mut(&before)) {
                levels.retain(|level| *level != mesh);
            }
            if let Some(place) = place {
                self.levels.entry(place).or_default().push(mesh);
            }
        }
        if let Some(before) = before
            && self.levels.get(&before).is_some_and(Vec::is_empty)
        {
            self.levels.remove(&before);
        }
        before.into_iter().chain(place)
    }
}

impl Levels {
    /// Finds which of the levels at a place fade into each other.
    fn chain(&mut self, meshes: &[Entity]) {
        let mut sorted: Vec<_> = meshes
            .iter()
            .filter_map(|mesh| Some((self.margins.get(mesh).copied()?, *mesh)))
            .collect();
        sorted.sort_by(|(a, first), (b, second)| {
            a.start[0].total_cmp(&b.start[0]).then(first.cmp(second))
        });
        for (i, (margins, mesh)) in sorted.iter().enumerate() {
            let before = sorted[..i]
                .iter()
                .find(|(before, _)| before.fades_into(margins));
            let first = before.map(|(_, before)| self.object(*before));
            self.first.set(*mesh, first);
        }
    }
}

impl Follow for Levels {
    fn follow(&mut self, main: &Self, changed: &mut MainEntityHashSet) {
        self.first.follow(&main.first, changed);
    }
}

pub(super) fn build(app: &mut App) {
    app.init_resource::<Levels>()
        .init_resource::<LevelsByPlace>()
        .add_systems(PostUpdate, find_levels);
}
