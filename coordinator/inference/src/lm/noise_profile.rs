//! The most probable sds of noise and of common errors at given predicted values.

use super::noise::{InferredNoise, Profiled};
use statistics::likelihood::{ErrorSd, Likelihood};
use statistics::prior::{LN_SQRT_TAU, Prior};

/// Normal scores between which an sd without a closed form is searched.
const FARTHEST_SCORE: f64 = 4.0;
/// Distance from an end of the searched interval of scores within which a score counts as lying at the end.
const AT_END: f64 = 0.01;
/// Number of golden sections of the searched interval of scores, down to a width of 2e-4.
const SECTIONS: u32 = 22;
/// Maximum number of passes over the sds.
const PASSES: u32 = 6;
/// Change of every score in a pass below which the passes end.
const MIN_SCORE_CHANGE: f64 = 1e-3;
/// Half the width of the second difference along a score.
const DIFFERENCE: f64 = 1e-2;
const GOLDEN: f64 = 0.618_033_988_749_894_8;

/// The inferred sds of a likelihood.
#[derive(Debug, Clone)]
pub(super) enum NoiseProfile {
    /// Noise sds of independent normal errors: each is the solution of a one-dimensional problem.
    Separate(Vec<InferredNoise>),
    /// Sds and correlation lengths that depend on each other: with common errors or heavy tails. Their indices in theta.
    Entangled(Vec<usize>),
}

impl NoiseProfile {
    pub(super) fn new(prior: &Prior, likelihood: &Likelihood) -> Self {
        match likelihood.entangles_unknown_sds() {
            false => Self::Separate(InferredNoise::all(prior, likelihood)),
            true => Self::Entangled(inferred_sds(likelihood)),
        }
    }

    /// Returns the indices of the sds in theta.
    pub(super) fn parameters(&self) -> Vec<usize> {
        match self {
            Self::Separate(noises) => noises.iter().map(|noise| noise.parameter).collect(),
            Self::Entangled(parameters) => parameters.clone(),
        }
    }

    /// Returns the most probable sds at predicted values; those of theta are ignored.
    ///
    /// Entangled sds maximise the density of their normal scores, one after the other by golden sections. The most probable value
    /// of an sd of which the data show nothing is 0, where the density has no curvature; the density of its score has an inner
    /// mode.
    pub(super) fn profile(
        &self,
        prior: &Prior,
        likelihood: &Likelihood,
        theta: &[f64],
        predicted: &[f64],
    ) -> Vec<Profiled> {
        match self {
            Self::Separate(noises) => {
                let data = likelihood.data().iter().zip(predicted);
                let residuals: Vec<f64> = data.map(|(datum, value)| datum.value - value).collect();
                noises.iter().map(|noise| noise.profile(&residuals)).collect()
            }
            Self::Entangled(parameters) => entangled(parameters, prior, likelihood, theta, predicted),
        }
    }

    /// Returns the gain of the log-density when scores replace entangled sds; 0 for separate ones.
    pub(super) fn change_of_measure(&self, prior: &Prior, theta: &[f64]) -> f64 {
        match self {
            Self::Separate(_) => 0.0,
            Self::Entangled(parameters) => {
                let gain = |&k: &usize| {
                    let marginal = &prior.marginals()[k];
                    let score = marginal.normal_score(theta[k]);
                    -0.5 * score * score - LN_SQRT_TAU - marginal.log_density(theta[k])
                };
                parameters.iter().map(gain).sum()
            }
        }
    }
}

/// Returns every inferred sd, of noise and of common errors, and every inferred correlation length, by ascending parameter.
fn inferred_sds(likelihood: &Likelihood) -> Vec<usize> {
    let common = likelihood.common().iter();
    let common_sds = common.flat_map(|error| error.size.hyperparameters());
    let data_sds = likelihood.data().iter().map(|datum| datum.sd);
    let mut parameters: Vec<usize> = data_sds
        .chain(common_sds)
        .filter_map(ErrorSd::parameter)
        .collect();
    parameters.sort_unstable();
    parameters.dedup();
    parameters
}

/// Maximises the density over the scores of entangled sds.
fn entangled(
    parameters: &[usize],
    prior: &Prior,
    likelihood: &Likelihood,
    theta: &[f64],
    predicted: &[f64],
) -> Vec<Profiled> {
    let marginal = |i: usize| &prior.marginals()[parameters[i]];
    let density = |scores: &[f64]| {
        let mut theta = theta.to_vec();
        for (i, score) in scores.iter().enumerate() {
            theta[parameters[i]] = marginal(i).from_normal_score(*score);
        }
        let squares: f64 = scores.iter().map(|score| score * score).sum();
        let scored = likelihood.log_likelihood(predicted, &theta);
        scored.map_or(f64::NEG_INFINITY, |l| l.value()) - 0.5 * squares
    };
    let along = |scores: &[f64], i: usize, score: f64| {
        let mut moved = scores.to_vec();
        moved[i] = score;
        density(&moved)
    };
    let mut scores = vec![0.0; parameters.len()];
    for _ in 0..PASSES {
        let before = scores.clone();
        for i in 0..scores.len() {
            scores[i] = golden_maximum(|score| along(&scores, i, score));
        }
        if scores
            .iter()
            .zip(&before)
            .all(|(a, b)| (a - b).abs() < MIN_SCORE_CHANGE)
        {
            break;
        }
    }
    let middle = density(&scores);
    (0..scores.len())
        .map(|i| {
            let value = |score| marginal(i).from_normal_score(score);
            let (low, high) = (scores[i] - DIFFERENCE, scores[i] + DIFFERENCE);
            let bend = 2.0 * middle - along(&scores, i, low) - along(&scores, i, high);
            let curvature = bend / (DIFFERENCE * DIFFERENCE);
            let rate = (value(high) - value(low)) / (2.0 * DIFFERENCE);
            let at_bound = scores[i].abs() > FARTHEST_SCORE - AT_END;
            Profiled {
                sd: value(scores[i]),
                at_bound,
                uncertainty: (!at_bound && curvature > 0.0).then(|| rate / curvature.sqrt()),
            }
        })
        .collect()
}

/// Finds the score of the highest density by golden sections; the density has one maximum.
fn golden_maximum(density: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (-FARTHEST_SCORE, FARTHEST_SCORE);
    let inner = |low: f64, high: f64| [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let [mut a, mut b] = inner(low, high);
    let (mut at_a, mut at_b) = (density(a), density(b));
    for _ in 0..SECTIONS {
        if at_a < at_b {
            low = a;
            (a, at_a) = (b, at_b);
            b = inner(low, high)[1];
            at_b = density(b);
        } else {
            high = b;
            (b, at_b) = (a, at_a);
            a = inner(low, high)[0];
            at_a = density(a);
        }
    }
    0.5 * (low + high)
}
