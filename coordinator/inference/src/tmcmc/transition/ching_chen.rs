//! The chains of the original sampler of Ching and Chen (2007), whose scale BASIS shares.

/// beta: the random walk's covariance is beta^2 = 0.04 times the weighted covariance of the pool.
pub(crate) const SCALE: f64 = 0.2;

/// Returns leaders and their chain lengths from resampled indices (ascending): an index drawn m times leads a chain of m steps.
pub(crate) fn leaders(indices: &[usize]) -> Vec<(usize, usize)> {
    indices
        .chunk_by(|a, b| a == b)
        .map(|group| (group[0], group.len()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiplicity_is_the_chain_length() {
        assert_eq!(leaders(&[0, 0, 2, 5, 5, 5]), [(0, 2), (2, 1), (5, 3)]);
    }
}
