//! Reference of `lines/settings/fog.wgsl`: how much of a line the engine's distance fog hides.

/// How fog grows with distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Falloff {
    Linear {
        start: f64,
        end: f64,
    },
    Exponential {
        density: f64,
    },
    ExponentialSquared {
        density: f64,
    },
    /// Extinction by channel.
    Atmospheric([f64; 3]),
}

/// The fraction of a colour at a distance that fog of this opacity replaces; of atmospheric
/// fog, the mean over the channels.
pub fn fog_fraction(falloff: Falloff, most: f64, distance: f64) -> f64 {
    let left = match falloff {
        Falloff::Linear { start, end } => ((end - distance) / (end - start)).clamp(0.0, 1.0),
        Falloff::Exponential { density } => (-distance * density).exp(),
        Falloff::ExponentialSquared { density } => (-(distance * density).powi(2)).exp(),
        Falloff::Atmospheric(extinction) => {
            extinction
                .iter()
                .map(|e| (-distance * e).exp())
                .sum::<f64>()
                / 3.0
        }
    };
    ((1.0 - left) * most).clamp(0.0, 1.0)
}
