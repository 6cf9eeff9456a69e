//! Components that outline single objects in every view: selected ones, and the hidden parts
//! of others.

use bevy::{
    app::{App, PostUpdate},
    color::{Color, Srgba},
    ecs::{
        change_detection::{DetectChanges, DetectChangesMut},
        component::Component,
        entity::{Entity, EntityHashMap},
        hierarchy::Children,
        query::{Or, With},
        reflect::ReflectComponent,
        resource::Resource,
        schedule::IntoScheduleConfigs,
        system::{Query, Res, ResMut},
    },
    reflect::{Reflect, std_traits::ReflectDefault},
    render::Extract,
};

use super::{
    changes::ChangedObjects,
    inherit::{Inherited, inherit},
    table::{HIDDEN_ONLY, ObjectStyleUniform, ObjectStyles},
};
use crate::settings::{FieldRange, clamp_color, clamp_or_default, linear_rgb};

/// Bits of `ObjectStyleUniform::kinds`.
const SILHOUETTES: u32 = 1;
const OBJECT_EDGES: u32 = 4;

/// Outlines this object in the picture, also where others hide it: for what the player has
/// selected or points at.
///
/// Nothing else is needed: every `Camera3d` that sees the object draws the outline, over its
/// other effects. All meshes of the object together have one outline, along the border of
/// what they cover. Objects in the depth prepass can have it (opaque and alpha-masked ones;
/// the holes of an alpha mask count as covered).
///
/// An object that also has an [`XRayOutline`] has only this outline.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct SelectionOutline {
    /// Colour of the line, clamped to what a display shows; its alpha is not used.
    /// Default: orange.
    pub color: Color,
    /// Width of the line in logical pixels. Range 0.5 to 16, default 3.
    #[reflect(@FieldRange::linear(0.5, 16.0).unit("px"))]
    pub width: f32,
    /// Opacity of the line. Range 0 to 1, default 1.
    #[reflect(@FieldRange::FRACTION)]
    pub opacity: f32,
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
            inherit: true,
        }
    }
}

/// Outlines the hidden parts of this object over what hides them: for a character behind a
/// wall.
///
/// Its silhouettes are drawn where other objects are in front of it. Where it can be seen,
/// there is no such line. Otherwise as a [`SelectionOutline`].
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct XRayOutline {
    /// Colour of the lines, clamped to what a display shows; its alpha is not used.
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

/// Colour, width and opacity of a line in their documented ranges.
fn bounded_line(
    (color, width, opacity): (Color, f32, f32),
    (default_color, default_width, default_opacity): (Color, f32, f32),
) -> (Color, f32, f32) {
    (
        clamp_color(color, default_color),
        clamp_or_default(width, default_width, 0.5, 16.0),
        clamp_or_default(opacity, default_opacity, 0.0, 1.0),
    )
}

/// A line with this colour, width and opacity. `kinds`: those that are drawn.
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

impl SelectionOutline {
    fn line(self) -> (Color, f32, f32) {
        (self.color, self.width, self.opacity)
    }

    /// The settings that are used: numbers and colour in their documented ranges.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let (color, width, opacity) = bounded_line(self.line(), Self::default().line());
        Self {
            color,
            width,
            opacity,
            ..self
        }
    }

    /// Only the border against other objects.
    fn uniform(self) -> ObjectStyleUniform {
        line_style(self.sanitized().line(), OBJECT_EDGES)
    }
}

impl XRayOutline {
    fn line(self) -> (Color, f32, f32) {
        (self.color, self.width, self.opacity)
    }

    /// The settings that are used: numbers and colour in their documented ranges.
    #[must_use]
    pub fn sanitized(self) -> Self {
        let (color, width, opacity) = bounded_line(self.line(), Self::default().line());
        Self {
            color,
            width,
            opacity,
            ..self
        }
    }

    /// Silhouettes and the border against other objects.
    fn uniform(self) -> ObjectStyleUniform {
        let kinds = SILHOUETTES | OBJECT_EDGES | HIDDEN_ONLY;
        line_style(self.sanitized().line(), kinds)
    }
}

/// The objects that are outlined by themselves. Both worlds have a copy.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub(crate) struct Marks {
    /// The lines of these objects.
    pub styles: ObjectStyles,
    /// The entity whose component marks a mesh.
    roots: EntityHashMap<Entity>,
}

impl Marks {
    /// The entity whose component marks a mesh, and the slot of its lines.
    pub fn of(&self, mesh: Entity) -> Option<(Entity, u8)> {
        let slot = self.styles.slots.get(&mesh)?;
        Some((*self.roots.get(&mesh)?, *slot))
    }
}

/// Either component.
type Marked = Or<(With<SelectionOutline>, With<XRayOutline>)>;

fn assign_marks(
    marked: Query<(Entity, Option<&SelectionOutline>, Option<&XRayOutline>), Marked>,
    children: Query<&Children>,
    (mut marks, mut styles): (ResMut<Marks>, ResMut<ObjectStyles>),
    (mut selected, mut x_ray): (Inherited<SelectionOutline>, Inherited<XRayOutline>),
) {
    // Both are asked, so that each forgets what was removed.
    let changed = [selected.is_changed(), x_ray.is_changed()].contains(&true);
    if !changed || (marked.is_empty() && !marks.styles.any()) {
        return;
    }
    let mut found: EntityHashMap<(Entity, ObjectStyleUniform)> = EntityHashMap::default();
    for (entity, selected, hidden) in &marked {
        let (uniform, inherited) = match (selected, hidden) {
            (Some(selected), _) => (selected.uniform(), selected.inherit),
            (None, Some(hidden)) => (hidden.uniform(), hidden.inherit),
            (None, None) => continue,
        };
        let own = |child| marked.contains(child);
        inherit(
            &mut found,
            (entity, (entity, uniform)),
            inherited,
            &children,
            own,
        );
    }
    let mut table = Marks::default();
    for (mesh, (root, uniform)) in &found {
        if uniform.opacity > 0.0 {
            let slot = table.styles.slot(*uniform);
            table.styles.slots.insert(*mesh, slot);
            table.roots.insert(*mesh, *root);
        }
    }
    let any = table.styles.any();
    marks.set_if_neq(table);
    if styles.marks != any {
        styles.marks = any;
    }
}

pub(super) fn extract_marks(
    main: Extract<Res<Marks>>,
    mut marks: ResMut<Marks>,
    mut changed: ResMut<ChangedObjects>,
) {
    if main.is_changed() {
        changed.note(&marks.styles.slots, &main.styles.slots);
        changed.note(&marks.roots, &main.roots);
        marks.clone_from(&main);
    }
}

pub(super) fn build(app: &mut App) {
    app.register_type::<SelectionOutline>()
        .register_type::<XRayOutline>()
        .init_resource::<Marks>()
        .add_systems(
            PostUpdate,
            assign_marks.after(super::components::assign_object_styles),
        );
}
