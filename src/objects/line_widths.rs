//! Meshes whose vertices say how wide lines are, and the views whose widths of lines are drawn.

use bevy::{
    platform::collections::HashSet,
    prelude::*,
    render::{
        render_resource::{LoadOp, RenderPassColorAttachment},
        view::RetainedViewEntity,
    },
};

use super::{
    IdRequest, IdsWanted, ObjectStyles, ViewLineWidths,
    inherit::{Inherited, Values},
};
use crate::gpu;

/// The alpha of this mesh's vertex colors ([`Mesh::ATTRIBUTE_COLOR`]) is the width of its lines:
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
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct LineWidths {
    /// Applies to all descendants as well, for example on the root of a glTF scene. Default:
    /// `true`.
    pub inherit: bool,
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
        styles.flags.widths = !meshes.0.is_empty();
    }
}

/// The views whose meshes were queued with pipelines that draw widths too.
#[derive(Resource, Default)]
pub(super) struct WidthViews(HashSet<RetainedViewEntity>);

impl WidthViews {
    pub fn clear(&mut self) {
        self.0.clear();
    }

    pub fn contains(&self, view: RetainedViewEntity) -> bool {
        self.0.contains(&view)
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

/// A texel of the texture that is the factor 1.
const ONE: f32 = 127.0 / 255.0;

/// The attachment of the pass that draws widths, cleared to the factor 1.
pub(super) fn width_attachment(widths: &ViewLineWidths) -> RenderPassColorAttachment<'_> {
    let one = LinearRgba::rgb(ONE, ONE, ONE);
    gpu::attachment(&widths.view, LoadOp::Clear(one.into()))
}
