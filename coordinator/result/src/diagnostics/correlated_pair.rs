//! Strongly correlated pairs of parameters.

use inference::diagnostics;

/// Most pairs that are shown, and the least rank correlation of them.
const PAIRS: usize = 3;
pub(crate) const LEAST_CORRELATION: f64 = 0.2;

/// Positions and rank correlations of the pairs, strongest first; the first of equals.
pub(crate) fn most_correlated(draws: &[Vec<f64>]) -> Vec<(usize, usize, f64)> {
    let mut pairs: Vec<(usize, usize, f64)> = Vec::new();
    for i in 0..draws.len() {
        for j in i + 1..draws.len() {
            pairs.extend(diagnostics::rank_correlation(&draws[i], &draws[j]).map(|r| (i, j, r)));
        }
    }
    pairs.retain(|pair| pair.2.abs() >= LEAST_CORRELATION);
    pairs.sort_by(|a, b| b.2.abs().total_cmp(&a.2.abs()));
    pairs.truncate(PAIRS);
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strongest_pairs_come_first() {
        // Ranks: the first two agree, the third has 1 - 6 * 14 / 60 = -0.4 with both, the constant has none.
        let draws = [
            vec![1.0, 2.0, 3.0, 4.0],
            vec![1.0, 2.0, 3.0, 4.5],
            vec![4.0, 1.0, 3.0, 2.0],
            vec![7.0; 4],
        ];
        let pairs: Vec<(usize, usize)> = most_correlated(&draws).iter().map(|p| (p.0, p.1)).collect();
        assert_eq!(pairs, [(0, 1), (0, 2), (1, 2)]);
    }
}
