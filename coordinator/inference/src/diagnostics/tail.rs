//! Tail probabilities of test statistics.

/// Number of terms after which the series and the fraction have converged for any degrees of freedom below 1e6.
const TERMS: u32 = 10_000;

/// Returns P(chi-square with these degrees of freedom >= `x`); the degrees of freedom need not be whole. 1 for `x` <= 0.
///
/// # Returns
/// `Q(nu / 2, x / 2)`, the upper regularised incomplete gamma function; `None` unless `nu` > 0 and `x` is a number.
///
/// # Source
/// Abramowitz & Stegun 26.4.19; 6.5.29 (series) below the mean, 6.5.31 (continued fraction, Lentz's method) above.
/// Checked by `tail::tests`.
#[must_use]
pub fn chi_square_tail(x: f64, nu: f64) -> Option<f64> {
    if x.is_nan() || !(nu.is_finite() && nu > 0.0) {
        return None;
    }
    if x <= 0.0 {
        return Some(1.0);
    }
    if x.is_infinite() {
        return Some(0.0);
    }
    let (a, x) = (0.5 * nu, 0.5 * x);
    let front = libm::exp(a * libm::log(x) - x - libm::lgamma(a));
    Some(if x < a + 1.0 {
        (1.0 - front * lower_series(a, x)).max(0.0)
    } else {
        front * upper_fraction(a, x)
    })
}

/// Returns `sum_k x^k / (a (a + 1) ... (a + k))`.
fn lower_series(a: f64, x: f64) -> f64 {
    let (mut term, mut sum) = (1.0 / a, 1.0 / a);
    for k in 1..TERMS {
        term *= x / (a + f64::from(k));
        sum += term;
        if term < 1e-16 * sum {
            break;
        }
    }
    sum
}

/// Returns the continued fraction of the upper incomplete gamma function, by Lentz's method.
fn upper_fraction(a: f64, x: f64) -> f64 {
    let kept = |v: f64| if v.abs() < 1e-300 { 1e-300 } else { v };
    let mut b = x + 1.0 - a;
    let mut c = 1e300;
    let mut d = 1.0 / kept(b);
    let mut fraction = d;
    for k in 1..TERMS {
        let k = f64::from(k);
        let numerator = -k * (k - a);
        b += 2.0;
        d = 1.0 / kept(numerator * d + b);
        c = kept(b + numerator / c);
        let factor = c * d;
        fraction *= factor;
        if (factor - 1.0).abs() < 1e-15 {
            break;
        }
    }
    fraction
}

/// Returns `ln P(X >= hits)`, where X is the number of marked ones among `drawn` of `all`, of which `marked` are marked: the
/// hypergeometric tail.
///
/// # Source
/// Fisher's exact test, one-sided. Checked by `tail::tests`.
pub(super) fn ln_hypergeometric_tail(all: usize, marked: usize, drawn: usize, hits: usize) -> f64 {
    let ln_factorial = |n: usize| libm::lgamma(n as f64 + 1.0);
    let ln_choose = |n: usize, k: usize| ln_factorial(n) - ln_factorial(k) - ln_factorial(n - k);
    let lowest = (marked + drawn).saturating_sub(all);
    if hits <= lowest {
        return 0.0;
    }
    let terms: Vec<f64> = (hits..=marked.min(drawn))
        .map(|x| ln_choose(marked, x) + ln_choose(all - marked, drawn - x) - ln_choose(all, drawn))
        .collect();
    let highest = terms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !highest.is_finite() {
        return highest;
    }
    let sum: f64 = terms.iter().map(|t| libm::exp(t - highest)).sum();
    (highest + libm::log(sum)).min(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chi_square_quantiles_of_a_table_have_their_probability() {
        // Abramowitz & Stegun, table 26.8.
        for (nu, x, p) in [
            (1.0, 3.841_459, 0.05),
            (1.0, 10.827_57, 0.001),
            (10.0, 18.307_04, 0.05),
            (10.0, 3.940_30, 0.95),
            (100.0, 124.342, 0.05),
        ] {
            let tail = chi_square_tail(x, nu).unwrap();
            assert!((tail / p - 1.0).abs() < 1e-4, "{nu} {x}: {tail}");
        }
        // With two degrees of freedom the tail is exp(-x/2), far out as well.
        for x in [0.1, 1.0, 7.0, 300.0] {
            let tail = chi_square_tail(x, 2.0).unwrap();
            assert!((tail / libm::exp(-0.5 * x) - 1.0).abs() < 1e-12, "{x}");
        }
        // Q(a + 1, x) = Q(a, x) + x^a exp(-x) / Gamma(a + 1), here with degrees of freedom that are not whole.
        let (a, x) = (1.3, 2.1);
        let step = libm::exp(a * libm::log(x) - x - libm::lgamma(a + 1.0));
        let [low, high] = [a, a + 1.0].map(|a| chi_square_tail(2.0 * x, 2.0 * a).unwrap());
        assert!((high - low - step).abs() < 1e-14);
    }

    #[test]
    fn a_chi_square_without_freedom_has_no_probability() {
        assert_eq!(chi_square_tail(1.0, 0.0), None);
        assert_eq!(chi_square_tail(f64::NAN, 1.0), None);
        assert_eq!(chi_square_tail(-1.0, 3.0), Some(1.0));
        assert_eq!(chi_square_tail(f64::INFINITY, 3.0), Some(0.0));
    }

    #[test]
    fn hypergeometric_tails_by_hand() {
        // Two of four are marked, two are drawn: both are marked with 1/6, at least one with 5/6, at least none with 1.
        let tail = |hits| libm::exp(ln_hypergeometric_tail(4, 2, 2, hits));
        assert!((tail(2) - 1.0 / 6.0).abs() < 1e-12);
        assert!((tail(1) - 5.0 / 6.0).abs() < 1e-12);
        assert!((tail(0) - 1.0).abs() < 1e-12);
        // More are drawn than are unmarked: one hit is sure.
        assert!((libm::exp(ln_hypergeometric_tail(4, 3, 2, 1)) - 1.0).abs() < 1e-12);
        // More hits than marked ones are impossible.
        assert!(ln_hypergeometric_tail(4, 1, 2, 2) < -1e300);
    }
}
