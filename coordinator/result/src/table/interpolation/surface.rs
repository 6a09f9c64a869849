//! Interpolation over all conditions that vary, by a Gaussian process.

use std::collections::BTreeMap;

use inference::gaussian_process::{GaussianProcess, Observation};
use job::repeats;
use shared::channel::Channel;
use shared::experiment::{Experiment, RunUse, TestRun};

use super::axis::Axis;
use super::interpolated::{Interpolated, InterpolatedOver};
use crate::words::number;

/// What one process is through: wheel, soil, pass, channel.
type Key = (String, String, u32, Channel);

/// The processes of an experiment, made when first asked for.
pub(super) struct Surfaces<'a> {
    experiment: &'a Experiment,
    known: BTreeMap<Key, Result<Surface, String>>,
}

impl<'a> Surfaces<'a> {
    pub(super) fn new(experiment: &'a Experiment) -> Self {
        Surfaces {
            experiment,
            known: BTreeMap::new(),
        }
    }

    /// The value at a run, or why there is none.
    pub(super) fn at(&mut self, run: &TestRun, channel: Channel) -> Result<Interpolated, String> {
        let key = (run.wheel.clone(), run.soil.clone(), run.pass, channel);
        let experiment = self.experiment;
        let make = || Surface::through(experiment, run, channel);
        self.known
            .entry(key)
            .or_insert_with(make)
            .as_ref()
            .map_err(Clone::clone)?
            .at(run)
    }
}

/// A process through the measurements of a channel.
struct Surface {
    /// The wheel, soil and pass.
    of: String,
    /// The conditions that vary.
    axes: Vec<Axis>,
    /// Those that do not.
    held: Vec<Axis>,
    /// The fitted runs, which have their values.
    fitted: Vec<TestRun>,
    process: GaussianProcess,
}

impl Surface {
    /// Through the fitted runs of a run's wheel, soil and pass.
    fn through(experiment: &Experiment, like: &TestRun, channel: Channel) -> Result<Self, String> {
        let mut of = format!("wheel {} on soil {}", like.wheel, like.soil);
        if like.pass > 1 {
            of += &format!(" at pass {}", like.pass);
        }
        let alike = |run: &&TestRun| {
            run.usage == RunUse::Fit
                && (&run.wheel, &run.soil, run.pass) == (&like.wheel, &like.soil, like.pass)
                && run.measured[channel.index()].is_some()
        };
        let runs: Vec<&TestRun> = experiment.runs.iter().filter(alike).collect();
        if runs.is_empty() {
            return Err(format!("{of} has no fitted {}", channel.words()));
        }
        let (axes, held): (Vec<Axis>, Vec<Axis>) =
            Axis::of(&runs).into_iter().partition(|axis| axis.varies(&runs));
        let observations = observations(&runs, &axes, channel);
        let process = GaussianProcess::through(&observations).filter(|_| !axes.is_empty());
        let process = process.ok_or_else(|| {
            let names: Vec<String> = axes.iter().map(|axis| axis.words().to_owned()).collect();
            match axes.is_empty() {
                true => format!("{of} was fitted in one condition"),
                false => format!(
                    "{of} has {} of {}, and a Gaussian process over {} needs {}",
                    number::count(observations.len(), "fitted condition"),
                    channel.words(),
                    number::list(&names),
                    GaussianProcess::least_observations(axes.len())
                ),
            }
        })?;
        Ok(Surface {
            of,
            axes,
            held,
            fitted: runs.into_iter().cloned().collect(),
            process,
        })
    }

    fn at(&self, run: &TestRun) -> Result<Interpolated, String> {
        let is_fitted = |axis: &Axis| self.fitted.iter().any(|own| axis.is_same(own, run));
        if let Some(axis) = self.held.iter().find(|axis| !is_fitted(axis)) {
            return Err(self.beside(*axis, run));
        }
        let point: Vec<f64> = self.axes.iter().map(|axis| axis.value(run)).collect();
        Ok(Interpolated {
            value: self.process.mean(&point),
            over: match self.process.reaches(&point) {
                true => InterpolatedOver::Conditions,
                false => InterpolatedOver::Extrapolation,
            },
        })
    }

    /// Why there is no value at a run beside the one level of a condition. The loads of a rig that does not hold them are one level,
    /// and scatter.
    fn beside(&self, axis: Axis, run: &TestRun) -> String {
        let fitted: Vec<&TestRun> = self.fitted.iter().collect();
        if axis != Axis::WheelLoad || axis.count(&fitted) == 1 {
            return format!("{} was fitted at one {} alone", self.of, axis.words());
        }
        let loads = || fitted.iter().map(|own| axis.value(own));
        let (least, most) = loads().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), load| {
            (least.min(load), most.max(load))
        });
        let [least, most, own] = [least, most, axis.value(run)].map(|load| number::significant(load, 3));
        format!(
            "{} was fitted at loads of {least} to {most} N, and not at {own} N",
            self.of
        )
    }
}

/// The means of the repeats of each condition; a run joins the first that it repeats.
fn observations(runs: &[&TestRun], axes: &[Axis], channel: Channel) -> Vec<Observation> {
    let mut conditions: Vec<Vec<&TestRun>> = Vec::new();
    for &run in runs {
        match conditions.iter_mut().find(|own| repeats(own[0], run)) {
            Some(own) => own.push(run),
            None => conditions.push(vec![run]),
        }
    }
    let mean = |own: &[&TestRun], of: &dyn Fn(&TestRun) -> f64| {
        own.iter().map(|run| of(run)).sum::<f64>() / own.len() as f64
    };
    let observation = |own: &Vec<&TestRun>| Observation {
        point: axes
            .iter()
            .map(|axis| mean(own, &|run| axis.value(run)))
            .collect(),
        value: mean(own, &|run| run.measured[channel.index()].unwrap_or_default()),
        repeats: own.len(),
    };
    conditions.iter().map(observation).collect()
}
