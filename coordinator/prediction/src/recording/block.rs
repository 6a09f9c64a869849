//! Ten samples, whose mean is compared with the model.

use shared::channel::Channel;

use super::sample::Sample;
use job::PlannedRun;

/// Number of samples of a block: a second at 10 Hz.
pub(super) const SAMPLES: usize = 10;

/// Samples with the model's values at the best parameters so far.
#[derive(Debug, Clone, Default)]
pub(super) struct SampleBlock {
    samples: Vec<Sample>,
    /// The model at the condition of each sample; `None` where it refuses it.
    modelled: Vec<Option<[f64; 4]>>,
    /// The parameters of these values.
    pub(super) theta: Vec<f64>,
}

impl SampleBlock {
    pub(super) fn new(theta: Vec<f64>) -> Self {
        SampleBlock {
            theta,
            ..Self::default()
        }
    }

    pub(super) fn push(&mut self, sample: Sample, modelled: Option<[f64; 4]>) {
        self.samples.push(sample);
        self.modelled.push(modelled);
    }

    pub(super) fn is_full(&self) -> bool {
        self.samples.len() == SAMPLES
    }

    /// Returns the mean over the samples.
    fn mean(&self, of: impl Fn(&Sample) -> f64) -> f64 {
        self.samples.iter().map(of).sum::<f64>() / self.samples.len() as f64
    }

    /// Returns the time of the first sample, the mean time, and that of the last sample `[s]`.
    pub(super) fn times(&self) -> [f64; 3] {
        let end = |sample: Option<&Sample>| sample.map_or(f64::NAN, |sample| sample.t_s);
        [
            end(self.samples.first()),
            self.mean(|sample| sample.t_s),
            end(self.samples.last()),
        ]
    }

    /// Returns the mean condition.
    pub(super) fn condition(&self) -> Option<PlannedRun> {
        let mut planned = self.samples.last()?.planned.clone();
        let run = &mut planned.run;
        run.slip = self.mean(|sample| sample.planned.run.slip);
        run.wheel_load_n = self.mean(|sample| sample.planned.run.wheel_load_n);
        run.sled_speed_m_s = self.mean(|sample| sample.planned.run.sled_speed_m_s);
        run.slip_angle_deg = self.mean(|sample| sample.planned.run.slip_angle_deg);
        Some(planned)
    }

    /// Returns the measured mean of a channel at the mean condition, with the number of its samples; `None` without any.
    ///
    /// The model is curved over conditions that vary within the block, so that its residuals are averaged, not its values.
    ///
    /// # Arguments
    /// - `at_mean`: the model at the mean condition and [`SampleBlock::theta`].
    pub(super) fn measured(&self, channel: Channel, at_mean: Option<[f64; 4]>) -> Option<(f64, usize)> {
        let c = channel.index();
        let rows = || {
            let rows = self.samples.iter().zip(&self.modelled);
            rows.filter_map(|(sample, modelled)| {
                Some((sample.measured[c]?, modelled.map(|values| values[c])))
            })
        };
        let count = rows().count();
        if count == 0 {
            return None;
        }
        let residuals: Option<f64> = rows()
            .map(|(measured, modelled)| Some(measured - modelled?))
            .sum();
        let mean = match (residuals, at_mean) {
            (Some(sum), Some(at_mean)) => at_mean[c] + sum / count as f64,
            _ => rows().map(|(measured, _)| measured).sum::<f64>() / count as f64,
        };
        Some((mean, count))
    }
}
