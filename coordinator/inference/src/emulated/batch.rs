//! A batch of evaluations: draws of the emulated target, and vectors where mass may have been missed.

use statistics::rng::Stream;

use super::emulator::Emulator;
use super::sample::EmulatedSample;
use super::target::EmulatedTarget;

/// Share of a batch that explores, and the share where more than a few draws of the stage before are doubtful.
const EXPLORED: f64 = 0.17;
const EXPLORED_MORE: f64 = 0.5;
const MUCH_DOUBT: f64 = 0.02;

/// Number of the random stream of a batch.
const BATCH_STEP: u64 = (1 << 40) + 2;

/// A vector of a batch, with what the emulator predicts there.
#[derive(Debug, Clone)]
pub(super) struct BatchPoint {
    pub(super) theta: Vec<f64>,
    pub(super) log_likelihood: f64,
    /// ln of the tempered likelihood by which the target holds it.
    pub(super) value: f64,
    pub(super) outputs: Vec<f64>,
}

/// A batch that awaits its evaluation.
#[derive(Debug, Clone)]
pub(super) struct Batch {
    /// The vectors: draws of the target, then explored ones.
    pub(super) points: Vec<BatchPoint>,
    /// Number of draws of the target.
    pub(super) drawn: usize,
    /// Median of the tempered log-likelihood over the sample of the target.
    pub(super) median: f64,
    /// Share of the draws of the stage before that may belong to the target, although the emulator is not trusted there.
    pub(super) doubt: f64,
    pub(super) emulator: Box<Emulator>,
}

impl Batch {
    /// Selects a batch: draws of the sample of the target, and draws of the stage before at which the emulator is not trusted
    /// but an optimistic likelihood would belong to the target.
    pub(super) fn new(
        target: &EmulatedTarget,
        exponent: f64,
        (sample, wide): (&EmulatedSample, &EmulatedSample),
        (size, seed): (usize, u64),
    ) -> Self {
        let mut stream = Stream::new(seed, 0, 0, BATCH_STEP);
        let size = size.min(sample.particles.len());
        let mut values: Vec<f64> = sample
            .particles
            .iter()
            .map(|particle| exponent * particle.log_likelihood.value())
            .collect();
        values.sort_by(f64::total_cmp);
        let median = values[values.len() / 2];
        let doubtful: Vec<&[f64]> = wide
            .thetas()
            .into_iter()
            .filter(|theta| {
                let score = target.score(theta);
                !score.is_trusted(exponent) && score.optimistic(exponent) > median
            })
            .collect();
        let doubt = doubtful.len() as f64 / wide.particles.len() as f64;
        let share = if doubt > MUCH_DOUBT {
            EXPLORED_MORE
        } else {
            EXPLORED
        };
        let explored = selected(&doubtful, (share * size as f64) as usize, &mut stream);
        let drawn = selected(&sample.thetas(), size - explored.len(), &mut stream);
        let points = drawn.iter().chain(&explored).map(|theta| {
            let score = target.score(theta);
            BatchPoint {
                theta: theta.to_vec(),
                log_likelihood: score.log_likelihood,
                value: score.value(exponent),
                outputs: target.emulator.predict(target.prior, theta).outputs,
            }
        });
        Self {
            points: points.collect(),
            drawn: drawn.len(),
            median,
            doubt,
            emulator: Box::new(target.emulator.clone()),
        }
    }

    /// Returns the parameter vectors.
    pub(super) fn thetas(&self) -> Vec<Vec<f64>> {
        self.points.iter().map(|point| point.theta.clone()).collect()
    }
}

/// Selects vectors at random, each once; all, if there are not enough.
fn selected<'a>(thetas: &[&'a [f64]], count: usize, stream: &mut Stream) -> Vec<&'a [f64]> {
    let mut order = thetas.to_vec();
    let count = count.min(order.len());
    for i in 0..count {
        let chosen = i + stream.below(order.len() - i);
        order.swap(i, chosen);
    }
    order.truncate(count);
    order
}
