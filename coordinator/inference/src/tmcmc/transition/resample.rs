//! Systematic resampling.

/// Resamples systematically: returns `count` indices, ascending, with one uniform number in (0, 1) for all.
///
/// Index i is drawn floor or ceil of `count * weights[i]` times. The weights sum to one.
pub(crate) fn systematic(weights: &[f64], count: usize, uniform: f64) -> Vec<usize> {
    let mut indices = Vec::with_capacity(count);
    let mut cumulative = 0.0;
    // Rounding may leave the sum just below the last comb tooth: the last index of positive weight takes it.
    let last = weights.iter().rposition(|&w| w > 0.0).unwrap_or(0);
    for (index, weight) in weights.iter().enumerate() {
        cumulative += weight;
        while indices.len() < count
            && (indices.len() as f64 + uniform < cumulative * count as f64 || index == last)
        {
            indices.push(index);
        }
    }
    indices
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_the_expected_ones_up_to_rounding() {
        let weights = [0.5, 0.0, 0.3, 0.2];
        let indices = systematic(&weights, 10, 0.7);
        assert_eq!(indices, [0, 0, 0, 0, 0, 2, 2, 2, 3, 3]);
        for tooth in [0.001, 0.25, 0.5, 0.999] {
            let indices = systematic(&[0.05, 0.9, 0.05, 0.0], 7, tooth);
            assert_eq!(indices.len(), 7);
            assert!(indices.iter().filter(|&&i| i == 1).count() >= 6);
            assert!(!indices.contains(&3));
        }
    }
}
