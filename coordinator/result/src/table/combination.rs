//! Combination of the predictions of all models of a study, by weights for each channel.

use std::collections::BTreeMap;

use shared::channel::Channel;

use super::combined_row::CombinedRow;
use super::comparison::Comparison;
use super::row::ComparisonRow;
use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

impl Study {
    /// Returns the measurements of the current model's experiment, with the average of the predictions of all models in the ledger that
    /// have the same measurements. A fit without draws is in no ledger, so its average is its own prediction.
    pub fn combined(&self) -> &[CombinedRow] {
        self.combined.get_or_init(|| self.combine())
    }

    fn combine(&self) -> Vec<CombinedRow> {
        let current = self.current().unwrap_or(&self.lead);
        let mut models: Vec<&FinishedCalibration> = self.ledger().collect();
        models.retain(|model| model.row.experiment == current.row.experiment);
        if models.is_empty() {
            models.push(current);
        }
        let models: Vec<&Comparison> = models.into_iter().map(FinishedCalibration::comparison).collect();
        let weights: BTreeMap<Channel, Vec<f64>> = Channel::ALL
            .into_iter()
            .map(|channel| (channel, weights(&models, channel)))
            .collect();
        // Comparisons of the same experiment have the same rows in the same order.
        let rows = current.comparison().rows.iter().enumerate();
        let combined = |(i, row): (usize, &ComparisonRow)| {
            let of_models = models
                .iter()
                .map(|model| model.rows.get(i).and_then(ComparisonRow::corrected_prediction));
            CombinedRow::new(row, of_models.zip(weights[&row.channel].iter().copied()))
        };
        rows.map(combined).collect()
    }
}

/// Returns the weight of each model for a channel, relative to the largest; 0 for a model without an error there.
fn weights(models: &[&Comparison], channel: Channel) -> Vec<f64> {
    let rmse = |model: &&Comparison| Some(model.corrected_fit.as_ref()?.channel(channel)?.rmse);
    let errors: Vec<Option<f64>> = models.iter().map(rmse).collect();
    let min = errors.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    let weight = |error: &Option<f64>| match *error {
        None => 0.0,
        Some(error) if error > 0.0 => (min / error) * (min / error),
        Some(_) => 1.0,
    };
    errors.iter().map(weight).collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::fixture;

    #[test]
    fn a_model_counts_by_its_mean_square_error_in_the_other_conditions() {
        let good = fixture::with_smooth_misfit();
        let mut bad = fixture::with_smooth_misfit();
        // Errors that alternate in sign cannot be predicted from the other conditions.
        for prediction in &mut bad.predictions {
            let pulls = &mut prediction.fit.as_mut().unwrap().drawbar_pull_n;
            let signs = [4.0, -4.0].into_iter().cycle();
            pulls.iter_mut().zip(signs).for_each(|(pull, by)| *pull += by);
        }
        let error = |comparison: &Comparison| {
            let table = comparison.corrected_fit.as_ref().unwrap();
            table.drawbar_pull.unwrap().rmse
        };
        let models = [good.comparison(), bad.comparison()];
        let weights = weights(&models, Channel::DrawbarPull);
        let ratio = error(models[0]) / error(models[1]);
        assert!(ratio < 0.5, "{ratio}");
        assert!(
            (weights[0] - 1.0).abs() < 1e-12 && (weights[1] - ratio * ratio).abs() < 1e-12,
            "{weights:?}"
        );
        assert_eq!(super::weights(&models, Channel::Torque), [0.0, 0.0]);
    }

    /// Returns a study of two models: the first misses the pull by a sine of slip; the second differs from it by another amount in each
    /// channel and run.
    fn grown() -> Study {
        let mut extension = fixture::with_smooth_misfit();
        extension.row.id = 3;
        for prediction in &mut extension.predictions {
            let held_out = prediction
                .holdout
                .as_mut()
                .map(|holdout| holdout.together.as_mut().unwrap());
            for observables in held_out.into_iter().chain(prediction.fit.as_mut().ok()) {
                let pulls = observables.drawbar_pull_n.iter_mut().enumerate();
                pulls.for_each(|(i, pull)| *pull += 0.1 * (i % 3) as f64);
                observables.sinkage_m.iter_mut().for_each(|z| *z += 0.001);
            }
        }
        Study {
            extensions: vec![extension],
            ..Study::from(fixture::with_smooth_misfit())
        }
    }

    #[test]
    fn each_run_and_channel_averages_its_own_rows_of_all_models() {
        let study = grown();
        let models = [study.lead.comparison(), study.extensions[0].comparison()];
        let rows = study.combined();
        assert_eq!(rows.len(), models[0].rows.len());
        let mut averaged = 0;
        for combined in rows {
            let corrected = |model: &&Comparison| {
                let mut rows = model.rows.iter();
                let row = rows.find(|row| row.run == combined.row.run && row.channel == combined.row.channel);
                row.and_then(|row| row.corrected)
            };
            let [Some(a), Some(b)] = [corrected(&models[0]), corrected(&models[1])] else {
                continue;
            };
            let [v, w] = weights(&models, combined.row.channel)[..] else {
                panic!("two models");
            };
            let expected = (v * a + w * b) / (v + w);
            assert!(
                (combined.mean.unwrap() - expected).abs() < 1e-12,
                "{} {expected}",
                combined.row.run
            );
            averaged += 1;
        }
        assert!(averaged > 10, "{averaged}");
    }

    #[test]
    fn no_prediction_reads_what_was_measured_in_a_held_out_run() {
        let predicted = |by: f64| -> Vec<Option<f64>> {
            let mut study = grown();
            for calibration in [&mut study.lead, &mut study.extensions[0]] {
                let held_out = calibration.spec.holdout_runs.clone();
                for run in held_out {
                    for measured in Arc::make_mut(&mut calibration.spec.experiment).runs[run]
                        .measured
                        .iter_mut()
                        .flatten()
                    {
                        *measured += by;
                    }
                }
            }
            let rows = study.combined();
            rows.iter()
                .flat_map(|combined| [combined.row.corrected, combined.mean])
                .collect()
        };
        assert_eq!(predicted(0.0), predicted(7.0));
    }
}
