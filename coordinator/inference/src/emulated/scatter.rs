//! The scatter of a rough model, which becomes part of the error model.
//!
//! A stage that is repeated without agreement may be one of a model whose outputs jump with its parameters. Evaluations at equal
//! distances on lines between draws of the target tell: their fourth differences hold the jumps alone.

use statistics::rng::Stream;

use super::round::{EmulatedRound, Next, Outputs, Position, ScatterLines};
use super::sample::EmulatedSample;
use super::sampler::EmulatedSampler;
use crate::numerical_noise::{self, POINTS};

/// Length of the line in distances of two draws: a smooth function has no fourth difference on it.
const LENGTH: f64 = 0.25;

/// Number of the random stream that selects the two draws.
const SCATTER_STEP: u64 = (1 << 40) + 3;

/// Number of lines: a kink of a smooth model may lie on one, and scatter lies on all.
const LINES: usize = 2;

/// Sd of the log-likelihood in nats below which scatter is not felt.
const UNFELT: f64 = 0.3;

impl EmulatedSampler {
    /// Asks for evaluations on lines between draws of the target.
    pub(super) fn ask_scatter(&self, position: Position, sample: EmulatedSample) -> Next {
        let round = self.record.rounds.len() as u64;
        let mut stream = Stream::new(self.settings.seed, round, 0, SCATTER_STEP);
        let lines = (0..LINES).flat_map(|_| self.line(&sample, &mut stream)).collect();
        let round = ScatterLines { position, sample };
        Next::Ask(EmulatedRound::Scatter(Box::new(round)), lines)
    }

    fn line(&self, sample: &EmulatedSample, stream: &mut Stream) -> Vec<Vec<f64>> {
        let thetas = sample.thetas();
        let first = stream.below(thetas.len());
        let second = (first + 1 + stream.below(thetas.len() - 1)) % thetas.len();
        let ends = [first, second].map(|i| self.prior.coordinates(thetas[i]));
        let point = |k: usize| {
            let share = LENGTH * k as f64 / (POINTS - 1) as f64;
            let pairs = ends[0].iter().zip(&ends[1]);
            let coordinates: Vec<f64> = pairs.map(|(a, b)| a + share * (b - a)).collect();
            self.prior.theta(&coordinates)
        };
        (0..POINTS).map(point).collect()
    }

    /// Adds the smallest scatter on any line to every known error sd, and repeats the stage.
    pub(super) fn after_scatter(&mut self, lines: &ScatterLines, outputs: &[Outputs]) -> Next {
        self.has_measured_scatter = true;
        let theta = lines.sample.thetas()[0];
        let is_rough = |line: &[Outputs]| {
            let sd = numerical_noise::log_likelihood_sd(&self.stated, line, theta);
            sd.is_some_and(|sd| sd > UNFELT || !numerical_noise::is_negligible(&self.stated, line, theta))
        };
        if outputs.chunks(POINTS).all(is_rough) {
            self.is_rough = true;
            self.add_scatter(outputs);
        }
        match self.emulator(&lines.sample.thetas()) {
            Some(emulator) => self.repeat_stage(lines.position, &emulator, &lines.sample),
            None => Next::GiveUp,
        }
    }

    fn add_scatter(&mut self, outputs: &[Outputs]) {
        let lines = outputs
            .chunks(POINTS)
            .map(|line| numerical_noise::declared_sds(&self.stated, line));
        let Some(lines) = lines.collect::<Option<Vec<Vec<f64>>>>() else {
            return;
        };
        let before = &self.record.numerical_noise;
        let sd = |channel: usize| {
            let smallest = lines.iter().map(|sds| sds[channel]).fold(f64::INFINITY, f64::min);
            smallest.max(before.get(channel).copied().unwrap_or(0.0))
        };
        let noise: Vec<f64> = (0..lines[0].len()).map(sd).collect();
        // The scatter of finite values is finite.
        if let Ok(likelihood) = self.stated.with_numerical_noise(&noise) {
            self.likelihood = likelihood;
            self.record.numerical_noise = noise;
        }
    }
}
