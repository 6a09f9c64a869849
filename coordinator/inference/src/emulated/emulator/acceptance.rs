//! The probability that the model accepts parameters, from the training points that it accepted and rejected.

use super::kriging::square_distance;

/// Widths of the kernel that are compared, in sds of the target.
const WIDTHS: [f64; 5] = [0.2, 0.4, 0.8, 1.6, 3.2];

/// Weight of the prior opinion that a point is accepted.
const PRIOR_WEIGHT: f64 = 0.05;

/// Probability below which none is stated: a boundary may lie elsewhere than the points say.
const MIN_PROBABILITY: f64 = 1e-3;

/// A kernel estimate of the probability that the model accepts a point.
#[derive(Debug, Clone)]
pub(crate) struct Acceptance {
    /// Whitened points, with whether the model accepted them.
    points: Vec<(Vec<f64>, bool)>,
    width: f64,
}

impl Acceptance {
    /// Makes the estimate whose width predicts each point best from all other points; `None` where every point was accepted.
    pub(crate) fn new(points: Vec<(Vec<f64>, bool)>) -> Option<Self> {
        if points.iter().all(|(_, accepted)| *accepted) {
            return None;
        }
        let mut estimate = Self { points, width: 1.0 };
        let score = |estimate: &Self| {
            let predict = |(i, (u, accepted)): (usize, &(Vec<f64>, bool))| {
                let probability = estimate.probability_without(u, Some(i));
                libm::log(if *accepted { probability } else { 1.0 - probability })
            };
            estimate.points.iter().enumerate().map(predict).sum::<f64>()
        };
        let mut best = (f64::NEG_INFINITY, 1.0);
        for width in WIDTHS {
            estimate.width = width;
            let score = score(&estimate);
            if score > best.0 {
                best = (score, width);
            }
        }
        estimate.width = best.1;
        Some(estimate)
    }

    /// Returns the probability that the model accepts a whitened point.
    pub(crate) fn probability(&self, u: &[f64]) -> f64 {
        self.probability_without(u, None)
    }

    fn probability_without(&self, u: &[f64], left_out: Option<usize>) -> f64 {
        let scale = -0.5 / (self.width * self.width);
        let (mut accepted, mut all) = (PRIOR_WEIGHT, PRIOR_WEIGHT);
        for (i, (point, was_accepted)) in self.points.iter().enumerate() {
            if Some(i) != left_out {
                let weight = libm::exp(scale * square_distance(point, u));
                all += weight;
                accepted += if *was_accepted { weight } else { 0.0 };
            }
        }
        (accepted / all).clamp(MIN_PROBABILITY, 1.0 - MIN_PROBABILITY)
    }
}
