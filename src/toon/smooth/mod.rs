//! Smoothed normals of the meshes whose materials ask for them: a vertex attribute, made in tasks.

mod normals;

use bevy::{
    mesh::VertexAttributeValues,
    platform::collections::{HashMap, HashSet},
    prelude::*,
    tasks::{AsyncComputeTaskPool, Task, futures::check_ready},
};

pub(super) use normals::SMOOTHED_NORMAL;
use normals::{Faces, Unsmoothed, octahedral};

use super::{ProxyShape, ToonMaterial};

/// The meshes that have smoothed normals, or soon will.
#[derive(Resource, Default)]
pub(super) struct SmoothMeshes(HashMap<AssetId<Mesh>, SmoothMesh>);

struct SmoothMesh {
    /// Rounds that the normals have, or will have.
    rounds: u32,
    /// Runs until the normals are made.
    task: Option<Task<Vec<[i16; 2]>>>,
    /// Events of the mesh that are not a change of its form: the insertion of the normals.
    own_events: usize,
}

fn rounds_of(material: &ToonMaterial) -> Option<u32> {
    match material.extension.proxy?.sanitized().shape {
        ProxyShape::Smoothed { rounds } => Some(rounds),
        _ => None,
    }
}

type Changes = (
    With<MeshMaterial3d<ToonMaterial>>,
    Or<(Changed<Mesh3d>, Changed<MeshMaterial3d<ToonMaterial>>)>,
);

/// Begins a task for each mesh that is to have other normals than it has.
pub(super) fn begin_smoothing(
    mut smooth: ResMut<SmoothMeshes>,
    worn: Query<(&Mesh3d, &MeshMaterial3d<ToonMaterial>)>,
    put_on: Query<(), Changes>,
    (materials, meshes): (Res<Assets<ToonMaterial>>, Res<Assets<Mesh>>),
    mut events: (
        MessageReader<AssetEvent<ToonMaterial>>,
        MessageReader<AssetEvent<Mesh>>,
    ),
) {
    let changed = smooth.changed(&mut events.1);
    let other_material = events.0.read().count() > 0;
    if changed.is_empty() && !other_material && put_on.is_empty() {
        return;
    }
    if materials.iter().all(|(_, m)| rounds_of(m).is_none()) {
        return;
    }
    let mut wanted: HashMap<AssetId<Mesh>, u32> = HashMap::default();
    for (mesh, material) in &worn {
        if let Some(rounds) = materials.get(&material.0).and_then(rounds_of) {
            let most = wanted.entry(mesh.id()).or_default();
            *most = rounds.max(*most);
        }
    }
    for (id, rounds) in wanted {
        let is_done = (smooth.0.get(&id)).is_some_and(|mesh| mesh.rounds == rounds);
        if is_done && !changed.contains(&id) {
            continue;
        }
        let Some(mesh) = meshes.get(id) else {
            continue;
        };
        smooth.begin(id, Faces::of(mesh), rounds);
    }
}

/// Gives meshes the normals that are ready.
pub(super) fn finish_smoothing(mut smooth: ResMut<SmoothMeshes>, mut meshes: ResMut<Assets<Mesh>>) {
    for (id, made) in &mut smooth.0 {
        let Some(normals) = made.task.as_mut().and_then(check_ready) else {
            continue;
        };
        made.task = None;
        // A mesh with other vertices has changed meanwhile, and there is an event for that.
        let positions = meshes
            .get(*id)
            .and_then(|mesh| mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).ok());
        if positions.is_none_or(|positions| positions.len() != normals.len()) {
            continue;
        }
        let Some(mut mesh) = meshes.get_mut(*id) else {
            continue;
        };
        let values = VertexAttributeValues::Snorm16x2(normals);
        if mesh.try_insert_attribute(SMOOTHED_NORMAL, values).is_ok() {
            made.own_events += 1;
        }
    }
}

impl SmoothMeshes {
    /// The meshes that were added or changed, but not by the insertion of their normals. Forgets
    /// those that were removed.
    fn changed(&mut self, events: &mut MessageReader<AssetEvent<Mesh>>) -> HashSet<AssetId<Mesh>> {
        let mut changed = HashSet::default();
        for event in events.read() {
            match event {
                AssetEvent::Added { id } => {
                    changed.insert(*id);
                }
                AssetEvent::Modified { id } => match self.0.get_mut(id) {
                    Some(mesh) if mesh.own_events > 0 => mesh.own_events -= 1,
                    _ => {
                        changed.insert(*id);
                    }
                },
                AssetEvent::Removed { id } => {
                    self.0.remove(id);
                }
                _ => {}
            }
        }
        changed
    }

    fn begin(&mut self, id: AssetId<Mesh>, faces: Result<Faces, Unsmoothed>, rounds: u32) {
        let own_events = self.0.get(&id).map_or(0, |mesh| mesh.own_events);
        let task = match faces {
            Ok(faces) => Some(AsyncComputeTaskPool::get().spawn(async move {
                let normals = faces.smoothed(rounds);
                normals.into_iter().map(octahedral).collect::<Vec<_>>()
            })),
            Err(error) => {
                warn_once!("a mesh with a `ProxyShape::Smoothed` keeps its own normals: {error}");
                None
            }
        };
        let mesh = SmoothMesh {
            rounds,
            task,
            own_events,
        };
        self.0.insert(id, mesh);
    }
}
