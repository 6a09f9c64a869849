//! Errors for a summary: of a model, of its corrected and combined predictions, and of interpolation without physics.

use shared::experiment::RunUse;

use crate::coverage_summary::CoverageSummary;
use crate::holdout_summary::HoldoutSummary;
use crate::table::combined_row::CombinedRow;
use crate::table::comparison::Comparison;
use crate::table::coverage::Coverage;
use crate::table::errors::ErrorTable;
use crate::table::fixed_sigma::FixedSigmas;
use crate::table::holdout_errors::HoldoutErrors;
use crate::table::row::rows_of;

/// Errors of a model on fitted and on holdout runs.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ErrorSummary {
    /// Value for the fitted runs.
    pub fit: Option<ErrorTable>,
    /// Value for the holdout runs.
    pub holdout: Option<ErrorTable>,
}

impl ErrorSummary {
    /// Returns the same errors with `rmse_fixed_sigma` in the given noise standard deviations.
    pub fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        let table = |table: Option<ErrorTable>| table.map(|table| table.in_fixed_sigmas(sigmas));
        ErrorSummary {
            fit: table(self.fit),
            holdout: table(self.holdout),
        }
    }
}

/// Errors of the corrected predictions. The correction is the model's error in the fitted conditions, interpolated by a Gaussian process.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct CorrectedSummary {
    /// Errors of the fitted runs, each corrected from the other conditions.
    pub fit: Option<ErrorTable>,
    /// Errors of the holdout runs.
    pub holdout: Option<ErrorTable>,
    /// Errors of the holdout runs by group; groups without a run are left out.
    #[serde(default)]
    pub holdout_groups: Vec<HoldoutSummary>,
    /// Share of measurements inside their 90 % interval.
    pub coverage90: CoverageSummary,
    /// Reasons why some predictions are not corrected; empty if all are.
    pub missing: Vec<String>,
}

impl CorrectedSummary {
    /// Takes the errors of the corrected predictions from a comparison.
    pub fn new(comparison: &Comparison) -> Self {
        let coverage = |usage| Coverage::count_corrected(rows_of(&comparison.rows, usage));
        CorrectedSummary {
            fit: comparison.corrected_fit.clone(),
            holdout: comparison.corrected_holdout.clone(),
            holdout_groups: HoldoutSummary::all(HoldoutErrors::of_corrected(comparison.rows.iter())),
            coverage90: CoverageSummary::from_counts(coverage),
            missing: comparison.not_corrected.clone(),
        }
    }

    /// Returns the same errors with `rmse_fixed_sigma` in the given noise standard deviations.
    pub fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        let ErrorSummary { fit, holdout } = ErrorSummary {
            fit: self.fit,
            holdout: self.holdout,
        }
        .in_fixed_sigmas(sigmas);
        CorrectedSummary {
            fit,
            holdout,
            holdout_groups: HoldoutSummary::all_in_fixed_sigmas(self.holdout_groups, sigmas),
            ..self
        }
    }
}

/// Errors of the weighted average of the corrected predictions of all models and of the prediction by the measurements alone.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct CombinedSummary {
    /// Maximum number of models in an average, the measurements alone not counted.
    pub models: usize,
    /// Errors of the fitted runs, each corrected from the other conditions.
    pub fit: Option<ErrorTable>,
    /// Errors of the holdout runs.
    pub holdout: Option<ErrorTable>,
    /// Errors of the holdout runs by group; groups without a run are left out.
    #[serde(default)]
    pub holdout_groups: Vec<HoldoutSummary>,
    /// Share of measurements inside their 90 % interval.
    pub coverage90: CoverageSummary,
}

impl CombinedSummary {
    /// Summarises the errors of combined predictions; `None` if no prediction is corrected.
    pub fn new(rows: &[CombinedRow], sigmas: &FixedSigmas) -> Option<Self> {
        let used = |usage| rows.iter().filter(move |combined| combined.row.usage == usage);
        let errors = |usage| {
            let table = ErrorTable::new(used(usage).map(|combined| (&combined.row, combined.mean)))?;
            Some(table.in_fixed_sigmas(sigmas))
        };
        let models = rows
            .iter()
            .map(|combined| combined.models)
            .max()
            .filter(|models| *models > 0)?;
        Some(CombinedSummary {
            models,
            fit: errors(RunUse::Fit),
            holdout: errors(RunUse::Holdout),
            holdout_groups: HoldoutSummary::all_in_fixed_sigmas(
                HoldoutSummary::all(HoldoutErrors::of_combined(rows.iter())),
                sigmas,
            ),
            coverage90: CoverageSummary::from_counts(|usage| {
                Coverage::from_outcomes(used(usage).filter_map(CombinedRow::covered))
            }),
        })
    }
}

/// Errors of interpolation without physics.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct BaselineSummary {
    /// `interpolation`: between the fitted measurements of the same wheel, soil and pass, by a monotone cubic if the runs differ in slip
    /// only, else by a Gaussian process over the conditions that vary.
    pub name: String,
    /// Errors on the holdout runs.
    pub holdout: Option<ErrorTable>,
    /// Errors of the holdout runs by group; groups without a run are left out.
    #[serde(default)]
    pub holdout_groups: Vec<HoldoutSummary>,
    /// Reasons why some runs are not interpolated; empty if all are.
    pub missing: Vec<String>,
}

impl BaselineSummary {
    /// Takes the errors of interpolation from a comparison.
    pub fn new(comparison: &Comparison) -> Self {
        BaselineSummary {
            name: "interpolation".into(),
            holdout: comparison.baseline_holdout.clone(),
            holdout_groups: HoldoutSummary::all(HoldoutErrors::of_baseline(comparison.rows.iter())),
            missing: comparison.not_interpolated.clone(),
        }
    }

    /// Returns the same errors with `rmse_fixed_sigma` in the given noise standard deviations.
    pub fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        BaselineSummary {
            holdout: self.holdout.map(|table| table.in_fixed_sigmas(sigmas)),
            holdout_groups: HoldoutSummary::all_in_fixed_sigmas(self.holdout_groups, sigmas),
            ..self
        }
    }
}
