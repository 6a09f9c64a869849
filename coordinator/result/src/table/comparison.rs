//! Model against measurement, run by run.

use super::errors::ErrorTable;
use super::group::ErrorGroup;
use super::row::ComparisonRow;

/// Model against measurement.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Comparison {
    /// Whether the measured values were read off figures.
    pub digitised: bool,
    /// One row for each run and measured channel.
    pub rows: Vec<ComparisonRow>,
    /// Errors of the fitted runs.
    pub fit: Option<ErrorTable>,
    /// Errors of the runs that were not fitted.
    pub holdout: Option<ErrorTable>,
    /// Errors of interpolating the fitted measurements, without physics, on the holdout measurements that the model predicts.
    pub baseline_holdout: Option<ErrorTable>,
    /// Why some holdout runs are not interpolated; empty where all are.
    pub not_interpolated: Vec<String>,
    /// Errors of the corrected predictions of the fitted runs, each by what the model misses in the other conditions.
    pub corrected_fit: Option<ErrorTable>,
    /// Errors of the corrected predictions of the runs that were not fitted.
    pub corrected_holdout: Option<ErrorTable>,
    /// Why some predictions are not corrected; empty where all are.
    pub not_corrected: Vec<String>,
    /// Errors by level of slip, load, speed and slip angle, and by wheel, of fitted runs and of the others.
    pub groups: Vec<ErrorGroup>,
}
