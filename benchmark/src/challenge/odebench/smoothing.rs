//! A smooth curve through measurements of one state.

use nalgebra::{DMatrix, DVector};

/// Prior sds of the first and the second derivative at the start, over the size of the values, in units of the span.
const DERIVATIVES: [f64; 2] = [10.0, 100.0];
/// Decimal logarithms of the roughness that are compared, and their distance.
const ROUGHNESS: [i32; 2] = [0, 20];
const DISTANCE: f64 = 0.5;

/// Returns the covariance of a twice integrated Wiener process at two times in units of the span.
fn wiener(a: f64, b: f64) -> f64 {
    let (s, d) = (a.min(b), (a - b).abs());
    s * s * s * (s * s / 20.0 + d * s / 8.0 + d * d / 12.0)
}

/// Returns the smooth values of a state: its start, which is given, and those at equal distances of time; `None` if no matrix is positive
/// definite.
///
/// The curve is a Gaussian process, twice an integral of a Wiener process, with unknown derivatives at the start (a quintic smoothing
/// spline). Its roughness is the one of the greatest likelihood.
///
/// # Arguments
/// - `sd`: of the noise.
pub fn smoothed(start: f64, values: &[f64], sd: f64) -> Option<Vec<f64>> {
    let count = values.len();
    let time = |k: usize| (k + 1) as f64 / count as f64;
    let rises = DVector::from_iterator(count, values.iter().map(|y| y - start));
    let size = rises.amax() + sd;
    let [first, second] = DERIVATIVES.map(|sd| sd * sd * size * size);
    let smooth = |exponent: i32| -> Option<(f64, DVector<f64>)> {
        let roughness = libm::exp10(DISTANCE * f64::from(exponent)) * size * size;
        let process = DMatrix::from_fn(count, count, |j, k| {
            let (a, b) = (time(j), time(k));
            first * a * b + second * a * a * b * b / 4.0 + roughness * wiener(a, b)
        });
        let noise = DMatrix::from_diagonal_element(count, count, sd * sd);
        let root = (&process + noise).cholesky()?;
        let weights = root.solve(&rises);
        let determinant: f64 = root.l_dirty().diagonal().iter().map(|x| libm::log(*x)).sum();
        Some((-0.5 * rises.dot(&weights) - determinant, process * weights))
    };
    let fits = (ROUGHNESS[0]..=ROUGHNESS[1]).filter_map(smooth);
    let (_, curve) = fits.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let curve = curve.iter().map(|rise| start + rise);
    Some(std::iter::once(start).chain(curve).collect())
}
