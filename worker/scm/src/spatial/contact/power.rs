//! z^n for one exponent and many z: a table of powers and a short binomial series.

use super::super::pack::{Pack, splat};

/// Number of sub-intervals of an octave.
const STEPS: usize = 256;
/// The smallest power of two that has a table entry; a shallower sinkage counts as 2^−40 m (1e-12 m).
const MIN_EXPONENT: i32 = -40;
const OCTAVES: usize = 64;
/// Number of entries of the table: a power of two, so that a mask keeps an index in range.
const SIZE: usize = OCTAVES * STEPS;
/// Number of terms of the binomial series: |t| ≤ 1/513, so the first omitted one is below 1e-12.
const TERMS: usize = 4;
/// Number of bits of a number below those that select its sub-interval.
const SHIFT: u32 = f64::MANTISSA_DIGITS - 1 - STEPS.ilog2();

/// `z ↦ z^n` for z < 2^24 m, with a relative error of 1e-12.
///
/// With c the middle of the sub-interval that holds z and `t = z/c − 1`: `z^n = c^n (1 + n t + n (n − 1)/2 t² + …)`.
/// Checked by `power_agrees_with_libm`.
#[derive(Debug, Clone)]
pub(crate) struct Power {
    powers: Box<[f64; SIZE]>,
    /// Coefficients, in every lane.
    series: [Pack; TERMS],
}

impl Power {
    pub(crate) fn new(exponent: f64) -> Self {
        let mut mantissa_powers = [0.0; STEPS];
        for (step, power) in mantissa_powers.iter_mut().enumerate() {
            let middle = 1.0 + (step as f64 + 0.5) / STEPS as f64;
            *power = libm::pow(middle, exponent);
        }
        let mut powers = Box::new([0.0; SIZE]);
        for (octave, entries) in powers.chunks_exact_mut(STEPS).enumerate() {
            let scale = libm::exp2(exponent * f64::from(MIN_EXPONENT + octave as i32));
            for (entry, power) in entries.iter_mut().zip(mantissa_powers) {
                *entry = power * scale;
            }
        }
        let mut series = [splat(0.0); TERMS];
        let mut coefficient = 1.0;
        for (k, term) in series.iter_mut().enumerate() {
            *term = splat(coefficient);
            coefficient *= (exponent - k as f64) / (k as f64 + 1.0);
        }
        Self { powers, series }
    }

    /// Returns z^n lane by lane; a negative z counts as zero.
    #[inline]
    pub(crate) fn raise(&self, z: Pack) -> Pack {
        const MIN_DEPTH: f64 = 1.0 / (1_u64 << -MIN_EXPONENT) as f64;
        const FIRST: usize = ((1023 + MIN_EXPONENT) as usize) * STEPS;
        let z = z.fast_max(splat(MIN_DEPTH));
        let power = |z: f64| {
            let place = (z.to_bits() >> SHIFT) as usize;
            self.powers[place.wrapping_sub(FIRST) & (SIZE - 1)]
        };
        let [z0, z1, z2, z3] = z.to_array();
        let power = [power(z0), power(z1), power(z2), power(z3)];
        // the bits below those of the sub-interval are replaced by its middle
        let middle = (z & splat(f64::from_bits(u64::MAX << SHIFT))) | splat(f64::from_bits(1 << (SHIFT - 1)));
        let t = (z - middle) / middle;
        let [c0, c1, c2, c3] = self.series;
        Pack::new(power) * ((c0 + c1 * t) + (t * t) * (c2 + c3 * t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn power_agrees_with_libm() {
        for exponent in [0.5, 0.8, 1.0, 1.1, 1.37, 2.0] {
            let power = Power::new(exponent);
            let mut worst = 0.0_f64;
            for i in 0..400_000_u32 {
                let z = 1e-9 * libm::exp(f64::from(i) * 5e-5);
                let got = power.raise(splat(z)).to_array()[2];
                worst = worst.max((got / libm::pow(z, exponent) - 1.0).abs());
            }
            assert!(worst < 1e-12, "{exponent}: {worst:e}");
        }
        assert!(Power::new(1.1).raise(splat(-1.0)).to_array()[0] < 1e-13);
    }
}
