//! Reference of `depth/map.wgsl`: \[CS\] Eq. 2 to 4. The logarithmic map is computed from
//! distances, the linear map as the exact quotient of raw depths.

/// How a projection turns the view depth z into the raw depth d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// d + offset is proportional to 1 / z.
    Perspective { offset: f64 },
    /// z = `plane_far` - d * extent, world units.
    Orthographic { plane_far: f64, extent: f64 },
}

/// What defines the depth map of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    pub projection: Projection,
    /// Raw depth of the near and the far end of the range; `None` for a view
    /// without geometry.
    pub ends: Option<[f64; 2]>,
    pub logarithmic: bool,
    /// The smallest range that is spread over [0, 1]: in perspective a fraction of
    /// near + offset, under an orthographic projection in raw depth.
    pub floor: f64,
    /// Distance of the sky behind D = 1, in units of the depth map.
    pub sky_gap: f64,
}

/// Whether a raw depth is sky or not a depth: 0, subnormal, negative, above 1, NaN.
pub fn is_background(d: f64) -> bool {
    !(d >= f64::from(f32::MIN_POSITIVE) && d <= 1.0)
}

impl Frame {
    /// A length that is proportional to the view depth of a raw depth.
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

    /// The floor in raw depth if the range does not exceed it, else `None`.
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
        // (z - min) / (max - min) as a quotient of raw depths: differences of
        // reciprocals lose digits by cancellation, in double precision too.
        match self.projection {
            Projection::Perspective { offset } => {
                (near - d) * (far + offset) / ((near - far) * (d + offset))
            }
            Projection::Orthographic { .. } => (near - d) / (near - far),
        }
    }

    /// (D, L): the depth map and its complement.
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

    /// D as contours see it: the sky is `sky_gap` behind D = 1.
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
