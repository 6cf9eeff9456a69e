//! The component.

use bevy::prelude::*;

use super::trail::Trail;
use crate::settings::{FieldRange, impl_sanitized};

/// Draws lines behind a mesh while it moves fast. Each line is the path of a point on its surface,
/// so lines of a turning mesh are curved (Lake et al. 2000).
///
/// Put it on an entity with a mesh. Points are chosen on its surface once, evenly by area; those at
/// the back of the movement draw a line. Lines begin a little behind the surface, taper to both
/// ends, and have the same width at every distance. They fade in with the speed, and are gone when
/// the thing stands still.
///
/// They follow the app's default clock, whatever the frame rate is, and stay while the game is
/// paused. Paths begin anew at a jump, which is a step of more than five times the usual speed,
/// and at a [`CameraCut`](crate::CameraCut) of any camera.
///
/// Lines are meshes, drawn after what is opaque and hidden by what is in front of them. They are
/// not in the prepass: they have no outlines and no shadows, do not change the visible range, and
/// the effects of a camera treat them as what is behind them. Of skinned meshes, points follow the
/// entity, not the bones. The mesh has to be readable in the main world, as meshes are by default.
/// Needs the feature `objects` or `toon`.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_comics::MotionLines;
/// fn throw(mut commands: Commands, ball: Entity) {
///     commands.entity(ball).insert(MotionLines { min_speed: 4.0, ..default() });
/// }
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Clone, PartialEq)]
#[require(Trail)]
pub struct MotionLines {
    /// Number of points on the surface. Those at the back of the movement draw a line: about a
    /// third of them on what is round. Range 1 to 128, default 48.
    #[reflect(@FieldRange::linear(1.0, 128.0))]
    pub points: u32,
    /// Time of the movement that the longest line shows, in seconds. Range 0.02 to 2, default
    /// 0.15.
    #[reflect(@FieldRange::logarithmic(0.02, 2.0).unit("s"))]
    pub duration: f32,
    /// Fraction of the duration that is left out behind the surface. Range 0 to 0.9, default 0.1.
    #[reflect(@FieldRange::linear(0.0, 0.9))]
    pub gap: f32,
    /// How much shorter than the longest line the shortest one is, as a fraction of it. Range 0 to
    /// 0.9, default 0.5.
    #[reflect(@FieldRange::linear(0.0, 0.9))]
    pub variation: f32,
    /// Speed of a point below which it has no line, in world units per second. Lines grow to
    /// their width between 0.8 and 1.2 times this. Range 1e-4 to 1e6, default 2.
    #[reflect(@FieldRange::logarithmic(1e-4, 1e6).unit("units / s"))]
    pub min_speed: f32,
    /// Width at the widest place, in logical pixels, or in page pixels
    /// ([`PageHeight`](crate::style::PageHeight)). Their size is that of the first active 3D camera.
    /// Range 0.5 to 16, default 3.
    #[reflect(@FieldRange::logarithmic(0.5, 16.0).unit("px"))]
    pub width: f32,
    /// Color of the ink before tonemapping; its alpha is the opacity. Components are clamped to
    /// what a display shows. Default: black.
    pub color: Color,
    /// Drawings per second: lines change with the drawings of a
    /// [`SteppedAnimation`](crate::SteppedAnimation) of the same rate. 0: in every frame. Range 0
    /// to 60, default 0.
    #[reflect(@FieldRange::linear(0.0, 60.0).unit("/ s"))]
    pub rate: f32,
    /// Chooses other points. Range 0 to 65535, default 0.
    #[reflect(@FieldRange::linear(0.0, 65535.0))]
    pub seed: u32,
}

impl Default for MotionLines {
    fn default() -> Self {
        Self {
            points: 48,
            duration: 0.15,
            gap: 0.1,
            variation: 0.5,
            min_speed: 2.0,
            width: 3.0,
            color: Color::BLACK,
            rate: 0.0,
            seed: 0,
        }
    }
}

impl MotionLines {
    /// The largest number of points.
    pub const MOST_POINTS: u32 = 128;
}

impl_sanitized!(MotionLines);
