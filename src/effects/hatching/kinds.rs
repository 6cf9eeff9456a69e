//! The modes of [`Hatching`](super::Hatching).

use bevy::reflect::{Reflect, ReflectDeserialize, ReflectSerialize, std_traits::ReflectDefault};
use serde::{Deserialize, Serialize};

/// What the strokes of a [`Hatching`](crate::Hatching) are fixed to.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum HatchingAnchor {
    /// The surfaces of things: strokes follow their shape. They are fixed to the world, or to an
    /// object that has a [`PatternAnchor`](crate::objects::PatternAnchor). Needs depth and normals;
    /// without them, strokes are fixed to the page.
    #[default]
    Object,
    /// The page: strokes are parallel, and stand still while things move under them (Lake et al.
    /// 2000). The sky is hatched too.
    Page,
}

/// What a [`Hatching`](crate::Hatching) is drawn with.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum HatchingMarks {
    /// Strokes.
    #[default]
    Strokes,
    /// Dots of one size, as many as the tone asks for: stipple. They lie on surfaces as strokes do,
    /// are anchored as strokes are, and grow one by one between the others when a thing comes
    /// nearer. On surfaces that are seen at an angle, they are ellipses.
    Dots,
}

/// What is between the strokes of a [`Hatching`](crate::Hatching).
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum HatchingGround {
    /// The colors of the picture, brighter under strokes, so that the mean of an area keeps its
    /// color as far as the display can show that.
    #[default]
    Color,
    /// A sheet of one color: [`Hatching::paper`](crate::Hatching::paper).
    Paper,
}

/// What decides how dark a [`Hatching`](crate::Hatching) is.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[reflect(Default, Clone, PartialEq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum HatchingSource {
    /// The lightness of the picture, so dark colors are hatched as well as shadows.
    #[default]
    Picture,
    /// The direction in which a surface faces: lightness 1 towards the
    /// [`KeyLight`](crate::KeyLight), a half beside it, 0 away from it. Colors and cast shadows
    /// have no effect. With [`HatchingAnchor::Page`], the same as [`HatchingSource::Picture`].
    Facing,
}
