//! Linear dependence among several quantities.

use nalgebra::{Cholesky, DMatrix, DVector};

/// Unexplained share of a quantity's variance below which earlier quantities determine it: a smaller share is rounding.
const REMAINING: f64 = 1e-12;
/// Absolute regression weight `[1]` at and above which a quantity belongs to a dependence.
const WEIGHT: f64 = 1e-6;

/// Returns the first quantity that is a linear function of earlier ones, with the quantities that it depends on.
///
/// # Equation
/// Quantity k is regressed on those before it: the weights are `w = C^-1 c`, with C their correlations among each other and c
/// those with k; the unexplained share of its variance is `1 - w'c`, at least 1e-12 where k is not determined. A dependency
/// counts from `|w| = 1e-6`.
///
/// # Arguments
/// - `correlations`: a row for each quantity, symmetric, 1 on the diagonal.
///
/// # Returns
/// Positions; `None` where no quantity follows from others. Checked by `tests::a_sum_follows_from_its_terms_alone`.
#[must_use]
pub fn linear_dependence(correlations: &[Vec<f64>]) -> Option<(usize, Vec<usize>)> {
    (1..correlations.len()).find_map(|last| {
        let before = DMatrix::from_fn(last, last, |i, j| correlations[i][j]);
        let with = DVector::from_fn(last, |i, _| correlations[i][last]);
        // The earlier quantities are independent, or a dependence would have been found before.
        let weights = Cholesky::new(before)?.solve(&with);
        let is_determined = 1.0 - weights.dot(&with) < REMAINING;
        is_determined.then(|| {
            let terms = (0..last).filter(|&i| weights[i].abs() > WEIGHT);
            (last, terms.collect())
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_follows_from_its_terms_alone() {
        // Correlations of three independent quantities x, y, z and (x + z) / sqrt(2).
        let half = 0.5_f64.sqrt();
        let row = |values: [f64; 4]| values.to_vec();
        let mut correlations = vec![
            row([1.0, 0.0, 0.0, half]),
            row([0.0, 1.0, 0.0, 0.0]),
            row([0.0, 0.0, 1.0, half]),
            row([half, 0.0, half, 1.0]),
        ];
        assert_eq!(linear_dependence(&correlations), Some((3, vec![0, 2])));
        correlations.pop();
        assert_eq!(linear_dependence(&correlations), None);
        assert_eq!(
            linear_dependence(&[vec![1.0, -1.0], vec![-1.0, 1.0]]),
            Some((1, vec![0]))
        );
    }
}
