//! Errors of a model and of interpolation without physics.

use crate::table::comparison::Comparison;
use crate::table::errors::ErrorTable;
use crate::table::fixed_sigma::FixedSigmas;

/// Errors on both kinds of runs.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ErrorSummary {
    /// Fitted runs.
    pub fit: Option<ErrorTable>,
    /// Runs that were not fitted.
    pub holdout: Option<ErrorTable>,
}

impl ErrorSummary {
    pub(super) fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        let table = |table: Option<ErrorTable>| table.map(|table| table.in_fixed_sigmas(sigmas));
        ErrorSummary {
            fit: table(self.fit),
            holdout: table(self.holdout),
        }
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
    pub(crate) fn of(comparison: &Comparison) -> Self {
        BaselineSummary {
            name: "interpolation".into(),
            holdout: comparison.baseline_holdout.clone(),
            missing: comparison.not_interpolated.clone(),
        }
    }

    pub(super) fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        BaselineSummary {
            holdout: self.holdout.map(|table| table.in_fixed_sigmas(sigmas)),
            ..self
        }
    }
}
