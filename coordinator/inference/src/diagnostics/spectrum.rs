//! The principal directions of draws: combinations of parameters that they determine best and worst.

use nalgebra::{DMatrix, SymmetricEigen};

/// A direction with the variance of the draws along it.
#[derive(Debug, Clone, PartialEq)]
pub struct Direction {
    /// Variance along the direction, in squared units of the coordinates.
    pub variance: f64,
    /// The direction, of length 1; its largest component is positive.
    pub loadings: Vec<f64>,
}

/// Returns the principal directions of equally weighted draws, the widest first; empty with fewer than two draws.
///
/// # Equation
/// Eigenvalues and eigenvectors of the sample covariance (divisor n - 1).
///
/// # Arguments
/// - `draws`: one vector of coordinates for each draw. In units of the prior's standard deviations the variances are
///   shares of the prior's: 1 along a direction of which the data hold no information.
///
/// # Validity
/// Where two variances are nearly equal, their directions are arbitrary within the plane that they span. Checked by
/// `spectrum::tests`.
#[must_use]
pub fn principal_directions(draws: &[Vec<f64>]) -> Vec<Direction> {
    let Some((_, covariance)) = mean_and_covariance(draws) else {
        return Vec::new();
    };
    if covariance.iter().any(|x| !x.is_finite()) {
        return Vec::new();
    }
    let dimension = covariance.nrows();
    let eigen = SymmetricEigen::new(covariance);
    let mut directions: Vec<Direction> = (0..dimension)
        .map(|k| {
            let loadings: Vec<f64> = (0..dimension).map(|i| eigen.eigenvectors[(i, k)]).collect();
            let largest = loadings
                .iter()
                .fold(0.0_f64, |l, &x| if x.abs() > l.abs() { x } else { l });
            let sign = if largest < 0.0 { -1.0 } else { 1.0 };
            Direction {
                // Rounding may leave a variance of zero slightly below it
                variance: eigen.eigenvalues[k].max(0.0),
                loadings: loadings.into_iter().map(|x| sign * x).collect(),
            }
        })
        .collect();
    directions.sort_by(|a, b| b.variance.total_cmp(&a.variance));
    directions
}

/// Returns the mean and sample covariance of draws; `None` with fewer than two.
pub(crate) fn mean_and_covariance(draws: &[Vec<f64>]) -> Option<(Vec<f64>, DMatrix<f64>)> {
    let dimension = draws.first()?.len();
    if draws.len() < 2 {
        return None;
    }
    let mean: Vec<f64> = (0..dimension)
        .map(|i| draws.iter().map(|d| d[i]).sum::<f64>() / draws.len() as f64)
        .collect();
    let divisor = (draws.len() - 1) as f64;
    let entry = |i: usize, j: usize| {
        let cross = draws.iter().map(|d| (d[i] - mean[i]) * (d[j] - mean[j]));
        cross.sum::<f64>() / divisor
    };
    // The upper half repeats the lower one: the sums would differ in their last bits.
    let covariance = DMatrix::from_fn(dimension, dimension, |i, j| entry(i.max(j), i.min(j)));
    Some((mean, covariance))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ridge_is_found_with_its_length_and_thickness() {
        // Along (1, -1)/sqrt 2 with +-2, across it with +-0.1: sums of squares 4 * 4 and 4 * 0.01 over three.
        let s = std::f64::consts::FRAC_1_SQRT_2;
        let draws: Vec<Vec<f64>> = [(2.0, 0.1), (2.0, -0.1), (-2.0, 0.1), (-2.0, -0.1)]
            .iter()
            .map(|(long, short)| vec![5.0 + s * (long + short), -3.0 + s * (short - long)])
            .collect();
        let [wide, narrow] = principal_directions(&draws).try_into().unwrap();
        assert!((wide.variance - 16.0 / 3.0).abs() < 1e-12);
        assert!((narrow.variance - 0.04 / 3.0).abs() < 1e-12);
        assert!((wide.loadings[0] + wide.loadings[1]).abs() < 1e-12);
        assert!((wide.loadings[0].abs() - s).abs() < 1e-12);
        assert!(narrow.loadings.iter().all(|x| (x - s).abs() < 1e-12));
    }

    #[test]
    fn one_draw_has_no_directions() {
        assert_eq!(principal_directions(&[vec![1.0, 2.0]]), []);
        assert_eq!(principal_directions(&[]), []);
    }
}
