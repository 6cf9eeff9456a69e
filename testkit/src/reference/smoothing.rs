//! Twin of `depth/smoothing.wgsl` and of the histogram of `depth/range.wgsl`.

/// Number of bins: eight per octave of raw depth. The last one counts depth 1
/// alone, the first one also all smaller depths.
pub const BINS: usize = 256;

/// The bin of a raw depth: its octave, and the eighth of the octave.
pub fn bin_of(d: f32) -> usize {
    let d = f64::from(d);
    let octave = d.log2().floor();
    let eighth = ((d / octave.exp2() - 1.0) * 8.0).floor();
    // Bin 255 begins at depth 1.
    (255.0 + octave * 8.0 + eighth).clamp(0.0, 255.0) as usize
}

/// Raw depth at the far end of a bin.
pub fn bin_start(bin: usize) -> f64 {
    let eighths = bin as f64 - 255.0;
    let octave = (eighths / 8.0).floor();
    octave.exp2() * (1.0 + (eighths - 8.0 * octave) / 8.0)
}

/// (count of each bin, total count) of the raw depths that are geometry.
pub fn histogram(depths: impl IntoIterator<Item = f32>) -> (Vec<u32>, u32) {
    let mut bins = vec![0; BINS];
    let mut total = 0;
    for d in depths {
        if super::raw::key(d) != 0 {
            bins[bin_of(d)] += 1;
            total += 1;
        }
    }
    (bins, total)
}

/// (near, far) raw depth such that `fraction` of the counted pixels is nearer than
/// the one and `fraction` is farther than the other. `ends`: the range without
/// percentiles, to which the result is clamped.
pub fn percentiles(bins: &[u32], total: u32, fraction: f64, ends: [f64; 2]) -> [f64; 2] {
    let rank = fraction * f64::from(total);
    let find = |order: &mut dyn Iterator<Item = usize>, nearer: bool| {
        let mut passed = 0.0;
        for bin in order {
            let count = f64::from(bins[bin]);
            if passed + count > rank {
                let part = (rank - passed) / count;
                let (low, high) = (bin_start(bin), bin_start(bin + 1));
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

/// Settings, as in `RangeSmoothing`.
#[derive(Clone, Copy, Debug)]
pub struct Smoothing {
    /// The constant that makes raw depth + offset proportional to 1 / z; `None` for
    /// an orthographic projection.
    pub offset: Option<f64>,
    pub despike: bool,
    /// Octaves of distance; under an orthographic projection, lengths of the range.
    pub hysteresis: f64,
    /// Time constants in seconds.
    pub expand: f64,
    pub shrink: f64,
}

impl Smoothing {
    /// The quantity that is smoothed: log2(raw depth + offset), or raw depth under an
    /// orthographic projection.
    pub fn level(&self, d: f64) -> f64 {
        match self.offset {
            Some(offset) => (d + offset).log2(),
            None => d,
        }
    }

    /// Raw depth of a level.
    pub fn depth(&self, level: f64) -> f64 {
        let d = match self.offset {
            Some(offset) => level.exp2() - offset,
            None => level,
        };
        d.clamp(f64::from(f32::MIN_POSITIVE), 1.0)
    }
}

/// One end of the range, in levels.
#[derive(Clone, Debug)]
struct Bound {
    level: f64,
    goal: f64,
    /// Whether the goal follows what is found.
    moving: bool,
    /// What was found one and two frames ago.
    seen: [f64; 2],
}

impl Bound {
    fn new(level: f64) -> Self {
        Self {
            level,
            goal: level,
            moving: false,
            seen: [level; 2],
        }
    }

    /// Advances by one frame. `fraction`: the part of the remaining difference (its
    /// argument, signed) that is made up in this frame.
    fn follow(
        &mut self,
        found: f64,
        hysteresis: f64,
        fraction: impl Fn(f64) -> f64,
        s: &Smoothing,
    ) {
        let [before, earlier] = self.seen;
        let mut three = [found, before, earlier];
        three.sort_by(f64::total_cmp);
        let at = if s.despike { three[1] } else { found };
        self.seen = [found, before];
        self.moving |= (at - self.goal).abs() > hysteresis;
        if self.moving {
            self.goal = at;
        }
        let left = self.goal - self.level;
        self.level += fraction(left) * left;
        let left = (self.goal - self.level).abs();
        if left <= hysteresis / 4.0 {
            self.moving = false;
        }
        let settled = if s.offset.is_some() { 1.0 } else { hysteresis };
        if left <= 0.00025 * settled {
            self.level = self.goal;
        }
    }
}

/// The range that is drawn, frame after frame.
#[derive(Clone, Debug, Default)]
pub struct Range {
    ends: Option<[Bound; 2]>,
}

impl Range {
    /// Advances by one frame: `found` is the range of the frame, the result the range
    /// that is drawn, both as raw depth of (near, far). `seconds`: since the last
    /// frame; `snap`: start anew from `found`. Without geometry nothing changes.
    pub fn step(
        &mut self,
        found: Option<[f64; 2]>,
        s: &Smoothing,
        seconds: f64,
        snap: bool,
    ) -> Option<[f64; 2]> {
        let [near, far] = found?.map(|d| s.level(d));
        match &mut self.ends {
            Some([n, f]) if !snap => {
                let hysteresis = match s.offset {
                    Some(_) => s.hysteresis,
                    None => s.hysteresis * (n.goal - f.goal).abs(),
                };
                let fraction = |grows: bool| {
                    let constant = if grows { s.expand } else { s.shrink };
                    if constant > 0.0 {
                        1.0 - (-seconds / constant).exp()
                    } else {
                        1.0
                    }
                };
                n.follow(near, hysteresis, |left| fraction(left > 0.0), s);
                f.follow(far, hysteresis, |left| fraction(left < 0.0), s);
            }
            ends => *ends = Some([Bound::new(near), Bound::new(far)]),
        }
        let [n, f] = self.ends.as_ref()?;
        let near = s.depth(n.level);
        Some([near, s.depth(f.level).min(near)])
    }
}
