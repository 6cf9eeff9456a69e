//! What object ids are drawn with instead of the view's depth, if their depth is compared with a
//! tolerance: a depth texture of their own, and the depth of the prepass as a texture.
//!
//! A depth test alone cannot do it. A bias in front of the prepass, or depth of their own without
//! the prepass, would give ids to what an alpha mask has cut away, because that lies in front.
//! Only a comparison from both sides needs no code of the materials.

use bevy::{
    core_pipeline::{core_3d::CORE_3D_DEPTH_FORMAT, prepass::ViewPrepassTextures},
    ecs::{
        component::Component,
        entity::Entity,
        query::{With, Without},
        system::{Commands, Query, Res, ResMut},
    },
    render::{
        render_resource::{
            BindGroup, LoadOp, Operations, RenderPassDepthStencilAttachment, StoreOp,
            TextureUsages, UniformBuffer,
        },
        texture::{CachedTexture, TextureCache},
        view::ExtractedView,
    },
};

use super::DepthTest;
use crate::{
    gpu::texture,
    objects::{IdRequest, Pressure, line_widths::Drawing},
};

/// On a view whose ids are drawn with a tolerance in this frame.
#[derive(Component)]
pub(in crate::objects) struct TolerantIds {
    depth: CachedTexture,
    pressure: UniformBuffer<Pressure>,
    /// What the pass binds instead of `ObjectIdPhase::bind_group`; `None` if there is no object.
    pub bind_group: Option<BindGroup>,
}

impl TolerantIds {
    /// The depth attachment of the pass. Nothing reads it later.
    pub fn attachment(&self) -> RenderPassDepthStencilAttachment<'_> {
        RenderPassDepthStencilAttachment {
            view: &self.depth.default_view,
            depth_ops: Some(Operations {
                load: LoadOp::Clear(0.0),
                store: StoreOp::Discard,
            }),
            stencil_ops: None,
        }
    }
}

/// The views whose ids are drawn, and those whose ids are no longer drawn.
type Views<'w, 's> = (
    Query<
        'w,
        's,
        (
            Entity,
            &'static ExtractedView,
            &'static IdRequest,
            Option<&'static ViewPrepassTextures>,
            Option<&'static mut TolerantIds>,
        ),
    >,
    Query<'w, 's, Entity, (With<TolerantIds>, Without<IdRequest>)>,
);

/// Gets the textures of this frame, and binds the depth of the prepass.
pub(super) fn prepare_tolerant_ids(
    mut commands: Commands,
    (mut views, stale): Views,
    test: Res<DepthTest>,
    drawing: Drawing,
    mut textures: ResMut<TextureCache>,
) {
    for view in &stale {
        commands.entity(view).remove::<TolerantIds>();
    }
    for (entity, view, request, prepass, known) in &mut views {
        let mut target = commands.entity(entity);
        let found = prepass
            .and_then(|prepass| prepass.depth.as_ref())
            .map(|depth| &depth.texture)
            .filter(|depth| depth.texture.sample_count() == request.samples);
        let (true, Some(found)) = (test.tolerant(), found) else {
            target.remove::<TolerantIds>();
            continue;
        };
        let descriptor = texture(
            "comics_object_id_depth",
            (request.size, request.samples),
            CORE_3D_DEPTH_FORMAT,
            TextureUsages::RENDER_ATTACHMENT,
        );
        let view = view.retained_view_entity;
        let known = known.map(|mut known| std::mem::take(&mut known.pressure));
        let mut pressure = known.unwrap_or_default();
        let bound = if drawing.draws_widths(view) {
            pressure.set(request.pressure.unwrap_or_default());
            pressure.write_buffer(&drawing.binder.device, &drawing.queue);
            pressure.binding()
        } else {
            None
        };
        let depth = Some(&found.default_view);
        let bind_group = drawing.bind_group((view, request), bound, depth);
        target.insert(TolerantIds {
            depth: textures.get(&drawing.binder.device, descriptor),
            pressure,
            bind_group,
        });
    }
}
