//! Levels of detail that fade into each other ([`VisibilityRange`]).
//!
//! The engine draws them with a pattern of pixels, in the prepass too: each pixel shows one of both levels. There, every
//! pixel would be a border between objects. So both levels are one object, and while they fade, both are drawn whole into
//! the depth that effects read. A level that fades to nothing has no lines from the middle of its margin on.

use std::ops::Range;

use bevy::{
    camera::visibility::VisibilityRange,
    ecs::entity::EntityHashMap,
    platform::collections::{HashMap, HashSet},
    prelude::*,
    render::sync_world::MainEntityHashSet,
};

use super::{changes::Follow, shared::Shared, table::ObjectStyles};

/// The margins of a range, at whose distances a mesh fades.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Margins {
    start: [f32; 2],
    end: [f32; 2],
    /// Whether it fades to nothing in the start margin, and in the end margin: no other level fades in
    /// there.
    to_nothing: [bool; 2],
}

/// The part of a margin from which on a mesh has mostly faded: from the 8th of the engine's 16 levels of
/// dither on, half of its pixels or more are gone.
const MOSTLY: f32 = 7.5 / 16.0;

impl Margins {
    /// `None` for a range that fades nowhere.
    fn new(range: &VisibilityRange) -> Option<Self> {
        let margin = |margin: &Range<f32>| [margin.start, margin.end];
        (!range.is_abrupt()).then(|| Self {
            start: margin(&range.start_margin),
            end: margin(&range.end_margin),
            to_nothing: [false; 2],
        })
    }

    fn is_inside(&self, distance: f32) -> bool {
        let inside = |[from, to]: [f32; 2]| (from..to).contains(&distance);
        inside(self.start) || inside(self.end)
    }

    /// Whether most of the mesh has faded to nothing at a distance inside of a margin.
    fn is_gone(&self, distance: f32) -> bool {
        let part = |[from, to]: [f32; 2]| (distance - from) / (to - from);
        let [start, end] = self.to_nothing;
        (start && 1.0 - part(self.start) >= MOSTLY) || (end && part(self.end) >= MOSTLY)
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
    /// The meshes whose margins, or other levels, changed last. Empty in the render world.
    pub changed: Vec<Entity>,
}

impl Levels {
    /// The mesh whose id this one has.
    pub fn object(&self, mesh: Entity) -> Entity {
        self.first.get(mesh).copied().unwrap_or(mesh)
    }

    /// Whether the mesh fades at some distance at which no other level fades in.
    pub fn fades_to_nothing(&self, mesh: Entity) -> bool {
        let margins = self.margins.get(&mesh);
        margins.is_some_and(|margins| margins.to_nothing != [false; 2])
    }

    /// The meshes that fade, seen from a point.
    pub fn fading(&self, eye: Vec3, places: &LevelPlaces) -> FadingMeshes {
        let mut fading = FadingMeshes::default();
        for (mesh, margins) in &self.margins {
            let Ok((at, visible)) = places.get(*mesh) else {
                continue;
            };
            // As the engine's pattern, also with `VisibilityRange::use_aabb`.
            let distance = at.translation().distance(eye);
            if visible.get() && margins.is_inside(distance) {
                fading.meshes.insert((*mesh).into());
                if margins.is_gone(distance) {
                    fading.gone.insert((*mesh).into());
                }
            }
        }
        fading
    }
}

/// Where levels are.
pub(crate) type LevelPlaces<'w, 's> =
    Query<'w, 's, (&'static GlobalTransform, &'static ViewVisibility), With<VisibilityRange>>;

/// On a view: the meshes that fade in this frame.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct FadingMeshes {
    pub meshes: MainEntityHashSet,
    /// Those that have mostly faded to nothing: they have no lines.
    pub gone: MainEntityHashSet,
}

/// The levels at each place, by which those of one thing are found.
#[derive(Resource, Default)]
pub(super) struct LevelsByPlace {
    places: EntityHashMap<Place>,
    levels: HashMap<Place, Vec<Entity>>,
}

type Changes = Or<(
    Changed<VisibilityRange>,
    Changed<ChildOf>,
    Changed<Transform>,
    Added<Mesh3d>,
)>;

pub(super) fn find_levels(
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
    levels.changed.clear();
    for gone in removed.read() {
        if !changed.contains(gone) {
            touched.extend(by_place.put(gone, None));
            levels.margins.remove(&gone);
            levels.first.set(gone, None);
            levels.changed.push(gone);
        }
    }
    for (mesh, range, parent, at) in &changed {
        let margins = Margins::new(range);
        let place = (
            parent.map(ChildOf::parent),
            at.translation.to_array().map(f32::to_bits),
        );
        touched.extend(by_place.put(mesh, margins.map(|_| place)));
        levels.changed.push(mesh);
        match margins {
            Some(margins) => levels.margins.insert(mesh, margins),
            None => {
                levels.first.set(mesh, None);
                levels.margins.remove(&mesh)
            }
        };
    }
    touched.sort_unstable();
    touched.dedup();
    for place in touched {
        let Some(meshes) = by_place.levels.get(&place) else {
            continue;
        };
        levels.chain(meshes);
    }
    let fades = !levels.margins.is_empty();
    if styles.flags.fades != fades {
        styles.flags.fades = fades;
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
    /// Finds which of the levels at a place fade into each other, and which to nothing.
    fn chain(&mut self, meshes: &[Entity]) {
        self.changed.extend_from_slice(meshes);
        let mut sorted: Vec<_> = meshes
            .iter()
            .filter_map(|mesh| Some((self.margins.get(mesh).copied()?, *mesh)))
            .collect();
        sorted.sort_by(|(a, first), (b, second)| {
            a.start[0].total_cmp(&b.start[0]).then(first.cmp(second))
        });
        let bits = |margin: [f32; 2]| margin.map(f32::to_bits);
        let starts: HashSet<_> = sorted.iter().map(|(m, _)| bits(m.start)).collect();
        // The first level that ends in a margin.
        let mut ends = HashMap::new();
        for (margins, mesh) in &sorted {
            let fades = |[from, to]: [f32; 2]| from < to;
            let before = ends.get(&bits(margins.start)).copied();
            let before = before.filter(|_| fades(margins.start));
            let first = before.map(|before| self.object(before));
            self.first.set(*mesh, first);
            ends.entry(bits(margins.end)).or_insert(*mesh);
            let follows = before.is_some();
            let is_followed = starts.contains(&bits(margins.end));
            if let Some(known) = self.margins.get_mut(mesh) {
                known.to_nothing = [
                    fades(margins.start) && !follows,
                    fades(margins.end) && !is_followed,
                ];
            }
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
        .init_resource::<LevelsByPlace>();
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Levels at one place: which of them have mostly faded at some distances.
    #[test]
    fn levels_are_gone_only_where_no_other_one_fades_in() {
        let two = [[0.0, 0.0, 8.0, 12.0], [8.0, 12.0, 30.0, 40.0]];
        let one = [[2.0, 4.0, 50.0, 50.0]];
        let of_two = [(10.0, false), (11.9, false), (33.0, false), (36.0, true)];
        let of_one = [(2.1, true), (2.9, true), (3.1, false), (49.0, false)];
        for (ranges, expected) in [(&two[..], of_two), (&one[..], of_one)] {
            let mut levels = Levels::default();
            let meshes = (1..).filter_map(Entity::from_raw_u32);
            let meshes: Vec<_> = meshes.take(ranges.len()).collect();
            for (mesh, [from, near, far, to]) in meshes.iter().zip(ranges) {
                let range = VisibilityRange {
                    start_margin: *from..*near,
                    end_margin: *far..*to,
                    use_aabb: false,
                };
                let margins = Margins::new(&range).expect("it fades");
                levels.margins.insert(*mesh, margins);
            }
            levels.chain(&meshes);
            for (distance, is_gone) in expected {
                let mut margins = levels.margins.values();
                let found = margins.any(|m| m.is_inside(distance) && m.is_gone(distance));
                assert_eq!(found, is_gone, "{ranges:?}, {distance}");
            }
            let fading = meshes.iter().filter(|mesh| levels.fades_to_nothing(**mesh));
            assert_eq!(fading.count(), 1);
        }
    }
}
