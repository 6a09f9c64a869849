//! The judgement of an emulator by a batch of evaluations.

use super::batch::Batch;
use super::emulator::Emulator;
use super::record::EmulatorRound;
use super::round::{Outputs, Position};
use super::sampler::EmulatedSampler;
use crate::tmcmc::draws::ImportanceWeights;

/// Largest error of the tempered log-evidence with which the exponent grows, in nats.
const MAX_EVIDENCE_ERROR: f64 = 0.7;

/// Largest sd of the error of the tempered log-likelihood with which the exponent grows, and at exponent 1, in nats: the share of effective
/// draws must be that of a normal error with this sd.
const MAX_SD: f64 = 1.0;
const MAX_FINAL_SD: f64 = 0.1;

/// Factor of the largest sds for each round of a stage that was repeated, down to the last: a rough model never agrees closely, and
/// uneven weights of the final draws say so.
const RELAXED: f64 = 1.5;
const MAX_RELAXED: f64 = 8.0;

/// Largest share of rejected evaluations with which the exponent grows, in the first round and in a stage that was repeated often.
const MAX_REJECTED: f64 = 0.25;
const MAX_REJECTED_LATER: f64 = 0.6;

/// Share of the outputs' variance that an emulator must explain, unless its error is a small one in error sds.
const EXPLAINED: f64 = 0.5;
const SMALL_ERROR: f64 = 0.3;

/// Largest share of doubtful draws of the stage before with which the exponent grows, and at exponent 1.
const MAX_DOUBT: f64 = 0.1;
const MAX_FINAL_DOUBT: f64 = 0.02;

/// Nats below the median of a sample within which an explored vector would have belonged to it.
const BELONGS: f64 = 3.0;

/// Nats by which the target understates an explored vector that it missed.
const UNDERSTATED: f64 = 1.0;

/// The bounds of a batch with which the exponent grows.
struct Limits {
    /// Smallest share of effective draws, weighted by the tempered likelihoods over those that the emulator predicted.
    share: f64,
    /// Largest number of explored vectors that belong to the target.
    missed: usize,
    rejected: f64,
    doubt: f64,
}

impl Limits {
    fn new(position: Position) -> Self {
        let factor = libm::pow(RELAXED, position.rounds as f64).min(MAX_RELAXED);
        let (sd, missed, doubt) = if position.exponent < 1.0 {
            (MAX_SD, position.rounds / 2, MAX_DOUBT)
        } else {
            (
                MAX_FINAL_SD * factor,
                0,
                (MAX_FINAL_DOUBT * factor).min(MAX_DOUBT),
            )
        };
        Self {
            share: libm::exp(-sd * sd),
            missed,
            rejected: (MAX_REJECTED * factor).min(MAX_REJECTED_LATER),
            doubt,
        }
    }

    /// Returns whether the draws of a batch are effective, and their mean weight agrees with the emulated evidence.
    fn hold(&self, weights: &ImportanceWeights) -> bool {
        weights.share() > self.share && weights.log_mean.abs() < MAX_EVIDENCE_ERROR
    }
}

impl EmulatedSampler {
    /// Compares a batch with the emulator. The emulator agrees if the draws of the target are effective as weighted draws of the model's,
    /// and few of the explored vectors belong to the target, at exponent 1 none.
    ///
    /// # Arguments
    /// - `learnt`: the emulator that learnt the batch.
    pub(super) fn judge(
        &self,
        (batch, outputs): (&Batch, &[Outputs]),
        position: Position,
        learnt: &Emulator,
    ) -> EmulatorRound {
        let exponent = position.exponent;
        let value = |theta: &[f64], outputs: &Outputs| exponent * self.judged(outputs, theta, learnt).value();
        let drawn = batch.points.iter().zip(outputs).take(batch.drawn);
        let accepted = drawn.filter(|(_, outputs)| outputs.is_some());
        let errors: Vec<f64> = accepted
            .map(|(point, outputs)| value(&point.theta, outputs) - exponent * point.log_likelihood)
            .collect();
        let explored = batch.points.iter().zip(outputs).skip(batch.drawn);
        let missed = explored.filter(|(point, outputs)| {
            let value = value(&point.theta, outputs);
            value > batch.median - BELONGS && value > point.value + UNDERSTATED
        });
        let missed = missed.count();
        let rejected = (batch.drawn - errors.len()) as f64 / batch.drawn as f64;
        let moments = crate::diagnostics::mean_and_sd(&errors);
        let channel_errors = self.channel_errors(batch, outputs);
        let limits = Limits::new(position);
        let weights = ImportanceWeights::new(&errors);
        let is_close = weights.is_some_and(|weights| limits.hold(&weights))
            && batch.doubt <= limits.doubt
            && rejected <= limits.rejected;
        EmulatorRound {
            tempering_exponent: exponent,
            evaluations: outputs.len(),
            rejected: outputs.iter().filter(|outputs| outputs.is_none()).count(),
            missed,
            error: moments.map(|(mean, sd)| [mean, sd]),
            agreed: is_close
                && missed <= limits.missed
                && (self.is_rough || self.explains(batch, outputs, &channel_errors)),
            channel_errors,
            training_points: batch.emulator.points,
            coordinates: batch.emulator.kind,
            settings: batch.emulator.settings(),
            left_out_error: batch.emulator.left_out_error,
        }
    }

    /// Returns whether the emulator predicts the outputs better than their mean does, or with small errors: a function that the
    /// training points do not resolve may hide its modes from both.
    fn explains(&self, batch: &Batch, outputs: &[Outputs], channel_errors: &[f64]) -> bool {
        if channel_errors.iter().all(|error| *error < SMALL_ERROR) {
            return true;
        }
        let (mut residual, mut total) = (0.0, 0.0);
        for (index, datum) in self.likelihood.data().iter().enumerate() {
            let drawn = batch.points.iter().zip(outputs).take(batch.drawn);
            let pairs: Vec<[f64; 2]> = drawn
                .filter_map(|(point, outputs)| {
                    let unit = datum.sd.at(&point.theta);
                    Some([outputs.as_ref()?[index] / unit, point.outputs[index] / unit])
                })
                .collect();
            let mean = pairs.iter().map(|[y, _]| y).sum::<f64>() / pairs.len().max(1) as f64;
            residual += pairs
                .iter()
                .map(|[y, predicted]| (y - predicted) * (y - predicted))
                .sum::<f64>();
            total += pairs.iter().map(|[y, _]| (y - mean) * (y - mean)).sum::<f64>();
        }
        residual < (1.0 - EXPLAINED) * total
    }

    /// Returns the root mean square error of the outputs at the draws of the target by channel, in error sds.
    fn channel_errors(&self, batch: &Batch, outputs: &[Outputs]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0_usize); self.channels()];
        let drawn = batch.points.iter().zip(outputs).take(batch.drawn);
        for (point, outputs) in drawn {
            let values = outputs.iter().flatten().zip(&point.outputs);
            for (datum, (y, predicted)) in self.likelihood.data().iter().zip(values) {
                let error = (y - predicted) / datum.sd.at(&point.theta);
                let (sum, count) = &mut sums[datum.channel];
                *sum += error * error;
                *count += 1;
            }
        }
        sums.into_iter().map(root_mean).collect()
    }

    /// Returns the number of channels, by their indices.
    pub(super) fn channels(&self) -> usize {
        let channels = self.likelihood.data().iter().map(|datum| datum.channel + 1);
        channels.max().unwrap_or(0)
    }
}

/// Returns the root of a mean, from the sum and the number of squares.
pub(super) fn root_mean((sum, count): (f64, usize)) -> f64 {
    (sum / count.max(1) as f64).sqrt()
}
