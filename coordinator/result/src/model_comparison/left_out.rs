//! Leave-one-condition-out prediction without refitting, by importance weights of the posterior draws.

use std::collections::BTreeMap;

use job::is_of_run;
use shared::channel::Channel;
use shared::experiment::{RunUse, TestRun};
use statistics::Likelihood;

use crate::finished_calibration::FinishedCalibration;
use crate::table::row::ComparisonRow;

/// The predictions of every condition from the others.
///
/// Let `l_d = ln p(y_c | the other data, theta_d)` for the data `y_c` of a condition and draw d. The draw has the importance weight
/// `exp(−l_d)`, truncated at `sqrt(D)` times the mean weight of the D draws (Ionides 2008, <https://doi.org/10.1198/106186008X320456>).
/// Then `ln p(y_c | the other data) = ln (sum_d w_d exp(l_d) / sum_d w_d)`. Bevameter readings are never left out.
#[derive(Debug)]
pub(super) struct LeftOut {
    /// Sum of the log-densities of all conditions.
    pub(super) log_density: f64,
    /// Mean prediction, keyed by run and channel.
    predicted: BTreeMap<(String, Channel), f64>,
}

/// A draw that the model accepted for the fitted runs.
struct Draw<'a> {
    theta: &'a [f64],
    values: Vec<f64>,
    log_likelihood: f64,
    observables: &'a shared::outcome::Observables,
}

impl LeftOut {
    /// Predicts each condition from the others; `None` without draws, or if there is only one condition.
    pub(super) fn new(calibration: &FinishedCalibration) -> Option<Self> {
        let spec = &calibration.spec;
        let likelihood = &spec.likelihood;
        let draws = calibration.predictive_draws().iter();
        let draws: Vec<Draw> = draws
            .filter_map(|draw| {
                let observables = draw.fit.as_ref().ok()?;
                let values = spec.predicted_values(observables);
                Some(Draw {
                    theta: &draw.theta,
                    log_likelihood: log_likelihood(likelihood, &values, &draw.theta)?,
                    values,
                    observables,
                })
            })
            .collect();
        let conditions = conditions(spec.fit_runs.iter().map(|&run| &spec.experiment.runs[run]));
        if draws.is_empty() || conditions.len() < 2 || calibration.estimate().is_some() {
            return None;
        }
        let mut left_out = LeftOut {
            log_density: 0.0,
            predicted: BTreeMap::new(),
        };
        for runs in conditions {
            left_out.leave_out(calibration, &draws, &runs)?;
        }
        Some(left_out)
    }

    /// Adds a condition, the runs of which are positions among the fitted ones.
    fn leave_out(&mut self, calibration: &FinishedCalibration, draws: &[Draw], runs: &[usize]) -> Option<()> {
        let spec = &calibration.spec;
        let data = spec.likelihood.data();
        let is_left_out = |i: &usize| is_of_run(data[*i].channel) && runs.contains(&data[*i].run);
        let kept: Vec<usize> = (0..data.len()).filter(|i| !is_left_out(i)).collect();
        if kept.len() == data.len() {
            return Some(());
        }
        let (rest, places) = spec.likelihood.subset(&kept).ok()?;
        let log_density = |draw: &Draw| {
            let values: Vec<f64> = places.iter().map(|&i| draw.values[i]).collect();
            Some(draw.log_likelihood - log_likelihood(&rest, &values, draw.theta)?)
        };
        let log_densities: Vec<f64> = draws.iter().map(log_density).collect::<Option<_>>()?;
        let weights = weights(&log_densities);
        let total: f64 = weights.iter().sum();
        let max = log_densities.iter().fold(f64::NEG_INFINITY, |max, l| max.max(*l));
        let terms = weights.iter().zip(&log_densities);
        let mean: f64 = terms.map(|(w, l)| w * libm::exp(l - max)).sum::<f64>() / total;
        self.log_density += max + libm::log(mean);
        for &run in runs {
            let name = &spec.experiment.runs[spec.fit_runs[run]].name;
            for channel in Channel::ALL {
                let value = |draw: &Draw| draw.observables.channel(channel).get(run).copied();
                let values: Option<Vec<f64>> = draws.iter().map(value).collect();
                if let Some(values) = values {
                    let sum: f64 = values.iter().zip(&weights).map(|(value, w)| value * w).sum();
                    self.predicted.insert((name.clone(), channel), sum / total);
                }
            }
        }
        Some(())
    }

    /// Returns the rows of the fitted runs with these predictions.
    pub(super) fn rows(&self, rows: &[ComparisonRow]) -> Vec<ComparisonRow> {
        let fitted = rows.iter().filter(|row| row.usage == RunUse::Fit);
        let predicted = fitted.map(|row| ComparisonRow {
            predicted: self.predicted.get(&(row.run.clone(), row.channel)).copied(),
            ..row.clone()
        });
        predicted.collect()
    }
}

fn log_likelihood(likelihood: &Likelihood, values: &[f64], theta: &[f64]) -> Option<f64> {
    let value = likelihood.log_likelihood(values, theta).ok()?.value();
    value.is_finite().then_some(value)
}

/// Returns the truncated weight of each draw, relative to the largest weight before truncation.
fn weights(log_densities: &[f64]) -> Vec<f64> {
    let min = log_densities.iter().fold(f64::INFINITY, |min, l| min.min(*l));
    let raw: Vec<f64> = log_densities.iter().map(|l| libm::exp(min - l)).collect();
    let count = raw.len() as f64;
    let limit = raw.iter().sum::<f64>() / count * count.sqrt();
    raw.into_iter().map(|weight| weight.min(limit)).collect()
}

/// Groups the positions of runs by condition, in the order in which conditions first appear.
fn conditions<'a>(runs: impl Iterator<Item = &'a TestRun>) -> Vec<Vec<usize>> {
    let key = |run: &TestRun| {
        let set = [run.slip, run.wheel_load_n, run.sled_speed_m_s, run.slip_angle_deg];
        (
            run.wheel.clone(),
            run.soil.clone(),
            run.pass,
            set.map(f64::to_bits),
        )
    };
    let mut found: Vec<(_, Vec<usize>)> = Vec::new();
    for (position, run) in runs.enumerate() {
        let key = key(run);
        match found.iter_mut().find(|(other, _)| *other == key) {
            Some((_, positions)) => positions.push(position),
            None => found.push((key, vec![position])),
        }
    }
    found.into_iter().map(|(_, positions)| positions).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn equal_draws_weigh_the_same_and_a_rare_one_is_limited() {
        assert_eq!(weights(&[-3.0, -3.0]), [1.0, 1.0]);
        // The raw weights are 1 and three times e^-20; the limit is sqrt(4) / 4 of their sum.
        let limited = weights(&[-23.0, -3.0, -3.0, -3.0]);
        assert!((limited[0] - 0.5).abs() < 1e-8, "{limited:?}");
    }

    #[test]
    fn every_measured_row_is_predicted_from_the_others() {
        let calibration = fixture::without_holdout();
        let left_out = LeftOut::new(&calibration).unwrap();
        assert!(left_out.log_density.is_finite());
        let comparison = calibration.comparison();
        let rows = left_out.rows(&comparison.rows);
        assert!(!rows.is_empty() && rows.iter().all(|row| row.predicted.is_some()));
    }
}
