//! The law of the errors: normal, or Student's t with its heavy tails.

use super::datum::LikelihoodError;
use crate::prior::LN_SQRT_TAU;

/// The distribution of the errors.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ErrorLaw {
    /// Normal; the scale is the standard deviation.
    #[default]
    Gaussian,
    /// Student's t, with heavy tails.
    ///
    /// The declared sd is the *scale* of the t, not its standard deviation, which is `sqrt(nu / (nu - 2))` times as large
    /// for `nu > 2`. Correlated errors have a multivariate t: the block as a whole may be an outlier.
    StudentT {
        /// Degrees of freedom nu, > 0.
        degrees_of_freedom: f64,
    },
}

impl ErrorLaw {
    pub(super) fn check(self) -> Result<(), LikelihoodError> {
        match self {
            ErrorLaw::StudentT {
                degrees_of_freedom: value,
            } if !(value.is_finite() && value > 0.0) => Err(LikelihoodError::Setting {
                name: "degrees_of_freedom",
                value,
                bound: "a finite number above 0",
            }),
            _ => Ok(()),
        }
    }

    /// Returns the log-density of `count` errors whose scale matrix has this log-determinant, at this squared distance
    /// `r' S^-1 r`.
    ///
    /// # Source
    /// Kotz & Nadarajah 2004, *Multivariate t Distributions and Their Applications*, Eq. 1.1. Checked by
    /// `likelihood::a_t_of_one_datum_has_its_hand_number` and `likelihood::blocks_match_a_dense_density`.
    pub(super) fn log_density(self, count: usize, squared_distance: f64, log_determinant: f64) -> f64 {
        let k = count as f64;
        match self {
            ErrorLaw::Gaussian => -k * LN_SQRT_TAU - 0.5 * log_determinant - 0.5 * squared_distance,
            ErrorLaw::StudentT {
                degrees_of_freedom: nu,
            } => {
                libm::lgamma(0.5 * (nu + k))
                    - libm::lgamma(0.5 * nu)
                    - 0.5 * k * libm::log(nu * std::f64::consts::PI)
                    - 0.5 * log_determinant
                    - 0.5 * (nu + k) * libm::log1p(squared_distance / nu)
            }
        }
    }

    /// Returns the weights of the slope and of the expected curvature along the errors, relative to those of the normal law.
    ///
    /// The slope of the t is `(nu + k) / (nu + q)` times the normal's at the squared distance q; its Fisher
    /// information is `(nu + k) / (nu + k + 2)` times the normal's (Lange, Little & Taylor 1989, J. Am. Stat. Assoc.
    /// 84:881, doi:10.2307/2290063).
    pub(super) fn weights(self, count: usize, squared_distance: f64) -> [f64; 2] {
        let k = count as f64;
        match self {
            ErrorLaw::Gaussian => [1.0, 1.0],
            ErrorLaw::StudentT {
                degrees_of_freedom: nu,
            } => [(nu + k) / (nu + squared_distance), (nu + k) / (nu + k + 2.0)],
        }
    }

    /// Returns the probability of an error below z scales.
    #[must_use]
    pub fn cumulative(self, z: f64) -> f64 {
        match self {
            ErrorLaw::Gaussian => 0.5 * libm::erfc(-z * std::f64::consts::FRAC_1_SQRT_2),
            ErrorLaw::StudentT {
                degrees_of_freedom: nu,
            } => {
                let tail = 0.5 * incomplete_beta(0.5 * nu, 0.5, nu / (nu + z * z));
                if z < 0.0 { tail } else { 1.0 - tail }
            }
        }
    }
}

/// The maximum number of terms of the continued fraction; any nu below 1e6 needs far fewer.
const TERMS: u32 = 10_000;

/// Returns the regularised incomplete beta function `I_x(a, b)` by its continued fraction (Lentz's method).
///
/// # Source
/// Abramowitz & Stegun 26.5.8. Checked by `law::tests`.
fn incomplete_beta(a: f64, b: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    // The fraction converges fast below the mean, its mirror image above.
    if x > (a + 1.0) / (a + b + 2.0) {
        return 1.0 - incomplete_beta(b, a, 1.0 - x);
    }
    let front = libm::exp(
        libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b) + a * libm::log(x) + b * libm::log1p(-x),
    );
    let kept = |v: f64| if v.abs() < 1e-300 { 1e-300 } else { v };
    let mut c = 1.0;
    let mut d = 1.0 / kept(1.0 - (a + b) * x / (a + 1.0));
    let mut fraction = d;
    for m in 1..TERMS {
        let m = f64::from(m);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / kept(1.0 + even * d);
        c = kept(1.0 + even / c);
        fraction *= d * c;
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / kept(1.0 + odd * d);
        c = kept(1.0 + odd / c);
        let factor = d * c;
        fraction *= factor;
        if (factor - 1.0).abs() < 1e-15 {
            break;
        }
    }
    front * fraction / a
}

#[cfg(test)]
mod tests {
    use super::ErrorLaw;

    #[test]
    fn quantiles_of_a_table_have_their_probability() {
        // Abramowitz & Stegun, table 26.10: 95 % points.
        for (nu, z) in [
            (1.0, 6.313_752),
            (3.0, 2.353_363),
            (5.0, 2.015_048),
            (30.0, 1.697_261),
        ] {
            let law = ErrorLaw::StudentT {
                degrees_of_freedom: nu,
            };
            assert!((law.cumulative(z) - 0.95).abs() < 1e-6, "{nu}");
            assert!((law.cumulative(-z) - 0.05).abs() < 1e-6, "{nu}");
            assert!((law.cumulative(0.0) - 0.5).abs() < 1e-12, "{nu}");
        }
        assert!((ErrorLaw::Gaussian.cumulative(1.644_853_627) - 0.95).abs() < 1e-9);
    }
}
