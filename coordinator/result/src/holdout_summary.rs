//! Errors on a group of holdout runs: an entry of a summary.

use crate::table::errors::ErrorTable;
use crate::table::fixed_sigma::FixedSigmas;
use crate::table::holdout_errors::HoldoutErrors;
use crate::table::holdout_group::HoldoutGroup;

/// Errors and coverage on the holdout runs of a group.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct HoldoutSummary {
    /// `in_levels`: each condition of the runs is a level of the fitted runs; `between_levels`: a condition lies between levels;
    /// `beyond`: a condition lies outside of the fitted range, or no fitted run has the wheel or the soil.
    #[schema(value_type = String)]
    pub name: HoldoutGroup,
    /// Number of runs, predicted or not.
    pub runs: usize,
    /// Errors; null if nothing of the group is predicted.
    pub error: Option<ErrorTable>,
    /// Share of measurements inside their 90 % interval; null without intervals.
    pub coverage90: Option<f64>,
}

impl HoldoutSummary {
    /// Summarises the errors of all groups.
    pub fn all(groups: Vec<HoldoutErrors>) -> Vec<Self> {
        groups.into_iter().map(HoldoutSummary::from).collect()
    }

    /// Returns the same errors with `rmse_fixed_sigma` in the given noise standard deviations.
    #[must_use]
    pub fn all_in_fixed_sigmas(groups: Vec<Self>, sigmas: &FixedSigmas) -> Vec<Self> {
        let group = |group: HoldoutSummary| HoldoutSummary {
            error: group.error.map(|table| table.in_fixed_sigmas(sigmas)),
            ..group
        };
        groups.into_iter().map(group).collect()
    }
}

impl From<HoldoutErrors> for HoldoutSummary {
    fn from(errors: HoldoutErrors) -> Self {
        HoldoutSummary {
            name: errors.group,
            runs: errors.runs,
            error: errors.errors,
            coverage90: errors
                .coverage
                .map(|coverage| coverage.inside as f64 / coverage.total as f64),
        }
    }
}
