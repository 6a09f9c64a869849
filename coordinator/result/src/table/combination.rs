//! Combination of the predictions of all models of a study and of the measurements alone, by weights for each channel.

use std::collections::BTreeMap;

use shared::channel::Channel;

use super::combined_row::CombinedRow;
use super::comparison::Comparison;
use super::corrected::Corrected;
use super::row::ComparisonRow;
use super::without_model::WithoutModel;
use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

impl Study {
    /// Returns the measurements of the current model's experiment, with the average of the predictions of all models that have the same
    /// measurements, those in the ledger and those that the job compares, and of these measurements alone. A fit without draws is in no
    /// ledger, so its average is over itself and the measurements.
    pub fn combined(&self) -> &[CombinedRow] {
        self.combined.get_or_init(|| self.combine())
    }

    fn combine(&self) -> Vec<CombinedRow> {
        let current = self.current().unwrap_or(&self.lead);
        let mut models: Vec<&FinishedCalibration> = self.ledger().chain(&self.other_models).collect();
        models.retain(|model| model.row.experiment == current.row.experiment);
        if models.is_empty() {
            models.push(current);
        }
        let models: Vec<&Comparison> = models.into_iter().map(FinishedCalibration::comparison).collect();
        let alone = WithoutModel::new(current);
        let weights: BTreeMap<Channel, Vec<f64>> = Channel::ALL
            .into_iter()
            .map(|channel| {
                let of_models = models.iter().map(|model| left_out_rmse(model, channel));
                let errors: Vec<Option<f64>> = of_models.chain([alone.rmse(channel)]).collect();
                (channel, weights(&errors))
            })
            .collect();
        let runs = current.spec.experiment.runs.iter().enumerate();
        let positions: BTreeMap<&str, usize> = runs.map(|(i, run)| (run.name.as_str(), i)).collect();
        // Comparisons of the same experiment have the same rows in the same order.
        let rows = current.comparison().rows.iter().enumerate();
        let combined = |(i, row): (usize, &ComparisonRow)| {
            let of_models = models
                .iter()
                .map(|model| model.rows.get(i).and_then(ComparisonRow::corrected_prediction));
            let mut weights = weights[&row.channel].iter().copied();
            let of_models: Vec<(Option<Corrected>, f64)> = of_models.zip(weights.by_ref()).collect();
            let run = positions.get(row.run.as_str());
            let of_measurements = run
                .and_then(|&run| alone.at(run, row.channel))
                .zip(weights.next());
            CombinedRow::new(row, &of_models, of_measurements)
        };
        rows.map(combined).collect()
    }
}

/// Returns the root mean square error of a model's corrected predictions of a channel in left-out levels; in left-out conditions where no
/// condition has levels.
fn left_out_rmse(model: &Comparison, channel: Channel) -> Option<f64> {
    let [levels, conditions] =
        [&model.corrected_levels, &model.corrected_fit].map(|table| table.as_ref()?.channel(channel));
    Some(levels.or(conditions)?.rmse)
}

/// Returns the weights of predictions with these root mean square errors, relative to the largest; 0 without an error.
fn weights(errors: &[Option<f64>]) -> Vec<f64> {
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
    use crate::table::errors::ErrorTable;

    /// Returns the errors of a channel of the models in left-out conditions, and in left-out levels.
    fn left_out(models: &[&Comparison], channel: Channel) -> [Vec<f64>; 2] {
        let rmse = |table: &Option<ErrorTable>| table.as_ref().unwrap().channel(channel).unwrap().rmse;
        let conditions = models.iter().map(|model| rmse(&model.corrected_fit)).collect();
        [
            conditions,
            models.iter().map(|model| rmse(&model.corrected_levels)).collect(),
        ]
    }

    #[test]
    fn a_model_that_does_not_cross_angles_counts_less_although_it_does_better_between_conditions() {
        // The first misses by an amount that alternates from run to run. The second misses alike at each angle, which the other slips at
        // this angle tell and the other angles do not.
        let crosses = fixture::over_angles(|slip, angle| if (slip + angle) % 2 == 0 { 6.0 } else { -6.0 });
        let does_not = fixture::over_angles(|_, angle| [0.0, 20.0, -20.0, 20.0][angle]);
        let models = [crosses.comparison(), does_not.comparison()];
        let [conditions, levels] = left_out(&models, Channel::DrawbarPull);
        assert!(conditions[1] < 0.5 * conditions[0], "{conditions:?}");
        assert!(levels[0] < 0.7 * levels[1], "{levels:?}");
        let errors = models.map(|model| left_out_rmse(model, Channel::DrawbarPull));
        let weights = weights(&errors);
        let ratio = levels[0] / levels[1];
        assert!(
            (weights[0] - 1.0).abs() < 1e-12 && (weights[1] - ratio * ratio).abs() < 1e-12,
            "{weights:?}"
        );
        assert_eq!(left_out_rmse(models[0], Channel::Torque), None);
        assert_eq!(super::weights(&[None, None]), [0.0, 0.0]);
    }

    #[test]
    fn a_model_counts_by_its_mean_square_error_where_no_condition_has_levels() {
        let calibration = fixture::with_smooth_misfit();
        let mut comparison = calibration.comparison().clone();
        comparison.corrected_levels = None;
        let [corrected, levels] = [&comparison, calibration.comparison()]
            .map(|comparison| left_out_rmse(comparison, Channel::DrawbarPull).unwrap());
        let conditions = comparison.corrected_fit.as_ref().unwrap().drawbar_pull.unwrap();
        assert_eq!(corrected.to_bits(), conditions.rmse.to_bits());
        // Each run has its slip alone, so that a level is a condition.
        assert!((levels / corrected - 1.0).abs() < 1e-9, "{levels} {corrected}");
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
    fn each_run_and_channel_averages_its_own_rows_of_all_models_and_of_the_measurements() {
        let study = grown();
        let models = [study.lead.comparison(), study.extensions[0].comparison()];
        let alone = WithoutModel::new(&study.extensions[0]);
        let rows = study.combined();
        assert_eq!(rows.len(), models[0].rows.len());
        let mut averaged = 0;
        for combined in rows {
            let channel = combined.row.channel;
            let corrected = |model: &&Comparison| {
                let mut rows = model.rows.iter();
                let row = rows.find(|row| row.run == combined.row.run && row.channel == channel);
                row.and_then(|row| row.corrected)
            };
            let [Some(a), Some(b)] = [corrected(&models[0]), corrected(&models[1])] else {
                continue;
            };
            let run = fixture::position(&study.lead, &combined.row.run);
            let of_models = models.map(|model| left_out_rmse(model, channel));
            let [u, v, w] = weights(&[of_models[0], of_models[1], alone.rmse(channel)])[..] else {
                panic!("two models and the measurements");
            };
            let measured = alone.at(run, channel).map_or(0.0, |corrected| corrected.mean);
            let of_models = (u * a + v * b) / (u + v);
            let best = u.max(v);
            let expected = (best * of_models + w * measured) / (best + w);
            assert!(
                (combined.mean.unwrap() - expected).abs() < 1e-12,
                "{} {expected}",
                combined.row.run
            );
            assert_eq!(combined.models, 2);
            averaged += 1;
        }
        assert!(averaged > 10, "{averaged}");
    }

    #[test]
    fn a_compared_model_that_the_study_does_not_continue_with_is_averaged_too() {
        let grown = grown();
        let compared = Study {
            other_models: grown.extensions.clone(),
            ..Study::from(fixture::with_smooth_misfit())
        };
        let means = |study: &Study| -> Vec<Option<f64>> {
            let rows = study.combined();
            rows.iter().map(|combined| combined.mean).collect()
        };
        assert_eq!(means(&compared), means(&grown));
        assert!(compared.combined().iter().all(|combined| combined.models <= 2));
        assert_ne!(
            means(&compared),
            means(&Study::from(fixture::with_smooth_misfit()))
        );
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
