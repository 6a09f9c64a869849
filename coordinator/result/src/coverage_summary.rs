//! Shares of measurements inside their 90 % intervals, for fitted and for holdout runs: an entry of a summary.

use shared::experiment::RunUse;

use crate::table::coverage::Coverage;

/// The shares of measurements inside their 90 % intervals.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct CoverageSummary {
    /// Value for the fitted runs.
    pub fit: Option<f64>,
    /// Value for the holdout runs.
    pub holdout: Option<f64>,
}

impl CoverageSummary {
    /// Makes the shares from the counts of each kind of runs.
    pub fn from_counts(count: impl Fn(RunUse) -> Option<Coverage>) -> Self {
        let share = |usage| count(usage).map(|coverage| coverage.inside as f64 / coverage.total as f64);
        CoverageSummary {
            fit: share(RunUse::Fit),
            holdout: share(RunUse::Holdout),
        }
    }
}
