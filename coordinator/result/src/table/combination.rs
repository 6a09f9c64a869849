//! What all models of a study predict together.

use std::collections::BTreeMap;

use shared::channel::Channel;
use statistics::ErrorLaw;

use super::comparison::Comparison;
use super::correction::Corrected;
use super::mixture::{Component, quantile};
use super::row::ComparisonRow;
use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

/// Standard deviations from the mean of a normal law to its 95 % quantile.
const TO_Q95: f64 = 1.644_853_626_951_472_7;

/// The corrected predictions of the models of a ledger, on average.
///
/// `p(y) = sum_k w_k N(y; m_k, s_k)`: `m_k` the corrected prediction of model k, `s_k` from its 90 % interval, `w_k` as 1 over the
/// mean square error of the channel's fitted runs, each corrected by the other conditions. Sharper weights, which the best model would
/// take, rest on differences that so few conditions as a rig has do not bear out.
///
/// # Source
/// Bates & Granger 1969, doi:10.1057/jors.1969.103. Checked by `models_that_err_to_both_sides_are_better_together` and others below.
#[derive(Debug, Clone)]
pub struct CombinedRow {
    /// The run and channel, with the prediction of the current model.
    pub(crate) row: ComparisonRow,
    /// Weighted mean of the corrected predictions [channel's unit]; `None` where no model has one.
    pub(crate) mean: Option<f64>,
    /// 5 % and 95 % quantile of a new measurement; `None` without intervals of all.
    pub(crate) interval: Option<[f64; 2]>,
    /// How many models it averages.
    pub(crate) models: usize,
}

impl CombinedRow {
    /// Of what each model predicts, with its weight.
    fn of(row: &ComparisonRow, of_models: impl Iterator<Item = (Option<Corrected>, f64)>) -> Self {
        let counted = of_models.filter(|(_, weight)| *weight > 0.0);
        let counted: Vec<(Corrected, f64)> =
            counted.filter_map(|(own, weight)| Some((own?, weight))).collect();
        let total: f64 = counted.iter().map(|(_, weight)| weight).sum();
        let shares = counted.iter().map(|(own, weight)| own.mean * weight / total);
        let component = |&(own, weight): &(Corrected, f64)| {
            let [q05, q95] = own.interval?;
            Some(Component {
                mean: own.mean,
                scale: Some((q95 - q05) / (2.0 * TO_Q95)),
                weight,
            })
        };
        let components: Option<Vec<Component>> = counted.iter().map(component).collect();
        let components = components.filter(|all| !all.is_empty());
        CombinedRow {
            row: row.clone(),
            mean: (!counted.is_empty()).then_some(shares.sum()),
            interval: components.map(|all| [0.05, 0.95].map(|p| quantile(&all, ErrorLaw::Gaussian, p))),
            models: counted.len(),
        }
    }

    /// Whether the measurement lies in its 90 % interval.
    pub(crate) fn covered(&self) -> Option<bool> {
        let [q05, q95] = self.interval?;
        Some((q05..=q95).contains(&self.row.measured))
    }
}

impl Study {
    /// The measurements that the current model is compared with, as the ledger's models of the same measurements predict them
    /// together; of a fit without draws, which stands in no ledger, by that fit alone.
    pub(crate) fn combined(&self) -> &[CombinedRow] {
        self.combined.get_or_init(|| self.combine())
    }

    fn combine(&self) -> Vec<CombinedRow> {
        let current = self.current().unwrap_or(&self.lead);
        let mut models: Vec<&FinishedCalibration> = self.ledger().collect();
        models.retain(|own| own.row.experiment == current.row.experiment);
        if models.is_empty() {
            models.push(current);
        }
        let models: Vec<&Comparison> = models.into_iter().map(FinishedCalibration::comparison).collect();
        let weights: BTreeMap<Channel, Vec<f64>> = Channel::ALL
            .into_iter()
            .map(|channel| (channel, weights(&models, channel)))
            .collect();
        // The rows of two comparisons of one experiment are those of its runs and channels, in the same order.
        let rows = current.comparison().rows.iter().enumerate();
        let combined = |(i, row): (usize, &ComparisonRow)| {
            let of_models = models
                .iter()
                .map(|own| own.rows.get(i).and_then(ComparisonRow::corrected_prediction));
            CombinedRow::of(row, of_models.zip(weights[&row.channel].iter().copied()))
        };
        rows.map(combined).collect()
    }
}

/// How much each model counts for a channel, over the one that counts most; 0 without an error.
fn weights(models: &[&Comparison], channel: Channel) -> Vec<f64> {
    let rmse = |own: &&Comparison| Some(own.corrected_fit.as_ref()?.channel(channel)?.rmse);
    let errors: Vec<Option<f64>> = models.iter().map(rmse).collect();
    let least = errors.iter().flatten().copied().fold(f64::INFINITY, f64::min);
    let weight = |error: &Option<f64>| match *error {
        None => 0.0,
        Some(error) if error > 0.0 => (least / error) * (least / error),
        Some(_) => 1.0,
    };
    errors.iter().map(weight).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    /// A row of the pull, measured as 0 N, that models of these weights correct to these values with a sd of 1 N.
    fn weighted(corrected: &[(Option<f64>, f64)]) -> CombinedRow {
        let rows = fixture::calibration().comparison().rows.clone();
        let row = ComparisonRow {
            measured: 0.0,
            ..rows[0].clone()
        };
        let of_model = |&(corrected, weight): &(Option<f64>, f64)| {
            let own = corrected.map(|mean| Corrected {
                mean,
                interval: Some([mean - TO_Q95, mean + TO_Q95]),
            });
            (own, weight)
        };
        CombinedRow::of(&row, corrected.iter().map(of_model))
    }

    /// The same of models that count alike.
    fn combined(corrected: &[Option<f64>]) -> CombinedRow {
        weighted(&corrected.iter().map(|own| (*own, 1.0)).collect::<Vec<_>>())
    }

    #[test]
    fn a_model_counts_by_its_mean_square_error_in_the_other_conditions() {
        let good = fixture::with_smooth_misfit();
        let mut bad = fixture::with_smooth_misfit();
        // Alternately too high and too low: nothing that the other conditions would tell.
        for prediction in &mut bad.predictions {
            let pulls = &mut prediction.fit.as_mut().unwrap().drawbar_pull_n;
            let signs = [4.0, -4.0].into_iter().cycle();
            pulls.iter_mut().zip(signs).for_each(|(pull, by)| *pull += by);
        }
        let error = |own: &Comparison| {
            let table = own.corrected_fit.as_ref().unwrap();
            table.drawbar_pull.unwrap().rmse
        };
        let models = [good.comparison(), bad.comparison()];
        let own = weights(&models, Channel::DrawbarPull);
        let ratio = error(models[0]) / error(models[1]);
        assert!(ratio < 0.5, "{ratio}");
        assert!(
            (own[0] - 1.0).abs() < 1e-12 && (own[1] - ratio * ratio).abs() < 1e-12,
            "{own:?}"
        );
        assert_eq!(weights(&models, Channel::Torque), [0.0, 0.0]);
    }

    #[test]
    fn the_mean_is_weighted() {
        let own = weighted(&[(Some(1.0), 1.0), (Some(5.0), 0.25), (Some(1e6), 0.0)]);
        assert!(
            (own.mean.unwrap() - 1.8).abs() < 1e-12 && own.models == 2,
            "{own:?}"
        );
    }

    #[test]
    fn models_that_err_to_both_sides_are_better_together() {
        let own = combined(&[Some(2.0), None, Some(-2.0)]);
        assert_eq!((own.mean, own.models), (Some(0.0), 2));
        assert_eq!(combined(&[Some(2.0)]).covered(), Some(false));
        assert_eq!(own.covered(), Some(true));
    }

    #[test]
    fn an_interval_holds_the_models_spread_too() {
        let [q05, q95] = combined(&[Some(0.3)]).interval.unwrap();
        assert!((q05 - 0.3 + TO_Q95).abs() < 1e-9 && (q95 - 0.3 - TO_Q95).abs() < 1e-9);
        // Half of the mixture lies below 0: a tenth of a half of each component lies beyond the outer quantile.
        let [q05, q95] = combined(&[Some(10.0), Some(-10.0)]).interval.unwrap();
        let outer = 10.0 + 1.281_551_565_544_600_5;
        assert!(
            (q05 + outer).abs() < 1e-6 && (q95 - outer).abs() < 1e-6,
            "{q05} {q95}"
        );
    }

    #[test]
    fn without_a_correction_there_is_nothing_to_combine() {
        let own = combined(&[None]);
        assert_eq!((own.mean, own.interval, own.models), (None, None, 0));
    }

    /// The base misses by a wave; a second model by that and another number in each channel and run.
    fn grown() -> Study {
        let mut extension = fixture::with_smooth_misfit();
        extension.row.id = 3;
        for prediction in &mut extension.predictions {
            let held_out = prediction
                .holdout
                .as_mut()
                .map(|own| own.together.as_mut().unwrap());
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
        for own in rows {
            let of = |model: &&Comparison| {
                let mut rows = model.rows.iter();
                let row = rows.find(|row| row.run == own.row.run && row.channel == own.row.channel);
                row.and_then(|row| row.corrected)
            };
            let [Some(a), Some(b)] = [of(&models[0]), of(&models[1])] else {
                continue;
            };
            let [v, w] = weights(&models, own.row.channel)[..] else {
                panic!("two models");
            };
            let expected = (v * a + w * b) / (v + w);
            assert!(
                (own.mean.unwrap() - expected).abs() < 1e-12,
                "{} {expected}",
                own.row.run
            );
            averaged += 1;
        }
        assert!(averaged > 10, "{averaged}");
    }

    #[test]
    fn no_prediction_reads_what_was_measured_in_a_held_out_run() {
        let predicted = |by: f64| -> Vec<Option<f64>> {
            let mut study = grown();
            for own in [&mut study.lead, &mut study.extensions[0]] {
                let held_out = own.spec.holdout_runs.clone();
                for run in held_out {
                    for measured in own.spec.experiment.runs[run].measured.iter_mut().flatten() {
                        *measured += by;
                    }
                }
            }
            let rows = study.combined();
            rows.iter()
                .flat_map(|own| [own.row.corrected, own.mean])
                .collect()
        };
        assert_eq!(predicted(0.0), predicted(7.0));
    }
}
