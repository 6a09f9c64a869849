//! `exp`, `ln` and powers that vectorise and have the same bits on every machine.
//!
//! A contact spends most of its time in these three. They have no branches and use only IEEE additions,
//! multiplications, divisions and integer arithmetic, so that a loop over points compiles to vector code
//! and every machine agrees on the result. Relative error below 1e-15 for `exp` and `ln`
//! (checked against `libm` in this file's tests); domains are restricted, as stated, to what a contact needs.

const LN_2_HIGH: f64 = 0.693_147_180_369_123_8; // the upper bits of ln 2: times a small integer is exact
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10; // ln 2 − LN_2_HIGH
const MANTISSA: u64 = 0x000f_ffff_ffff_ffff;
const ONE: u64 = 0x3ff0_0000_0000_0000; // bits of 1.0
const ROOT_HALF: u64 = 0x3fe6_a09e_667f_3bcd; // bits of sqrt(1/2)
const TWO_52: f64 = 4_503_599_627_370_496.0;

/// The smallest argument of [`exp`] that is distinguished from smaller ones.
pub const MIN_EXPONENT: f64 = -700.0;

/// Computes e^x for x ≤ 700; below [`MIN_EXPONENT`] it gives e^−700 (1e-304), which no sum in this crate can tell from 0.
#[inline]
pub fn exp(x: f64) -> f64 {
    let x = if x > MIN_EXPONENT { x } else { MIN_EXPONENT };
    // Adding 1.5 · 2^52 leaves the nearest integer k in the low bits of the sum.
    let shifted = x * core::f64::consts::LOG2_E + 1.5 * TWO_52;
    let k = shifted - 1.5 * TWO_52;
    let r = (x - k * LN_2_HIGH) - k * LN_2_LOW; // |r| ≤ ln 2 / 2
    // Taylor polynomial of degree 12 (remainder 1.7e-16), in pairs so that the chain of operations is short.
    let r2 = r * r;
    let r4 = r2 * r2;
    let low = (1.0 + r) + r2 * (0.5 + r * (1.0 / 6.0));
    let middle = (1.0 / 24.0 + r * (1.0 / 120.0)) + r2 * (1.0 / 720.0 + r * (1.0 / 5_040.0));
    let high = (1.0 / 40_320.0 + r * (1.0 / 362_880.0)) + r2 * (1.0 / 3_628_800.0 + r * (1.0 / 39_916_800.0));
    let series = low + r4 * (middle + r4 * (high + r4 * (1.0 / 479_001_600.0)));
    // Multiplies by 2^k: k + 1023 goes into the exponent field; higher bits of k are shifted out.
    series * f64::from_bits((shifted.to_bits() << 52).wrapping_add(ONE))
}

/// Computes the natural logarithm of a positive, normal x. Any other x gives an unspecified number.
#[inline]
pub fn ln(x: f64) -> f64 {
    // x = 2^k m with sqrt(1/2) ≤ m < sqrt(2).
    let bits = x.to_bits().wrapping_add(ONE - ROOT_HALF);
    let m = f64::from_bits((bits & MANTISSA).wrapping_add(ROOT_HALF));
    let k = f64::from_bits((bits >> 52) | TWO_52.to_bits()) - (TWO_52 + 1023.0);
    // ln m = 2 artanh(s), s = (m − 1) / (m + 1), |s| ≤ 0.172; the first term left out is below 3e-17.
    let s = (m - 1.0) / (m + 1.0);
    let q = s * s;
    let q2 = q * q;
    let q4 = q2 * q2;
    let low = (1.0 / 3.0 + q * (1.0 / 5.0)) + q2 * (1.0 / 7.0 + q * (1.0 / 9.0));
    let middle = (1.0 / 11.0 + q * (1.0 / 13.0)) + q2 * (1.0 / 15.0 + q * (1.0 / 17.0));
    let series = low + q4 * (middle + q4 * (1.0 / 19.0 + q * (1.0 / 21.0)));
    let twice = s + s;
    k * LN_2_HIGH + (twice + (twice * q * series + k * LN_2_LOW))
}

/// Computes `base^exponent` for 0 < base ≤ 1 and exponent ≥ 0; never below e^−700 (see [`exp`]).
#[inline]
pub fn fraction_pow(base: f64, exponent: f64) -> f64 {
    exp(exponent * ln(base))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exp_agrees_with_libm_within_four_parts_in_1e16() {
        for i in 0..=1_000_000_u32 {
            let x = -690.0 + f64::from(i) * 1e-3;
            let expected = libm::exp(x);
            assert!((exp(x) / expected - 1.0).abs() < 6e-16, "exp({x})");
        }
        assert!(exp(f64::NEG_INFINITY) < 1e-303 && exp(-0.0).to_bits() == ONE);
    }

    #[test]
    fn ln_agrees_with_libm_within_a_few_units_in_the_last_place() {
        for i in 0..=1_000_000_u32 {
            let x = libm::exp(-200.0 + f64::from(i) * 4e-4);
            let expected = libm::log(x);
            assert!(
                (ln(x) - expected).abs() <= 6e-16 * expected.abs(),
                "ln({x}) {} {expected}",
                ln(x)
            );
        }
        assert!(ln(1.0).abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn power_of_a_fraction_agrees_with_libm() {
        for i in 1..=1000_u32 {
            let base = f64::from(i) * 1e-3;
            for exponent in [0.0, 0.3, 1.0, 1.1, 2.5] {
                let expected = libm::pow(base, exponent);
                assert!(
                    (fraction_pow(base, exponent) / expected - 1.0).abs() < 5e-15,
                    "{base}^{exponent}"
                );
            }
        }
    }
}
