//! Seeded pseudo-random numbers, which are the same in every run of the tests.

/// The generator splitmix64.
#[derive(Debug)]
pub struct Random(u64);

impl Random {
    /// Numbers of one seed.
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    /// Returns any 64 bits.
    pub fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number below `bound`, which is at least 1.
    pub fn below(&mut self, bound: u64) -> u64 {
        self.next_u64() % bound
    }
}
