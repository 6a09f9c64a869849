//! Surface: interpolation over all conditions that vary, by a Gaussian process.

use std::collections::BTreeMap;

use inference::gaussian_process::{GaussianProcess, Observation};
use shared::channel::Channel;
use shared::experiment::{Experiment, RunUse, TestRun};

use super::interpolated::{Interpolated, InterpolatedOver};
use crate::table::conditions::{Conditions, repeated};
use crate::words::number;

/// Wheel, soil, pass and channel of the measurements of one process.
type Key = (String, String, u32, Channel);

/// The processes of an experiment, fitted on demand.
pub(super) struct Surfaces<'a> {
    experiment: &'a Experiment,
    surfaces: BTreeMap<Key, Result<Surface, String>>,
}

impl<'a> Surfaces<'a> {
    pub(super) fn new(experiment: &'a Experiment) -> Self {
        Surfaces {
            experiment,
            surfaces: BTreeMap::new(),
        }
    }

    /// Returns the interpolated value at a run, or why there is none.
    pub(super) fn at(&mut self, run: &TestRun, channel: Channel) -> Result<Interpolated, String> {
        let key = (run.wheel.clone(), run.soil.clone(), run.pass, channel);
        let experiment = self.experiment;
        let make = || Surface::through(experiment, run, channel);
        self.surfaces
            .entry(key)
            .or_insert_with(make)
            .as_ref()
            .map_err(Clone::clone)?
            .at(run)
    }
}

/// A Gaussian process through the measurements of a channel.
struct Surface {
    /// Wheel, soil and pass in words.
    subject: String,
    conditions: Conditions,
    process: GaussianProcess,
}

impl Surface {
    /// Fits a process to the fitted runs of the same wheel, soil and pass as `like`.
    fn through(experiment: &Experiment, like: &TestRun, channel: Channel) -> Result<Self, String> {
        let mut subject = format!("wheel {} on soil {}", like.wheel, like.soil);
        if like.pass > 1 {
            subject += &format!(" at pass {}", like.pass);
        }
        let alike = |run: &&TestRun| {
            run.usage == RunUse::Fit
                && (&run.wheel, &run.soil, run.pass) == (&like.wheel, &like.soil, like.pass)
                && run.measured[channel.index()].is_some()
        };
        let runs: Vec<&TestRun> = experiment.runs.iter().filter(alike).collect();
        if runs.is_empty() {
            return Err(format!("{subject} has no fitted {}", channel.words()));
        }
        let conditions = Conditions::new(&runs);
        let axes = conditions.axes.len();
        let observations = observations(&runs, &conditions, channel);
        let process = GaussianProcess::through(&observations).filter(|_| axes > 0);
        let process = process.ok_or_else(|| match axes {
            0 => format!("{subject} was fitted in one condition"),
            axes => format!(
                "{subject} has {} of {}, and a Gaussian process over {} needs {}",
                number::count(observations.len(), "fitted condition"),
                channel.words(),
                conditions.names(),
                GaussianProcess::min_observations(axes)
            ),
        })?;
        Ok(Surface {
            subject,
            conditions,
            process,
        })
    }

    fn at(&self, run: &TestRun) -> Result<Interpolated, String> {
        if let Some(reason) = self.conditions.reason_beside(&self.subject, run) {
            return Err(reason);
        }
        let point = self.conditions.point(run);
        Ok(Interpolated {
            value: self.process.mean(&point),
            over: match self.process.reaches(&point) {
                true => InterpolatedOver::Conditions,
                false => InterpolatedOver::Extrapolation,
            },
        })
    }
}

/// Averages the repeats of each condition.
fn observations(runs: &[&TestRun], conditions: &Conditions, channel: Channel) -> Vec<Observation> {
    let observation = |members: Vec<usize>| {
        let repeats: Vec<&TestRun> = members.into_iter().map(|i| runs[i]).collect();
        let values = repeats.iter().filter_map(|run| run.measured[channel.index()]);
        Observation {
            point: conditions.mean_point(&repeats),
            value: values.sum::<f64>() / repeats.len() as f64,
            repeats: repeats.len(),
        }
    };
    repeated(runs).into_iter().map(observation).collect()
}
