//! Runs that contradict what was expected of them.

use job::PlannedRun;
use result::NewMeasurements;
use serde::{Deserialize, Serialize};
use shared::channel::Channel;
use utoipa::ToSchema;

use crate::ensemble::Simulated;

/// Probability below which a run contradicts the others, over all of its channels together.
const CONTRADICTS: f64 = 1e-3;

/// A measurement of a new run beside what the runs before it made probable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Expectation {
    /// Name of the run.
    pub run: String,
    /// Name of the channel, with its unit.
    pub channel: String,
    /// The measured value.
    pub measured: f64,
    /// Mean of a new measurement by the models and parameters before the run.
    pub expected: f64,
    /// Probability of a measurement at least as far out on either side.
    pub probability: f64,
    /// Whether the probability is so small that the run contradicts all others: its sensor, preparation or condition may be wrong.
    pub contradicts: bool,
}

/// Compares the measurements of new runs with their predictive distribution, a mixture of normal densities over the draws of all models.
///
/// # Returns
/// The tail probability `2 min(F, 1 - F)` of each measured channel of each run whose noise is known, `F = sum w Phi((y - m) / s)`. A run
/// contradicts the others where it is below 0.001 over the number of its channels.
/// Checked by `tests::a_measurement_far_out_contradicts`.
pub fn expectations(simulated: &Simulated, measured: &[PlannedRun]) -> Vec<Expectation> {
    let models = simulated.models.iter();
    let models: Vec<(f64, NewMeasurements<'_>)> = models
        .map(|model| (model.weight, NewMeasurements::new(&model.calibration)))
        .collect();
    let mut all = Vec::new();
    for (number, run) in measured.iter().enumerate() {
        let channels = run.run.measured.iter().flatten().count();
        for channel in Channel::ALL {
            let Some(value) = run.run.measured[channel.index()] else {
                continue;
            };
            let mut parts = Vec::new();
            for (weight, new) in &models {
                for measurement in new.at(simulated.first + number, channel) {
                    let components = measurement.components.iter();
                    parts.extend(components.map(|c| (weight * c.weight, c.mean, c.scale)));
                }
            }
            let known: Option<Vec<(f64, f64, f64)>> = parts
                .into_iter()
                .map(|(weight, mean, scale)| Some((weight, mean, scale?)))
                .collect();
            let Some((expected, probability)) = known.as_deref().and_then(|parts| tail(parts, value)) else {
                continue;
            };
            all.push(Expectation {
                run: run.run.name.clone(),
                channel: channel.column().to_owned(),
                measured: value,
                expected,
                probability,
                contradicts: probability < CONTRADICTS / channels as f64,
            });
        }
    }
    all
}

/// Returns mean and two-sided tail probability of a mixture of normal densities: weights, means, standard deviations.
fn tail(parts: &[(f64, f64, f64)], value: f64) -> Option<(f64, f64)> {
    let total: f64 = parts.iter().map(|(weight, ..)| weight).sum();
    if total <= 0.0 {
        return None;
    }
    let mean = parts.iter().map(|(weight, mean, _)| weight * mean).sum::<f64>() / total;
    let side = |sign: f64| {
        let parts = parts.iter();
        let sum: f64 = parts
            .map(|(weight, mean, sd)| {
                weight * 0.5 * libm::erfc(sign * (value - mean) / (sd * std::f64::consts::SQRT_2))
            })
            .sum();
        sum / total
    };
    Some((mean, (2.0 * side(1.0).min(side(-1.0))).min(1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_measurement_far_out_contradicts() {
        let parts = [(0.5, 0.0, 1.0), (0.5, 0.0, 1.0)];
        let probability = |value: f64| tail(&parts, value).unwrap().1;
        assert!((probability(0.0) - 1.0).abs() < 1e-12);
        assert!((probability(1.959_964) - 0.05).abs() < 1e-6);
        assert!((probability(-1.959_964) - 0.05).abs() < 1e-6);
        assert!(probability(4.0) < CONTRADICTS);
        // Between two models that disagree, a value of the less probable one is no contradiction.
        let parts = [(0.9, 0.0, 1.0), (0.1, 10.0, 1.0)];
        assert!(tail(&parts, 10.0).unwrap().1 > 0.05);
        assert_eq!(tail(&[], 1.0), None);
    }
}
