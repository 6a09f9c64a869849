//! The next generation that a strategy asks for, or the end.

use crate::point_estimate::StopReason;

/// The request of a strategy.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum NextGeneration {
    /// A generation at these positions, all within the bounds.
    Ask(Vec<Vec<f64>>),
    /// The end of the evolution.
    End(StopReason),
}
