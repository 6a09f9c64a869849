//! An observation: the mean of the repeats at one point.

/// The mean of the repeats at one point.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// Coordinates of the point, each in its unit.
    pub point: Vec<f64>,
    /// The mean [unit of the values].
    pub value: f64,
    /// Number of repeats, at least 1.
    pub repeats: usize,
}
