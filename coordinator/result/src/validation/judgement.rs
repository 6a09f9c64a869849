//! Errors and coverage of a prediction.

use crate::table::coverage::Coverage;
use crate::table::errors::ErrorTable;
use crate::table::fixed_sigma::FixedSigmas;
use crate::table::interpolation::InterpolatedOver;
use crate::table::row::ComparisonRow;

/// How well some measurements are predicted that were left out.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Judgement {
    /// Errors of the model; null where it refuses every run.
    pub model: Option<ErrorTable>,
    /// Errors of interpolating the other measurements, without physics, where the model predicts too; null where there is none.
    pub interpolation: Option<ErrorTable>,
    /// Errors of the model on the same measurements as those of interpolation, so that both compare.
    pub model_beside: Option<ErrorTable>,
    /// Measurements whose interpolation extrapolates.
    pub extrapolated: usize,
    /// Measurements in their 90 % intervals.
    pub inside: usize,
    /// Measurements with an interval; none where the calibration has no posterior.
    pub with_interval: usize,
}

impl Judgement {
    /// Of rows, in the noise of a study.
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
