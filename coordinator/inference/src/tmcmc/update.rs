//! The posterior after more data: draws weighted anew and, where few remain effective, stages of draws from a mixture fitted to them.
//!
//! With the draws of p(theta | old) each has the weight `L(theta; all) / L(theta; old)`, whose mean is the ratio of the evidences. Where
//! the effective share of the weights is small, a mixture is fitted to the weighted draws, tempered so that enough of them count, and new
//! draws of it are weighted by `L(theta; all) p(theta) / q(theta)`, whose mean is the evidence.
//!
//! # Source
//! Chopin 2002, Biometrika 89:539, doi:10.1093/biomet/89.3.539 (reweighting by batches of data); Cappé et al. 2004, J. Comput. Graph. Stat.
//! 13:907, doi:10.1198/106186004X12803.

use statistics::log_likelihood::LogLikelihood;
use statistics::prior::Prior;

use super::draws::{DrawKey, DrawProposal, Fit, ImportanceWeights, WeightedSample};
use super::particle::Particle;
use super::pool::ChainState;

/// Least effective share of draws that are weighted anew, and of draws from a mixture.
const MIN_SHARE: f64 = 0.2;
/// Least number of effective draws that a mixture is fitted to; weights are tempered until they have it.
const MIN_FITTED: f64 = 100.0;
/// Number of mixtures after which the update has failed.
const MAX_STAGES: usize = 8;
/// Largest number of components of a mixture.
const COMPONENTS: usize = 8;
/// The first stage of the random streams, which no sampler uses.
const FIRST_STAGE: usize = 1 << 20;

/// How an updated posterior was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UpdateMethod {
    /// The draws were weighted anew.
    Reweighted,
    /// New draws come from a mixture, after this number of mixtures.
    Drawn(usize),
}

/// The posterior after more data.
#[derive(Debug, Clone)]
pub struct UpdatedPosterior {
    /// The draws, with the log-likelihood of all data.
    pub draws: Vec<Particle>,
    /// Their weights, which sum to one.
    pub weights: Vec<f64>,
    /// Number of independent draws that they are worth.
    pub ess: f64,
    /// Log-evidence of all data.
    pub log_evidence: f64,
    /// How the draws were found.
    pub method: UpdateMethod,
}

/// An update in progress, which is told the log-likelihoods of all data at the parameter vectors that it asks for.
#[derive(Debug)]
pub struct PosteriorUpdate {
    prior: Prior,
    seed: u64,
    asked: Vec<Vec<f64>>,
    coordinates: Vec<Vec<f64>>,
    log_ratios: Vec<f64>,
    /// The evidence of the data so far; `None` once the draws are those of a mixture.
    old_log_evidence: Option<f64>,
    stages: usize,
}

/// What follows when an update is told.
#[derive(Debug)]
pub enum UpdateProgress {
    /// It asks for more parameter vectors.
    Asks(PosteriorUpdate),
    /// It has ended.
    Updated(UpdatedPosterior),
    /// Too few draws count: the posterior must be calibrated again.
    Failed,
}

impl PosteriorUpdate {
    /// Begins with equally weighted draws of the posterior so far.
    ///
    /// # Arguments
    /// - `draws`: with the log-likelihoods of the data so far. `log_evidence`: of the same data.
    pub fn new(prior: Prior, draws: &[Particle], log_evidence: f64, seed: u64) -> Self {
        let possible = draws.iter().filter(|draw| !draw.log_likelihood.is_impossible());
        let (mut asked, mut log_ratios) = (Vec::new(), Vec::new());
        for draw in possible {
            asked.push(draw.theta.clone());
            log_ratios.push(-draw.log_likelihood.value());
        }
        PosteriorUpdate {
            coordinates: asked.iter().map(|theta| prior.coordinates(theta)).collect(),
            prior,
            seed,
            asked,
            log_ratios,
            old_log_evidence: Some(log_evidence),
            stages: 0,
        }
    }

    /// Returns the parameter vectors whose log-likelihood of all data is asked for.
    pub fn asked(&self) -> &[Vec<f64>] {
        &self.asked
    }

    /// Takes the log-likelihoods in the order of [`PosteriorUpdate::asked`].
    ///
    /// Checked by `tests::an_update_is_the_posterior_of_all_data`.
    pub fn tell(self, log_likelihoods: &[LogLikelihood]) -> UpdateProgress {
        let mut sample = WeightedSample::default();
        let rows = self.coordinates.iter().zip(&self.log_ratios).zip(log_likelihoods);
        for ((coordinates, log_ratio), log_likelihood) in rows {
            let state = ChainState {
                coordinates: coordinates.clone(),
                log_prior: self.prior.log_density_of_coordinates(coordinates),
                log_likelihood: *log_likelihood,
            };
            sample.push(state, *log_ratio);
        }
        let Some(weights) = sample.weights(1.0) else {
            return UpdateProgress::Failed;
        };
        if weights.share() >= MIN_SHARE {
            return UpdateProgress::Updated(self.updated(&sample, weights));
        }
        let next = (self.stages < MAX_STAGES)
            .then(|| self.next(&sample, &weights))
            .flatten();
        next.map_or(UpdateProgress::Failed, UpdateProgress::Asks)
    }

    fn updated(&self, sample: &WeightedSample, weights: ImportanceWeights) -> UpdatedPosterior {
        UpdatedPosterior {
            draws: sample
                .states
                .iter()
                .map(|state| Particle::new(state, &self.prior))
                .collect(),
            ess: weights.ess,
            log_evidence: self.old_log_evidence.unwrap_or(0.0) + weights.log_mean,
            weights: weights.normalised,
            method: match self.stages {
                0 => UpdateMethod::Reweighted,
                stages => UpdateMethod::Drawn(stages),
            },
        }
    }

    /// Draws from a mixture that is fitted to the weighted draws.
    fn next(&self, sample: &WeightedSample, weights: &ImportanceWeights) -> Option<Self> {
        let log_weights = sample.log_weights(1.0);
        let count = log_weights.len();
        let possible = log_weights.iter().filter(|weight| weight.is_finite()).count();
        if possible < 2 * (self.prior.dimension() + 2) {
            return None;
        }
        // Even weights of all possible draws are twice as many effective ones, so that the search ends.
        let enough = MIN_FITTED.min(0.5 * possible as f64);
        let (mut fitted, mut power) = (weights.clone(), 1.0);
        while fitted.ess < enough {
            power *= 0.7;
            let tempered: Vec<f64> = log_weights.iter().map(|w| power * w).collect();
            fitted = ImportanceWeights::new(&tempered)?;
        }
        let stages = self.stages + 1;
        let key = DrawKey::new(self.seed, FIRST_STAGE + stages, 0);
        let fit = Fit::new(sample, &fitted, &self.prior, COMPONENTS, &mut key.fit())?;
        let mut proposal = DrawProposal::new((fit, None), &self.prior, key, count, true)?;
        let draws = proposal.draws(count, &self.prior);
        Some(PosteriorUpdate {
            prior: self.prior.clone(),
            seed: self.seed,
            asked: draws
                .iter()
                .map(|draw| self.prior.theta(&draw.coordinates))
                .collect(),
            log_ratios: draws.iter().map(|draw| draw.log_ratio).collect(),
            coordinates: draws.into_iter().map(|draw| draw.coordinates).collect(),
            old_log_evidence: None,
            stages,
        })
    }
}

#[cfg(test)]
mod tests {
    use statistics::rng::Stream;
    use statistics::{Distribution, Marginal};

    use super::*;

    const TAU: f64 = std::f64::consts::TAU;

    fn log_normal(x: f64, mean: f64, sd: f64) -> f64 {
        -0.5 * ((x - mean) / sd).powi(2) - 0.5 * libm::log(TAU) - libm::log(sd)
    }

    /// Two parameters with standard normal priors, each measured with an sd of 0.5 in the first data, and of `sd` in the second.
    fn updated(second: f64, sd: f64) -> UpdatedPosterior {
        let normal = Distribution::Normal { mean: 0.0, sd: 1.0 };
        let prior = Prior::new(vec![Marginal::new(normal, None).unwrap(); 2]);
        let old = |theta: &[f64]| theta.iter().map(|&x| log_normal(0.4, x, 0.5)).sum::<f64>();
        let all = |theta: &[f64]| old(theta) + theta.iter().map(|&x| log_normal(second, x, sd)).sum::<f64>();
        // The posterior of the first data is N(0.32, 0.2).
        let draws: Vec<Particle> = (0..2000)
            .map(|i| {
                let z = Stream::new(7, 0, i, 0).normals(2);
                let theta: Vec<f64> = z.iter().map(|z| 0.32 + 0.2_f64.sqrt() * z).collect();
                Particle {
                    log_likelihood: LogLikelihood::new(old(&theta)).unwrap(),
                    log_prior: prior.log_density(&theta),
                    theta,
                }
            })
            .collect();
        let log_evidence = 2.0 * log_normal(0.4, 0.0, 1.25_f64.sqrt());
        let mut update = PosteriorUpdate::new(prior, &draws, log_evidence, 3);
        loop {
            let told: Vec<LogLikelihood> = update
                .asked()
                .iter()
                .map(|theta| LogLikelihood::new(all(theta)).unwrap())
                .collect();
            match update.tell(&told) {
                UpdateProgress::Asks(next) => update = next,
                UpdateProgress::Updated(updated) => return updated,
                UpdateProgress::Failed => panic!("the update fails"),
            }
        }
    }

    #[test]
    fn an_update_is_the_posterior_of_all_data() {
        for (second, sd) in [(0.5, 0.6), (1.4, 0.1), (2.0, 0.1)] {
            let updated = updated(second, sd);
            let precision = 1.0 / 0.2 + 1.0 / (sd * sd);
            let (mean, deviation) = (
                (0.32 / 0.2 + second / (sd * sd)) / precision,
                precision.powf(-0.5),
            );
            // The evidence of the second data is their density by the posterior of the first.
            let evidence = 2.0 * log_normal(0.4, 0.0, 1.25_f64.sqrt())
                + 2.0 * log_normal(second, 0.32, (0.2 + sd * sd).sqrt());
            let error = 1.0 / updated.ess.sqrt();
            for parameter in 0..2 {
                let values = updated.draws.iter().zip(&updated.weights);
                let found: f64 = values.map(|(draw, weight)| weight * draw.theta[parameter]).sum();
                assert!(
                    (found - mean).abs() < 5.0 * error * deviation,
                    "{found} is not {mean}"
                );
            }
            assert!(
                (updated.log_evidence - evidence).abs() < 5.0 * error,
                "{updated:?}"
            );
            let is_far = sd < 0.5;
            assert_eq!(
                updated.method == UpdateMethod::Reweighted,
                !is_far,
                "{:?}",
                updated.method
            );
        }
    }

    #[test]
    fn an_update_ends_where_the_model_rejects_most_draws() {
        let normal = Distribution::Normal { mean: 0.0, sd: 1.0 };
        let prior = Prior::new(vec![Marginal::new(normal, None).unwrap(); 2]);
        let draws: Vec<Particle> = (0..2000)
            .map(|i| {
                let theta = Stream::new(7, 0, i, 0).normals(2);
                Particle {
                    log_likelihood: LogLikelihood::new(0.0).unwrap(),
                    log_prior: prior.log_density(&theta),
                    theta,
                }
            })
            .collect();
        // With this many draws that the model accepts, the update goes on or fails.
        for (accepted, goes_on) in [(60, true), (5, false), (0, false)] {
            let update = PosteriorUpdate::new(prior.clone(), &draws, 0.0, 3);
            let told: Vec<LogLikelihood> = (0..2000)
                .map(|i| {
                    if i < accepted {
                        LogLikelihood::new(-(i as f64)).unwrap()
                    } else {
                        LogLikelihood::Impossible
                    }
                })
                .collect();
            let progress = update.tell(&told);
            assert_eq!(
                matches!(progress, UpdateProgress::Asks(_)),
                goes_on,
                "{accepted} of 2000"
            );
        }
    }
}
