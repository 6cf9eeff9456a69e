//! Components that change or remove the outlines of single mesh entities.

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

/// Removes the [`Outlines`](crate::Outlines) of this object.
///
/// Other objects keep theirs: an object in front of this one still has its outline,
/// also where the two meet. It works on every mesh in the depth prepass (opaque and
/// alpha-masked, lit or unlit, skinned, morphed, instanced by the engine). Transparent
/// meshes have no outlines anyway.
///
/// [`Contours`](crate::Contours) do not change: they are found in the depth map, which
/// does not distinguish objects.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct NoOutlines {
    /// Applies to all descendants as well, for example on the root of a glTF scene.
    /// A descendant with an [`OutlineStyle`] or `NoOutlines` of its own is left out,
    /// together with everything below it. Default: `false`.
    pub inherit: bool,
}

impl NoOutlines {
    /// For an object and its descendants: [`inherit`](Self::inherit) is `true`.
    pub const INHERITED: Self = Self { inherit: true };
}

/// Draws the lines of this object in another style than the camera's
/// [`Outlines`](crate::Outlines).
///
/// Where one surface hides another, the line between them belongs to the nearer one.
/// Where two objects or the two sides of a crease meet, it belongs to the one that
/// draws this kind of line; if both do, to the nearer one. An object that also has
/// [`NoOutlines`] has no lines.
///
/// At most 255 different styles are told apart; objects with any further style get
/// the 255th, and the log warns.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct OutlineStyle {
    /// Colour of all lines, clamped to what a display shows; its alpha is not used.
    /// `None` keeps the camera's. Default: `None`.
    pub color: Option<Color>,
    /// Width of all lines in logical pixels; `None` keeps the camera's.
    /// Range 0.5 to 16, default `None`.
    pub width: Option<f32>,
    /// Kinds of line that are drawn, if the camera draws them too. Default: all.
    pub kinds: OutlineKinds,
    /// Applies to all descendants as well, as [`NoOutlines::inherit`]. Default: `false`.
    pub inherit: bool,
}

/// The kinds of outline.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Default, Clone, PartialEq)]
pub struct OutlineKinds {
    /// Lines where the object ends in front of another surface or of the sky.
    /// Default: `true`.
    pub silhouettes: bool,
    /// Lines where its surface bends sharply. Default: `true`.
    pub creases: bool,
    /// Lines where it meets other objects. Default: `true`.
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
    /// The settings that are used: width and colour in their documented ranges.
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

/// Builds the table of outline styles, and gives each object that has one its slot.
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
