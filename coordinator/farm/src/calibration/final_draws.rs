//! The final draws: parameter vectors that are simulated after a sampler or a fit has ended.

use std::collections::{BTreeMap, BTreeSet};

use inference::point_estimate::ModeEstimate;
use inference::{Particle, PosteriorSample};
use record::{EvaluationKey, EvaluationRow};

/// The parameter vectors that are simulated once the posterior or the estimate is known.
#[derive(Debug)]
pub(super) struct FinalDraws {
    /// The vectors to simulate on fitted and holdout runs.
    pub(super) thetas: Vec<Vec<f64>>,
    /// The vector of the highest likelihood, if it is simulated once more.
    pub(super) likeliest: Option<Vec<f64>>,
    /// The draws whose fitted runs were simulated while sampling.
    pub(super) simulated: BTreeSet<usize>,
    /// The draws at which the model rejects one of several holdout runs.
    pub(super) refused: BTreeSet<usize>,
}

impl FinalDraws {
    fn new(thetas: Vec<Vec<f64>>, likeliest: Option<Vec<f64>>) -> Self {
        FinalDraws {
            thetas,
            likeliest,
            simulated: BTreeSet::new(),
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

    /// Takes over the fitted runs of the draws that were simulated while sampling. Returns a row for each of them.
    ///
    /// # Arguments
    /// - `drawn`: the whole results of the sampler's last round. `width`: of the sampler's rounds.
    pub(super) fn take_over(
        &mut self,
        drawn: &BTreeMap<u64, EvaluationRow>,
        width: usize,
    ) -> Vec<EvaluationRow> {
        let bits = |theta: &[f64]| -> Vec<u64> { theta.iter().map(|x| x.to_bits()).collect() };
        // Equal draws take the row that comes first.
        let rows: BTreeMap<Vec<u64>, &EvaluationRow> =
            drawn.values().rev().map(|row| (bits(&row.theta), row)).collect();
        let draws = self.thetas.iter().enumerate();
        let taken: Vec<(usize, EvaluationRow)> = draws
            .filter_map(|(draw, theta)| {
                let evaluation = EvaluationKey::Prediction { draw, holdout: false }.number(width);
                let row = EvaluationRow {
                    evaluation,
                    log_likelihood: None,
                    ..(*rows.get(&bits(theta))?).clone()
                };
                Some((draw, row))
            })
            .collect();
        self.simulated = taken.iter().map(|(draw, _)| *draw).collect();
        taken.into_iter().map(|(_, row)| row).collect()
    }

    /// Returns the evaluations of all draws that remain to be simulated.
    pub(super) fn keys(&self, has_holdout: bool) -> Vec<EvaluationKey> {
        let draws = (0..self.thetas.len()).flat_map(|draw| {
            let fitted = !self.simulated.contains(&draw);
            let parts = [(false, fitted), (true, has_holdout)];
            let asked = parts.into_iter().filter(|(_, is_asked)| *is_asked);
            asked.map(move |(holdout, _)| EvaluationKey::Prediction { draw, holdout })
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
