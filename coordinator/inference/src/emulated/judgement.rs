//! The judgement of an emulator by a batch of evaluations.

use super::batch::Batch;
use super::emulator::Emulator;
use super::record::EmulatorRound;
use super::round::{Outputs, Position};
use super::sampler::EmulatedSampler;
use super::target::error_sd;

/// Largest sd and mean of the error of the tempered log-likelihood with which the exponent grows, in nats.
const MAX_SD: f64 = 0.5;
const MAX_MEAN: f64 = 0.7;

/// Largest sd of that error at exponent 1.
const MAX_FINAL_SD: f64 = 0.1;

/// Factor of the largest sds for each round of a stage that was repeated, down to the last: a rough model never agrees closely, and
/// uneven weights of the final draws say so.
const RELAXED: f64 = 1.3;
const MAX_RELAXED: f64 = 6.0;

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

/// The bounds of a batch with which the exponent grows.
struct Limits {
    sd: f64,
    rejected: f64,
}

impl Limits {
    fn new(position: Position) -> Self {
        let factor = libm::pow(RELAXED, position.rounds as f64).min(MAX_RELAXED);
        let (sd, largest) = if position.exponent < 1.0 {
            (MAX_SD, 1.0)
        } else {
            (MAX_FINAL_SD, MAX_RELAXED * MAX_FINAL_SD)
        };
        Self {
            sd: (sd * factor).min(largest),
            rejected: (MAX_REJECTED * factor).min(MAX_REJECTED_LATER),
        }
    }
}

impl EmulatedSampler {
    /// Compares a batch with the emulator. The emulator agrees if the tempered log-likelihoods at the draws of the target have small
    /// errors, and none of the explored vectors belongs to the target.
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
        let missed =
            explored.filter(|(point, outputs)| value(&point.theta, outputs) > batch.median - BELONGS);
        let missed = missed.count();
        let rejected = (batch.drawn - errors.len()) as f64 / batch.drawn as f64;
        let moments = crate::diagnostics::mean_and_sd(&errors);
        let [mean, sd] = moments.map_or([f64::INFINITY; 2], |(mean, sd)| [mean, sd]);
        let channel_errors = self.channel_errors(batch, outputs);
        let limits = Limits::new(position);
        let max_doubt = if exponent < 1.0 {
            MAX_DOUBT
        } else {
            MAX_FINAL_DOUBT
        };
        let is_close = batch.doubt <= max_doubt
            && sd < limits.sd
            && mean.abs() < MAX_MEAN
            && rejected <= limits.rejected;
        EmulatorRound {
            tempering_exponent: exponent,
            evaluations: outputs.len(),
            rejected: outputs.iter().filter(|outputs| outputs.is_none()).count(),
            missed,
            error: moments.map(|(mean, sd)| [mean, sd]),
            agreed: is_close
                && missed == 0
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
                    let unit = error_sd(datum.sd, &point.theta);
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
                let error = (y - predicted) / error_sd(datum.sd, &point.theta);
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
