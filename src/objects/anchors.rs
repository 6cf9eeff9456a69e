//! Objects that screens of a halftone follow.

use bevy::prelude::*;

use super::{inherit::Heritage, table::ObjectStyleUniform};

/// The screens of a [`Halftone`](crate::Halftone) with
/// [`ScreenAnchor::Object`](crate::effects::ScreenAnchor::Object) follow this object: the dots move, turn
/// and grow with it, as if they were printed on the figure.
///
/// The dots rotate with the object's roll on the screen: with the screen direction of its Y axis,
/// or of its -Z axis where Y points to within 6 degrees of the camera. They grow with its apparent
/// size, from 0.71 to 1.41 of [`Halftone::cell_size`](crate::Halftone::cell_size); then dots of
/// half the size take over, faded in and out. While the center is behind the camera, its dots lie
/// on the page.
///
/// Each object takes a slot of the table of [`OutlineStyle`](crate::OutlineStyle)s, which has 255.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct PatternAnchor {
    /// The point that the dots rotate and scale around, in the object's own space. A point that is
    /// not finite counts as the origin. Default: the origin.
    pub center: Vec3,
    /// Applies to all descendants as well, so that a figure of several meshes has one pattern,
    /// except for those with a `PatternAnchor` of their own. Default: `true`.
    pub inherit: bool,
}

impl Default for PatternAnchor {
    fn default() -> Self {
        Self {
            center: Vec3::ZERO,
            inherit: true,
        }
    }
}

/// A style whose screens follow an object; `None` for an object without an extent, or not at a
/// finite place.
pub(super) fn anchored_style(
    anchor: &PatternAnchor,
    at: &GlobalTransform,
    style: ObjectStyleUniform,
) -> Option<ObjectStyleUniform> {
    let offset = Some(anchor.center).filter(|center| center.is_finite());
    let center = at.transform_point(offset.unwrap_or_default());
    let (scale, rotation, _) = at.to_scale_rotation_translation();
    let size = scale.abs().element_product().cbrt();
    let rotation = Vec4::from(rotation.normalize());
    let is_sound = center.is_finite() && rotation.is_finite() && size.is_normal();
    is_sound.then_some(ObjectStyleUniform {
        anchor_center: center,
        anchor_rotation: rotation,
        anchor_size: size,
        ..style
    })
}

/// The component and where its object is.
pub(crate) struct Anchored;

impl Heritage for Anchored {
    type Own = (&'static PatternAnchor, &'static GlobalTransform);
    type Changed = (
        With<PatternAnchor>,
        Or<(Changed<PatternAnchor>, Changed<GlobalTransform>)>,
    );

    fn passes_on((screen, _): &(&PatternAnchor, &GlobalTransform)) -> bool {
        screen.inherit
    }
}
