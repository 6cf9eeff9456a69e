//! The depth of every object in the depth map, for effects that treat objects as a whole.

use bevy::{
    asset::load_embedded_asset,
    camera::primitives::Aabb,
    core_pipeline::schedule::{Core3d, Core3dSystems},
    ecs::entity::{EntityHashMap, EntityHashSet},
    prelude::*,
    render::{
        Extract, GpuResourceAppExt, Render, RenderStartup,
        render_resource::{
            BindGroupLayoutDescriptor, BindGroupLayoutEntries, BufferUsages,
            CachedComputePipelineId, ComputePipelineDescriptor, PipelineCache, ShaderStages,
            SpecializedComputePipeline, SpecializedComputePipelines, UniformBuffer,
            binding_types::{
                storage_buffer_read_only_sized, storage_buffer_sized, uniform_buffer,
                uniform_buffer_sized,
            },
        },
        renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery},
        sync_world::MainEntityHashSet,
    },
};

use super::{
    ObjectDepthRequest, ObjectDepths, ObjectEye,
    changes::{ChangedObjects, NoteChanges},
    groups::ObjectGroups,
    object_ids::ObjectIds,
    shared::Shared,
    simplification::{BY_DISTANCE, Simplifications},
};
use crate::{
    bind_groups::Binder,
    depth::{DepthMapping, prepare::ViewDepthRange},
    gpu::{Table, buffer, compute_pass, definitions, entry},
    schedule::{ComicsSystems, PrepareComics},
};

/// Bytes of the depth of an id, and the smallest number of them in a table.
const ENTRY: u64 = 16;
const LEAST_ENTRIES: u64 = 1024;

/// A box in world space, along its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl Bounds {
    /// The box around a mesh; `None` if it is at no finite place.
    fn of(aabb: &Aabb, at: &GlobalTransform) -> Option<Self> {
        let affine = at.affine();
        let center = affine.transform_point3(aabb.center.into());
        let axes = Mat3::from(affine.matrix3);
        let half = Vec3::from(aabb.half_extents);
        let reach =
            axes.x_axis.abs() * half.x + axes.y_axis.abs() * half.y + axes.z_axis.abs() * half.z;
        let found = Self {
            low: center - reach,
            high: center + reach,
        };
        (found.low.is_finite() && found.high.is_finite()).then_some(found)
    }

    fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }
}

/// The object had its id in the frame before.
const KNOWN: u32 = 0;
/// The object has got its id in this frame.
const FRESH: u32 = 1;
/// Several objects have the id, or the object has no box.
const UNKNOWN: u32 = 2;

/// The boxes of all objects, while some view asks for their depths.
#[derive(Resource, Default)]
pub(super) struct ObjectBounds {
    /// The object of each mesh, and the mesh's box.
    meshes: EntityHashMap<(Entity, Bounds)>,
    /// The meshes of each object, and the box around them.
    objects: EntityHashMap<(Vec<Entity>, Bounds)>,
    /// The simplifications of the meshes that have one of their own.
    simplifications: Shared<Vec2>,
    /// Whether some view asked in the last frame.
    asked: bool,
    /// The objects that the table has yet to follow.
    touched: EntityHashSet,
    /// `Bounds` of `depths.wgsl`, by id.
    pub table: Table<12>,
}

impl ObjectBounds {
    /// Sets the box of a mesh, or that it has none.
    fn set(&mut self, mesh: Entity, found: Option<(Entity, Bounds)>) {
        let before = match found {
            Some(found) => self.meshes.insert(mesh, found),
            None => self.meshes.remove(&mesh),
        };
        if before == found {
            return;
        }
        let [old, new] = [before, found].map(|known| known.map(|(object, _)| object));
        self.touched.extend(old.into_iter().chain(new));
        if old == new {
            return;
        }
        if let Some((meshes, _)) = old.and_then(|object| self.objects.get_mut(&object)) {
            meshes.retain(|other| *other != mesh);
        }
        if let Some((object, bounds)) = found {
            let (meshes, _) = self.objects.entry(object).or_insert((Vec::new(), bounds));
            meshes.push(mesh);
        }
    }

    /// Finds the boxes of objects whose meshes have changed.
    fn unite(&mut self) {
        for object in &self.touched {
            let Some((meshes, around)) = self.objects.get_mut(object) else {
                continue;
            };
            let boxes = meshes.iter().filter_map(|mesh| self.meshes.get(mesh));
            match boxes.map(|(_, bounds)| *bounds).reduce(Bounds::with) {
                Some(bounds) => *around = bounds,
                None => {
                    self.objects.remove(object);
                }
            }
        }
    }

    /// The entry of an object in the table.
    fn entry(&self, object: Entity, id: u16, is_new: bool) -> [u32; 12] {
        let Some((meshes, found)) = self.objects.get(&object) else {
            return unknown(id);
        };
        let [x, y, z] = found.low.midpoint(found.high).to_array().map(f32::to_bits);
        let half = 0.5 * (found.high - found.low);
        let [across, down, deep] = half.to_array().map(f32::to_bits);
        let state = if is_new { FRESH } else { KNOWN };
        let own = meshes
            .iter()
            .find_map(|mesh| self.simplifications.get(*mesh));
        let [factor, offset] = own.unwrap_or(&BY_DISTANCE).to_array().map(f32::to_bits);
        let id = u32::from(id);
        [x, y, z, id, across, down, deep, state, factor, offset, 0, 0]
    }

    /// Brings the table up to date.
    fn fill(&mut self, ids: &ObjectIds) {
        let touched = std::mem::take(&mut self.touched);
        let mut table = std::mem::take(&mut self.table);
        // The id 0 is that of no object, and the table is never empty.
        for at in table.len()..=ids.last() {
            table.set(at, [0; 12]);
        }
        if ids.are_new() || table.buffer().is_none() {
            for (object, id, is_new) in ids.of_objects() {
                table.set(usize::from(id), self.entry(object, id, is_new));
            }
            for id in ids.shared() {
                table.set(usize::from(id), unknown(id));
            }
        } else {
            for object in touched {
                if let Some(id) = ids.alone(object) {
                    table.set(usize::from(id), self.entry(object, id, false));
                }
            }
        }
        self.table = table;
    }
}

/// The entry of an id that several objects have, or of an object without a box.
fn unknown(id: u16) -> [u32; 12] {
    let mut entry = [0; 12];
    entry[3] = u32::from(id);
    entry[7] = UNKNOWN;
    entry
}

/// Meshes with their boxes and transforms.
type Boxed = (Entity, &'static Aabb, &'static GlobalTransform);

type OtherBox = (
    With<Mesh3d>,
    Or<(Changed<GlobalTransform>, Changed<Aabb>, Changed<Mesh3d>)>,
);

fn extract_bounds(
    views: Query<(), With<ObjectDepthRequest>>,
    (groups, regrouped): (Res<ObjectGroups>, Res<ChangedObjects>),
    meshes: Extract<Query<Boxed, With<Mesh3d>>>,
    changed: Extract<Query<Boxed, OtherBox>>,
    (mut unmeshed, mut unboxed): (
        Extract<RemovedComponents<Mesh3d>>,
        Extract<RemovedComponents<Aabb>>,
    ),
    simplifications: Extract<Res<Simplifications>>,
    mut bounds: ResMut<ObjectBounds>,
) {
    let bounds = &mut *bounds;
    let gone: Vec<Entity> = unmeshed.read().chain(unboxed.read()).collect();
    if views.is_empty() {
        if std::mem::take(&mut bounds.asked) {
            *bounds = ObjectBounds::default();
        }
        return;
    }
    let found = |(mesh, aabb, at): (Entity, &Aabb, &GlobalTransform)| {
        let bounds = Bounds::of(aabb, at)?;
        Some((groups.object(mesh), bounds))
    };
    if !std::mem::replace(&mut bounds.asked, true) {
        for mesh in &meshes {
            bounds.set(mesh.0, found(mesh));
        }
    } else {
        for mesh in gone.into_iter().filter(|mesh| !meshes.contains(*mesh)) {
            bounds.set(mesh, None);
        }
        for mesh in &changed {
            bounds.set(mesh.0, found(mesh));
        }
        for mesh in regrouped
            .0
            .iter()
            .filter_map(|mesh| meshes.get(mesh.id()).ok())
        {
            bounds.set(mesh.0, found(mesh));
        }
    }
    let mut simplified = MainEntityHashSet::default();
    bounds
        .simplifications
        .follow(&simplifications.0, &mut simplified);
    for mesh in simplified {
        let object = bounds.meshes.get(&mesh.id()).map(|(object, _)| *object);
        bounds.touched.extend(object);
    }
    bounds.unite();
}

/// On a view whose effects treat objects as a whole: the pass that finds their depths.
#[derive(Component)]
pub(super) struct ObjectDepthPass {
    uniform: UniformBuffer<ObjectEye>,
    pipeline: CachedComputePipelineId,
    mapping: DepthMapping,
    cuts: u32,
}

impl ObjectDepthPass {
    fn reads_range(&self) -> bool {
        self.mapping.follows_visible_range()
    }

    /// Whether its depths say nothing about those of this request.
    fn is_past(&self, request: &ObjectDepthRequest) -> bool {
        (self.mapping, self.cuts) != (request.mapping, request.cuts)
    }
}

#[derive(Resource)]
struct ObjectDepthPipeline {
    shader: Handle<Shader>,
}

impl ObjectDepthPipeline {
    fn layout(visible_range: bool) -> BindGroupLayoutDescriptor {
        let compute = ShaderStages::COMPUTE;
        let mut entries = BindGroupLayoutEntries::sequential(
            compute,
            (
                uniform_buffer::<ObjectEye>(false),
                storage_buffer_read_only_sized(false, None),
                storage_buffer_sized(false, None),
            ),
        )
        .to_vec();
        if visible_range {
            entries.push(uniform_buffer_sized(false, None).build(3, compute));
        }
        BindGroupLayoutDescriptor::new("comics_object_depths", &entries)
    }
}

impl SpecializedComputePipeline for ObjectDepthPipeline {
    /// Whether the depth map spans the visible range.
    type Key = bool;

    fn specialize(&self, visible_range: Self::Key) -> ComputePipelineDescriptor {
        ComputePipelineDescriptor {
            label: Some("comics_object_depths".into()),
            layout: vec![Self::layout(visible_range)],
            shader: self.shader.clone(),
            shader_defs: definitions([(visible_range, "VISIBLE_RANGE")]).collect(),
            entry_point: Some("object_depth".into()),
            ..Default::default()
        }
    }
}

/// The views with depths of objects, and those that may no longer have them.
type WithDepths<'w, 's> = (
    Query<
        'w,
        's,
        (
            Entity,
            &'static ObjectDepthRequest,
            Option<&'static mut ObjectDepthPass>,
            Option<&'static ObjectDepths>,
        ),
    >,
    Query<'w, 's, Entity, (With<ObjectDepths>, Without<ObjectDepthRequest>)>,
);

fn prepare_object_depths(
    mut commands: Commands,
    (mut views, stale): WithDepths,
    (mut bounds, ids): (ResMut<ObjectBounds>, Res<ObjectIds>),
    (pipeline, cache): (Res<ObjectDepthPipeline>, Res<PipelineCache>),
    mut pipelines: ResMut<SpecializedComputePipelines<ObjectDepthPipeline>>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
) {
    for view in &stale {
        commands
            .entity(view)
            .remove::<(ObjectDepths, ObjectDepthPass)>();
    }
    if views.is_empty() {
        return;
    }
    bounds.fill(&ids);
    bounds.table.write(&device, &queue);
    let entries = (ids.last() as u64 + 1).next_power_of_two();
    let size = ENTRY * entries.max(LEAST_ENTRIES);
    for (entity, request, mut known, table) in &mut views {
        let resets = known.as_ref().is_none_or(|pass| pass.is_past(request));
        let known = known.as_mut().map(|pass| std::mem::take(&mut pass.uniform));
        let mut uniform = known.unwrap_or_default();
        uniform.set(ObjectEye {
            resets: u32::from(resets),
            ..request.eye
        });
        uniform.write_buffer(&device, &queue);
        let reads_range = request.mapping.follows_visible_range();
        let mut view = commands.entity(entity);
        view.insert(ObjectDepthPass {
            uniform,
            pipeline: pipelines.specialize(&cache, &pipeline, reads_range),
            mapping: request.mapping,
            cuts: request.cuts,
        });
        if table.is_none_or(|table| table.table.size() < size) {
            let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
            let table = buffer(&device, "comics_object_depths", size, usage);
            view.insert(ObjectDepths { table });
        }
    }
}

/// Records the pass that finds the depths of objects. Where it cannot run, they are unknown: those
/// of the last frame may be depths in another depth map.
fn find_object_depths(
    view: ViewQuery<(&ObjectDepthPass, &ObjectDepths, Option<&ViewDepthRange>)>,
    bounds: Res<ObjectBounds>,
    binder: Binder,
    mut ctx: RenderContext,
) {
    let (pass, table, range) = view.into_inner();
    let keys = range.and_then(ViewDepthRange::drawn);
    let (Some(pipeline), Some(uniform), Some(objects), true) = (
        binder.cache.get_compute_pipeline(pass.pipeline),
        pass.uniform.binding(),
        bounds.table.binding(),
        keys.is_some() || !pass.reads_range(),
    ) else {
        ctx.command_encoder().clear_buffer(&table.table, 0, None);
        return;
    };
    let mut entries = vec![
        entry(0, uniform),
        entry(1, objects),
        entry(2, table.table.as_entire_binding()),
    ];
    if let Some(keys) = keys.filter(|_| pass.reads_range()) {
        entries.push(entry(3, keys.as_entire_binding()));
    }
    let layout = ObjectDepthPipeline::layout(pass.reads_range());
    let group = binder.group("comics_object_depths", &layout, &entries);
    let encoder = ctx.command_encoder();
    let mut compute = compute_pass(encoder, "comics_object_depths", (pipeline, &group), &[]);
    compute.dispatch_workgroups((bounds.table.len() as u32).div_ceil(64), 1, 1);
}

fn init_pipeline(
    mut commands: Commands,
    assets: Res<AssetServer>,
    views: Query<Entity, With<ObjectDepths>>,
) {
    // This runs again after a lost device, whose buffers are no longer valid.
    for view in &views {
        commands
            .entity(view)
            .remove::<(ObjectDepths, ObjectDepthPass)>();
    }
    commands.insert_resource(ObjectDepthPipeline {
        shader: load_embedded_asset!(assets.as_ref(), "depths.wgsl"),
    });
}

/// Adds the pass to the render world.
pub(super) fn build(render_app: &mut SubApp) {
    render_app
        .init_gpu_resource::<ObjectBounds>()
        .init_gpu_resource::<SpecializedComputePipelines<ObjectDepthPipeline>>()
        .add_systems(RenderStartup, init_pipeline)
        .add_systems(ExtractSchedule, extract_bounds.after(NoteChanges))
        .add_systems(
            Render,
            prepare_object_depths.in_set(PrepareComics::Services),
        )
        .add_systems(
            Core3d,
            find_object_depths
                .after(ComicsSystems::DepthRange)
                .before(ComicsSystems::Outlines)
                .before(Core3dSystems::MainPass),
        );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_hold_the_corners_of_the_mesh() {
        let aabb = Aabb::from_min_max(Vec3::new(-1.0, 0.0, -2.0), Vec3::new(3.0, 1.0, 4.0));
        let at = Transform {
            translation: Vec3::new(5.0, -2.0, 1.0),
            rotation: Quat::from_rotation_y(0.7) * Quat::from_rotation_x(-0.4),
            scale: Vec3::new(1.0, -2.0, 0.5),
        };
        let at = GlobalTransform::from(at);
        let found = Bounds::of(&aabb, &at).expect("finite");
        let mut tight = None::<Bounds>;
        for corner in 0..8 {
            let side = |axis: usize| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
            let half = Vec3::from(aabb.half_extents) * Vec3::new(side(0), side(1), side(2));
            let place = at.transform_point(Vec3::from(aabb.center) + half);
            let point = Bounds {
                low: place,
                high: place,
            };
            tight = Some(tight.map_or(point, |tight| tight.with(point)));
        }
        let tight = tight.expect("corners");
        assert!(found.low.distance(tight.low) < 1e-5, "{found:?}, {tight:?}");
        assert!(
            found.high.distance(tight.high) < 1e-5,
            "{found:?}, {tight:?}"
        );
        let nowhere = GlobalTransform::from(Transform::from_xyz(f32::NAN, 0.0, 0.0));
        assert_eq!(Bounds::of(&aabb, &nowhere), None);
    }
}
