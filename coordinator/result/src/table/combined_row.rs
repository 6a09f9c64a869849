//! A combined row: the average prediction of several models and of the measurements alone for a run and channel.

use statistics::ErrorLaw;

use super::corrected::Corrected;
use super::mixture::{Component, quantile};
use super::row::ComparisonRow;

/// Standard deviations from the mean of a normal law to its 95 % quantile.
const TO_Q95: f64 = 1.644_853_626_951_472_7;

/// The weighted average of the corrected predictions of the models in a ledger, and of the prediction by the measurements alone.
///
/// `p(y) = sum_k w_k N(y; m_k, s_k)` with the corrected prediction `m_k` of model k, and `s_k` from its 90 % interval. The weight `w_k`
/// is proportional to 1 over the mean square error of the channel's fitted runs, each corrected without all runs at its level of a
/// condition; all models together weigh as the best of them beside the measurements alone. A rig has too few levels to support sharper
/// weights, which would select the best model.
///
/// # Source
/// Bates & Granger 1969, doi:10.1057/jors.1969.103. Checked by `models_that_err_to_both_sides_are_better_together` and others below.
#[derive(Debug, Clone)]
pub struct CombinedRow {
    /// Run and channel, with the prediction of the current model.
    pub row: ComparisonRow,
    /// Weighted mean of the predictions [channel's unit]; `None` if no model is corrected.
    pub mean: Option<f64>,
    /// 5 % and 95 % quantile of a new measurement; `None` unless all models have an interval.
    pub interval: Option<[f64; 2]>,
    /// Number of models in the average, the measurements alone not counted.
    pub models: usize,
}

impl CombinedRow {
    /// Averages the corrected predictions of the models and the prediction by the measurements alone, which come with their weights. The models
    /// extend each other, and the parameters of each know the level that was left out, so that they err together and by more than they tell:
    /// beside the measurements alone, all of them have the weight of the best. Where no model counts, the measurements alone are no combination.
    pub(super) fn new(
        row: &ComparisonRow,
        of_models: &[(Option<Corrected>, f64)],
        of_measurements: Option<(Corrected, f64)>,
    ) -> Self {
        let with_prediction = |&(corrected, weight): &(Option<Corrected>, f64)| Some((corrected?, weight));
        let is_counted = |(_, weight): &(Corrected, f64)| *weight > 0.0;
        let models = of_models.iter().filter_map(with_prediction).filter(is_counted);
        let mut counted: Vec<(Corrected, f64)> = models.collect();
        let models = counted.len();
        let of_models = counted.iter().map(|(_, weight)| *weight);
        let (sum, max) = of_models.fold((0.0_f64, 0.0_f64), |(sum, max), weight| {
            (sum + weight, max.max(weight))
        });
        let beside_models = |(predicted, weight): (Corrected, f64)| (predicted, weight * sum / max);
        counted.extend(
            of_measurements
                .filter(|counted| models > 0 && is_counted(counted))
                .map(beside_models),
        );
        let total: f64 = counted.iter().map(|(_, weight)| weight).sum();
        let shares = counted
            .iter()
            .map(|(corrected, weight)| corrected.mean * weight / total);
        let component = |&(corrected, weight): &(Corrected, f64)| {
            let [q05, q95] = corrected.interval?;
            Some(Component {
                mean: corrected.mean,
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
            models,
        }
    }

    /// Returns whether the 90 % interval contains the measurement; `None` without an interval.
    pub fn covered(&self) -> Option<bool> {
        let [q05, q95] = self.interval?;
        Some((q05..=q95).contains(&self.row.measured))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    /// Returns a row with a measured pull of 0 N; each model has a corrected value, a standard deviation of 1 N and a weight.
    fn weighted(corrected: &[(Option<f64>, f64)]) -> CombinedRow {
        let rows = fixture::calibration().comparison().rows.clone();
        let row = ComparisonRow {
            measured: 0.0,
            ..rows[0].clone()
        };
        let of_model = |&(corrected, weight): &(Option<f64>, f64)| {
            let prediction = corrected.map(|mean| Corrected {
                mean,
                interval: Some([mean - TO_Q95, mean + TO_Q95]),
            });
            (prediction, weight)
        };
        CombinedRow::new(&row, &corrected.iter().map(of_model).collect::<Vec<_>>(), None)
    }

    /// Returns the same row for models of equal weight.
    fn combined(corrected: &[Option<f64>]) -> CombinedRow {
        weighted(&corrected.iter().map(|mean| (*mean, 1.0)).collect::<Vec<_>>())
    }

    #[test]
    fn the_mean_is_weighted() {
        let row = weighted(&[(Some(1.0), 1.0), (Some(5.0), 0.25), (Some(1e6), 0.0)]);
        assert!(
            (row.mean.unwrap() - 1.8).abs() < 1e-12 && row.models == 2,
            "{row:?}"
        );
    }

    #[test]
    fn the_measurements_alone_count_beside_a_model_and_are_no_combination_without_one() {
        let rows = fixture::calibration().comparison().rows.clone();
        let predicted = |mean: f64| Corrected { mean, interval: None };
        let combine = |models: &[Option<f64>]| {
            let of_models: Vec<_> = models.iter().map(|mean| (mean.map(predicted), 1.0)).collect();
            CombinedRow::new(&rows[0], &of_models, Some((predicted(4.0), 3.0)))
        };
        let beside_one = combine(&[Some(0.0)]);
        assert_eq!((beside_one.mean, beside_one.models), (Some(3.0), 1));
        // Two alike are no more than one.
        let beside_two = combine(&[Some(0.0), None, Some(0.0)]);
        assert_eq!((beside_two.mean, beside_two.models), (Some(3.0), 2));
        let without = combine(&[None]);
        assert_eq!((without.mean, without.models), (None, 0));
    }

    #[test]
    fn models_that_err_to_both_sides_are_better_together() {
        let row = combined(&[Some(2.0), None, Some(-2.0)]);
        assert_eq!((row.mean, row.models), (Some(0.0), 2));
        assert_eq!(combined(&[Some(2.0)]).covered(), Some(false));
        assert_eq!(row.covered(), Some(true));
    }

    #[test]
    fn an_interval_holds_the_models_spread_too() {
        let [q05, q95] = combined(&[Some(0.3)]).interval.unwrap();
        assert!((q05 - 0.3 + TO_Q95).abs() < 1e-9 && (q95 - 0.3 - TO_Q95).abs() < 1e-9);
        // Each component has half of the weight, so 10 % of it must lie beyond the outer quantile.
        let [q05, q95] = combined(&[Some(10.0), Some(-10.0)]).interval.unwrap();
        let outer = 10.0 + 1.281_551_565_544_600_5;
        assert!(
            (q05 + outer).abs() < 1e-6 && (q95 - outer).abs() < 1e-6,
            "{q05} {q95}"
        );
    }

    #[test]
    fn without_a_correction_there_is_nothing_to_combine() {
        let row = combined(&[None]);
        assert_eq!((row.mean, row.interval, row.models), (None, None, 0));
    }
}
