//! Judgement: errors and coverage of the predictions of left-out measurements.

use crate::table::coverage::Coverage;
use crate::table::errors::ErrorTable;
use crate::table::fixed_sigma::FixedSigmas;
use crate::table::interpolation::InterpolatedOver;
use crate::table::row::ComparisonRow;

/// Errors and coverage of the predictions of left-out measurements.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Judgement {
    /// Errors of the model; null if the model refuses every run.
    pub model: Option<ErrorTable>,
    /// Errors of interpolation without physics on the measurements that the model predicts too; null if there are none.
    pub interpolation: Option<ErrorTable>,
    /// Errors of the model on the same measurements as those of interpolation, so that both compare.
    pub model_beside: Option<ErrorTable>,
    /// Number of measurements whose interpolation extrapolates.
    pub extrapolated: usize,
    /// Number of measurements in their 90 % intervals.
    pub inside: usize,
    /// Number of measurements with an interval; 0 if the calibration has no posterior.
    pub with_interval: usize,
}

impl Judgement {
    /// Judges the predictions of the rows in the noise of a study.
    pub(super) fn new(rows: &[ComparisonRow], sigmas: &FixedSigmas) -> Self {
        let table = |table: Option<ErrorTable>| table.map(|table| table.in_fixed_sigmas(sigmas));
        let coverage = Coverage::count(rows.iter());
        let is_beyond = |row: &&ComparisonRow| row.interpolated_over == Some(InterpolatedOver::Extrapolation);
        let both = || {
            rows.iter()
                .filter(|row| row.predicted.is_some() && row.interpolated.is_some())
        };
        Judgement {
            model: table(ErrorTable::of_model(rows.iter())),
            interpolation: table(ErrorTable::of_baseline(both())),
            model_beside: table(ErrorTable::of_model(both())),
            extrapolated: rows.iter().filter(is_beyond).count(),
            inside: coverage.map_or(0, |c| c.inside),
            with_interval: coverage.map_or(0, |c| c.total),
        }
    }
}
