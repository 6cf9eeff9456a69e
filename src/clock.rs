//! The clock of drawings: what is redrawn several times a second, and stands still in
//! between, as in films that are animated "on twos" (12 drawings a second).
//!
//! All that moves like this asks here, so that boiling lines, sketches, speed lines, grain
//! and stepped animation of the same rate change in the same frame.

/// A frame that is this many seconds early belongs to the next drawing. Clocks count
/// nanoseconds: at 12 drawings and 60 frames a second, every fifth frame is a nanosecond
/// before or behind its drawing.
const EARLY: f64 = 1e-6;

/// Number of the drawing that is shown at a time, from 0 on.
///
/// `seconds`: of the app's default clock, which stands still while the game is paused.
/// `rate`: drawings per second; at 0 there is one drawing for all time.
pub(crate) fn drawing(seconds: f64, rate: f32) -> u64 {
    // A float that is negative or not a number becomes 0.
    ((seconds + EARLY) * f64::from(rate)).floor() as u64
}

/// The number as a seed for shaders. It repeats after 65536 drawings.
pub(crate) fn animation_seed(seconds: f64, rate: f32) -> u32 {
    (drawing(seconds, rate) % 65536) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Frames of 1/60 s, in nanoseconds that are rounded down or up: 12 drawings a second,
    /// five frames each.
    #[test]
    fn drawings_begin_with_their_frame() {
        for nanoseconds in [16_666_666u64, 16_666_667] {
            for frame in 0..600u64 {
                let seconds = (frame * nanoseconds) as f64 * 1e-9;
                assert_eq!(drawing(seconds, 12.0), frame / 5, "frame {frame}");
            }
        }
    }

    #[test]
    fn every_time_and_rate_has_a_drawing() {
        assert_eq!(drawing(1e9, 0.0), 0);
        assert_eq!(drawing(-5.0, 12.0), 0);
        assert_eq!(drawing(f64::NAN, 12.0), 0);
        assert_eq!(drawing(3.0, 60.0), 180);
        assert_eq!(animation_seed(65537.0, 1.0), 1);
    }
}
