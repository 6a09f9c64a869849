//! What a model misses in one condition.

/// Measured minus model, as the mean over the repeats of one condition.
#[derive(Debug, Clone, PartialEq)]
pub struct Misfit {
    /// The condition's coordinates, each in its own unit.
    pub point: Vec<f64>,
    /// Number of what was tested, say of a wheel on a soil: two groups miss alike as far as the misfits say so.
    pub group: usize,
    /// The mean [unit of the channel].
    pub value: f64,
    /// Variance of the noise of the mean [unit squared].
    pub noise_variance: f64,
}
