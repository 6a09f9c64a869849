//! Errors of a model, of its corrected predictions and of interpolation without physics.

use shared::experiment::RunUse;

use crate::coverage_summary::CoverageSummary;
use crate::table::combined_row::CombinedRow;
use crate::table::comparison::Comparison;
use crate::table::coverage::Coverage;
use crate::table::errors::ErrorTable;
use crate::table::fixed_sigma::FixedSigmas;
use crate::table::row::rows_of;

/// Errors on both kinds of runs.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ErrorSummary {
    /// Fitted runs.
    pub fit: Option<ErrorTable>,
    /// Runs that were not fitted.
    pub holdout: Option<ErrorTable>,
}

impl ErrorSummary {
    /// The same errors in the noise sds of a study.
    pub fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        let table = |table: Option<ErrorTable>| table.map(|table| table.in_fixed_sigmas(sigmas));
        ErrorSummary {
            fit: table(self.fit),
            holdout: table(self.holdout),
        }
    }
}

/// The model with what it misses in the fitted conditions, interpolated by a Gaussian process over the conditions that vary.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct CorrectedSummary {
    /// Errors of the fitted runs, each corrected by what the model misses in the other conditions.
    pub fit: Option<ErrorTable>,
    /// Errors of the runs that were not fitted.
    pub holdout: Option<ErrorTable>,
    /// Share of measurements inside their 90 % interval.
    pub coverage90: CoverageSummary,
    /// Why some predictions are not corrected; empty where all are.
    pub missing: Vec<String>,
}

impl CorrectedSummary {
    /// The corrected predictions of a comparison.
    pub fn new(comparison: &Comparison) -> Self {
        let coverage = |usage| Coverage::count_corrected(rows_of(&comparison.rows, usage));
        CorrectedSummary {
            fit: comparison.corrected_fit.clone(),
            holdout: comparison.corrected_holdout.clone(),
            coverage90: CoverageSummary::from_counts(coverage),
            missing: comparison.not_corrected.clone(),
        }
    }

    /// The same errors in the noise sds of a study.
    pub fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        let CorrectedSummary { fit, holdout, .. } = self;
        let ErrorSummary { fit, holdout } = ErrorSummary { fit, holdout }.in_fixed_sigmas(sigmas);
        CorrectedSummary { fit, holdout, ..self }
    }
}

/// The corrected predictions of the ledger's models, averaged.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct CombinedSummary {
    /// Most models that a prediction averages.
    pub models: usize,
    /// Errors of the fitted runs, each corrected by the other conditions.
    pub fit: Option<ErrorTable>,
    /// Errors of the runs that were not fitted.
    pub holdout: Option<ErrorTable>,
    /// Share of measurements inside their 90 % interval.
    pub coverage90: CoverageSummary,
}

impl CombinedSummary {
    /// `None` where nothing is corrected.
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
            coverage90: CoverageSummary::from_counts(|usage| {
                Coverage::from_outcomes(used(usage).filter_map(CombinedRow::covered))
            }),
        })
    }
}

/// Interpolation without physics.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct BaselineSummary {
    /// `interpolation`: between the fitted measurements of the same wheel, soil and pass, by a monotone cubic where runs differ in slip
    /// alone, else by a Gaussian process over the conditions that vary.
    pub name: String,
    /// Its errors.
    pub holdout: Option<ErrorTable>,
    /// Why some runs are not interpolated; empty where all are.
    pub missing: Vec<String>,
}

impl BaselineSummary {
    /// The interpolation of a comparison.
    pub fn new(comparison: &Comparison) -> Self {
        BaselineSummary {
            name: "interpolation".into(),
            holdout: comparison.baseline_holdout.clone(),
            missing: comparison.not_interpolated.clone(),
        }
    }

    /// The same errors in the noise sds of a study.
    pub fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        BaselineSummary {
            holdout: self.holdout.map(|table| table.in_fixed_sigmas(sigmas)),
            ..self
        }
    }
}
