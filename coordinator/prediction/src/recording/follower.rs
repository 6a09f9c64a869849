//! From the samples of a recording to the parameters of the soil.

use std::collections::VecDeque;

use inference::tracking::tracker::WALK_SIZES;
use inference::tracking::{Block, NoiseEstimate, Tracker, TrackerSettings};
use job::{ConditionDefaults, PlannedRun};
use result::FinishedCalibration;
use shared::channel::Channel;
use shared::file::unknown_word;
use shared::model::{ModelKind, ModelVariant};

use super::answer::{ChannelNoise, FollowedRecording, RecordedParameter, RecordedTime, SoilChange, WalkSize};
use super::block::SampleBlock;
use super::sample::Sample;
use crate::ensemble::variant;
use crate::error::PredictionError;

/// Parameters of the soil, which may vary unless others are asked for.
const SOIL: [&str; 7] = [
    "k_c",
    "k_phi",
    "log10_p_ref",
    "kappa",
    "n",
    "friction_angle_deg",
    "cohesion_pa",
];
/// Mean interval of changes of the soil `[s]`.
const CHANGE_INTERVAL_S: f64 = 100.0;
/// Probability above which a change is flagged.
const FLAGGED: f64 = 0.95;

/// A model at one condition: from parameters to the channels; `None` where it refuses them, an error where the machine fails.
pub type CompiledModel = Box<dyn Fn(&[f64]) -> Result<Option<[f64; 4]>, String>>;

/// A recording that is followed.
pub struct RecordingFollower<'a> {
    calibration: &'a FinishedCalibration,
    compile: &'a dyn Fn(&ModelVariant) -> Result<CompiledModel, String>,
    /// Positions and names of the parameters that may vary.
    varying: Vec<usize>,
    tracker: Tracker,
    noise: [NoiseEstimate; 4],
    /// The channels that the recording has.
    channels: Vec<Channel>,
    block: SampleBlock,
    /// Blocks that wait until the noise is known.
    waiting: VecDeque<SampleBlock>,
    /// Times of the first and the last sample of each block that was taken `[s]`.
    taken: Vec<[f64; 3]>,
}

impl<'a> RecordingFollower<'a> {
    /// Begins with the posterior of a calibration.
    ///
    /// # Arguments
    /// - `parameters`: those that may vary; empty: those of the soil. `compile`: makes a model of a variant with one condition.
    ///
    /// # Errors
    /// [`PredictionError::NoDraws`]; [`PredictionError::NoStoredDraws`]; [`PredictionError::Request`] names a parameter that is not free, or
    /// says that the model is too slow.
    pub fn new(
        calibration: &'a FinishedCalibration,
        parameters: &[String],
        compile: &'a dyn Fn(&ModelVariant) -> Result<CompiledModel, String>,
    ) -> Result<Self, PredictionError> {
        let id = calibration.row.id;
        if calibration.estimate().is_some() {
            return Err(PredictionError::NoDraws(id));
        }
        let spec = &calibration.spec;
        if !matches!(
            spec.model.kind,
            ModelKind::QuasiStatic | ModelKind::WongReece | ModelKind::Rft
        ) {
            let message =
                "a recording is followed by a model of steady motion: quasi_static, wong_reece or rft";
            return Err(PredictionError::Request(message.into()));
        }
        let free = &spec.fit_variant.parameters;
        if let Some(unknown) = parameters.iter().find(|name| !free.contains(name)) {
            let message = unknown_word("free parameter", unknown, free.iter().map(String::as_str));
            return Err(PredictionError::Request(message));
        }
        let varies = |name: &String| match parameters.is_empty() {
            true => SOIL.contains(&name.as_str()),
            false => parameters.contains(name),
        };
        let varying: Vec<usize> = (0..free.len()).filter(|&i| varies(&free[i])).collect();
        if varying.is_empty() {
            let message =
                "the calibration has no free parameter of the soil: name the parameters that may vary";
            return Err(PredictionError::Request(message.into()));
        }
        let draws = calibration.predictive_draws().iter();
        let draws: Vec<Vec<f64>> = draws.map(|draw| spec.model_theta(&draw.theta).to_vec()).collect();
        if draws.len() < 2 {
            return Err(PredictionError::NoStoredDraws(id));
        }
        let prior = spec.prior().subset(&(0..free.len()).collect::<Vec<_>>());
        let settings = TrackerSettings {
            varying: varying.clone(),
            change_interval_s: CHANGE_INTERVAL_S,
            bound: FLAGGED,
        };
        let tracker = Tracker::new(prior, &draws, settings);
        Ok(RecordingFollower {
            block: SampleBlock::new(tracker.leading()),
            calibration,
            compile,
            varying,
            tracker,
            noise: Default::default(),
            channels: Vec::new(),
            waiting: VecDeque::new(),
            taken: Vec::new(),
        })
    }

    /// Returns what a row of a recording may leave out.
    pub fn defaults(calibration: &FinishedCalibration) -> ConditionDefaults<'_> {
        let experiment = &calibration.spec.experiment;
        ConditionDefaults::new(experiment, &experiment.wheels)
    }

    /// Takes a sample. Returns the parameters after each block that it completes: one for each ten samples, and none before the noise is
    /// known from 50.
    ///
    /// # Errors
    /// [`PredictionError::Model`] if the model cannot be evaluated; [`PredictionError::Request`] if it does not predict a channel, or if a
    /// channel does not vary.
    pub fn take(&mut self, sample: Sample) -> Result<Vec<RecordedTime>, PredictionError> {
        let modelled = self.compiled(&sample.planned)?(&self.block.theta).map_err(PredictionError::Model)?;
        for channel in Channel::ALL {
            let c = channel.index();
            let Some(measured) = sample.measured[c] else {
                continue;
            };
            if !self.channels.contains(&channel) {
                self.channels.push(channel);
            }
            let Some(values) = &modelled else { continue };
            if values[c].is_nan() {
                let message = format!("the model does not predict {}", channel.column());
                return Err(PredictionError::Request(message));
            }
            self.noise[c].add(measured - values[c]);
            if self.noise[c].is_silent() {
                let message = format!(
                    "{} is without noise, which a recording of a rig has",
                    channel.column()
                );
                return Err(PredictionError::Request(message));
            }
        }
        self.block.push(sample, modelled);
        if !self.block.is_full() {
            return Ok(Vec::new());
        }
        let next = SampleBlock::new(self.tracker.leading());
        self.waiting.push_back(std::mem::replace(&mut self.block, next));
        let mut times = Vec::new();
        while let Some(variances) = self.variances() {
            let Some(block) = self.waiting.pop_front() else {
                break;
            };
            times.push(self.take_block(&block, variances)?);
        }
        if !times.is_empty() {
            self.block.theta = self.tracker.leading();
        }
        Ok(times)
    }

    fn compiled(&self, planned: &PlannedRun) -> Result<CompiledModel, PredictionError> {
        let wheels = &self.calibration.spec.experiment.wheels;
        let variant = ModelVariant {
            channels: Vec::new(),
            stiffness_sensitivity: false,
            ..variant(self.calibration, wheels, planned)
        };
        (self.compile)(&variant).map_err(PredictionError::Model)
    }

    /// Returns the variance of a mean of one independent sample by channel; `None` until that of all channels is known.
    fn variances(&self) -> Option<[f64; 4]> {
        let mut variances = [f64::NAN; 4];
        for channel in &self.channels {
            let (sd, correlated) = self.noise[channel.index()].sd_and_correlated()?;
            variances[channel.index()] = sd * sd * correlated;
        }
        (!self.channels.is_empty()).then_some(variances)
    }

    fn take_block(
        &mut self,
        block: &SampleBlock,
        variances: [f64; 4],
    ) -> Result<RecordedTime, PredictionError> {
        let Some(condition) = block.condition() else {
            return Err(PredictionError::Request("the recording has no sample".into()));
        };
        let model = self.compiled(&condition)?;
        let at_mean = model(&block.theta).map_err(PredictionError::Model)?;
        let rows = self.channels.iter().filter_map(|&channel| {
            let (mean, count) = block.measured(channel, at_mean)?;
            Some((channel.index(), mean, variances[channel.index()] / count as f64))
        });
        let rows: Vec<(usize, f64, f64)> = rows.collect();
        let times = block.times();
        let elapsed_s = self.taken.last().map_or(0.0, |last| times[1] - last[1]);
        self.taken.push(times);
        let mut failure = None;
        let values = |theta: &[f64]| match model(theta) {
            Ok(values) => values.map(|values| rows.iter().map(|row| values[row.0]).collect()),
            Err(message) => {
                failure.get_or_insert(message);
                None
            }
        };
        let taken = Block {
            elapsed_s,
            values: rows.iter().map(|row| row.1).collect(),
            variances: rows.iter().map(|row| row.2).collect(),
        };
        let before = self.tracker.changes().len();
        let is_taken = self.tracker.take(&taken, values);
        if let Some(message) = failure {
            return Err(PredictionError::Model(message));
        }
        Ok(RecordedTime {
            t_s: times[2],
            parameters: self.parameters(),
            change_probability: self.tracker.change_probability(),
            change: self.changes().into_iter().nth(before),
            is_refused: !is_taken,
        })
    }

    fn parameters(&self) -> Vec<RecordedParameter> {
        let parameters = self.varying.iter().map(|&i| {
            let parameter = &self.calibration.spec.parameters[i];
            let [low, median, high] = [0.05, 0.5, 0.95].map(|p| self.tracker.quantile(i, p));
            RecordedParameter {
                name: parameter.name.clone(),
                unit: parameter.unit.clone(),
                median,
                interval: [low, high],
            }
        });
        parameters.collect()
    }

    fn changes(&self) -> Vec<SoilChange> {
        let changes = self.tracker.changes().iter().map(|change| SoilChange {
            t_s: self.taken[change.block - 1][0],
            found_s: self.taken[change.found - 1][2],
            probability: change.probability,
        });
        changes.collect()
    }

    /// Ends the recording. Samples of an incomplete block are left out.
    ///
    /// # Arguments
    /// - `times`: the parameters after each block.
    pub fn end(self, times: Vec<RecordedTime>) -> FollowedRecording {
        let walk = WALK_SIZES.iter().zip(self.tracker.walk_probabilities());
        let noise = self.channels.iter().filter_map(|channel| {
            let (sd, correlated_samples) = self.noise[channel.index()].sd_and_correlated()?;
            Some(ChannelNoise {
                channel: channel.column().to_owned(),
                sd,
                correlated_samples,
            })
        });
        FollowedRecording {
            calibration: self.calibration.row.id,
            times,
            changes: self.changes(),
            walk: walk
                .map(|(&prior_sds, probability)| WalkSize {
                    prior_sds,
                    probability,
                })
                .collect(),
            noise: noise.collect(),
        }
    }
}
