//! The joint density of two parameters by a Gaussian kernel.

use super::kernel::REACH;
use crate::diagnostics::moments::mean_and_sd;

/// Returns the joint density of draws of two parameters on a grid, by a Gaussian kernel of constant window.
///
/// `f(x) = 1/(n 2 pi |H|^(1/2)) sum_i exp(-(x - x_i)' H^-1 (x - x_i) / 2)` with `H = n^(-1/3) S`, S the covariance of the draws.
/// The kernel has the correlation of the draws, so a ridge is not smoothed across. The estimate is reflected at the bounds of the
/// support, in each coordinate.
///
/// # Arguments
/// - `values`: the draws of both parameters, equally weighted, pairwise, within their supports.
/// - `support`: lower and upper bound of each, infinite where there is none. Beyond them the density is 0.
/// - `grid`: the values of each at which it is evaluated.
///
/// # Returns
/// The density in 1 over the product of the units, row by row: `[grid[1]][grid[0]]`, the first parameter fastest. `None` for
/// fewer than three draws, of lists of different lengths, and where the draws lie on a line.
///
/// # Validity
/// It integrates to 1 over the support where the bandwidth is small against the support's width. One image is reflected at each
/// bound.
///
/// # Source
/// Scott 1992, Multivariate Density Estimation, Eq. 6.42 with d = 2: the bandwidth that is optimal for a normal density;
/// reflection as in Silverman 1986, section 2.10. Checked by `a_correlated_normal_is_recovered` and others below.
#[must_use]
pub fn joint_density(values: [&[f64]; 2], support: [(f64, f64); 2], grid: [&[f64]; 2]) -> Option<Vec<f64>> {
    let n = values[0].len();
    if n < 3 || values[1].len() != n {
        return None;
    }
    let kernel = Kernel::new(values)?;
    // Draws are transformed to coordinates in which the kernel is round. A mirrored draw has a mirrored kernel, so the point is
    // mirrored instead.
    let round: Vec<[f64; 2]> = values[0]
        .iter()
        .zip(values[1])
        .map(|(x, y)| kernel.round(*x, *y))
        .collect();
    let reach = [0, 1].map(|i| REACH * kernel.sd[i]);
    let open = |x: f64, y: f64| {
        let [a, b] = kernel.round(x, y);
        let squares = round.iter().map(|r| {
            let (u, v) = (a - r[0], b - r[1]);
            u * u + v * v
        });
        let near = squares.filter(|s| *s < REACH * REACH);
        near.map(|s| libm::exp(-0.5 * s)).sum::<f64>()
    };
    let scale = 1.0 / (n as f64 * 2.0 * std::f64::consts::PI * kernel.root);
    let mut density = Vec::with_capacity(grid[0].len() * grid[1].len());
    for &y in grid[1] {
        let ys = folds(y, support[1], reach[1]);
        for &x in grid[0] {
            let xs = folds(x, support[0], reach[0]);
            let images = ys.iter().flat_map(|y| xs.iter().map(move |x| (*x, *y)));
            density.push(scale * images.map(|(x, y)| open(x, y)).sum::<f64>());
        }
    }
    Some(density)
}

/// Returns a point and its mirror images in the bounds within reach of the kernel; none for a point beyond the support.
fn folds(x: f64, (lower, upper): (f64, f64), reach: f64) -> Vec<f64> {
    if x < lower || x > upper {
        return Vec::new();
    }
    let bounds = [lower, upper].into_iter();
    let near = bounds.filter(|bound| (x - bound).abs() < reach);
    std::iter::once(x)
        .chain(near.map(|bound| 2.0 * bound - x))
        .collect()
}

/// The kernel: H = L L', L lower triangular.
struct Kernel {
    /// L: first diagonal element, the one below it, second diagonal element.
    factor: [f64; 3],
    sd: [f64; 2],
    /// Square root of the determinant of H.
    root: f64,
}

impl Kernel {
    fn new(values: [&[f64]; 2]) -> Option<Self> {
        let n = values[0].len() as f64;
        let (mean_x, sd_x) = mean_and_sd(values[0])?;
        let (mean_y, sd_y) = mean_and_sd(values[1])?;
        let pairs = values[0].iter().zip(values[1]);
        let cross: f64 = pairs.map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
        let correlation = cross / ((n - 1.0) * sd_x * sd_y);
        // This product is 1 - r^2, accurate even for r near 1.
        let rest = (1.0 - correlation) * (1.0 + correlation);
        // An sd of 0 makes the correlation NaN.
        if rest <= 1e-12 || rest.is_nan() {
            return None;
        }
        let h = libm::pow(n, -1.0 / 6.0);
        let sd = [h * sd_x, h * sd_y];
        let factor = [sd[0], correlation * sd[1], libm::sqrt(rest) * sd[1]];
        Some(Kernel {
            factor,
            sd,
            root: factor[0] * factor[2],
        })
    }

    /// Returns L^-1 (x, y).
    fn round(&self, x: f64, y: f64) -> [f64; 2] {
        let [first, below, second] = self.factor;
        let u = x / first;
        [u, (y - below * u) / second]
    }
}

/// Returns the levels of a density whose contours enclose given shares of the probability: highest-density regions.
///
/// # Arguments
/// - `density`: values on a grid of equal cells.
/// - `shares`: of the probability on the grid, each in (0, 1).
///
/// # Returns
/// For each share the lowest density of the region; empty where the density is 0 everywhere.
///
/// # Source
/// Hyndman 1996, Computing and graphing highest density regions, Am. Stat. 50:120, doi:10.1080/00031305.1996.10474359. Checked by
/// `levels_enclose_their_shares`.
#[must_use]
pub fn highest_density_levels(density: &[f64], shares: &[f64]) -> Vec<f64> {
    let mut sorted = density.to_vec();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let total: f64 = sorted.iter().sum();
    if total <= 0.0 {
        return Vec::new();
    }
    let level = |share: &f64| {
        let mut enclosed = 0.0;
        let reached = sorted.iter().find(|value| {
            enclosed += *value;
            enclosed >= share * total
        });
        reached.copied().unwrap_or(0.0)
    };
    shares.iter().map(level).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use statistics::prior::{Distribution, Marginal};

    const FREE: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

    /// Evenly spread pairs of a normal with unit sds and this correlation: a lattice without chance (Korobov).
    fn normal(correlation: f64) -> [Vec<f64>; 2] {
        let marginal = Marginal::new(Distribution::Normal { mean: 0.0, sd: 1.0 }, None).unwrap();
        let n = 3000;
        let pair = |k: usize| {
            let u = marginal.quantile((k as f64 + 0.5) / f64::from(n));
            let v = marginal.quantile((0.5 + 0.618_033_988_75 * k as f64) % 1.0);
            (u, correlation * u + (1.0 - correlation * correlation).sqrt() * v)
        };
        let (x, y) = (0..n as usize).map(pair).unzip();
        [x, y]
    }

    fn grid(half: f64, n: usize) -> Vec<f64> {
        (0..n)
            .map(|k| half * (2.0 * k as f64 / (n - 1) as f64 - 1.0))
            .collect()
    }

    #[test]
    fn a_correlated_normal_is_recovered() {
        for correlation in [0.0, -0.9] {
            let [x, y] = normal(correlation);
            let g = grid(5.0, 101);
            let f = joint_density([&x, &y], [FREE, FREE], [&g, &g]).unwrap();
            assert!((f.iter().sum::<f64>() * 0.01 - 1.0).abs() < 1e-3);
            // Smoothed by its own shape it is the same normal with 1 + n^(-1/3) times the covariance.
            let wider = 1.0 + 3000.0_f64.powf(-1.0 / 3.0);
            let rest: f64 = 1.0 - correlation * correlation;
            let peak = 1.0 / (2.0 * std::f64::consts::PI * wider * rest.sqrt());
            for (i, &b) in g.iter().enumerate() {
                for (k, &a) in g.iter().enumerate() {
                    let form = (a * a - 2.0 * correlation * a * b + b * b) / (rest * wider);
                    let exact = peak * (-0.5 * form).exp();
                    let got = f[i * g.len() + k];
                    assert!(
                        (got - exact).abs() < 0.03 * peak,
                        "{got} where {exact} is due at {a} {b}"
                    );
                }
            }
        }
    }

    #[test]
    fn at_bounds_the_mass_is_folded_back() {
        // Both coordinates mirrored at 0: the quarter plane holds everything, and the corner is four times as high.
        let [x, y] = normal(0.0);
        let (x, y): (Vec<f64>, Vec<f64>) = (
            x.iter().map(|v| v.abs()).collect(),
            y.iter().map(|v| v.abs()).collect(),
        );
        let g: Vec<f64> = (0..101).map(|k| 0.05 * (f64::from(k) + 0.5)).collect();
        let half = (0.0, f64::INFINITY);
        let f = joint_density([&x, &y], [half, half], [&g, &g]).unwrap();
        assert!((f.iter().sum::<f64>() * 0.0025 - 1.0).abs() < 5e-3);
        let corner = 4.0 / (2.0 * std::f64::consts::PI);
        assert!((f[0] / corner - 1.0).abs() < 0.1, "{} against {corner}", f[0]);
        let beyond = joint_density([&x, &y], [half, half], [&[-0.1], &[1.0]]).unwrap();
        assert!(beyond[0].abs() < 1e-300);
    }

    #[test]
    fn levels_enclose_their_shares() {
        // For a normal density of two parameters, the contour at (1 - p) of the peak encloses p.
        let [x, y] = normal(0.5);
        let g = grid(5.0, 101);
        let f = joint_density([&x, &y], [FREE, FREE], [&g, &g]).unwrap();
        let peak = f.iter().copied().fold(0.0, f64::max);
        let levels = highest_density_levels(&f, &[0.5, 0.9]);
        for (level, expected) in levels.iter().zip([0.5, 0.1]) {
            assert!(
                (level / peak - expected).abs() < 0.03,
                "{} {expected}",
                level / peak
            );
        }
        // By hand: 4 + 3 of 10 hold 0.7, 4 holds 0.4.
        let levels = highest_density_levels(&[1.0, 4.0, 2.0, 3.0], &[0.4, 0.5, 0.99]);
        assert_eq!(levels, [4.0, 3.0, 1.0]);
        assert!(highest_density_levels(&[0.0, 0.0], &[0.5]).is_empty());
    }

    #[test]
    fn draws_on_a_line_have_no_density() {
        let line = [1.0, 2.0, 3.0, 4.0];
        assert_eq!(
            joint_density([&line, &line], [FREE, FREE], [&[1.0], &[1.0]]),
            None
        );
        assert_eq!(
            joint_density([&line, &[1.0; 4]], [FREE, FREE], [&[1.0], &[1.0]]),
            None
        );
        assert_eq!(
            joint_density([&line, &line[..3]], [FREE, FREE], [&[1.0], &[1.0]]),
            None
        );
    }
}
