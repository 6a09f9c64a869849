//! The parameter vectors simulated after a sampler or a fit has ended.

use std::collections::BTreeSet;

use inference::Particle;

/// What is simulated once the posterior, or the estimate, is known.
#[derive(Debug)]
pub(super) struct FinalDraws {
    /// To simulate on fitted and holdout runs.
    pub(super) thetas: Vec<Vec<f64>>,
    /// The one of the highest likelihood, if it is simulated once more.
    pub(super) likeliest: Option<Vec<f64>>,
    /// The draws at which the model refuses one of several holdout runs.
    pub(super) refused: BTreeSet<usize>,
    /// Whether all are simulated, so that the holdout runs of these are asked for one by one.
    pub(super) apart: bool,
}

impl FinalDraws {
    pub(super) fn new(thetas: Vec<Vec<f64>>, likeliest: Option<Vec<f64>>) -> Self {
        FinalDraws {
            thetas,
            likeliest,
            refused: BTreeSet::new(),
            apart: false,
        }
    }
}

/// The draws that are simulated on every run: the most probable parameters, by default the particle's, then evenly spaced
/// draws; beside, the likeliest.
pub(super) fn final_draws(particles: &[Particle], mode: Option<&[f64]>) -> FinalDraws {
    let highest = |score: &dyn Fn(usize) -> f64| {
        (0..particles.len()).reduce(|a, b| if score(b) > score(a) { b } else { a })
    };
    let log_likelihood = |i: usize| particles[i].log_likelihood.value();
    let likeliest = highest(&log_likelihood);
    let spread = job::PREDICTION_DRAWS - 1;
    let count = particles.len().min(spread);
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
