//! Places besides lines that are inked.

/// Places where the depth map D departs from planes. At other places, every two opposite
/// neighbors at the same distance, at most `radius`, have D less than `least` away from
/// a plane through the pixel between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapJumps {
    /// Smallest departure of D that counts.
    pub least: f32,
    /// Largest distance in physical pixels.
    pub radius: f32,
}

impl MapJumps {
    /// Places that satisfy either of two conditions.
    pub(crate) fn or(self, other: Self) -> Self {
        Self {
            least: self.least.min(other.least),
            radius: self.radius.max(other.radius),
        }
    }
}
