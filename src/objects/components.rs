//! Components on mesh entities.

use bevy::{
    color::Color,
    ecs::{
        change_detection::DetectChangesMut,
        component::Component,
        entity::Entity,
        hierarchy::Children,
        query::{Or, With},
        reflect::ReflectComponent,
        system::{Query, ResMut},
    },
    reflect::{Reflect, std_traits::ReflectDefault},
};

use super::table::{ObjectStyleUniform, ObjectStyles};
use crate::settings::{bounded_option, displayable, linear_rgb};

/// This object has no lines of its own.
///
/// Other objects keep theirs: the outline of what stands in front of it is
/// drawn, also where the two meet. Works on every mesh that is drawn in the
/// depth prepass (opaque and alpha-masked, lit or not, skinned, morphed,
/// instanced by the engine). Transparent meshes have no lines anyway.
///
/// This is about [`Outlines`](crate::Outlines): [`Contours`](crate::Contours)
/// are drawn on the depth map, which knows no objects.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct NoOutlines {
    /// Whether it holds for all descendants as well, except those with a
    /// [`OutlineStyle`] or `NoOutlines` of their own: what the root of a glTF
    /// scene wants. Default: `false`.
    pub inherit: bool,
}

impl NoOutlines {
    /// For an object and everything below it.
    pub const INHERITED: Self = Self { inherit: true };
}

/// The lines of this object look different from the camera's
/// [`Outlines`](crate::Outlines).
///
/// A line belongs to the nearer of the two surfaces that it parts; where both
/// are at the same depth, to the one that has lines at all. Objects under
/// [`NoOutlines`] have none, whatever else they carry.
///
/// No more than 255 styles that differ from one another are told apart.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct OutlineStyle {
    /// Colour of all lines; `None` keeps the camera's. Clamped to what a
    /// display shows; its alpha is not used. Default: `None`.
    pub color: Option<Color>,
    /// Width in logical pixels; `None` keeps the camera's. Range 0.5 to 16.
    /// Default: `None`.
    pub width: Option<f32>,
    /// Which kinds of line are drawn, of those that the camera draws.
    /// Default: all.
    pub kinds: OutlineKinds,
    /// As [`NoOutlines::inherit`]. Default: `false`.
    pub inherit: bool,
}

/// The kinds of outline.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Default, Clone, PartialEq)]
pub struct OutlineKinds {
    /// Where the object ends in front of something.
    pub silhouettes: bool,
    /// Where its surface folds.
    pub creases: bool,
    /// Where it touches other objects.
    pub objects: bool,
}

impl Default for OutlineKinds {
    fn default() -> Self {
        Self {
            silhouettes: true,
            creases: true,
            objects: true,
        }
    }
}

impl OutlineStyle {
    /// The settings that are used.
    #[must_use]
    pub fn sanitized(self) -> Self {
        Self {
            color: self.color.map(|c| displayable(c, Color::BLACK)),
            width: bounded_option(self.width, 2.0, 0.5, 16.0),
            ..self
        }
    }

    fn uniform(self) -> ObjectStyleUniform {
        let style = self.sanitized();
        let OutlineKinds {
            silhouettes,
            creases,
            objects,
        } = style.kinds;
        ObjectStyleUniform {
            color: linear_rgb(style.color.unwrap_or(Color::BLACK)),
            has_color: if style.color.is_some() { 1.0 } else { 0.0 },
            half_width: style.width.map_or(-1.0, |w| 0.5 * w),
            kinds: u32::from(silhouettes) | u32::from(creases) << 1 | u32::from(objects) << 2,
        }
    }
}

/// Gives every styled object its slot in the table.
pub(crate) fn assign_object_styles(
    styled: Query<
        (Entity, Option<&OutlineStyle>, Option<&NoOutlines>),
        Or<(With<OutlineStyle>, With<NoOutlines>)>,
    >,
    children: Query<&Children>,
    own: Query<(), Or<(With<OutlineStyle>, With<NoOutlines>)>>,
    mut styles: ResMut<ObjectStyles>,
) {
    if styled.is_empty() && !styles.any() {
        return;
    }
    let mut table = ObjectStyles::default();
    for (entity, style, none) in &styled {
        let (uniform, inherit) = match (style, none) {
            (_, Some(none)) => (
                ObjectStyleUniform {
                    kinds: 0,
                    ..Default::default()
                },
                none.inherit,
            ),
            (Some(style), None) => (style.uniform(), style.inherit),
            (None, None) => continue,
        };
        let slot = table.slot(uniform);
        table.slots.insert(entity, slot);
        let mut below = vec![entity];
        while inherit && let Some(parent) = below.pop() {
            for child in children
                .get(parent)
                .into_iter()
                .flat_map(|c| c.iter().copied())
            {
                if !own.contains(child) {
                    table.slots.insert(child, slot);
                    below.push(child);
                }
            }
        }
    }
    styles.set_if_neq(table);
}
