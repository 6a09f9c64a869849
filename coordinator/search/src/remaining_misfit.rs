//! The misfit that the best explanation of a search leaves: its size by channel, and the condition with which it varies.

use inference::diagnostics::chi_square_tail;
use job::PLATE;
use record::RemainingMisfit;
use shared::channel::Channel;
use shared::experiment::{TestRun, rim_speed_m_s};

use super::models::SearchModels;

/// p-value below which a channel is left unexplained.
const UNLIKELY: f64 = 0.01;
/// Standard normal score beyond which a correlation is significant: two-sided p of 0.01 over five conditions.
const SCORE: f64 = 3.09;

/// A condition of a run by its name in results.
type Condition = (&'static str, fn(&TestRun) -> Option<f64>);

/// The conditions of a run. Slip comes before sled speed: a rig may set the slip by the sled speed, and of equal correlations the
/// first is reported.
const CONDITIONS: [Condition; 5] = [
    ("slip", |run| Some(run.slip)),
    ("wheel_load", |run| Some(run.wheel_load_n)),
    ("rim_speed", |run| {
        Some(rim_speed_m_s(run.slip, run.sled_speed_m_s))
    }),
    ("sled_speed", |run| Some(run.sled_speed_m_s)),
    ("order", |run| run.order.map(f64::from)),
];

/// Lists the channels that are left unexplained, the worst first.
///
/// # Arguments
/// - `residuals`: measured less predicted value of each datum, in declared noise sds; empty where nothing is left.
pub(super) fn remaining_misfit(models: &SearchModels, residuals: &[f64]) -> Vec<RemainingMisfit> {
    let spec = &models.base;
    let of_channel = |channel: &Channel| {
        let data = spec.likelihood.data().iter().zip(residuals);
        let data = data.filter(|(datum, _)| datum.channel < PLATE && datum.channel == channel.index());
        let (runs, residuals): (Vec<&TestRun>, Vec<f64>) = data
            .map(|(datum, residual)| (&spec.experiment.runs[spec.fit_runs[datum.run]], *residual))
            .unzip();
        let squares: f64 = residuals.iter().map(|r| r * r).sum();
        let is_unlikely = chi_square_tail(squares, residuals.len() as f64).is_some_and(|p| p < UNLIKELY);
        is_unlikely.then(|| {
            let along = along(&runs, &residuals);
            RemainingMisfit {
                channel: *channel,
                noise_sds: (squares / residuals.len() as f64).sqrt(),
                values: residuals.len() as u64,
                along: along.map(|(name, _)| name.to_owned()),
                correlation: along.map(|(_, correlation)| correlation),
            }
        })
    };
    let mut left: Vec<RemainingMisfit> = Channel::ALL.iter().filter_map(of_channel).collect();
    left.sort_by(|a, b| b.noise_sds.total_cmp(&a.noise_sds));
    left
}

/// Returns the condition with which residuals correlate most strongly, if the correlation is significant by Fisher's z.
fn along(runs: &[&TestRun], residuals: &[f64]) -> Option<(&'static str, f64)> {
    let correlations = CONDITIONS.iter().filter_map(|(name, value)| {
        let values: Option<Vec<f64>> = runs.iter().map(|run| value(run)).collect();
        Some((*name, correlation(&values?, residuals)?))
    });
    let best = correlations.reduce(|a, b| if b.1.abs() > a.1.abs() { b } else { a })?;
    let score = libm::atanh(best.1.abs().min(1.0 - 1e-12)) * (runs.len() as f64 - 3.0).max(0.0).sqrt();
    (score > SCORE).then_some(best)
}

/// Computes Pearson's correlation; `None` if either does not vary.
fn correlation(x: &[f64], y: &[f64]) -> Option<f64> {
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (mean_x, mean_y) = (mean(x), mean(y));
    let sum = |f: fn(f64, f64) -> f64| {
        x.iter()
            .zip(y)
            .map(|(a, b)| f(a - mean_x, b - mean_y))
            .sum::<f64>()
    };
    let (xx, yy) = (sum(|a, _| a * a), sum(|_, b| b * b));
    (xx > 0.0 && yy > 0.0).then(|| sum(|a, b| a * b) / (xx * yy).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::read;

    #[test]
    fn what_is_left_is_named_by_channel_and_condition() {
        let (job, files, _) = read("tests/data/shear-mobilisation");
        let models = SearchModels::new(&job, &files, 1).unwrap();
        let spec = &models.base;
        let data = spec.likelihood.data();
        let slip = |run: usize| spec.experiment.runs[spec.fit_runs[run]].slip;
        let residual = |channel: usize, run: usize| match Channel::ALL[channel] {
            Channel::Sinkage => 4.0 - 12.0 * slip(run),
            Channel::Torque => 1.6,
            _ => 0.5,
        };
        let residuals: Vec<f64> = data.iter().map(|d| residual(d.channel, d.run)).collect();
        let left = remaining_misfit(&models, &residuals);
        let names: Vec<_> = left
            .iter()
            .map(|own| (own.channel, own.along.as_deref()))
            .collect();
        assert_eq!(names, [(Channel::Sinkage, Some("slip")), (Channel::Torque, None)]);
        assert!(left[0].correlation.unwrap() < -0.999);
        assert!((left[1].noise_sds - 1.6).abs() < 1e-12);
        assert!(left[0].words().contains("falls with slip"), "{}", left[0].words());
        assert!(remaining_misfit(&models, &[]).is_empty());
    }
}
