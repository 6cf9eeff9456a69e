//! Components that change or remove the outlines of single mesh entities.

use bevy::prelude::*;

use super::{
    anchors::{Anchored, anchored_style},
    inherit::{Either, Inherited},
    levels::Levels,
    table::{ObjectStyleUniform, ObjectStyles, UNSTYLED},
};
use crate::settings::{FieldRange, NotFinite, impl_sanitized, linear_rgb};

/// Removes the [`Outlines`](crate::Outlines) of this object.
///
/// Other objects keep theirs: an object in front of this one still has its outline,
/// also where the two meet. It works on every mesh in the depth prepass (opaque and
/// alpha-masked, lit or unlit, skinned, morphed, instanced by the engine), and on transparent
/// ones with [`DepthWrite`](crate::objects::DepthWrite); others have no outlines anyway.
///
/// [`Contours`](crate::Contours) do not change: they are found in the depth map, which
/// does not distinguish objects.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct NoOutlines {
    /// Applies to all descendants as well, for example on the root of a glTF scene. It stops at
    /// descendants with an [`OutlineStyle`] or `NoOutlines` of their own: neither they nor anything
    /// below them are affected. Default: `true`.
    pub inherit: bool,
}

/// Takes this object out of the color effects: its colors stay as they were rendered.
///
/// The effects of the stages [`Tone`, `Color` and `Print`](crate::effect::EffectStage) do not apply
/// to it: tone bands, desaturation, colorization, screens, and a game's own effects. Lines and the
/// effects of the whole page still apply; [`NoOutlines`] removes its lines. Along its edges,
/// multisampled pixels mix the styled and the unstyled color. Use it for things whose color has a
/// meaning: a cursor, a team's flag, a light.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct NoStyle {
    /// Applies to all descendants as well, except for those with a `NoStyle` of their own.
    /// Default: `true`.
    pub inherit: bool,
}

/// Draws the lines of this object in another style than the camera's
/// [`Outlines`](crate::Outlines).
///
/// Where one surface hides another, the line between them belongs to the nearer one.
/// Where two objects or the two sides of a crease meet, it belongs to the one that
/// draws this kind of line; if both do, to the nearer one. An object that also has
/// [`NoOutlines`] has no lines.
///
/// At most 255 different styles exist at a time; objects with any further style get the 255th, and
/// a warning is logged.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
pub struct OutlineStyle {
    /// Color of all lines, clamped to what a display shows; its alpha is not used.
    /// `None` keeps the camera's. Default: `None`.
    pub color: Option<Color>,
    /// Width of all lines in logical pixels; `None` keeps the camera's.
    /// Range 0.5 to 16, default `None`.
    #[reflect(@FieldRange::linear(0.5, 16.0).unit("px"), @NotFinite(2.0))]
    pub width: Option<f32>,
    /// Factor of the opacity of all lines. Faithful lines lie on both sides of an edge; only the
    /// side on the object changes. Range 0 to 1; `None` is 1. Default: `None`.
    #[reflect(@FieldRange::FRACTION, @NotFinite(1.0))]
    pub opacity: Option<f32>,
    /// Kinds of line that are drawn, if the camera draws them too. Default: all.
    pub kinds: OutlineKinds,
    /// Applies to all descendants as well, as [`NoOutlines::inherit`]. Default: `true`.
    pub inherit: bool,
}

impl Default for OutlineStyle {
    fn default() -> Self {
        Self {
            color: None,
            width: None,
            opacity: None,
            kinds: OutlineKinds::default(),
            inherit: true,
        }
    }
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

impl_sanitized!(OutlineStyle);

impl OutlineStyle {
    fn uniform(self) -> ObjectStyleUniform {
        let style = self.sanitized();
        let kinds = style.kinds;
        ObjectStyleUniform {
            color: linear_rgb(style.color.unwrap_or(Color::BLACK)),
            has_color: if style.color.is_some() { 1.0 } else { 0.0 },
            half_width: style.width.map_or(-1.0, |w| 0.5 * w),
            kinds: u32::from(kinds.silhouettes)
                | u32::from(kinds.creases) << 1
                | u32::from(kinds.objects) << 2,
            opacity: style.opacity.unwrap_or(1.0),
            ..Default::default()
        }
    }
}

type Outlined = Either<NoOutlines, OutlineStyle>;

/// The outlines of an object with one of the components.
fn outlines((none, style): (Option<&NoOutlines>, Option<&OutlineStyle>)) -> ObjectStyleUniform {
    match (none, style) {
        (None, Some(style)) => style.uniform(),
        _ => ObjectStyleUniform {
            kinds: 0,
            ..Default::default()
        },
    }
}

/// Gives the objects whose style has changed their places in the table.
pub(crate) fn assign_object_styles(
    mut outlined: Inherited<Outlined>,
    mut unstyled: Inherited<NoStyle>,
    mut anchored: Inherited<Anchored>,
    levels: Res<Levels>,
    mut styles: ResMut<ObjectStyles>,
) {
    let mut changed = outlined.update();
    changed.extend(unstyled.update());
    changed.extend(anchored.update());
    if changed.is_empty() && !levels.is_changed() {
        return;
    }
    let style = |object| {
        let own = outlined.of(object).map(|(_, parts)| outlines(parts));
        let is_bare = unstyled.of(object).is_some();
        let mut style = own.unwrap_or_default();
        if is_bare {
            style.kinds |= UNSTYLED;
        }
        let anchor = anchored.of(object);
        let anchored = anchor.and_then(|(_, (anchor, at))| anchored_style(anchor, at, style));
        anchored.or((own.is_some() || is_bare).then_some(style))
    };
    styles.assign(changed.iter().map(|object| (*object, style(*object))));
    if levels.is_changed() {
        changed.extend(levels.changed.iter().copied());
    }
    let fade = |object| (object, levels.fades_to_nothing(object));
    styles.fade(changed.into_iter().map(fade));
}
