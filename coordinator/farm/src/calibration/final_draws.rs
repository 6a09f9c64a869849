//! The final draws: parameter vectors that are simulated after a sampler or a fit has ended.

use std::collections::BTreeSet;

use inference::point_estimate::ModeEstimate;
use inference::{Particle, PosteriorSample};
use record::EvaluationKey;

/// The parameter vectors that are simulated once the posterior or the estimate is known.
#[derive(Debug)]
pub(super) struct FinalDraws {
    /// The vectors to simulate on fitted and holdout runs.
    pub(super) thetas: Vec<Vec<f64>>,
    /// The vector of the highest likelihood, if it is simulated once more.
    pub(super) likeliest: Option<Vec<f64>>,
    /// The draws at which the model rejects one of several holdout runs.
    pub(super) refused: BTreeSet<usize>,
}

impl FinalDraws {
    fn new(thetas: Vec<Vec<f64>>, likeliest: Option<Vec<f64>>) -> Self {
        FinalDraws {
            thetas,
            likeliest,
            refused: BTreeSet::new(),
        }
    }

    /// Takes final draws from a posterior.
    pub(super) fn from_posterior(posterior: &PosteriorSample) -> Self {
        spread(&posterior.particles, None)
    }

    /// Takes final draws from an estimate's normal approximation; without one, the estimate is the only draw.
    ///
    /// # Arguments
    /// - `has_histories`: whether the model has a time axis, so that the estimate is simulated once more.
    pub(super) fn from_estimate(estimate: &ModeEstimate, has_histories: bool) -> Self {
        match &estimate.approximation {
            Some(approximation) => spread(&approximation.draws, Some(&estimate.theta)),
            None => FinalDraws::new(
                vec![estimate.theta.clone()],
                has_histories.then(|| estimate.theta.clone()),
            ),
        }
    }

    /// Returns the evaluations of all draws.
    pub(super) fn keys(&self, has_holdout: bool) -> Vec<EvaluationKey> {
        let parts = if has_holdout {
            [false, true].as_slice()
        } else {
            &[false]
        };
        let draws = (0..self.thetas.len()).flat_map(|draw| {
            let key = move |&holdout| EvaluationKey::Prediction { draw, holdout };
            parts.iter().map(key)
        });
        draws
            .chain(self.likeliest.iter().map(|_| EvaluationKey::Likeliest))
            .collect()
    }

    /// Returns the evaluations of `runs` holdout runs, one by one, at the draws at which the model rejects them together.
    pub(super) fn keys_of_refused(&self, runs: usize) -> Vec<EvaluationKey> {
        let key = |&draw: &usize| (0..runs).map(move |run| EvaluationKey::HoldoutRun { draw, run });
        self.refused.iter().flat_map(key).collect()
    }
}

/// Selects the draws that are simulated on every run: the most probable parameters (by default those of the most probable particle), then
/// evenly spaced draws; and the likeliest draw once more.
fn spread(particles: &[Particle], mode: Option<&[f64]>) -> FinalDraws {
    let highest = |score: &dyn Fn(usize) -> f64| {
        (0..particles.len()).reduce(|a, b| if score(b) > score(a) { b } else { a })
    };
    let log_likelihood = |i: usize| particles[i].log_likelihood.value();
    let likeliest = highest(&log_likelihood);
    let count = particles.len().min(job::PREDICTION_DRAWS - 1);
    let even = (0..count).map(|k| k * particles.len() / count);
    let theta = |i: usize| particles[i].theta.clone();
    let best = mode.map(<[f64]>::to_vec).or_else(|| {
        let best = highest(&|i| log_likelihood(i) + particles[i].log_prior);
        best.map(theta)
    });
    FinalDraws::new(
        best.into_iter().chain(even.map(theta)).collect(),
        likeliest.map(theta),
    )
}
