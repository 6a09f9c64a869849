//! The final draws: a sample of the emulated posterior and of wider densities, evaluated by the model and weighted.

use statistics::log_likelihood::LogLikelihood;

use super::emulator::Emulator;
use super::record::FinalWeights;
use super::round::{EmulatedRound, FinalBatch, Next, Outputs};
use super::sample::{EmulatedSample, PosteriorDraws, round_seed};
use super::sampler::EmulatedSampler;
use super::target::EmulatedTarget;
use crate::tmcmc::draws::{DrawKey, DrawProposal};
use crate::tmcmc::transition::systematic;
use crate::tmcmc::{Particle, PosteriorSample};

/// Numbers of the final draws: of the emulated posterior, of the mixture fitted to it, whose tails are heavier, and of the mixture
/// fitted to the stage before, which reaches mass that the emulator may have missed.
const DRAWS: [usize; 3] = [150, 20, 30];

/// Share of effective draws with which the final draws are the result.
const ENOUGH: f64 = 0.4;

/// Number of final samples after which one with a smaller share is the result, and the share that it must have.
const ATTEMPTS: usize = 4;
const MIN_SHARE: f64 = 0.2;

/// First number of the seeds of final samples.
const FIRST_SEED: u64 = 1 << 20;

/// The densities of the final draws.
struct FinalDensity<'a> {
    target: EmulatedTarget<'a>,
    drawn: &'a PosteriorDraws,
    wide: &'a DrawProposal,
}

impl FinalDensity<'_> {
    /// Returns ln (density / prior density) of all final draws together at a parameter vector, and the emulated posterior's density over
    /// it.
    fn at(&self, theta: &[f64], log_likelihood: f64, log_ratio: f64) -> (f64, f64) {
        let coordinates = self.target.prior.coordinates(theta);
        let parts = [
            log_likelihood - self.drawn.log_evidence,
            -log_ratio,
            self.wide.log_density_ratio(self.target.prior, &coordinates),
        ];
        let largest = parts.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let total: usize = DRAWS.iter().sum();
        let shares = DRAWS.iter().map(|&count| count as f64 / total as f64);
        let sum: f64 = shares
            .zip(parts)
            .map(|(share, part)| share * libm::exp(part - largest))
            .sum();
        let log_density = largest + libm::log(sum);
        (log_density, libm::exp(parts[0] - log_density))
    }
}

impl EmulatedSampler {
    /// Draws from the emulated posterior and asks for the evaluations.
    pub(super) fn ask_final(&mut self, emulator: &Emulator, sample: &EmulatedSample) -> Next {
        match self.final_batch(emulator, sample) {
            Some(batch) => {
                let thetas = batch.thetas.clone();
                Next::Ask(EmulatedRound::Final(Box::new(batch)), thetas)
            }
            None => Next::GiveUp,
        }
    }

    fn final_batch(&self, emulator: &Emulator, from: &EmulatedSample) -> Option<FinalBatch> {
        let number = FIRST_SEED + (self.record.rounds.len() + self.record.finals.len()) as u64;
        let seed = round_seed(self.settings.seed, number);
        let target = self.target(emulator);
        let sample = target.sample(1.0, from, seed).ok()?;
        let drawn = target.posterior_draws(&sample, &self.wide, seed)?;
        let mut wide = self.wide.proposal(&self.prior, DrawKey::new(seed, 0, 2))?;
        let density = FinalDensity {
            target,
            drawn: &drawn,
            wide: &wide.clone(),
        };
        let chosen = systematic(&drawn.weights, DRAWS[0], 0.5);
        let indices = chosen.into_iter().chain(0..DRAWS[1]);
        let (mut thetas, mut densities) = (Vec::new(), Vec::new());
        for i in indices {
            densities.push(density.at(&drawn.thetas[i], drawn.log_likelihoods[i], drawn.log_ratios[i]));
            thetas.push(drawn.thetas[i].clone());
        }
        for draw in wide.draws(DRAWS[2], &self.prior) {
            let theta = self.prior.theta(&draw.coordinates);
            let value = target.score(&theta).value(1.0);
            let ratio = -drawn.proposal.log_density_ratio(&self.prior, &draw.coordinates);
            densities.push(density.at(&theta, value, ratio));
            thetas.push(theta);
        }
        Some(FinalBatch {
            sample,
            thetas,
            densities,
            variance: drawn.log_evidence_variance,
        })
    }

    /// Weighs the final draws: they are the result, or they refine the emulator.
    pub(super) fn after_final(&mut self, batch: &FinalBatch, outputs: &[Outputs]) -> Next {
        let Some(emulator) = self.emulator(&batch.sample.thetas()) else {
            return Next::GiveUp;
        };
        let pairs = batch.thetas.iter().zip(outputs);
        let likelihoods: Vec<LogLikelihood> = pairs
            .map(|(theta, outputs)| self.judged(outputs, theta, &emulator))
            .collect();
        let Some(weights) = FinalWeighing::new(&likelihoods, &batch.densities) else {
            return Next::GiveUp;
        };
        self.record.finals.push(FinalWeights {
            draws: weights.normalised.len(),
            ess: weights.ess,
            max_share: weights.normalised.iter().copied().fold(0.0, f64::max),
        });
        let share = weights.ess / weights.normalised.len() as f64;
        if share < ENOUGH && self.record.finals.len() < ATTEMPTS {
            return self.ask_final(&emulator, &batch.sample);
        }
        if share < MIN_SHARE {
            return Next::GiveUp;
        }
        let chosen = systematic(&weights.normalised, batch.thetas.len(), 0.5);
        let particles = chosen.into_iter().map(|i| Particle {
            theta: batch.thetas[i].clone(),
            log_likelihood: likelihoods[i],
            log_prior: self.prior.log_density(&batch.thetas[i]),
        });
        let particles: Vec<Particle> = particles.collect();
        self.finish(particles, &weights, batch.variance)
    }

    fn finish(&mut self, particles: Vec<Particle>, weights: &FinalWeighing, variance: f64) -> Next {
        let draws = particles.len();
        let share = weights.ess / draws as f64;
        if let Some(stage) = self.emulated_stages.last_mut() {
            // The final draws replace the sample of the emulated posterior.
            let finals = self.record.finals.len();
            stage.acceptance = share;
            stage.steps += finals;
            stage.log_evidence_increment = weights.log_evidence - self.wide.log_evidence;
            stage.weight_cov = (1.0 / share - 1.0).max(0.0).sqrt();
            stage.ess = weights.ess;
            stage.evaluations += (finals * draws) as u64;
            stage.population.clone_from(&particles);
        }
        self.stages = std::mem::take(&mut self.emulated_stages);
        Next::Done(Box::new(PosteriorSample {
            particles,
            log_evidence: weights.log_evidence,
            log_evidence_se: (weights.variance + variance).sqrt(),
            drift_z: 0.0,
            weight_drift_z: 0.0,
            equilibrated: true,
            evaluations: self.count.evaluations as u64,
            rejected: self.count.rejected as u64,
        }))
    }
}

/// The weights of the final draws.
struct FinalWeighing {
    normalised: Vec<f64>,
    /// ln Z.
    log_evidence: f64,
    /// Variance of `log_evidence`.
    variance: f64,
    /// Effective sample size.
    ess: f64,
}

impl FinalWeighing {
    /// Weighs draws by `w = likelihood * prior density / density of the draws`; `None` if the model rejected all.
    ///
    /// The evidence is the ratio estimate `sum w / sum a`, where a is the emulated posterior's density over that of the draws, whose
    /// mean is 1: it is exact for a perfect emulator. Its variance is that of `w - Z a` within the draws of each density, whose numbers
    /// are fixed.
    ///
    /// # Source
    /// Cochran 1977, Sampling Techniques, chapter 6.
    fn new(likelihoods: &[LogLikelihood], densities: &[(f64, f64)]) -> Option<Self> {
        let pairs = likelihoods.iter().zip(densities);
        let logs: Vec<f64> = pairs.map(|(l, (density, _))| l.value() - density).collect();
        let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if !largest.is_finite() {
            return None;
        }
        let weights: Vec<f64> = logs.iter().map(|log| libm::exp(log - largest)).collect();
        let sum: f64 = weights.iter().sum();
        let ratio = sum / densities.iter().map(|(_, a)| a).sum::<f64>();
        let residuals: Vec<f64> = weights
            .iter()
            .zip(densities)
            .map(|(w, (_, a))| w - ratio * a)
            .collect();
        let (mut first, mut squares) = (0, 0.0);
        for count in DRAWS {
            let part = &residuals[first..first + count];
            let mean = part.iter().sum::<f64>() / count as f64;
            let deviations: f64 = part.iter().map(|w| (w - mean) * (w - mean)).sum();
            squares += deviations * count as f64 / (count as f64 - 1.0);
            first += count;
        }
        let normalised: Vec<f64> = weights.iter().map(|w| w / sum).collect();
        Some(Self {
            ess: 1.0 / normalised.iter().map(|w| w * w).sum::<f64>(),
            log_evidence: largest + libm::log(ratio),
            variance: squares / (sum * sum),
            normalised,
        })
    }
}
