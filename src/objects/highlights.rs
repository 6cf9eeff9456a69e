//! Components that outline single objects in every view: selected ones, and the hidden parts
//! of others.

use bevy::{prelude::*, render::sync_world::MainEntityHashSet};

use super::{
    changes::Follow,
    inherit::{Either, Inherited, register},
    shared::Shared,
    table::{HIDDEN_ONLY, ObjectStyleUniform, ObjectStyles, VISIBLE_ONLY},
};
use crate::settings::{FieldRange, impl_sanitized, linear_rgb};

/// Bits of `ObjectStyleUniform::kinds`.
const SILHOUETTES: u32 = 1;
const OBJECT_EDGES: u32 = 4;

/// Draws an outline around this object, for what the player has selected or points at. It shows
/// through objects in front unless [`occluded`](Self::occluded) is `false`.
///
/// Nothing else is needed: every `Camera3d` that sees the object draws the outline, over its other
/// effects. All meshes of the object share one outline, along the border of the area that they
/// cover together. Objects in the depth prepass can have it (opaque and alpha-masked ones; the
/// holes of an alpha mask count as covered).
///
/// An object that also has an [`XRayOutline`] has only this outline.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct SelectionOutline {
    /// Color of the line, clamped to what a display shows; its alpha is not used.
    /// Default: orange.
    pub color: Color,
    /// Width of the line in logical pixels. Range 0.5 to 16, default 3.
    #[reflect(@FieldRange::linear(0.5, 16.0).unit("px"))]
    pub width: f32,
    /// Opacity of the line. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
    /// Whether the outline shows through objects in front. Default: `true`.
    pub occluded: bool,
    /// Applies to all descendants as well, except for those with a `SelectionOutline` or
    /// [`XRayOutline`] of their own. Default: `true`.
    pub inherit: bool,
}

impl Default for SelectionOutline {
    fn default() -> Self {
        Self {
            color: Color::Srgba(Srgba::new(1.0, 0.55, 0.05, 1.0)),
            width: 3.0,
            opacity: 1.0,
            occluded: true,
            inherit: true,
        }
    }
}

/// Outlines the hidden parts of this object over what hides them: for a character behind a
/// wall.
///
/// All of its silhouettes are drawn, also those inside of it, where other objects hide it. If the
/// object has a [`SelectionOutline`] too, only that is drawn.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct XRayOutline {
    /// Color of the lines, clamped to what a display shows; its alpha is not used.
    /// Default: light blue.
    pub color: Color,
    /// Width of the lines in logical pixels. Range 0.5 to 16, default 2.
    #[reflect(@FieldRange::linear(0.5, 16.0).unit("px"))]
    pub width: f32,
    /// Opacity of the lines. Range 0 to 1, default 0.8.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
    /// Applies to all descendants as well, except for those with an `XRayOutline` or
    /// [`SelectionOutline`] of their own. Default: `true`.
    pub inherit: bool,
}

impl Default for XRayOutline {
    fn default() -> Self {
        Self {
            color: Color::Srgba(Srgba::new(0.45, 0.8, 1.0, 1.0)),
            width: 2.0,
            opacity: 0.8,
            inherit: true,
        }
    }
}

/// A line with this color, width and opacity. `kinds`: those that are drawn.
fn line_style((color, width, opacity): (Color, f32, f32), kinds: u32) -> ObjectStyleUniform {
    ObjectStyleUniform {
        color: linear_rgb(color),
        has_color: 1.0,
        half_width: 0.5 * width,
        kinds,
        opacity,
        ..Default::default()
    }
}

impl_sanitized!(SelectionOutline, XRayOutline);

impl SelectionOutline {
    /// Only the border against other objects.
    fn uniform(self) -> ObjectStyleUniform {
        let visible = if self.occluded { 0 } else { VISIBLE_ONLY };
        let s = self.sanitized();
        line_style((s.color, s.width, s.opacity), OBJECT_EDGES | visible)
    }
}

impl XRayOutline {
    /// Silhouettes and the border against other objects.
    fn uniform(self) -> ObjectStyleUniform {
        let kinds = SILHOUETTES | OBJECT_EDGES | HIDDEN_ONLY;
        let s = self.sanitized();
        line_style((s.color, s.width, s.opacity), kinds)
    }
}

/// The objects that are outlined by themselves. Both worlds have a copy.
#[derive(Resource, Default)]
pub(crate) struct HighlightedObjects {
    /// The lines of these objects.
    pub styles: ObjectStyles,
    /// The entity whose component highlights a mesh.
    roots: Shared<Entity>,
}

impl HighlightedObjects {
    /// The entity whose component highlights a mesh, and the slot of its lines.
    pub fn of(&self, mesh: Entity) -> Option<(Entity, u8)> {
        let slot = self.styles.slots.get(mesh)?;
        Some((*self.roots.get(mesh)?, *slot))
    }
}

impl Follow for HighlightedObjects {
    fn follow(&mut self, main: &Self, changed: &mut MainEntityHashSet) {
        self.styles.follow(&main.styles, changed);
        self.roots.follow(&main.roots, changed);
    }
}

type Highlight = Either<SelectionOutline, XRayOutline>;

/// The lines of an object with one of the components; `None` if they are not seen.
fn lines(
    (selected, hidden): (Option<&SelectionOutline>, Option<&XRayOutline>),
) -> Option<ObjectStyleUniform> {
    let hidden = || hidden.map(|hidden| hidden.uniform());
    let lines = selected.map(|selected| selected.uniform()).or_else(hidden);
    lines.filter(|lines| lines.opacity > 0.0)
}

fn assign_highlights(
    mut highlighted: Inherited<Highlight>,
    (mut highlights, mut styles): (ResMut<HighlightedObjects>, ResMut<ObjectStyles>),
) {
    let changed = highlighted.update();
    if changed.is_empty() {
        return;
    }
    let highlights = &mut *highlights;
    highlights.roots.begin();
    let changed = changed.into_iter().map(|mesh| {
        let (root, lines) = highlighted
            .of(mesh)
            .map(|(root, parts)| (root, lines(parts)))
            .unzip();
        highlights.roots.set(mesh, root);
        (mesh, lines.flatten())
    });
    highlights.styles.assign(changed);
    styles.flags.highlights = highlights.styles.any();
}

pub(super) fn build(app: &mut App) {
    register::<SelectionOutline>(app);
    register::<XRayOutline>(app);
    app.init_resource::<HighlightedObjects>().add_systems(
        PostUpdate,
        assign_highlights.after(super::components::assign_object_styles),
    );
}
