//! Meshes whose vertices say how wide lines are, and the preparation of the texture that the
//! pass of object ids draws their widths and the pressure into.

use bevy::{
    color::LinearRgba,
    ecs::{
        component::Component,
        entity::Entity,
        query::{Or, With, Without},
        reflect::ReflectComponent,
        resource::Resource,
        system::{Commands, Query, Res, ResMut, SystemParam},
    },
    platform::collections::HashSet,
    reflect::{Reflect, std_traits::ReflectDefault},
    render::{
        render_resource::{
            BindGroup, BindingResource, IntoBinding, LoadOp, RenderPassColorAttachment,
            TextureUsages, TextureView, UniformBuffer,
        },
        renderer::RenderQueue,
        texture::TextureCache,
        view::{ExtractedView, RetainedViewEntity},
    },
};

use super::{
    IdRequest, IdsWanted, ObjectStyles, Pressure, ViewLineWidths,
    inherit::{Inherited, Values},
    phase::ObjectIdPhases,
    pipeline::{ObjectIdPipeline, with_prepass_depth},
    sections::SectionBuffer,
    widths::WIDTH_FORMAT,
};
use crate::{bind_groups::Binder, gpu};

/// The alpha of this mesh's vertex colors
/// ([`Mesh::ATTRIBUTE_COLOR`](bevy::mesh::Mesh::ATTRIBUTE_COLOR)) is the width of its lines:
/// 0 is no line, 0.5 the width that lines have otherwise, 1 twice that width.
///
/// In between, the width changes gradually; over the surface, it is interpolated as vertex colors
/// are. It multiplies the factors of the camera's [`LineWeight`](crate::lines::LineWeight); its
/// product with [`pressure`](crate::lines::LineWeight::pressure) is 2 at most. It applies to lines
/// of the corrected equations, on devices with compute shaders. A line belongs to the surface in
/// front; the width of creases and object edges is the mean over both sides.
///
/// A mesh without vertex colors has the factor 1, and the log warns once. The engine
/// multiplies the material's color by vertex colors: with [`AlphaMode::Opaque`] the alpha
/// changes no picture, with [`AlphaMode::Mask`] it is compared with the cutoff. A material with
/// a prepass vertex shader of its own must write the fields of the engine's prepass
/// `VertexOutput`.
///
/// While some mesh has it, object ids and a texture of one byte per pixel (and sample) are
/// drawn for every camera with outlines.
///
/// [`AlphaMode::Opaque`]: bevy::prelude::AlphaMode::Opaque
/// [`AlphaMode::Mask`]: bevy::prelude::AlphaMode::Mask
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct LineWidths {
    /// Applies to all descendants as well, for example on the root of a glTF scene. Default:
    /// `true`.
    pub inherit: bool,
}

impl Default for LineWidths {
    fn default() -> Self {
        Self { inherit: true }
    }
}

/// The meshes with [`LineWidths`].
pub(super) type WideMeshes = Values<LineWidths, ()>;

/// Keeps [`WideMeshes`] up to date.
pub(super) fn find_wide_meshes(
    mut marked: Inherited<LineWidths>,
    mut meshes: ResMut<WideMeshes>,
    mut styles: ResMut<ObjectStyles>,
) {
    if !meshes.update(&mut marked, |_| ()).is_empty() {
        styles.widths = !meshes.0.is_empty();
    }
}

/// The views whose meshes were queued with pipelines that draw widths too.
#[derive(Resource, Default)]
pub(super) struct WidthViews(HashSet<RetainedViewEntity>);

impl WidthViews {
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Decides for a view. `wanted`: by the plan of its camera; `before`: the request of the
    /// last frame, whose plan may still be drawn.
    pub fn decide(
        &mut self,
        view: RetainedViewEntity,
        wanted: Option<&IdsWanted>,
        before: Option<&IdRequest>,
    ) -> bool {
        let draws = wanted.is_some_and(|wanted| wanted.widths)
            || before.is_some_and(|before| before.pressure.is_some());
        if draws {
            self.0.insert(view);
        }
        draws
    }
}

/// On a view whose widths are drawn.
#[derive(Component, Default)]
pub(super) struct WidthBindings {
    pressure: UniformBuffer<Pressure>,
    /// What the pass binds instead of `ObjectIdPhase::bind_group`; `None` if there is no object.
    pub group: Option<BindGroup>,
}

/// What binds the objects of a view.
#[derive(SystemParam)]
pub(super) struct Drawing<'w> {
    queued: Res<'w, WidthViews>,
    phases: Res<'w, ObjectIdPhases>,
    sections: Res<'w, SectionBuffer>,
    shared: Res<'w, ObjectIdPipeline>,
    pub binder: Binder<'w>,
    pub queue: Res<'w, RenderQueue>,
}

impl Drawing<'_> {
    /// Whether the widths of a view are drawn.
    pub fn draws_widths(&self, view: RetainedViewEntity) -> bool {
        self.queued.0.contains(&view)
    }

    /// What the pass of object ids binds; `None` without an object. `pressure`: that
    /// of its lines, if their widths are drawn; `depth`: that of the prepass, if depth is compared
    /// with a tolerance.
    pub fn bind_group(
        &self,
        (view, request): (RetainedViewEntity, &IdRequest),
        pressure: Option<BindingResource>,
        depth: Option<&TextureView>,
    ) -> Option<BindGroup> {
        let [objects, sections] = self.phases.views.get(&view)?.bound(&self.sections)?;
        let mut entries = vec![
            gpu::entry(0, objects.as_entire_binding()),
            gpu::entry(1, sections.as_entire_binding()),
        ];
        let mut layout = if let Some(pressure) = pressure {
            entries.push(gpu::entry(2, pressure));
            self.shared.with_widths.clone()
        } else {
            self.shared.layout.clone()
        };
        if let Some(depth) = depth {
            entries.push(gpu::entry(3, depth.into_binding()));
            layout = with_prepass_depth(&layout, request.samples > 1);
        }
        Some(
            self.binder
                .group("comics_objects_of_view", &layout, &entries),
        )
    }
}

/// Views with widths that may no longer have them.
type Stale = (
    Or<(With<ViewLineWidths>, With<WidthBindings>)>,
    Without<IdRequest>,
);

/// Gets the textures of this frame, and binds what is drawn into them.
pub(super) fn prepare_line_widths(
    mut commands: Commands,
    mut views: Query<(
        Entity,
        &ExtractedView,
        &IdRequest,
        Option<&mut WidthBindings>,
    )>,
    stale: Query<Entity, Stale>,
    drawing: Drawing,
    mut textures: ResMut<TextureCache>,
) {
    for (entity, view, request, known) in &mut views {
        let mut target = commands.entity(entity);
        if !drawing.draws_widths(view.retained_view_entity) {
            target.remove::<(ViewLineWidths, WidthBindings)>();
            continue;
        }
        let mut bindings = known
            .map(|mut known| std::mem::take(&mut *known))
            .unwrap_or_default();
        bindings.pressure.set(request.pressure.unwrap_or_default());
        (bindings.pressure).write_buffer(&drawing.binder.device, &drawing.queue);
        let view = view.retained_view_entity;
        let pressure = bindings.pressure.binding();
        bindings.group = drawing.bind_group((view, request), pressure, None);
        let usage = TextureUsages::RENDER_ATTACHMENT
            | TextureUsages::TEXTURE_BINDING
            | TextureUsages::COPY_SRC;
        let size = (request.size, request.samples);
        let descriptor = gpu::texture("comics_line_widths", size, WIDTH_FORMAT, usage);
        let texture = ViewLineWidths::from(textures.get(&drawing.binder.device, descriptor));
        target.insert((texture, bindings));
    }
    for entity in &stale {
        let mut target = commands.entity(entity);
        target.remove::<(ViewLineWidths, WidthBindings)>();
    }
}

/// A texel of the texture that is the factor 1.
const ONE: f32 = 127.0 / 255.0;

/// The attachment of the pass that draws widths, cleared to the factor 1.
pub(super) fn width_attachment(widths: &ViewLineWidths) -> RenderPassColorAttachment<'_> {
    let one = LinearRgba::rgb(ONE, ONE, ONE);
    gpu::attachment(&widths.view, LoadOp::Clear(one.into()))
}
