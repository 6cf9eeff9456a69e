//! Random input for the panel's own tests.

use std::{
    fmt::Debug,
    time::{Duration, Instant},
};

/// How many inputs are tried: the variable `FUZZ_CASES`, else 5000.
pub fn cases() -> usize {
    let given = std::env::var("FUZZ_CASES").ok();
    given.and_then(|text| text.parse().ok()).unwrap_or(5000)
}

/// What `f` makes of an input. Panics if that takes a second or longer.
pub fn in_time<T>(input: &impl Debug, f: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let made = f();
    let took = start.elapsed();
    assert!(took < Duration::from_secs(1), "{took:?}: {input:?}");
    made
}

/// Repeatable numbers: xorshift64*, Marsaglia and Vigna.
pub struct Numbers(u64);

impl Numbers {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub fn bits(&mut self) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 32) as u32
    }

    /// A number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        self.bits() as usize % end.max(1)
    }
}
