//! Coverage of intervals on both kinds of runs.

use shared::experiment::RunUse;

use crate::table::coverage::Coverage;

/// Coverage on both kinds of runs.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct CoverageSummary {
    /// Fitted runs.
    pub fit: Option<f64>,
    /// Runs that were not fitted.
    pub holdout: Option<f64>,
}

impl CoverageSummary {
    /// Of the counts of each kind of runs.
    pub fn from_counts(count: impl Fn(RunUse) -> Option<Coverage>) -> Self {
        let share = |usage| count(usage).map(|coverage| coverage.inside as f64 / coverage.total as f64);
        CoverageSummary {
            fit: share(RunUse::Fit),
            holdout: share(RunUse::Holdout),
        }
    }
}
