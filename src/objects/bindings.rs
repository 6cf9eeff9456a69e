//! What the pass of object ids binds and draws to, besides ids, where the widths of lines are drawn
//! too, and where depth is compared with a tolerance: then it has a depth texture of its own, and
//! the depth of the prepass as a texture.
//!
//! A depth test alone cannot compare with a tolerance. A bias in front of the prepass, or depth of
//! their own without the prepass, would give ids to what an alpha mask has cut away, because that
//! lies in front. Only a comparison from both sides needs no code of the materials.

use bevy::{
    core_pipeline::{core_3d::CORE_3D_DEPTH_FORMAT, prepass::ViewPrepassTextures},
    prelude::*,
    render::{
        render_resource::{BindGroup, IntoBinding, TextureUsages, UniformBuffer},
        renderer::RenderQueue,
        texture::{CachedTexture, TextureCache},
        view::ExtractedView,
    },
};

use super::{
    IdRequest, Pressure, ViewLineWidths,
    depth_test::DepthTest,
    line_widths::WidthViews,
    phase::ObjectIdPhases,
    pipeline::{ObjectIdPipeline, with_prepass_depth},
    sections::SectionBuffer,
    widths::WIDTH_FORMAT,
};
use crate::{
    bind_groups::Binder,
    gpu::{self, entry},
};

/// On a view whose widths are drawn, or whose ids are drawn with a tolerance in this frame.
#[derive(Component, Default)]
pub(super) struct IdBindings {
    pressure: UniformBuffer<Pressure>,
    /// The depth texture of ids that are drawn with a tolerance.
    pub depth: Option<CachedTexture>,
    /// What the pass binds instead of `InstanceBuffers::bound`; `None` if there is no object.
    pub group: Option<BindGroup>,
}

/// Gets the textures of this frame, and binds what is drawn into them.
pub(super) fn prepare_id_bindings(
    mut commands: Commands,
    mut views: Query<(
        Entity,
        &ExtractedView,
        &IdRequest,
        Option<&ViewPrepassTextures>,
        Option<&mut IdBindings>,
    )>,
    stale: Query<Entity, (With<IdBindings>, Without<IdRequest>)>,
    (queued, phases, test): (Res<WidthViews>, Res<ObjectIdPhases>, Res<DepthTest>),
    (sections, shared): (Res<SectionBuffer>, Res<ObjectIdPipeline>),
    (binder, queue): (Binder, Res<RenderQueue>),
    mut textures: ResMut<TextureCache>,
) {
    for (entity, view, request, prepass, known) in &mut views {
        let view = view.retained_view_entity;
        let mut target = commands.entity(entity);
        let draws_widths = queued.contains(view);
        let found = prepass
            .and_then(|prepass| prepass.depth.as_ref())
            .map(|depth| &depth.texture)
            .filter(|depth| test.tolerant() && depth.texture.sample_count() == request.samples);
        if !draws_widths && found.is_none() {
            target.remove::<(ViewLineWidths, IdBindings)>();
            continue;
        }
        let mut texture = |label, format, usage| {
            let usage = usage | TextureUsages::RENDER_ATTACHMENT;
            let size = (request.size, request.samples);
            textures.get(&binder.device, gpu::texture(label, size, format, usage))
        };
        let known = known.map(|mut known| std::mem::take(&mut known.pressure));
        let mut pressure = known.unwrap_or_default();
        if draws_widths {
            pressure.set(request.pressure.unwrap_or_default());
            pressure.write_buffer(&binder.device, &queue);
            let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
            let widths = texture("comics_line_widths", WIDTH_FORMAT, read);
            target.insert(ViewLineWidths::from(widths));
        } else {
            target.remove::<ViewLineWidths>();
        }
        let depth = found.map(|_| {
            let unread = TextureUsages::empty();
            texture("comics_object_id_depth", CORE_3D_DEPTH_FORMAT, unread)
        });
        let bound = phases.views.get(&view);
        let bound = bound.and_then(|phase| phase.bound(&sections));
        let group = bound.map(|[objects, sections]| {
            let mut entries = vec![
                entry(0, objects.as_entire_binding()),
                entry(1, sections.as_entire_binding()),
            ];
            let mut layout = shared.layout.clone();
            if let Some(pressure) = pressure.binding().filter(|_| draws_widths) {
                entries.push(entry(2, pressure));
                layout = shared.with_widths.clone();
            }
            if let Some(found) = found {
                entries.push(entry(3, (&found.default_view).into_binding()));
                layout = with_prepass_depth(&layout, request.samples > 1);
            }
            binder.group("comics_objects_of_view", &layout, &entries)
        });
        target.insert(IdBindings {
            pressure,
            depth,
            group,
        });
    }
    for entity in &stale {
        let mut target = commands.entity(entity);
        target.remove::<(ViewLineWidths, IdBindings)>();
    }
}
