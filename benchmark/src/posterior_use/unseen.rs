//! Predictions of unseen conditions of the example `hidden-effect`, by its base model and by the repaired one, against the truth that made
//! the data, beside interpolation.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use coordinator::embedded::Evaluate;
use job::{ConditionDefaults, Spec};
use prediction::prediction::{PredictedQuantity, predict};
use prediction::{Ensemble, Prediction, planned_runs};
use record::Extension;
use result::{Interpolations, Study};
use search::candidate::extended;
use shared::channel::Channel;
use shared::file::FileSet;
use shared::model::ModelVariant;
use shared::outcome::Outcome;
use statistics::rng::Stream;

use super::finished::{finished, simulate};
use crate::error::StudyError;

const JOB: &str = include_str!("../../../examples/hidden-effect/job.toml");
const EXPERIMENT: &str = include_str!("../../../examples/hidden-effect/experiment.toml");
const RUNS: &str = include_str!("../../../examples/hidden-effect/runs.csv");
const HIDDEN: &str = "janosi_hanamoto";
/// The parameters that made the data: `k_phi` of 7.499e6 with `k_c` = 0 is a pressure of 44.2 kPa at 10 mm.
const TRUTH: [(&str, f64); 5] = [
    ("log10_p_ref", 4.645_144_539_570_086),
    ("n", 1.114_937_276_875_425_4),
    ("friction_angle_deg", 29.725_862_144_637_787),
    ("wheel_radius_m", 0.129_152_900_659_868_29),
    ("janosi_hanamoto.shear_modulus_m", 0.01),
];
/// The measured channels, with the declared noise and the factor to the unit in which they are shown.
const CHANNELS: [(Channel, f64, f64); 3] = [
    (Channel::DrawbarPull, 1.2, 1.0),
    (Channel::Torque, 0.15, 1.0),
    (Channel::Sinkage, 0.0004, 1e3),
];
/// The random stream of the conditions, which no sampler uses.
const STAGE: u64 = 1 << 45;
/// The condition whose slope is printed.
const SLOPE: &str = "run,slip,wheel_load_n,sled_speed_m_s\nslope,0.2,100,0.016\n";

/// Errors and coverage of one channel.
#[derive(Debug, Clone, Copy, Default)]
pub struct Judged {
    /// Sums of squared errors of the model, of the corrected model and of interpolation, with their counts.
    squares: [(f64, usize); 3],
    /// New measurements inside the intervals of the model and of the corrected model.
    inside: [usize; 2],
}

/// The predictions of one model.
#[derive(Debug)]
pub struct Unseen {
    name: &'static str,
    channels: [Judged; 3],
    conditions: usize,
    /// Mean of the slope, and its intervals by parameters and for a new measurement `[deg]`.
    slope: [f64; 5],
    true_slope: f64,
}

impl Unseen {
    /// Returns the share of new measurements inside the model's 90 % intervals.
    pub fn coverage(&self) -> f64 {
        let inside: usize = self.channels.iter().map(|judged| judged.inside[0]).sum();
        inside as f64 / (3 * self.conditions) as f64
    }

    /// Returns the root mean square error of a channel by the model, corrected, and by interpolation, in SI units.
    pub fn errors(&self, channel: usize) -> [f64; 3] {
        self.channels[channel]
            .squares
            .map(|(sum, count)| (sum / count as f64).sqrt())
    }
}

impl fmt::Display for Unseen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} of {} unseen conditions", self.name, self.conditions)?;
        let share = |inside: usize| 100.0 * inside as f64 / self.conditions as f64;
        for (k, (channel, _, factor)) in CHANNELS.iter().enumerate() {
            let [model, corrected, interpolated] = self.errors(k).map(|error| error * factor);
            let [inside, inside_corrected] = self.channels[k].inside.map(share);
            writeln!(
                f,
                "  {:<13} error {model:.3}, corrected {corrected:.3}, interpolation {interpolated:.3}; inside 90 %: {inside:.1} %, corrected \
                 {inside_corrected:.1} %",
                channel.words()
            )?;
        }
        let [mean, low, high, new_low, new_high] = self.slope;
        writeln!(f, "  all channels inside 90 %: {:.1} %", 100.0 * self.coverage())?;
        writeln!(
            f,
            "  slope at slip 0.2: {mean:.2} deg, parameters {low:.2} to {high:.2}, new measurement {new_low:.2} to {new_high:.2}; truth {:.2}",
            self.true_slope
        )
    }
}

/// Predicts a number of conditions by the base model and by the repaired one.
pub fn run(count: u64, seed: u64) -> Result<Vec<Unseen>, StudyError> {
    let job = FileSet {
        toml: JOB.into(),
        files: BTreeMap::new(),
    };
    let repaired = extended("job.toml", &job, &[&Extension::Effect(HIDDEN.into())])?;
    let truth = Truth::new(spec(&repaired)?)?;
    let judge = |(name, job): (&'static str, &FileSet)| judged(name, spec(job)?, &truth, count, seed);
    [("base", &job), ("with the hidden effect", &repaired)]
        .into_iter()
        .map(judge)
        .collect()
}

fn spec(job: &FileSet) -> Result<Spec, StudyError> {
    let experiment = FileSet {
        toml: EXPERIMENT.into(),
        files: [("runs.csv".to_owned(), RUNS.to_owned())].into(),
    };
    Ok(Spec::new("job.toml", job, "experiment.toml", &experiment)?)
}

/// The model that made the data.
struct Truth {
    variant: ModelVariant,
    theta: Vec<f64>,
}

impl Truth {
    fn new(spec: Spec) -> Result<Truth, StudyError> {
        let value = |name: &String| {
            let known = TRUTH.iter().find(|(known, _)| known == name);
            known
                .map(|(_, value)| *value)
                .ok_or_else(|| format!("no truth of {name}").into())
        };
        let theta: Result<Vec<f64>, StudyError> = spec.fit_variant.parameters.iter().map(value).collect();
        Ok(Truth {
            theta: theta?,
            variant: spec.fit_variant,
        })
    }

    /// Returns the channels of the condition of a variant.
    fn at(&self, asked: &ModelVariant) -> Result<[f64; 3], StudyError> {
        let variant = ModelVariant {
            conditions: asked.conditions.clone(),
            ..self.variant.clone()
        };
        match Evaluate::new(&variant)?.evaluate(&self.theta) {
            Outcome::Evaluated(seen) => Ok(CHANNELS.map(|(channel, _, _)| seen.channel(channel)[0])),
            other => Err(format!("the truth is refused: {other:?}").into()),
        }
    }
}

/// Returns the conditions as a plan: slips, loads and rim speeds of the fitted and held-out runs, at random.
fn plan(count: u64, seed: u64) -> String {
    let mut text = "slip,wheel_load_n,sled_speed_m_s\n".to_owned();
    for number in 0..count {
        let mut stream = Stream::new(seed, STAGE, number, 0);
        let slip = 0.05 + 0.65 * stream.uniform();
        let load = 50.0 + 100.0 * stream.uniform();
        let rim = 0.01 * libm::pow(8.0, stream.uniform());
        text += &format!("{slip},{load},{}\n", rim * (1.0 - slip));
    }
    text
}

fn judged(
    name: &'static str,
    spec: Spec,
    truth: &Truth,
    count: u64,
    seed: u64,
) -> Result<Unseen, StudyError> {
    let mut experiment = (*spec.experiment).clone();
    let ensemble = Ensemble::new(Study::from(finished(spec)?), 1, BTreeMap::new())?;
    let asked = Arc::clone(&ensemble.asked().spec.experiment);
    let defaults = ConditionDefaults::new(&asked, ensemble.wheels());
    let mut runs = planned_runs(Some(&plan(count, seed)), None, &defaults)?;
    runs.extend(planned_runs(Some(SLOPE), None, &defaults)?);
    let variants = RefCell::new(Vec::new());
    let simulated = ensemble.simulate(runs.clone(), None, |question| {
        variants.borrow_mut().clone_from(&question.variants);
        simulate(&question)
    })?;
    let true_values: Vec<[f64; 3]> = variants
        .borrow()
        .iter()
        .map(|variant| truth.at(variant))
        .collect::<Result<_, _>>()?;
    let predicted = predict(&simulated, &[]);
    let first = experiment.runs.len();
    for (planned, values) in runs.iter().zip(&true_values) {
        let mut run = planned.run.clone();
        for ((channel, _, _), value) in CHANNELS.iter().zip(values) {
            run.measured[channel.index()] = Some(*value);
        }
        experiment.runs.push(run);
    }
    let interpolations = Interpolations::new(&experiment);
    let mut channels = [Judged::default(); 3];
    for (i, values) in true_values.iter().enumerate().take(count as usize) {
        let noise = Stream::new(seed, STAGE + 1, i as u64, 0).normals(3);
        for (k, (channel, sd, _)) in CHANNELS.iter().enumerate() {
            let quantity = quantity(&predicted, i, channel.column())?;
            let interpolated = interpolations.at(first + i, *channel).map(|found| found.value);
            let judged = &mut channels[k];
            let estimates = [Some(quantity.mean), quantity.corrected, interpolated];
            for (squares, estimate) in judged.squares.iter_mut().zip(estimates) {
                if let Some(estimate) = estimate {
                    squares.0 += (estimate - values[k]).powi(2);
                    squares.1 += 1;
                }
            }
            let measured = values[k] + sd * noise[k];
            let intervals = [quantity.measurement, quantity.corrected_measurement];
            for (inside, interval) in judged.inside.iter_mut().zip(intervals) {
                *inside += usize::from(interval.is_some_and(|[low, high]| (low..=high).contains(&measured)));
            }
        }
    }
    let slope = quantity(&predicted, count as usize, "balanced_slope_deg")?;
    let [low, high] = slope.parameters;
    let [new_low, new_high] = slope.measurement.unwrap_or([f64::NAN; 2]);
    let pull = true_values.last().map_or(f64::NAN, |values| values[0]);
    Ok(Unseen {
        name,
        channels,
        conditions: count as usize,
        slope: [slope.mean, low, high, new_low, new_high],
        true_slope: libm::atan(pull / 100.0).to_degrees(),
    })
}

fn quantity<'a>(
    predicted: &'a Prediction,
    run: usize,
    name: &str,
) -> Result<&'a PredictedQuantity, StudyError> {
    let mut quantities = predicted.runs[run].quantities.iter();
    let found = quantities.find(|quantity| quantity.name == name);
    found.ok_or_else(|| format!("run {run} has no prediction of {name}").into())
}
