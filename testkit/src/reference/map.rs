//! Twin of `depth/map.wgsl`: [CS] Eq. 2 to 4 from distances, in double
//! precision.

/// A projection, as far as depth goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// d + offset = scale / z.
    Perspective { offset: f64 },
    /// z = `plane_far` - d * extent.
    Orthographic { plane_far: f64, extent: f64 },
}

/// The depth map of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    pub projection: Projection,
    /// Raw depths of the ends of the range; `None` for an empty view.
    pub ends: Option<[f64; 2]>,
    pub logarithmic: bool,
    /// As the shader has it: relative, or in raw depth.
    pub floor: f64,
    pub sky_gap: f64,
}

pub fn is_background(d: f64) -> bool {
    !(d >= f64::from(f32::MIN_POSITIVE) && d <= 1.0)
}

impl Frame {
    /// A length proportional to the distance of a raw depth.
    fn z(&self, d: f64) -> f64 {
        match self.projection {
            Projection::Perspective { offset } => 1.0 / (d + offset),
            Projection::Orthographic { plane_far, extent } => plane_far - d * extent,
        }
    }

    fn log_z(&self, d: f64) -> f64 {
        match self.projection {
            Projection::Perspective { .. } => self.z(d).ln(),
            Projection::Orthographic { extent, .. } => self.z(d).max(1e-4 * extent).ln(),
        }
    }

    /// Whether the range is below the floor.
    fn floored(&self, near: f64, far: f64) -> Option<f64> {
        let least = match self.projection {
            Projection::Perspective { offset } => self.floor * (near + offset),
            Projection::Orthographic { .. } => self.floor,
        };
        (near - far <= least).then_some(least)
    }

    /// The map before it is clamped to [0, 1].
    fn open(&self, d: f64) -> f64 {
        let [near, far] = self.ends.expect("only asked where there is geometry");
        if let Some(least) = self.floored(near, far) {
            return match self.projection {
                Projection::Perspective { offset } => {
                    (near - d) / least * (far + offset) / (d + offset)
                }
                Projection::Orthographic { .. } => (near - d) / least,
            };
        }
        if self.logarithmic {
            let whole = self.log_z(far) - self.log_z(near);
            return if whole > 0.0 {
                (self.log_z(d) - self.log_z(near)) / whole
            } else {
                0.0
            };
        }
        // (z - min) / (max - min) as the exact quotient of the stored depths:
        // differences of reciprocals would cancel, in double precision too.
        match self.projection {
            Projection::Perspective { offset } => {
                (near - d) * (far + offset) / ((near - far) * (d + offset))
            }
            Projection::Orthographic { .. } => (near - d) / (near - far),
        }
    }

    /// (D, L).
    pub fn depth_map(&self, d: f64) -> [f64; 2] {
        let Some([near, far]) = self.ends else {
            return [1.0, 0.0];
        };
        if is_background(d) {
            return [1.0, 0.0];
        }
        let map = self.open(d).clamp(0.0, 1.0);
        if self.floored(near, far).is_some() || self.logarithmic {
            return [map, 1.0 - map];
        }
        let l = match self.projection {
            Projection::Perspective { offset } => {
                (d - far) * (near + offset) / ((near - far) * (d + offset))
            }
            Projection::Orthographic { .. } => (d - far) / (near - far),
        };
        [map, l.clamp(0.0, 1.0)]
    }

    /// The map with the sky a gap behind everything.
    pub fn with_sky(&self, d: f64) -> f64 {
        let Some([near, far]) = self.ends else {
            return 1.0;
        };
        if is_background(d) {
            1.0 + self.sky_gap
        } else {
            self.open(d.clamp(far, near))
        }
    }
}
