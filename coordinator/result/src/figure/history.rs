//! Measured and simulated histories, filtered.

use serde::Serialize;
use shared::channel::Channel;
use shared::experiment::MeasuredHistory;
use shared::outcome::SimulatedHistory;
use signal::{INTERVAL_S, LowPass};
use utoipa::ToSchema;

use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

/// One channel of one fitted run over time.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct ChannelHistory {
    /// Name of the channel without its unit.
    #[schema(value_type = String)]
    pub channel: Channel,
    /// SI unit.
    pub unit: &'static str,
    /// Name of the run.
    pub run: String,
    /// Recording of the rig; null where the run has averages alone.
    pub measured: Option<MeasuredSeries>,
    /// Simulated histories, including the transients.
    pub model: Vec<ModelSeries>,
}

/// Means over intervals of equal length.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct MeasuredSeries {
    /// Ends of the intervals, from the beginning of the recording `[s]`.
    pub t_s: Vec<f64>,
    /// After the protocol's low-pass [channel's unit].
    pub value: Vec<f64>,
    /// Before it [channel's unit].
    pub raw: Vec<f64>,
    /// The part that the protocol averages `[s]`.
    pub window_s: [f64; 2],
}

/// The simulated history at one parameter vector.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct ModelSeries {
    /// Which parameter vector: `maximum likelihood`, that particle; `GA optimum`, what the algorithm found.
    pub label: String,
    /// Ends of the intervals `[s]`.
    pub t_s: Vec<f64>,
    /// After the protocol's low-pass [channel's unit].
    pub value: Vec<f64>,
    /// Before it [channel's unit].
    pub raw: Vec<f64>,
}

impl FinishedCalibration {
    /// Measured and simulated histories of every channel that a fitted run measured, by channel, then by run; `None` of a
    /// model without time. Both have gone through the same filter.
    pub fn histories(&self) -> Option<Vec<ChannelHistory>> {
        let simulated = self.simulated_histories.as_ref()?;
        let label = match self.estimate() {
            None => "maximum likelihood".to_owned(),
            Some(_) => format!("{} optimum", self.spec.algorithm.name().to_uppercase()),
        };
        // A cut-off beyond what 10 Hz can represent filters nothing; the averaging protocol rejects it.
        let lowpass_hz = self.spec.experiment.protocol.lowpass_hz;
        let filter = LowPass::unless_zero(lowpass_hz, 1.0 / INTERVAL_S).ok().flatten();
        let mut histories = Vec::new();
        for channel in Channel::ALL {
            for (&position, simulated) in self.spec.fit_runs.iter().zip(simulated) {
                let run = &self.spec.experiment.runs[position];
                if run.measured[channel.index()].is_none() {
                    continue;
                }
                histories.push(ChannelHistory {
                    channel,
                    unit: channel.unit(),
                    run: run.name.clone(),
                    measured: run.history.as_ref().and_then(|h| measured(h, channel)),
                    model: vec![model(label.clone(), simulated, channel, filter.as_ref())],
                });
            }
        }
        Some(histories)
    }
}

/// The histories of a study's calibrations in the same pictures; `None` where none has any.
pub(super) fn all(study: &Study) -> Option<Vec<ChannelHistory>> {
    let mut each = study.submitted().filter_map(FinishedCalibration::histories);
    let mut histories = each.next()?;
    for further in each {
        // The calibrations of a study fit the same runs.
        for (history, other) in histories.iter_mut().zip(further) {
            history.model.extend(other.model);
        }
    }
    Some(histories)
}

/// The ends of so many intervals `[s]`.
fn ends(intervals: usize, interval_s: f64) -> Vec<f64> {
    (1..=intervals).map(|k| k as f64 * interval_s).collect()
}

fn measured(history: &MeasuredHistory, channel: Channel) -> Option<MeasuredSeries> {
    let recorded = history.channel(channel)?;
    Some(MeasuredSeries {
        t_s: ends(recorded.raw.len(), history.interval_s),
        value: recorded.filtered.clone(),
        raw: recorded.raw.clone(),
        window_s: [history.transient_s, history.transient_s + recorded.covered_s],
    })
}

fn model(
    label: String,
    simulated: &SimulatedHistory,
    channel: Channel,
    filter: Option<&LowPass>,
) -> ModelSeries {
    let raw = simulated.channel(channel).to_vec();
    let mut value = raw.clone();
    if let Some(filter) = filter {
        filter.apply(&mut value);
    }
    ModelSeries {
        label,
        t_s: ends(raw.len(), INTERVAL_S),
        value,
        raw,
    }
}
