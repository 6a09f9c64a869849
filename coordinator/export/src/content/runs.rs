//! Runs: what was set, what was measured, and what the model says at the draws that were simulated on every run.

use record::Prediction;
use result::FinishedCalibration;
use shared::channel::Channel;
use shared::experiment::TestRun;
use shared::outcome::Observables;

use super::draws::{draw_labels, numbers};
use crate::inference_data::Group;
use crate::variable::{Values, Variable};

/// The name that measured values, their predictions and their log-likelihoods share.
const MEASUREMENT: &str = "measurement";

/// The fitted runs of a calibration, or those held out.
pub(super) struct Part<'a> {
    calibration: &'a FinishedCalibration,
    runs: Vec<&'a TestRun>,
    /// The channels that some run of the experiment has measured.
    channels: Vec<Channel>,
    of: fn(&Prediction) -> Option<&Observables>,
}

impl<'a> Part<'a> {
    /// The fitted runs.
    pub(super) fn fitted(calibration: &'a FinishedCalibration) -> Self {
        Part::new(calibration, &calibration.spec.fit_runs, |draw| {
            draw.fit.as_ref().ok()
        })
    }

    /// The runs that are not fitted.
    pub(super) fn held_out(calibration: &'a FinishedCalibration) -> Self {
        Part::new(calibration, &calibration.spec.holdout_runs, |draw| {
            draw.holdout.as_ref()?.as_ref().ok()
        })
    }

    fn new(
        calibration: &'a FinishedCalibration,
        runs: &[usize],
        of: fn(&Prediction) -> Option<&Observables>,
    ) -> Self {
        let all = &calibration.spec.experiment.runs;
        let is_measured = |channel: &Channel| all.iter().any(|run| run.measured[channel.index()].is_some());
        Part {
            calibration,
            runs: runs.iter().map(|&run| &all[run]).collect(),
            channels: Channel::ALL.into_iter().filter(is_measured).collect(),
            of,
        }
    }

    /// The labels of run and channel.
    fn labels(&self) -> Vec<Variable> {
        let channels = self.channels.iter().map(|channel| channel.column().to_owned());
        vec![
            Variable::labels("run", Values::Text(self.texts(|run| &run.name))),
            Variable::labels("channel", Values::Text(channels.collect())),
        ]
    }

    fn texts(&self, of: impl Fn(&TestRun) -> &String) -> Vec<String> {
        self.runs.iter().map(|run| of(run).clone()).collect()
    }

    fn dims(&self) -> [(&'static str, usize); 2] {
        [("run", self.runs.len()), ("channel", self.channels.len())]
    }

    /// A variable over the simulated draws, runs and channels.
    fn over_draws(&self, name: &str, group: &str, meaning: &str, values: Vec<f64>) -> Group {
        let draws = self.calibration.predictive_draws();
        let [run, channel] = self.dims();
        let dims = [("chain", 1), ("draw", draws.len()), run, channel];
        let mut coords = draw_labels(places(self.calibration));
        coords.extend(self.labels());
        Group {
            name: group.to_owned(),
            coords,
            data_vars: vec![Variable::new(name, &dims, "", meaning, Values::Real(values))],
        }
    }

    /// What the model says, without noise; NaN where it rejects a draw.
    pub(super) fn predictive(&self, group: &str) -> Group {
        let mut values = Vec::new();
        for draw in self.calibration.predictive_draws() {
            let observables = (self.of)(draw);
            for run in 0..self.runs.len() {
                let value = |channel: &Channel| {
                    let values = observables.map(|observables| observables.channel(*channel));
                    values
                        .and_then(|values| values.get(run).copied())
                        .unwrap_or(f64::NAN)
                };
                values.extend(self.channels.iter().map(value));
            }
        }
        let meaning = "value of the model at the draw, without noise, in the unit of the channel";
        self.over_draws(MEASUREMENT, group, meaning, values)
    }

    /// The log-density of each fitted measurement by itself.
    pub(super) fn log_likelihood(&self) -> Group {
        let spec = &self.calibration.spec;
        let mut values = Vec::new();
        for draw in self.calibration.predictive_draws() {
            let mut table = vec![f64::NAN; self.runs.len() * self.channels.len()];
            let predicted = (self.of)(draw).map(|observables| spec.predicted_values(observables));
            let densities = predicted.and_then(|p| spec.likelihood.log_densities(&p, &draw.theta).ok());
            for (datum, density) in spec.likelihood.data().iter().zip(densities.unwrap_or_default()) {
                let place = self
                    .channels
                    .iter()
                    .position(|channel| channel.index() == datum.channel);
                if let Some(place) = place {
                    table[datum.run * self.channels.len() + place] = density;
                }
            }
            values.extend(table);
        }
        let is_alone = (0..spec.likelihood.data().len()).all(|datum| spec.likelihood.is_alone(datum));
        let meaning = match is_alone {
            true => "log-density of the measurement",
            false => {
                "log-density of the measurement by itself: some errors are common to several, so that the sum is not the joint log-density"
            }
        };
        self.over_draws(MEASUREMENT, "log_likelihood", meaning, values)
    }

    /// What was measured; NaN where nothing was.
    pub(super) fn measured(&self, group: &str) -> Group {
        let of_run = |run: &&TestRun| -> Vec<f64> {
            let value = |channel: &Channel| run.measured[channel.index()].unwrap_or(f64::NAN);
            self.channels.iter().map(value).collect()
        };
        let values = self.runs.iter().flat_map(of_run).collect();
        let meaning = "measured value, in the unit of the channel";
        Group {
            name: group.to_owned(),
            coords: self.labels(),
            data_vars: vec![Variable::new(
                MEASUREMENT,
                &self.dims(),
                "",
                meaning,
                Values::Real(values),
            )],
        }
    }

    /// What the rig was set to.
    pub(super) fn conditions(&self, group: &str) -> Group {
        let [run, channel] = self.dims();
        let real = |name: &str, unit: &str, of: fn(&TestRun) -> f64| {
            let values = self.runs.iter().map(|run| of(run)).collect();
            Variable::new(name, &[run], unit, "", Values::Real(values))
        };
        let text = |name: &str, values| Variable::new(name, &[run], "", "", Values::Text(values));
        let passes = self.runs.iter().map(|run| i64::from(run.pass)).collect();
        let units = self.channels.iter().map(|channel| channel.unit().to_owned());
        Group {
            name: group.to_owned(),
            coords: self.labels(),
            data_vars: vec![
                text("wheel", self.texts(|run| &run.wheel)),
                text("soil", self.texts(|run| &run.soil)),
                real("slip", "1", |run| run.slip),
                real("wheel_load_n", "N", |run| run.wheel_load_n),
                real("sled_speed_m_s", "m/s", |run| run.sled_speed_m_s),
                real("slip_angle_deg", "deg", |run| run.slip_angle_deg),
                Variable::new("pass", &[run], "", "", Values::Whole(passes)),
                Variable::new("unit", &[channel], "", "", Values::Text(units.collect())),
            ],
        }
    }
}

/// Where the simulated draws stand in the posterior, which they are equally spaced draws of.
fn places(calibration: &FinishedCalibration) -> Vec<i64> {
    let draws = calibration.predictive_draws();
    let is_same = |a: &[f64], b: &[f64]| a.iter().map(|x| x.to_bits()).eq(b.iter().map(|x| x.to_bits()));
    let mut posterior = calibration.posterior.iter().zip(0_i64..);
    let place = |draw: &Prediction| {
        let found = posterior.find(|(sample, _)| is_same(&sample.theta, &draw.theta));
        found.map(|(_, place)| place)
    };
    let places: Option<Vec<i64>> = draws.iter().map(place).collect();
    places.unwrap_or_else(|| numbers(draws.len()))
}
