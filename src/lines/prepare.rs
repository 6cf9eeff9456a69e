//! Prepares the textures and uniforms of the views whose lines are requested.

use std::sync::atomic::{AtomicBool, Ordering};

use bevy::{
    ecs::{
        component::Component,
        entity::Entity,
        query::{With, Without},
        system::{Commands, Query, Res, ResMut},
    },
    math::UVec2,
    render::{
        render_resource::{
            Extent3d, TextureDescriptor, TextureDimension, TextureUsages, UniformBuffer,
        },
        renderer::{RenderDevice, RenderQueue},
        texture::{CachedTexture, TextureCache},
    },
};

use super::{
    pipelines::{EDGE_FORMAT, GATHER_REACH},
    request::{LinePassUniform, LinePasses, LineRequest},
};

/// On a view in the render world: the lines of this frame.
#[derive(Component)]
pub(crate) struct ViewLines {
    pub uniform: UniformBuffer<LinePassUniform>,
    /// The edge of every pixel, see `edge.wgsl`.
    pub edges: Option<CachedTexture>,
    /// The flood's textures and strides, if there is a flood.
    pub flood: Option<Flood>,
    /// Whether the passes of this frame were recorded.
    pub found: AtomicBool,
}

impl Default for ViewLines {
    fn default() -> Self {
        let mut uniform = UniformBuffer::default();
        uniform.set_label(Some("comics_lines"));
        Self {
            uniform,
            edges: None,
            flood: None,
            found: AtomicBool::new(false),
        }
    }
}

impl ViewLines {
    /// The edges; `None` unless the passes of this frame were recorded.
    pub fn found(&self) -> Option<&CachedTexture> {
        let found = self.found.load(Ordering::Relaxed);
        self.edges.as_ref().filter(|_| found)
    }
}

/// A jump flood: a first step, then one for each stride. The steps alternate between
/// two textures.
pub(crate) struct Flood {
    pub strides: Vec<u32>,
    pub textures: [CachedTexture; 2],
}

impl Flood {
    /// The strides, in pixels, of a flood over a distance of `reach` pixels. Beyond
    /// [`GATHER_REACH`] the last two are repeated, which corrects nearly all errors of
    /// the flood.
    pub fn strides(reach: i32) -> Vec<u32> {
        let longest = (reach.max(1) as u32).next_power_of_two();
        let halving = (0..=longest.ilog2()).rev().map(|k| 1 << k);
        let again = [2, 1].into_iter().filter(|_| reach > GATHER_REACH);
        halving.chain(again).collect()
    }

    /// The texture that the last step writes.
    pub fn result(&self) -> &CachedTexture {
        &self.textures[self.strides.len() % 2]
    }
}

fn texture(
    textures: &mut TextureCache,
    device: &RenderDevice,
    label: &'static str,
    size: UVec2,
) -> CachedTexture {
    let descriptor = TextureDescriptor {
        label: Some(label),
        size: Extent3d {
            width: size.x,
            height: size.y,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: EDGE_FORMAT,
        usage: TextureUsages::RENDER_ATTACHMENT
            | TextureUsages::TEXTURE_BINDING
            | TextureUsages::COPY_SRC,
        view_formats: &[],
    };
    textures.get(device, descriptor)
}

pub(crate) fn prepare_view_lines(
    mut commands: Commands,
    mut views: Query<(Entity, &LineRequest, &LinePasses, Option<&mut ViewLines>)>,
    stale: Query<Entity, (With<ViewLines>, Without<LineRequest>)>,
    mut textures: ResMut<TextureCache>,
    (device, queue): (Res<RenderDevice>, Res<RenderQueue>),
) {
    for (entity, request, passes, lines) in &mut views {
        let mut fill = |lines: &mut ViewLines| {
            let mut new = |label| texture(&mut textures, &device, label, request.size);
            lines.edges = Some(new("comics_edges"));
            lines.flood = passes.flood.map(|_| Flood {
                strides: Flood::strides(request.lines.reach),
                textures: [new("comics_lines"), new("comics_lines")],
            });
            lines.found = AtomicBool::new(false);
            lines.uniform.set(LinePassUniform {
                view: request.view,
                lines: request.lines,
            });
            lines.uniform.write_buffer(&device, &queue);
        };
        match lines {
            Some(mut lines) => fill(&mut lines),
            None => {
                let mut lines = ViewLines::default();
                fill(&mut lines);
                commands.entity(entity).insert(lines);
            }
        }
    }
    for entity in &stale {
        commands.entity(entity).remove::<ViewLines>();
    }
}
