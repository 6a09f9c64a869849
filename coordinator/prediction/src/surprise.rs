//! Runs that contradict what was expected of them.

use job::PlannedRun;
use result::NewMeasurements;
use serde::{Deserialize, Serialize};
use shared::channel::Channel;
use statistics::ErrorLaw;
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

/// A part of a predictive distribution: an error law about a mean.
struct Part {
    weight: f64,
    mean: f64,
    scale: f64,
    law: ErrorLaw,
}

/// Compares the measurements of new runs with their predictive distribution, a mixture of the error laws of the jobs over the draws of
/// all models.
///
/// # Returns
/// The tail probability `2 min(F, 1 - F)` of each measured channel of each run whose noise is known, `F = sum w G((y - m) / s)`, G the
/// normal or Student's t distribution of the errors. A run contradicts the others where it is below 0.001 over the number of its channels.
/// Checked by `tests::a_measurement_far_out_contradicts`.
pub fn expectations(simulated: &Simulated, measured: &[PlannedRun]) -> Vec<Expectation> {
    let models = simulated.models.iter();
    let models: Vec<(f64, ErrorLaw, NewMeasurements<'_>)> = models
        .map(|model| {
            let calibration = &model.calibration;
            let law = calibration.spec.likelihood.law();
            (model.weight, law, NewMeasurements::new(calibration))
        })
        .collect();
    let mut all = Vec::new();
    for (number, run) in measured.iter().enumerate() {
        let channels = run.run.measured.iter().flatten().count();
        for channel in Channel::ALL {
            let Some(value) = run.run.measured[channel.index()] else {
                continue;
            };
            let mut parts = Vec::new();
            for (weight, law, new) in &models {
                for measurement in new.at(simulated.first + number, channel) {
                    let components = measurement.components.iter();
                    parts.extend(components.map(|c| {
                        Some(Part {
                            weight: weight * c.weight,
                            mean: c.mean,
                            scale: c.scale?,
                            law: *law,
                        })
                    }));
                }
            }
            let known: Option<Vec<Part>> = parts.into_iter().collect();
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

/// Returns mean and two-sided tail probability of a mixture.
fn tail(parts: &[Part], value: f64) -> Option<(f64, f64)> {
    let total: f64 = parts.iter().map(|part| part.weight).sum();
    if total <= 0.0 {
        return None;
    }
    let mean = parts.iter().map(|part| part.weight * part.mean).sum::<f64>() / total;
    // The probability of a measurement farther along one direction.
    let side = |sign: f64| {
        let beyond = |part: &Part| part.weight * part.law.cumulative(sign * (part.mean - value) / part.scale);
        parts.iter().map(beyond).sum::<f64>() / total
    };
    Some((mean, (2.0 * side(1.0).min(side(-1.0))).min(1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(weight: f64, mean: f64, law: ErrorLaw) -> Part {
        Part {
            weight,
            mean,
            scale: 1.0,
            law,
        }
    }

    #[test]
    fn a_measurement_far_out_contradicts() {
        let normal = ErrorLaw::Gaussian;
        let parts = [part(0.5, 0.0, normal), part(0.5, 0.0, normal)];
        let probability = |value: f64| tail(&parts, value).unwrap().1;
        assert!((probability(0.0) - 1.0).abs() < 1e-12);
        assert!((probability(1.959_964) - 0.05).abs() < 1e-6);
        assert!((probability(-1.959_964) - 0.05).abs() < 1e-6);
        assert!(probability(4.0) < CONTRADICTS);
        // Between two models that disagree, a value of the less probable one is no contradiction.
        let parts = [part(0.9, 0.0, normal), part(0.1, 10.0, normal)];
        assert!(tail(&parts, 10.0).unwrap().1 > 0.05);
        assert_eq!(tail(&[], 1.0), None);
    }

    #[test]
    fn a_measurement_far_out_is_no_contradiction_under_heavy_tails() {
        let law = ErrorLaw::StudentT {
            degrees_of_freedom: 4.0,
        };
        let probability = tail(&[part(1.0, 0.0, law)], 4.0).unwrap().1;
        // By the closed form of the t with 4 degrees of freedom: 1 - u (3 - u^2) / 2 at u = 4 / sqrt(20).
        assert!((probability - 0.016_130).abs() < 1e-6, "{probability}");
        assert!(probability > CONTRADICTS);
    }
}
