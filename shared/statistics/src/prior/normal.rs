//! The standard normal distribution, both tails to full relative accuracy.

/// The logarithm of sqrt(2 pi).
pub const LN_SQRT_TAU: f64 = 0.918_938_533_204_672_8;

/// Number of Newton steps after which the quantile has converged for every representable probability.
const NEWTON_STEPS: usize = 60;

/// Returns P(Z < z).
pub fn cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2)
}

/// Returns ln P(Z < z); below -30 by the first term of Mills' ratio, with an error of 1/z^2.
pub fn log_cdf(z: f64) -> f64 {
    if z > -30.0 {
        libm::log(cdf(z))
    } else {
        -0.5 * z * z - LN_SQRT_TAU - libm::log(-z)
    }
}

/// Returns P(a < Z < b) without cancellation in the tails.
pub(super) fn mass(a: f64, b: f64) -> f64 {
    if a > 0.0 {
        cdf(-a) - cdf(-b)
    } else if b < 0.0 {
        cdf(b) - cdf(a)
    } else {
        1.0 - cdf(a) - cdf(-b)
    }
}

/// Returns the z with P(Z < z) = `p`, for 0 < `p` <= 1/2.
///
/// Newton on ln cdf, which is concave and increasing, from a start below the root (cdf(z) <= exp(-z^2/2)/2
/// for z <= 0): the iterates rise to the root and never pass it.
pub fn lower_quantile(p: f64) -> f64 {
    let mut z = -(-2.0 * libm::log(2.0 * p)).max(0.0).sqrt();
    for _ in 0..NEWTON_STEPS {
        let below = cdf(z);
        let slope = libm::exp(-0.5 * z * z - LN_SQRT_TAU) / below;
        let step = libm::log(p / below) / slope;
        if !step.is_finite() || step <= 1e-15 * (1.0 + z.abs()) {
            break;
        }
        z += step;
    }
    z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantile_inverts_the_distribution_function() {
        for p in [1e-300, 1e-100, 1e-16, 1e-6, 0.01, 0.2, 0.49, 0.5] {
            let back = cdf(lower_quantile(p));
            assert!((back / p - 1.0).abs() < 1e-10, "{p}: {back}");
        }
        // Tables: z(0.025) = 1.959 963 984 540 054.
        assert!((lower_quantile(0.025) + 1.959_963_984_540_054).abs() < 1e-13);
    }

    #[test]
    fn mass_keeps_its_digits_in_the_tail() {
        // Q(10) = 7.619 853 024 160 527e-24, Q(11) = 1.910 659 574 498 69e-28.
        let expected = 7.619_853_024_160_527e-24 - 1.910_659_574_498_69e-28;
        assert!((mass(10.0, 11.0) / expected - 1.0).abs() < 1e-12);
        assert!((mass(-11.0, -10.0) / expected - 1.0).abs() < 1e-12);
    }
}
