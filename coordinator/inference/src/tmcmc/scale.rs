//! The scale of a random walk: where it begins, and the acceptance rate that it is adapted to.

/// The scale that is optimal for a random walk on a normal target (Roberts, Gelman & Gilks 1997).
pub(super) fn initial_scale(dimension: usize) -> f64 {
    2.38 / (dimension as f64).sqrt()
}

/// The acceptance rate to aim at: 0.44 in one dimension, 0.23 in many.
pub(super) fn target_acceptance(dimension: usize) -> f64 {
    0.21 / dimension as f64 + 0.23
}
