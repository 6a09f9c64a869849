//! Random streams, one for every (seed, stage, particle, step).
//!
//! The streams are `ChaCha8` counters: seed, stage and step make the key, the particle is the stream number. So no draw
//! depends on the number or order of other draws.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Half the spacing of 53-bit uniforms; keeps them off 0 and 1.
const UNIFORM_STEP: f64 = 1.0 / 9_007_199_254_740_992.0;

/// Last eight bytes of every key: the name of the scheme; a new scheme gets a new name.
const SCHEME: [u8; 8] = *b"grouser1";

/// A stream of random numbers.
#[derive(Debug, Clone)]
pub struct Stream(ChaCha8Rng);

impl Stream {
    /// Creates the stream of one particle at one step of one stage.
    #[must_use]
    pub fn new(seed: u64, stage: u64, particle: u64, step: u64) -> Self {
        let mut key = [0_u8; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&stage.to_le_bytes());
        key[16..24].copy_from_slice(&step.to_le_bytes());
        key[24..].copy_from_slice(&SCHEME);
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(particle);
        Self(generator)
    }

    /// Draws a uniform number in the open interval (0, 1), on a grid of 2^-53.
    pub fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) as f64 + 0.5) * UNIFORM_STEP
    }

    /// Draws a uniform integer in `0..bound` (0 for a bound of 0); the bias is below `bound` / 2^64.
    pub fn below(&mut self, bound: usize) -> usize {
        ((u128::from(self.0.next_u64()) * bound as u128) >> 64) as usize
    }

    /// Draws a pair of independent standard normal numbers (Box & Muller 1958, doi:10.1214/aoms/1177706645).
    pub fn normal_pair(&mut self) -> (f64, f64) {
        let radius = (-2.0 * libm::log(self.uniform())).sqrt();
        let angle = std::f64::consts::TAU * self.uniform();
        (radius * libm::cos(angle), radius * libm::sin(angle))
    }

    /// Draws `count` independent standard normal numbers.
    pub fn normals(&mut self, count: usize) -> Vec<f64> {
        let mut normals = Vec::with_capacity(count + 1);
        while normals.len() < count {
            let (first, second) = self.normal_pair();
            normals.push(first);
            normals.push(second);
        }
        normals.truncate(count);
        normals
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_differ_in_every_index_and_repeat() {
        let first = |seed, stage, particle, step| Stream::new(seed, stage, particle, step).0.next_u64();
        let base = first(1, 2, 3, 4);
        assert_eq!(base, first(1, 2, 3, 4));
        for other in [
            first(9, 2, 3, 4),
            first(1, 9, 3, 4),
            first(1, 2, 9, 4),
            first(1, 2, 3, 9),
        ] {
            assert_ne!(base, other);
        }
    }

    #[test]
    fn normals_have_mean_zero_and_unit_variance() {
        let draws = Stream::new(7, 0, 0, 0).normals(100_000);
        let mean = draws.iter().sum::<f64>() / 1e5;
        let variance = draws.iter().map(|z| z * z).sum::<f64>() / 1e5;
        // Standard errors 0.0032 and 0.0045.
        assert!(mean.abs() < 0.013, "{mean}");
        assert!((variance - 1.0).abs() < 0.018, "{variance}");
    }

    #[test]
    fn integers_cover_their_range_evenly() {
        let mut stream = Stream::new(7, 0, 0, 0);
        let mut counts = [0_i32; 5];
        for _ in 0..50_000 {
            counts[stream.below(5)] += 1;
        }
        assert!(
            counts.iter().all(|&count| (count - 10_000).abs() < 400),
            "{counts:?}"
        );
    }
}
