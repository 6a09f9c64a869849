//! The comparison of a model with the measurements: rows, errors and groups.

use super::errors::ErrorTable;
use super::group::ErrorGroup;
use super::row::ComparisonRow;

/// The comparison of a model with the measurements.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Comparison {
    /// Whether the measured values were read off figures.
    pub digitised: bool,
    /// One row for each run and measured channel.
    pub rows: Vec<ComparisonRow>,
    /// Errors of the fitted runs.
    pub fit: Option<ErrorTable>,
    /// Errors of the holdout runs.
    pub holdout: Option<ErrorTable>,
    /// Errors of interpolation without physics on the holdout measurements that the model predicts.
    pub baseline_holdout: Option<ErrorTable>,
    /// Reasons why some holdout runs are not interpolated; empty if all are.
    pub not_interpolated: Vec<String>,
    /// Errors of the corrected predictions of the fitted runs, each corrected from the other conditions.
    pub corrected_fit: Option<ErrorTable>,
    /// Errors of the corrected predictions of the fitted runs, each corrected without all runs at its level of a condition, once for each
    /// condition with at least three levels; null without one.
    pub corrected_levels: Option<ErrorTable>,
    /// Errors of the corrected predictions of the holdout runs.
    pub corrected_holdout: Option<ErrorTable>,
    /// Reasons why some predictions are not corrected; empty if all are.
    pub not_corrected: Vec<String>,
    /// Errors by level of slip, load, speed and slip angle, and by wheel, for fitted and for holdout runs.
    pub groups: Vec<ErrorGroup>,
}
