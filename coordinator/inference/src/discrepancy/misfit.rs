//! The misfit of a model in one condition.

/// Measured minus model, as the mean over the repeats of one condition.
#[derive(Debug, Clone, PartialEq)]
pub struct Misfit {
    /// The condition's coordinates, each in its own unit.
    pub point: Vec<f64>,
    /// Number of the group, for example of the runs of one wheel on one soil. The correlation between groups is inferred.
    pub group: usize,
    /// The mean [unit of the channel].
    pub value: f64,
    /// Variance of the noise of the mean [unit squared].
    pub noise_variance: f64,
}
