//! Computation of the comparison of a calibration with the measurements, row by row.

use std::collections::{BTreeMap, BTreeSet};

use record::RejectionReason;
use shared::channel::Channel;
use shared::experiment::RunUse;

use super::comparison::Comparison;
use super::correction::Corrections;
use super::errors::ErrorTable;
use super::fixed_sigma::FixedSigmas;
use super::group::error_groups;
use super::holdout_group::FittedConditions;
use super::interpolation::Interpolations;
use super::predictive::{Levels, predictive};
use super::refusal::Refusal;
use super::row::{ComparisonRow, rows_of};
use crate::finished_calibration::FinishedCalibration;

impl FinishedCalibration {
    /// Returns the holdout measurements interpolated from the fitted ones.
    pub fn interpolations(&self) -> &Interpolations {
        self.interpolations
            .get_or_init(|| Interpolations::new(&self.spec.experiment))
    }

    /// Compares the model with the measurements, run by run.
    pub fn comparison(&self) -> &Comparison {
        self.comparison.get_or_init(|| self.compared())
    }

    fn compared(&self) -> Comparison {
        let interpolations = self.interpolations();
        let levels = Levels::new(self);
        let corrections = Corrections::new(self);
        let runs = &self.spec.experiment.runs;
        let conditions = FittedConditions::new(self.spec.fit_runs.iter().map(|&i| &runs[i]).collect());
        let mut not_corrected = BTreeSet::new();
        let mut rows = Vec::new();
        for (i, run) in runs.iter().enumerate() {
            let refused = self.refusal(i);
            let holdout_group = (run.usage == RunUse::Holdout).then(|| conditions.group(run));
            for channel in Channel::ALL {
                let Some(measured) = run.measured[channel.index()] else {
                    continue;
                };
                let p = predictive(self, &levels, i, channel);
                let interpolated = interpolations.at(i, channel);
                let corrected = p.map(|p| corrections.at(i, channel, p)).and_then(|found| {
                    let reason = found.as_ref().err().cloned();
                    not_corrected.extend(reason);
                    found.ok()
                });
                let corrected_interval = corrected.and_then(|prediction| prediction.interval);
                rows.push(ComparisonRow {
                    run: run.name.clone(),
                    usage: run.usage,
                    holdout_group,
                    wheel: run.wheel.clone(),
                    slip: run.slip,
                    wheel_load_n: run.wheel_load_n,
                    sled_speed_m_s: run.sled_speed_m_s,
                    slip_angle_deg: run.slip_angle_deg,
                    channel,
                    unit: channel.unit().into(),
                    measured,
                    predicted: p.map(|p| p.mean),
                    q05: p.and_then(|p| p.interval).map(|[q05, _]| q05),
                    q95: p.and_then(|p| p.interval).map(|[_, q95]| q95),
                    noise_sd: p.and_then(|p| p.noise_sd),
                    residual_sigma: p.and_then(|p| p.noise_sd.map(|sd| (measured - p.mean) / sd)),
                    error_sd: p.and_then(|p| p.error_sd),
                    corrected: corrected.map(|prediction| prediction.mean),
                    corrected_q05: corrected_interval.map(|[q05, _]| q05),
                    corrected_q95: corrected_interval.map(|[_, q95]| q95),
                    refused: refused.clone(),
                    interpolated: interpolated.map(|i| i.value),
                    interpolated_over: interpolated.map(|i| i.over),
                });
            }
        }
        let sigmas = FixedSigmas::new(self);
        let errors = |usage| Some(ErrorTable::of_model(rows_of(&rows, usage))?.in_fixed_sigmas(&sigmas));
        let corrected =
            |usage| Some(ErrorTable::of_corrected(rows_of(&rows, usage))?.in_fixed_sigmas(&sigmas));
        Comparison {
            digitised: self
                .spec
                .experiment
                .campaign
                .as_ref()
                .is_some_and(|campaign| campaign.digitised),
            fit: errors(RunUse::Fit),
            holdout: errors(RunUse::Holdout),
            baseline_holdout: ErrorTable::of_baseline(rows_of(&rows, RunUse::Holdout))
                .map(|table| table.in_fixed_sigmas(&sigmas)),
            not_interpolated: interpolations.missing(),
            corrected_fit: corrected(RunUse::Fit),
            corrected_levels: self
                .between_levels(&rows, &corrections)
                .map(|table| table.in_fixed_sigmas(&sigmas)),
            corrected_holdout: corrected(RunUse::Holdout),
            not_corrected: not_corrected.into_iter().collect(),
            groups: error_groups(&rows),
            rows,
        }
    }

    /// Returns the errors of the fitted rows, each predicted by the model and the discrepancy of the other levels.
    fn between_levels(&self, rows: &[ComparisonRow], corrections: &Corrections) -> Option<ErrorTable> {
        let runs = &self.spec.experiment.runs;
        let by_run: BTreeMap<(&str, Channel), &ComparisonRow> = rows
            .iter()
            .map(|row| ((row.run.as_str(), row.channel), row))
            .collect();
        let left_out = Channel::ALL.into_iter().flat_map(|channel| {
            let discrepancies = corrections.between_levels(channel).into_iter();
            discrepancies.map(move |(run, discrepancy)| (run, channel, discrepancy))
        });
        ErrorTable::new(left_out.filter_map(|(run, channel, discrepancy)| {
            let row = *by_run.get(&(runs[run].name.as_str(), channel))?;
            Some((row, row.predicted.map(|predicted| predicted + discrepancy)))
        }))
    }

    /// Counts the final draws at which the model refuses a run; `None` if it refuses none.
    ///
    /// # Arguments
    /// - `run`: position in the experiment.
    pub fn refusal(&self, run: usize) -> Option<Refusal> {
        let spec = &self.spec;
        let draws = self.predictive_draws();
        let held_out = spec.holdout_runs.iter().position(|&r| r == run);
        let refused = draws.iter().filter_map(|draw| match (held_out, &draw.holdout) {
            (Some(position), Some(holdout)) => holdout.run(position).err(),
            (Some(_), None) => None,
            (None, _) => draw.fit.as_ref().err(),
        });
        let refused: Vec<&RejectionReason> = refused.collect();
        Some(Refusal {
            draws: refused.len(),
            of: draws.len(),
            reason: refused.first()?.to_string(),
        })
    }
}

#[cfg(test)]
mod tests {
    use statistics::Discrepancy;

    use super::*;
    use crate::fixture;

    #[test]
    fn all_errors_together_are_the_noise_alone_without_a_discrepancy_and_wider_with_one() {
        let plain = fixture::calibration();
        let mut inadequate = fixture::calibration();
        inadequate.spec.likelihood_settings.discrepancies = [Discrepancy::Known(3.0); 4];
        let errors = |calibration: &FinishedCalibration| -> Vec<(Channel, f64, f64, f64)> {
            let rows = calibration.comparison().rows.iter();
            rows.filter_map(|row| Some((row.channel, row.noise_sd?, row.error_sd?, row.residual_sigma?)))
                .collect()
        };
        let (alone, with) = (errors(&plain), errors(&inadequate));
        assert!(!alone.is_empty() && alone.len() == with.len());
        for ((channel, noise, all, residual), (_, _, wider, same)) in alone.into_iter().zip(with) {
            match channel {
                Channel::DrawbarPull => assert!((all - noise).abs() < 1e-12, "declared: {noise} {all}"),
                // The noise is the mean over the draws, and the total error their root mean square.
                _ => assert!(all >= noise, "inferred: {noise} {all}"),
            }
            assert!((wider / all - 10.0_f64.sqrt()).abs() < 1e-12, "{all} {wider}");
            assert_eq!(residual.to_bits(), same.to_bits());
        }
    }
}
