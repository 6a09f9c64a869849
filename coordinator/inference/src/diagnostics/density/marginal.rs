//! The density of draws by a Gaussian kernel.

use super::kernel::REACH;
use crate::diagnostics::moments::mean_and_sd;
use crate::diagnostics::quantile::quantile;

/// Returns the bandwidth that is optimal for a normal density: h = (4 / (3 n))^(1/5) s.
///
/// s is the smaller of standard deviation and interquartile range / 1.349, so that neither tails nor a second mode
/// oversmooth; where half the draws are equal, the standard deviation.
///
/// # Arguments
/// - `values`: n equally weighted draws, in any unit.
///
/// # Returns
/// h > 0 in the unit of the draws; `None` for fewer than two draws, or where all are equal.
///
/// # Source
/// Silverman 1986, Density Estimation for Statistics and Data Analysis, Eq. 3.28, with the robust s of Eq. 3.30; his rule of
/// thumb (Eq. 3.31) is 0.85 of it. Checked by `the_bandwidth_is_silverman_s`.
#[must_use]
pub fn bandwidth(values: &[f64]) -> Option<f64> {
    if values.len() < 2 {
        return None;
    }
    let (_, sd) = mean_and_sd(values)?;
    let width = (quantile(values, 0.75)? - quantile(values, 0.25)?) / 1.349;
    let spread = if width > 0.0 { sd.min(width) } else { sd };
    (spread > 0.0).then(|| libm::pow(4.0 / (3.0 * values.len() as f64), 0.2) * spread)
}

/// Returns the density of draws at the points of a grid, by a Gaussian kernel that is reflected at the bounds of the support.
///
/// `f(x) = 1/(n h sqrt(2 pi)) sum_i sum_k exp(-(x - x_ik)^2 / (2 h^2))`, `x_ik` the draw and its mirror images in the bounds.
///
/// # Arguments
/// - `values`: equally weighted draws, each within the support.
/// - `support`: lower and upper bound, infinite where there is none. Beyond it the density is 0.
/// - `grid`: points of evaluation, in the unit of the draws.
///
/// # Returns
/// The density in 1 over the unit of the draws; `None` where [`bandwidth`] is `None`.
///
/// # Validity
/// It integrates to 1 over the support. Reflection keeps mass and height at a bound, but makes the slope 0 there.
/// Between two bounds three images are summed to either side, enough for every bandwidth of draws between them.
///
/// # Source
/// Silverman 1986, section 2.10 (reflection). Checked by `it_integrates_to_one_between_bounds` and others below.
#[must_use]
pub fn density(values: &[f64], support: (f64, f64), grid: &[f64]) -> Option<Vec<f64>> {
    let h = bandwidth(values)?;
    let images: Vec<f64> = values.iter().flat_map(|&x| images(x, support)).collect();
    let scale = 1.0 / (values.len() as f64 * h * libm::sqrt(2.0 * std::f64::consts::PI));
    let at = |&x: &f64| {
        if x < support.0 || x > support.1 {
            return 0.0;
        }
        let distances = images.iter().map(|image| (x - image) / h);
        let near = distances.filter(|u| u.abs() < REACH);
        scale * near.map(|u| libm::exp(-0.5 * u * u)).sum::<f64>()
    };
    Some(grid.iter().map(at).collect())
}

/// Returns a draw and its mirror images in the bounds of a support.
fn images(x: f64, (lower, upper): (f64, f64)) -> Vec<f64> {
    match (lower.is_finite(), upper.is_finite()) {
        (false, false) => vec![x],
        (true, false) => vec![x, 2.0 * lower - x],
        (false, true) => vec![x, 2.0 * upper - x],
        (true, true) => {
            let period = 2.0 * (upper - lower);
            [-1.0, 0.0, 1.0]
                .into_iter()
                .flat_map(|k| [x + k * period, 2.0 * lower - x + k * period])
                .collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use statistics::prior::{Distribution, Marginal};

    const FREE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

    /// Evenly spread quantiles of a distribution: a sample without chance.
    fn sample(distribution: Distribution, n: usize) -> Vec<f64> {
        let marginal = Marginal::new(distribution, None).unwrap();
        (0..n)
            .map(|k| marginal.quantile((k as f64 + 0.5) / n as f64))
            .collect()
    }

    fn grid(from: f64, to: f64, n: usize) -> Vec<f64> {
        (0..n)
            .map(|k| from + (to - from) * k as f64 / (n - 1) as f64)
            .collect()
    }

    fn integral(x: &[f64], f: &[f64]) -> f64 {
        let part = |i: usize| 0.5 * (f[i] + f[i + 1]) * (x[i + 1] - x[i]);
        (0..x.len() - 1).map(part).sum()
    }

    #[test]
    fn the_bandwidth_is_silverman_s() {
        // 243 draws: (4 / 729)^(1/5) = 0.353_070; the quartiles of 0, 1, ..., 242 are 60.5 and 181.5.
        let values: Vec<f64> = (0..243).map(f64::from).collect();
        // The sd, sqrt(243 * 244 / 12) = 70.29, is the smaller one: 121 / 1.349 = 89.7.
        let expected = 0.353_070 * 70.292_247;
        assert!((bandwidth(&values).unwrap() - expected).abs() < 1e-3);
        // A few wild draws change the quartiles, 59.75 and 179.25 of 240, hardly.
        let mut wild: Vec<f64> = (0..240).map(f64::from).collect();
        wild.extend([1e6, 2e6, 3e6]);
        let ratio = bandwidth(&wild).unwrap() / (0.353_070 * 121.0 / 1.349);
        assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
        assert_eq!(bandwidth(&[1.0]), None);
        assert_eq!(bandwidth(&[2.0; 9]), None);
    }

    #[test]
    fn a_normal_sample_gives_the_normal_widened_by_the_kernel() {
        let values = sample(Distribution::Normal { mean: 3.0, sd: 2.0 }, 2000);
        let x = grid(-9.0, 15.0, 241);
        let f = density(&values, FREE, &x).unwrap();
        assert!((integral(&x, &f) - 1.0).abs() < 1e-6);
        // A normal smoothed by a normal kernel is a normal with the squares of both sds.
        let h = bandwidth(&values).unwrap();
        let sd = (4.0 + h * h).sqrt();
        for (x, f) in x.iter().zip(&f) {
            let u = (x - 3.0) / sd;
            let exact = (-0.5 * u * u).exp() / (sd * (2.0 * std::f64::consts::PI).sqrt());
            assert!((f - exact).abs() < 5e-4, "{f} where {exact} is due at {x}");
        }
    }

    #[test]
    fn at_a_bound_the_height_is_kept() {
        // |normal| has the height 2 / sqrt(2 pi) = 0.798 at 0; without reflection half of it is left.
        let values = sample(Distribution::HalfNormal { scale: 1.0 }, 2000);
        let x = grid(0.0, 8.0, 401);
        let f = density(&values, (0.0, f64::INFINITY), &x).unwrap();
        assert!((f[0] - 0.798).abs() < 0.02, "{}", f[0]);
        assert!((integral(&x, &f) - 1.0).abs() < 1e-4);
        let open = density(&values, FREE, &x).unwrap();
        assert!((open[0] - 0.399).abs() < 0.02, "{}", open[0]);
        let mirrored: Vec<f64> = values.iter().map(|v| -v).collect();
        let reflected = density(&mirrored, (f64::NEG_INFINITY, 0.0), &[0.0, -1.0]).unwrap();
        assert_eq!([reflected[0].to_bits()], [f[0].to_bits()]);
    }

    #[test]
    fn it_integrates_to_one_between_bounds() {
        let x = grid(0.0, 2.0, 401);
        for values in [
            sample(
                Distribution::Uniform {
                    lower: 0.0,
                    upper: 2.0,
                },
                300,
            ),
            vec![0.0, 2.0],
            vec![0.0, 0.1, 0.2, 2.0],
        ] {
            let f = density(&values, (0.0, 2.0), &x).unwrap();
            assert!((integral(&x, &f) - 1.0).abs() < 5e-3, "{values:?}");
            assert!(
                x.iter()
                    .zip(&f)
                    .all(|(x, f)| (0.0..=2.0).contains(x) || *f < 1e-300)
            );
        }
        // A uniform sample stays uniform up to its bounds.
        let values = sample(
            Distribution::Uniform {
                lower: 0.0,
                upper: 2.0,
            },
            300,
        );
        let f = density(&values, (0.0, 2.0), &grid(0.0, 2.0, 41)).unwrap();
        assert!(f.iter().all(|f| (f - 0.5).abs() < 2e-3), "{f:?}");
    }

    #[test]
    fn equal_draws_have_no_density() {
        assert_eq!(density(&[1.0; 5], FREE, &[1.0]), None);
        assert_eq!(density(&[], FREE, &[1.0]), None);
    }
}
