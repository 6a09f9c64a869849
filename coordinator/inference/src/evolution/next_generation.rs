//! What a strategy wants next: a generation, or the end.

use crate::point_estimate::StopReason;

/// What a strategy wants next.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum NextGeneration {
    /// A generation at these positions, all within the bounds.
    Ask(Vec<Vec<f64>>),
    /// Nothing any more.
    End(StopReason),
}
