//! Figure of measured and simulated histories after the same filter (the source paper's Fig. 7).

use job::repeats;
use serde::Serialize;
use shared::channel::Channel;
use shared::experiment::{MeasuredHistory, TestRun};
use shared::outcome::SimulatedHistory;
use signal::{INTERVAL_S, LowPass};
use utoipa::ToSchema;

use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

/// The history of one channel of one run.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct ChannelHistory {
    /// Name of the channel without its unit.
    #[schema(value_type = String)]
    pub channel: Channel,
    /// SI unit of the channel.
    pub unit: &'static str,
    /// Name of the run.
    pub run: String,
    /// Recording of the rig; null if the run has only averages.
    pub measured: Option<MeasuredSeries>,
    /// Simulated histories, including the transients.
    pub model: Vec<ModelSeries>,
}

/// Means over intervals of equal length.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct MeasuredSeries {
    /// Ends of the intervals, from the beginning of the recording `[s]`.
    pub t_s: Vec<f64>,
    /// Values after the protocol's low-pass filter [channel's unit].
    pub value: Vec<f64>,
    /// Values before the filter [channel's unit].
    pub raw: Vec<f64>,
    /// Begin and end of the part that the protocol averages `[s]`.
    pub window_s: [f64; 2],
}

/// The simulated history at one parameter vector.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct ModelSeries {
    /// Name of the prediction: `maximum likelihood` for the particle of highest likelihood, `GA optimum` for the result of a search,
    /// `posterior mean` and `corrected` for transients.
    pub label: String,
    /// Ends of the intervals `[s]`.
    pub t_s: Vec<f64>,
    /// Values after the protocol's low-pass filter [channel's unit].
    pub value: Vec<f64>,
    /// Values before the filter [channel's unit].
    pub raw: Vec<f64>,
}

impl FinishedCalibration {
    /// Returns the measured and simulated histories by channel, then by run, of every channel that a fitted run measured; those of the
    /// transients for a model that predicts no others; `None` for a model without time. Both have passed the same filter.
    pub fn histories(&self) -> Option<Vec<ChannelHistory>> {
        let Some(simulated) = &self.simulated_histories else {
            return Some(self.transient_histories()).filter(|histories| !histories.is_empty());
        };
        let label = self.label("maximum likelihood");
        // A cut-off above the Nyquist frequency of 10 Hz data has no filter; the averaging protocol rejects it.
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

impl FinishedCalibration {
    /// Returns the label of a prediction: that of a fit without draws is its algorithm's.
    fn label(&self, of_sample: &str) -> String {
        match self.estimate() {
            None => of_sample.to_owned(),
            Some(_) => format!("{} optimum", self.spec.algorithm.name().to_uppercase()),
        }
    }

    /// Returns the sinkage of recorded runs and its posterior mean before the steady state, for the first run of each condition.
    fn transient_histories(&self) -> Vec<ChannelHistory> {
        let experiment = &self.spec.experiment;
        let slip_begins_m = experiment.protocol.slip_begins_m.unwrap_or(0.0);
        let mut shown: Vec<&TestRun> = Vec::new();
        let mut histories = Vec::new();
        for transient in self.predicted_transients(self.comparison()) {
            let run = experiment.runs.iter().find(|run| run.name == transient.row.run);
            let Some((run, history)) = run.and_then(|run| Some((run, run.history.as_ref()?))) else {
                continue;
            };
            if shown.iter().any(|earlier| repeats(earlier, run)) {
                continue;
            }
            shown.push(run);
            let time_s = |travel_m: &f64| history.time_at(slip_begins_m + travel_m);
            let t_s: Vec<f64> = transient.travel_m.iter().map(time_s).collect();
            let series = |label: String, value: Vec<f64>| ModelSeries {
                label,
                t_s: t_s.clone(),
                raw: value.clone(),
                value,
            };
            let predicted = series(self.label("posterior mean"), transient.predicted_m);
            let corrected = transient
                .corrected_m
                .filter(|_| self.estimate().is_none())
                .map(|value| series("corrected".to_owned(), value));
            histories.push(ChannelHistory {
                channel: Channel::Sinkage,
                unit: Channel::Sinkage.unit(),
                run: run.name.clone(),
                measured: measured(history, Channel::Sinkage),
                model: std::iter::once(predicted).chain(corrected).collect(),
            });
        }
        histories
    }
}

/// Puts the histories of all submitted calibrations of a study into the same figures; `None` if there is none.
pub(super) fn all(study: &Study) -> Option<Vec<ChannelHistory>> {
    let mut each = study.submitted().filter_map(FinishedCalibration::histories);
    let mut histories = each.next()?;
    for further in each {
        for added in further {
            let is_same = |history: &&mut ChannelHistory| {
                (history.channel, &history.run) == (added.channel, &added.run)
            };
            match histories.iter_mut().find(is_same) {
                Some(history) => history.model.extend(added.model),
                None => histories.push(added),
            }
        }
    }
    Some(histories)
}

/// Returns the ends of consecutive intervals of equal length `[s]`.
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
