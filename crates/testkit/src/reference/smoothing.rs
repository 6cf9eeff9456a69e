//! Reference of `depth/smoothing.wgsl`.

/// An end that rests beside everything that was found for this time, in seconds, begins
/// to settle.
pub const WATCH: f64 = 4.0;
/// Time constant in seconds with which it settles.
pub const SETTLE: f64 = 2.0;
/// A longer frame, in seconds, counts as one of this length for [`WATCH`].
pub const LONGEST_WATCHED: f64 = 0.1;

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

/// What the goal of a bound does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    /// It stays within the hysteresis.
    Rests,
    /// It is what is found.
    Follows,
    /// It stays, and the bound moves to it slowly.
    Settles,
}

/// One end of the range, in levels.
#[derive(Clone, Debug)]
struct Bound {
    level: f64,
    /// Raw depth of the goal.
    goal: f32,
    mode: Mode,
    /// Raw depths that were found one and two frames ago.
    seen: [f32; 2],
    /// Raw depths that were found since the bound is watched, smallest and largest, and
    /// the seconds since then.
    watched: ([f32; 2], f64),
}

/// The depth halfway between two, among all single-precision numbers.
fn middle(low: f32, high: f32) -> f32 {
    f32::from_bits(low.to_bits() + (high.to_bits() - low.to_bits()) / 2)
}

/// What a frame does to a bound.
struct Frame {
    found: f32,
    /// In levels.
    hysteresis: f64,
    seconds: f64,
    /// Whether a larger level widens the range.
    nearest: bool,
}

impl Bound {
    fn new(d: f32, s: &Smoothing) -> Self {
        Self {
            level: s.level(f64::from(d)),
            goal: d,
            mode: Mode::Rests,
            seen: [d; 2],
            watched: ([d; 2], 0.0),
        }
    }

    /// Chooses the goal.
    fn aim(&mut self, at: f32, frame: &Frame, s: &Smoothing) {
        let level = |d: f32| s.level(f64::from(d));
        if (level(at) - level(self.goal)).abs() > frame.hysteresis {
            self.mode = Mode::Follows;
        }
        if self.mode == Mode::Follows {
            self.goal = at;
            self.watched = ([at; 2], 0.0);
            return;
        }
        let ([low, high], seconds) = self.watched;
        let (low, high) = (low.min(at), high.max(at));
        let seconds = seconds + frame.seconds.min(LONGEST_WATCHED);
        if seconds < WATCH {
            self.watched = ([low, high], seconds);
            return;
        }
        if self.goal < low || self.goal > high {
            self.goal = middle(low, high);
            self.mode = Mode::Settles;
        }
        self.watched = ([at; 2], 0.0);
    }

    /// Advances by one frame.
    fn follow(&mut self, frame: &Frame, s: &Smoothing) {
        let [before, earlier] = self.seen;
        let mut three = [frame.found, before, earlier];
        three.sort_by(f32::total_cmp);
        let at = if s.despike { three[1] } else { frame.found };
        self.seen = [frame.found, before];
        self.aim(at, frame, s);

        let goal = s.level(f64::from(self.goal));
        let grows = (goal > self.level) == frame.nearest;
        let mut constant = if grows { s.expand } else { s.shrink };
        if self.mode == Mode::Settles {
            constant = constant.max(SETTLE);
        }
        let kept = if constant > 0.0 {
            (-frame.seconds / constant).exp()
        } else {
            0.0
        };
        let left = kept * (goal - self.level);
        self.level = goal - left;
        if self.mode == Mode::Follows && left.abs() <= frame.hysteresis / 4.0 {
            self.mode = Mode::Rests;
        }
        let settled = if s.offset.is_some() {
            1.0
        } else {
            frame.hysteresis
        };
        if left.abs() <= 0.00025 * settled {
            self.level = goal;
            if self.mode == Mode::Settles {
                self.mode = Mode::Rests;
            }
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
        let [near, far] = found?.map(|d| d as f32);
        match &mut self.ends {
            Some([n, f]) if !snap => {
                let goals = [n.goal, f.goal].map(|d| s.level(f64::from(d)));
                let hysteresis = match s.offset {
                    Some(_) => s.hysteresis,
                    None => s.hysteresis * (goals[0] - goals[1]).abs(),
                };
                for (bound, found, nearest) in [(n, near, true), (f, far, false)] {
                    let frame = Frame {
                        found,
                        hysteresis,
                        seconds,
                        nearest,
                    };
                    bound.follow(&frame, s);
                }
            }
            ends => *ends = Some([Bound::new(near, s), Bound::new(far, s)]),
        }
        let [n, f] = self.ends.as_ref()?;
        let near = s.depth(n.level);
        Some([near, s.depth(f.level).min(near)])
    }
}
