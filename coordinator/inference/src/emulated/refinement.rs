//! The stages that lead to exponent 1: each is repeated with a better emulator until the emulator agrees with the model.

use super::batch::Batch;
use super::emulator::Emulator;
use super::round::{EmulatedRound, Next, Outputs, Position, Refinement};
use super::sample::{EmulatedSample, round_seed};
use super::sampler::EmulatedSampler;
use super::target::{EmulatedScore, EmulatedTarget};
use crate::tmcmc::StageRecord;

/// Effective share of the sample at the next exponent.
const SHARE: f64 = 0.2;

/// Largest mean sd of the emulated tempered log-likelihood at the next exponent, in nats.
const MAX_SD: f64 = 1.5;

/// Factor by which the exponent grows in spite of this: the emulator agreed at the last exponent, and its sds are upper estimates.
const MIN_GROWTH: f64 = 1.3;

/// Number of rounds at one exponent after which the scatter of the model is measured.
const ROUGH_ROUNDS: usize = 3;

/// Evaluations before exponent 1, for each parameter and two more, after which the emulator is given up.
const MAX_EVALUATIONS: usize = 100;

/// Number of bisections on the logarithm of the step, and the smallest step.
const BISECTIONS: usize = 40;
const MIN_STEP: f64 = 1e-12;

impl EmulatedSampler {
    /// Fits the first emulator to the design, and begins the first stage.
    pub(super) fn after_design(&mut self, thetas: &[&[f64]]) -> Next {
        match self.emulator(thetas) {
            Some(emulator) => self.next_stage(&emulator, 0.0),
            None => Next::GiveUp,
        }
    }

    /// Asks for the first batch of the next stage.
    fn next_stage(&self, emulator: &Emulator, from: f64) -> Next {
        let (exponent, share) = self.next_exponent(emulator, from);
        let position = Position {
            from,
            exponent,
            rounds: 0,
            evaluations: 0,
            share,
        };
        self.ask_batch(emulator, &self.wide, position)
    }

    /// Chooses an exponent above that of the last stage, from its sample.
    fn next_exponent(&self, emulator: &Emulator, from: f64) -> (f64, f64) {
        let target = self.target(emulator);
        let scores: Vec<EmulatedScore> = self
            .wide
            .thetas()
            .iter()
            .map(|theta| target.score(theta))
            .collect();
        next_exponent(&scores, from)
    }

    /// Returns the target that an emulator predicts.
    pub(super) fn target<'a>(&'a self, emulator: &'a Emulator) -> EmulatedTarget<'a> {
        EmulatedTarget {
            prior: &self.prior,
            likelihood: &self.likelihood,
            emulator,
        }
    }

    fn ask_batch(&self, emulator: &Emulator, from: &EmulatedSample, position: Position) -> Next {
        let seed = round_seed(self.settings.seed, self.record.rounds.len() as u64);
        let target = self.target(emulator);
        let Ok(sample) = target.sample(position.exponent, from, seed) else {
            return Next::GiveUp;
        };
        let samples = (&sample, &self.wide);
        let batch = Batch::new(&target, position.exponent, samples, (self.settings.batch, seed));
        let thetas = batch.thetas();
        let refinement = Refinement {
            position,
            sample,
            batch,
        };
        Next::Ask(EmulatedRound::Refinement(Box::new(refinement)), thetas)
    }

    /// Compares the emulator with the model at the batch: the exponent grows, or the stage is repeated with a better emulator.
    pub(super) fn after_refinement(&mut self, refinement: Refinement, outputs: &[Outputs]) -> Next {
        let Refinement {
            mut position,
            sample,
            batch,
        } = refinement;
        let Some(emulator) = self.emulator(&sample.thetas()) else {
            return Next::GiveUp;
        };
        let round = self.judge((&batch, outputs), position, &emulator);
        let agreed = round.agreed;
        position.rounds += 1;
        position.evaluations += outputs.len();
        self.record.rounds.push(round);
        let spent: usize = self.record.rounds.iter().map(|round| round.evaluations).sum();
        if spent > MAX_EVALUATIONS * (self.prior.dimension() + 2) {
            return Next::GiveUp;
        }
        if !agreed && position.rounds >= ROUGH_ROUNDS && !self.has_measured_scatter {
            return self.ask_scatter(position, sample);
        }
        if !agreed {
            return self.repeat_stage(position, &emulator, &sample);
        }
        self.emulated_stages.push(self.stage_record(position, &sample));
        if position.exponent >= 1.0 {
            return self.ask_final(&emulator, &sample);
        }
        self.wide = sample;
        self.next_stage(&emulator, position.exponent)
    }

    /// Repeats a stage with a better emulator, which may choose a lower exponent.
    pub(super) fn repeat_stage(
        &self,
        mut position: Position,
        emulator: &Emulator,
        sample: &EmulatedSample,
    ) -> Next {
        let (exponent, share) = self.next_exponent(emulator, position.from);
        if exponent < position.exponent {
            position.exponent = exponent;
            position.share = share;
        }
        self.ask_batch(emulator, sample, position)
    }

    fn stage_record(&self, position: Position, sample: &EmulatedSample) -> StageRecord {
        StageRecord {
            stage: self.emulated_stages.len() + 1,
            tempering_exponent: position.exponent,
            acceptance: position.share,
            drift_z: 0.0,
            weight_drift_z: 0.0,
            correlation: 0.0,
            steps: position.rounds,
            log_evidence_increment: sample.log_evidence - self.wide.log_evidence,
            weight_cov: (1.0 / position.share - 1.0).max(0.0).sqrt(),
            ess: position.share * sample.particles.len() as f64,
            scale: 0.0,
            evaluations: position.evaluations as u64,
            equilibrated: true,
            population: sample.particles.clone(),
        }
    }
}

/// Returns the largest exponent, at most 1, at which the weights of a sample at `from` leave a share of effective draws and the emulator
/// is sure enough, and the share.
fn next_exponent(scores: &[EmulatedScore], from: f64) -> (f64, f64) {
    let forecast = |exponent: f64| {
        // A sample of the prior knows neither rejections nor distrust.
        let term = |score: &EmulatedScore| {
            let before = if from > 0.0 { score.value(from) } else { 0.0 };
            score.value(exponent) - before
        };
        let largest = scores.iter().map(term).fold(f64::NEG_INFINITY, f64::max);
        let (mut sum, mut squares, mut sds) = (0.0, 0.0, 0.0);
        for score in scores {
            let weight = libm::exp(term(score) - largest);
            sum += weight;
            squares += weight * weight;
            sds += weight * exponent * score.sd;
        }
        (sum * sum / (squares * scores.len() as f64), sds / sum)
    };
    let is_reached = |exponent: f64| {
        let (share, sd) = forecast(exponent);
        share >= SHARE && (sd <= MAX_SD || exponent <= MIN_GROWTH * from)
    };
    if is_reached(1.0) {
        return (1.0, forecast(1.0).0);
    }
    let (mut low, mut high) = (libm::log(MIN_STEP), libm::log(1.0 - from));
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if is_reached(from + libm::exp(middle)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    let exponent = from + libm::exp(low);
    (exponent, forecast(exponent).0)
}
