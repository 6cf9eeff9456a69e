//! Blends two effects of one type.
//!
//! Numbers and vectors are interpolated linearly, numbers of logarithmic ranges by ratio,
//! colors in `OKLab`. A mode has
//! no value in between: the effect fades out, its mode changes at half time, when
//! it has no strength, and it fades in again, so that the picture does not jump.
//! Only fields with [`BlendField::Switch`] change at half time without a fade.
//!
//! [`BlendField::Switch`]: crate::effect::BlendField::Switch

use super::Effect;
use crate::settings::{crossfade, crossfade_weight};

/// The effect between `a` (`t` = 0) and `b` (`t` = 1). If only one side has it, it
/// fades. If the depth map is `remapped`, the part that depends on the map fades
/// out until half time, and in again.
pub(super) fn blend<E: Effect>(a: Option<E>, b: Option<E>, t: f32, remapped: bool) -> Option<E> {
    // Where a mode changes, the effect has no strength at half time anyway.
    let same_modes = |(a, b): (&E, &E)| a.same_modes(b);
    let fades_map = remapped && a.as_ref().zip(b.as_ref()).is_none_or(same_modes);
    let effect = crossfade(a, b, t, E::faded, E::mixed, E::same_modes)?;
    Some(if fades_map {
        effect.map_faded(crossfade_weight(t))
    } else {
        effect
    })
}
