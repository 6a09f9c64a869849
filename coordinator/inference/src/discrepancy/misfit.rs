//! The misfit of a model in one condition.

/// Measured minus model, as the mean over the repeats of one condition.
#[derive(Debug, Clone, PartialEq)]
pub struct Misfit {
    /// The condition's coordinates, each in its own unit.
    pub point: Vec<f64>,
    /// Number of what was tested, for example a wheel on a soil. The misfits determine how much two groups have in common.
    pub group: usize,
    /// The mean [unit of the channel].
    pub value: f64,
    /// Variance of the noise of the mean [unit squared].
    pub noise_variance: f64,
}
