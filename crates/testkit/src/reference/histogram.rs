//! Reference of `depth/histogram.wgsl`, of the counting in `depth/range.wgsl` and of the
//! percentiles in `depth/smoothing.wgsl`.

/// Number of bins, from far to near.
pub const BINS: usize = 256;

/// What the bins divide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bins {
    /// Perspective: eight bins per octave of raw depth. The last one counts depth 1
    /// alone, the first one also all smaller depths.
    Octaves,
    /// Orthographic: a window of raw depth, (near, far). The edges of the bins are at
    /// the squares of equal steps from either end to the middle. The outermost bins also
    /// count what is outside.
    Window([f64; 2]),
}

impl Bins {
    /// The bin of a raw depth.
    pub fn bin_of(&self, d: f32) -> usize {
        let d = f64::from(d);
        match self {
            Self::Octaves => {
                let octave = d.log2().floor();
                let eighth = ((d / octave.exp2() - 1.0) * 8.0).floor();
                // Bin 255 begins at depth 1.
                (255.0 + octave * 8.0 + eighth).clamp(0.0, 255.0) as usize
            }
            Self::Window([near, far]) => {
                let from_far = (d - far) / (near - far);
                if from_far > 0.5 {
                    let i = (2.0 * (1.0 - from_far).max(0.0)).sqrt() * 128.0;
                    255 - (i.floor() as usize).min(127)
                } else {
                    let i = (2.0 * from_far.max(0.0)).sqrt() * 128.0;
                    (i.floor() as usize).min(127)
                }
            }
        }
    }

    /// Raw depth between `bin - 1` and `bin`.
    pub fn edge(&self, bin: usize) -> f64 {
        match self {
            Self::Octaves => {
                let eighths = bin as f64 - 255.0;
                let octave = (eighths / 8.0).floor();
                octave.exp2() * (1.0 + (eighths - 8.0 * octave) / 8.0)
            }
            Self::Window([near, far]) => {
                let half = |steps: f64| 0.5 * (steps / 128.0).powi(2) * (near - far);
                let steps = bin as f64;
                if steps <= 128.0 {
                    far + half(steps)
                } else {
                    near - half(256.0 - steps)
                }
            }
        }
    }

    /// (count of each bin, total count) of the raw depths that are geometry.
    pub fn count(&self, depths: impl IntoIterator<Item = f32>) -> (Vec<u32>, u32) {
        let mut bins = vec![0; BINS];
        let mut total = 0;
        for d in depths {
            if super::raw::key(d) != 0 {
                bins[self.bin_of(d)] += 1;
                total += 1;
            }
        }
        (bins, total)
    }

    /// Raw depths of the (far, near) end of a bin. `ends`: the extremes (near, far) of
    /// the counted depths.
    fn ends_of(&self, bin: usize, [near, far]: [f64; 2]) -> [f64; 2] {
        let [low, high] = [self.edge(bin), self.edge(bin + 1)];
        match self {
            Self::Octaves => [low, high],
            Self::Window(_) => [
                if bin == 0 { far } else { low.max(far) },
                if bin == 255 { near } else { high.min(near) },
            ],
        }
    }

    /// (near, far) raw depth such that `fraction` of the counted pixels is nearer than
    /// the one and `fraction` is farther than the other. `ends`: the range without
    /// percentiles, to which the result is clamped.
    pub fn percentiles(&self, bins: &[u32], total: u32, fraction: f64, ends: [f64; 2]) -> [f64; 2] {
        let rank = fraction * f64::from(total);
        let find = |order: &mut dyn Iterator<Item = usize>, nearer: bool| {
            let mut passed = 0.0;
            for bin in order {
                let count = f64::from(bins[bin]);
                if passed + count > rank {
                    let part = (rank - passed) / count;
                    let [low, high] = self.ends_of(bin, ends);
                    return if nearer {
                        high - part * (high - low)
                    } else {
                        low + part * (high - low)
                    };
                }
                passed += count;
            }
            panic!("no pixel is left beyond the fraction {fraction}");
        };
        let [near, far] = ends;
        [
            find(&mut (0..BINS).rev(), true).clamp(far, near),
            find(&mut (0..BINS), false).clamp(far, near),
        ]
    }
}
