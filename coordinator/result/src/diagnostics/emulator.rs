//! Diagnostics of an emulator: its errors against the errors of the data, and the weights of the final draws.

use std::collections::BTreeMap;

use inference::{EmulatorRecord, EmulatorRound};
use shared::channel::Channel;

use crate::finished_calibration::FinishedCalibration;
use crate::words::data_channel::{DataChannel, ShownUnit};
use crate::words::number;

/// A batch of evaluations that judged the emulator.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct EmulatorRoundRow {
    /// Tempering exponent of the stage.
    pub tempering_exponent: f64,
    /// Number of evaluations.
    pub evaluations: usize,
    /// Number of evaluations that the model rejected.
    pub rejected: usize,
    /// Mean error of the tempered log-likelihood `[nats]`; null where the model rejected all.
    pub mean_error: Option<f64>,
    /// Standard deviation of that error `[nats]`.
    pub error_sd: Option<f64>,
    /// Root mean square error of the outputs by channel, in error standard deviations.
    pub channel_errors: BTreeMap<String, f64>,
    /// Number of training points of the emulator.
    pub training_points: usize,
    /// Whether the emulator agreed with the model, so that the exponent grew; otherwise the batch refined it.
    pub agreed: bool,
}

/// The emulator of a sampler.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct EmulatorDiagnostics {
    /// The batches in their order.
    pub rounds: Vec<EmulatorRoundRow>,
    /// Number of final draws, all evaluated by the model.
    pub final_draws: usize,
    /// Effective number of the final draws by their weights; null if the emulator was given up.
    pub effective_draws: Option<f64>,
    /// Largest share of one final draw in all weights.
    pub max_share: Option<f64>,
    /// Scatter of the model that counts as noise, by channel, in the unit of the channel; empty for a smooth model.
    pub numerical_noise: BTreeMap<String, f64>,
    /// Whether the emulator was given up, so that the model itself was sampled.
    pub fell_back: bool,
}

/// Returns the diagnostics of the emulator; `None` for a calibration without one.
pub fn emulator(calibration: &FinishedCalibration) -> Option<EmulatorDiagnostics> {
    let record = calibration.emulator.as_ref()?;
    let last = record.finals.last().filter(|_| !record.fell_back);
    Some(EmulatorDiagnostics {
        rounds: record
            .rounds
            .iter()
            .map(|round| row(calibration, round))
            .collect(),
        final_draws: last.map_or(0, |weights| weights.draws),
        effective_draws: last.map(|weights| weights.ess),
        max_share: last.map(|weights| weights.max_share),
        numerical_noise: numerical_noise(record),
        fell_back: record.fell_back,
    })
}

/// Returns the scatter of a rough model by channel, in the unit of the channel.
pub fn numerical_noise(record: &EmulatorRecord) -> BTreeMap<String, f64> {
    let channels = record
        .numerical_noise
        .iter()
        .enumerate()
        .filter(|(_, sd)| **sd > 0.0);
    channels
        .map(|(index, sd)| (DataChannel::from_index(index).name().to_owned(), *sd))
        .collect()
}

fn row(calibration: &FinishedCalibration, round: &EmulatorRound) -> EmulatorRoundRow {
    let fitted = super::data_channel::fitted_channels(&calibration.spec);
    EmulatorRoundRow {
        tempering_exponent: round.tempering_exponent,
        evaluations: round.evaluations,
        rejected: round.rejected,
        mean_error: round.error.map(|[mean, _]| mean),
        error_sd: round.error.map(|[_, sd]| sd),
        channel_errors: fitted
            .into_iter()
            .filter_map(|(index, channel)| {
                Some((channel.name().to_owned(), *round.channel_errors.get(index)?))
            })
            .collect(),
        training_points: round.training_points,
        agreed: round.agreed,
    }
}

impl EmulatorDiagnostics {
    /// Returns the root mean square error of the outputs at the last batch over the channels, in error standard deviations.
    pub fn error_sigma(&self) -> Option<f64> {
        let errors = &self.rounds.last()?.channel_errors;
        let squares: f64 = errors.values().map(|error| error * error).sum();
        (!errors.is_empty()).then(|| (squares / errors.len() as f64).sqrt())
    }

    /// Returns the share of effective draws among the final draws.
    pub fn effective_share(&self) -> Option<f64> {
        self.effective_draws.map(|ess| ess / self.final_draws as f64)
    }

    /// Returns the number of evaluations of the batches.
    pub fn evaluations(&self) -> usize {
        self.rounds.iter().map(|round| round.evaluations).sum()
    }

    /// Returns sentences on the emulator, the final draws and the scatter of the model.
    pub fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        let rounds = number::count(self.rounds.len(), "round");
        let evaluations = number::count(self.evaluations(), "evaluation");
        match (self.effective_draws, self.error_sigma()) {
            (Some(ess), Some(error)) => words.push(format!(
                "an emulator of the model's outputs was refined in {rounds} with {evaluations} in all, to an error of {} error sds; {} of \
                 the model weigh as {ess:.0} independent ones",
                number::significant(error, 2),
                number::count(self.final_draws, "final draw")
            )),
            _ => words.push(format!(
                "the emulator of the model's outputs was given up after {rounds} with {evaluations}, because it did not learn them; the \
                 model itself was sampled"
            )),
        }
        let sizes: Vec<String> = Channel::ALL
            .iter()
            .filter_map(|channel| {
                let sd = *self.numerical_noise.get(channel.column())?;
                Some(format!(
                    "{} {}",
                    channel.words(),
                    ShownUnit::new(*channel).size(sd)
                ))
            })
            .collect();
        if !sizes.is_empty() {
            words.push(format!(
                "the model itself scatters with its parameters, which counts as noise here: {}",
                sizes.join(", ")
            ));
        }
        words
    }
}
