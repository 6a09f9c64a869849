//! Effective sample size of weights, and rank correlation.

/// Returns the effective sample size of weights, `(sum w)^2 / sum w^2` (Kish 1965); 0 if no weight is positive.
#[must_use]
pub fn kish_ess(weights: &[f64]) -> f64 {
    let sum: f64 = weights.iter().sum();
    let squares: f64 = weights.iter().map(|w| w * w).sum();
    if squares > 0.0 { sum * sum / squares } else { 0.0 }
}

/// Returns the coefficient of variation of weights: sd / mean with divisor n; infinite if no weight is positive.
#[must_use]
pub fn weight_cov(weights: &[f64]) -> f64 {
    let ess = kish_ess(weights);
    if ess > 0.0 {
        (weights.len() as f64 / ess - 1.0).max(0.0).sqrt()
    } else {
        f64::INFINITY
    }
}

/// Returns Spearman's rank correlation of two equally long slices, ties at their mean rank; `None` if a slice is constant or the
/// lengths differ.
#[must_use]
pub fn rank_correlation(first: &[f64], second: &[f64]) -> Option<f64> {
    if first.len() != second.len() {
        return None;
    }
    let centre = (first.len() as f64 - 1.0) / 2.0;
    let (first, second) = (ranks(first), ranks(second));
    let (mut cross, mut squares_first, mut squares_second) = (0.0, 0.0, 0.0);
    for (a, b) in first.iter().zip(&second) {
        let (a, b) = (a - centre, b - centre);
        cross += a * b;
        squares_first += a * a;
        squares_second += b * b;
    }
    (squares_first > 0.0 && squares_second > 0.0).then(|| cross / (squares_first * squares_second).sqrt())
}

/// Ranks from 0, ties at their mean.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let mut start = 0;
    for group in order.chunk_by(|&a, &b| values[a].total_cmp(&values[b]).is_eq()) {
        let rank = start as f64 + (group.len() as f64 - 1.0) / 2.0;
        for &index in group {
            ranks[index] = rank;
        }
        start += group.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ess_and_cov_of_hand_weights() {
        // (1 + 1 + 2)^2 / (1 + 1 + 4) = 16 / 6; mean 4/3, variance 6/3 - 16/9 = 2/9, cov^2 = 1/8.
        let weights = [1.0, 1.0, 2.0];
        assert!((kish_ess(&weights) - 16.0 / 6.0).abs() < 1e-12);
        assert!((weight_cov(&weights) - 0.125_f64.sqrt()).abs() < 1e-12);
        assert!(weight_cov(&[0.0, 0.0]).is_infinite());
    }

    #[test]
    fn rank_correlation_sees_order_only() {
        assert_eq!(rank_correlation(&[1.0, 2.0, 9.0], &[-3.0, 0.0, 0.1]), Some(1.0));
        assert_eq!(rank_correlation(&[1.0, 2.0, 9.0], &[3.0, 0.0, -7.0]), Some(-1.0));
        // Ranks 0.5 0.5 2 against 0 1 2: 1.5 / sqrt(1.5 * 2).
        let tied = rank_correlation(&[1.0, 1.0, 9.0], &[1.0, 2.0, 3.0]).unwrap();
        assert!((tied - 1.5 / 3.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(rank_correlation(&[1.0, 1.0], &[1.0, 2.0]), None);
    }
}
