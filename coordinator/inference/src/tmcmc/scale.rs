//! The scale of a random walk: its initial value, and the acceptance rate to which it is adapted.

/// Returns the optimal scale of a random walk on a normal target.
///
/// # Source
/// Roberts, Gelman & Gilks 1997, Ann. Appl. Probab. 7:110, doi:10.1214/aoap/1034625254.
pub(super) fn initial_scale(dimension: usize) -> f64 {
    2.38 / (dimension as f64).sqrt()
}

/// Returns the target acceptance rate: 0.44 in one dimension, 0.23 in many.
pub(super) fn target_acceptance(dimension: usize) -> f64 {
    0.21 / dimension as f64 + 0.23
}
