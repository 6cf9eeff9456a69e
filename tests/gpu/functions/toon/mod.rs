//! Functions of the toon material that read bindings, against references: the shipped functions,
//! with their uniforms, the view and the lights as variables.

mod atmosphere;
mod borders;
mod light_shadow;
mod light_textures;

/// Numbers that look random.
pub struct Numbers(u64);

impl Numbers {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// From 0 to 1, both included.
    pub fn part(&mut self) -> f32 {
        // SplitMix64 (Steele, Lea and Flood 2014).
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 40) as f32 / ((1 << 24) - 1) as f32
    }

    pub fn within(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.part()
    }

    /// Whether something happens that happens once in `n` times.
    pub fn once_in(&mut self, n: u32) -> bool {
        self.part() * (n as f32) < 1.0
    }

    pub fn unit(&mut self) -> [f32; 3] {
        loop {
            let v = [0; 3].map(|_| f64::from(self.within(-1.0, 1.0)));
            let long = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            if (0.1..=1.0).contains(&long) {
                return v.map(|x| (x / long) as f32);
            }
        }
    }
}
