//! The error ledger: the errors of the calibrations of a study, each compared with the previous one.

use shared::channel::Channel;
use shared::experiment::RunUse;

use super::coverage::Coverage;
use super::errors::ErrorTable;
use super::fixed_sigma::FixedSigmas;
use super::holdout_errors::HoldoutErrors;
use super::row::rows_of;
use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;
use crate::words::number;

/// Ratio of an error to the previous one above which it counts as worse; smaller changes may be scatter.
const WORSE: f64 = 1.05;

/// A line of the error ledger.
pub struct LedgerLine<'a> {
    /// The calibration that the line is about.
    pub calibration: &'a FinishedCalibration,
    /// `base`, or the added effects and freed parameters; with the number of runs if runs were added.
    pub model: String,
    /// Errors on the fitted runs, then on the holdout runs.
    pub rows: Vec<LedgerRow>,
}

/// The errors of a calibration on the fitted or the holdout runs.
pub struct LedgerRow {
    /// Whether the runs were fitted or held out.
    pub usage: RunUse,
    /// Errors in SI units, and in the noise standard deviations of the study.
    pub errors: ErrorTable,
    /// Channels whose error is more than 5 % larger than in the previous line, on the same measurements.
    pub worse: Vec<Channel>,
    /// Coverage of the 90 % intervals.
    pub coverage: Option<Coverage>,
    /// Errors on the groups of the holdout runs; empty for the fitted runs.
    pub groups: Vec<HoldoutErrors>,
}

/// The errors in noise standard deviations above which intervals of that noise would hold few of the measurements.
const LARGE: f64 = 3.0;

impl LedgerRow {
    /// Returns whether the intervals hold every measurement although the errors are larger than 3 sds of the noise. The intervals are then much wider
    /// than the noise, as with an inferred discrepancy, and the count does not support the model.
    pub fn is_inside_by_width(&self) -> bool {
        let holds = self.coverage.is_some_and(|held| held.inside == held.total);
        holds && self.errors.all.rmse_fixed_sigma.is_some_and(|sds| sds > LARGE)
    }
}

impl Study {
    /// Returns the noise standard deviations that all lines of the ledger are measured in.
    pub fn fixed_sigmas(&self) -> FixedSigmas {
        FixedSigmas::new(&self.lead)
    }

    /// Returns the lines of the ledger.
    pub fn ledger_lines(&self) -> Vec<LedgerLine<'_>> {
        let sigmas = self.fixed_sigmas();
        let mut lines: Vec<LedgerLine> = Vec::new();
        for calibration in self.ledger() {
            let comparison = calibration.comparison();
            let row = |(usage, errors): (RunUse, &Option<ErrorTable>)| {
                let errors = errors.clone()?.in_fixed_sigmas(&sigmas);
                // Errors on other measurements are not comparable.
                let last = lines
                    .last()
                    .filter(|line| line.calibration.row.experiment == calibration.row.experiment)
                    .and_then(|line| line.rows.iter().find(|r| r.usage == usage));
                // Errors are not comparable either if the models refuse different numbers of measurements.
                let last = last.filter(|row| row.errors.all.unpredicted == errors.all.unpredicted);
                let is_worse = |channel: &Channel| {
                    let before = last.and_then(|last| last.errors.channel(*channel));
                    let now = errors.channel(*channel);
                    before
                        .zip(now)
                        .is_some_and(|(before, now)| now.rmse > WORSE * before.rmse)
                };
                Some(LedgerRow {
                    usage,
                    worse: Channel::ALL.into_iter().filter(is_worse).collect(),
                    coverage: Coverage::count(rows_of(&comparison.rows, usage)),
                    groups: HoldoutErrors::of_model(rows_of(&comparison.rows, usage))
                        .into_iter()
                        .map(|group| group.in_fixed_sigmas(&sigmas))
                        .collect(),
                    errors,
                })
            };
            let tables = [
                (RunUse::Fit, &comparison.fit),
                (RunUse::Holdout, &comparison.holdout),
            ];
            let rows = tables.into_iter().filter_map(row).collect();
            lines.push(LedgerLine {
                model: self.model_words(calibration),
                calibration,
                rows,
            });
        }
        lines
    }

    fn model_words(&self, calibration: &FinishedCalibration) -> String {
        let parts = [calibration.spec.effects_on_wheels(), self.freed(calibration)].concat();
        let model = match parts.as_slice() {
            [] => "base".to_owned(),
            parts => format!("with {}", parts.join(", ")),
        };
        match calibration.row.experiment == self.lead.row.experiment {
            true => model,
            false => {
                let runs = number::count(calibration.spec.fit_runs.len(), "fitted run");
                format!("{model}, {runs}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn a_channel_that_got_worse_is_marked_and_no_other() {
        let marked = |by: f64, change: &dyn Fn(&mut FinishedCalibration)| -> Vec<Channel> {
            let mut study = fixture::grown();
            let extension = &mut study.extensions[0];
            for prediction in &mut extension.predictions {
                let observables = prediction.fit.as_mut().unwrap();
                observables.sinkage_m.iter_mut().for_each(|z| *z += by);
            }
            change(extension);
            let lines = study.ledger_lines().into_iter();
            lines
                .flat_map(|line| line.rows)
                .flat_map(|row| row.worse)
                .collect()
        };
        assert_eq!(marked(0.0, &|_| ()), []);
        assert_eq!(marked(0.05, &|_| ()), [Channel::Sinkage]);
        assert_eq!(marked(0.05, &|extension| extension.row.experiment += 1), []);
    }

    #[test]
    fn intervals_as_wide_as_large_errors_do_not_support_a_model() {
        let is_by_width = |inside: usize, sds: Option<f64>| {
            let study = fixture::grown();
            let mut row = study.ledger_lines().remove(0).rows.remove(0);
            row.coverage = Some(Coverage { inside, total: 30 });
            row.errors.all.rmse_fixed_sigma = sds;
            row.is_inside_by_width()
        };
        assert!(is_by_width(30, Some(19.2)) && is_by_width(30, Some(3.1)));
        // A few large errors outside narrow intervals make the mean large, too.
        assert!(!is_by_width(29, Some(19.2)) && !is_by_width(30, Some(2.9)) && !is_by_width(30, None));
    }

    #[test]
    fn errors_are_not_compared_where_a_model_refuses_runs_that_the_one_before_predicts() {
        // The second model is worse on the runs that both models predict.
        let after = || {
            let mut refused = fixture::with_refused_runs();
            refused.row.id += 1;
            let holdouts = refused
                .predictions
                .iter_mut()
                .flat_map(|prediction| &mut prediction.holdout);
            for observables in holdouts.flat_map(|holdout| holdout.alone.values_mut().flatten()) {
                observables.drawbar_pull_n.iter_mut().for_each(|f| *f += 500.0);
            }
            refused
        };
        let marked = |before: FinishedCalibration| {
            let study = Study {
                extensions: vec![after()],
                ..Study::from(before)
            };
            let lines = study.ledger_lines();
            let rows = lines.iter().flat_map(|line| &line.rows);
            let held_out = rows.filter(|row| row.usage == RunUse::Holdout);
            held_out.flat_map(|row| row.worse.clone()).collect::<Vec<_>>()
        };
        assert_eq!(marked(fixture::with_held_out_runs(4, 0.5)), []);
        assert_eq!(marked(fixture::with_refused_runs()), [Channel::DrawbarPull]);
    }
}
