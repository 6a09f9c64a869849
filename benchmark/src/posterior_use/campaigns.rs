//! Decisions over synthetic campaigns: by the expected loss over the posterior, and by the loss at the most probable parameters.
//!
//! A truth is drawn from the prior, six runs are simulated with it and noise is added. The calibration of these runs decides by the file of
//! the example `slope-decision`. What a choice costs is its expected loss at the truth.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

use coordinator::embedded::Evaluate;
use job::{ConditionDefaults, Spec, read_decision};
use prediction::decision::{decide, decision_runs};
use prediction::{DecisionAnswer, Ensemble};
use result::{FinishedCalibration, Study};
use shared::channel::Channel;
use shared::experiment::read_wheels;
use shared::file::FileSet;
use shared::outcome::Outcome;
use statistics::rng::Stream;

use super::finished::{at, finished, simulate};
use crate::error::StudyError;
use crate::parallel::each;

const DECISION: &str = include_str!("../../../examples/slope-decision/decision.toml");
const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\n[soil.s]\n[noise]\ndrawbar_pull_n = 3.0\ntorque_n_m = 0.4\nsinkage_m = 0.001\n";
const JOB: &str = "[model]\nkind = \"quasi_static\"\n[priors]\nlog10_p_ref = { uniform = [4.0, 5.6] }\nkappa = 0.0\nn = { normal = [1.1, 0.2], bounds = [0.8, 2.0] }\nfriction_angle_deg = { normal = [24.0, 5.0], bounds = [11.5, 45.0] }\nwheel_radius_m = { uniform = [0.125, 0.155] }\n\"janosi_hanamoto.shear_modulus_m\" = { lognormal = [0.01, 1.8] }\n[sampler]\nparticles = 400\n";
const CONDITIONS: [&str; 6] = [
    "a,w,s,0.05,60,0.02",
    "b,w,s,0.15,60,0.02",
    "c,w,s,0.3,60,0.02",
    "d,w,s,0.05,120,0.02",
    "e,w,s,0.15,120,0.02",
    "f,w,s,0.3,120,0.02",
];
/// The measured channels with their noise.
const MEASURED: [(Channel, f64); 3] = [
    (Channel::DrawbarPull, 3.0),
    (Channel::Torque, 0.4),
    (Channel::Sinkage, 0.001),
];
/// The first random stream of this study, which no sampler uses.
const STAGE: u64 = 1 << 46;
/// The largest number of consecutive draws of the prior that the model may refuse.
const MAX_REFUSED: u64 = 1000;
/// Copies of the truth that stand for a posterior: their errors give the expected loss.
const COPIES: usize = 40;

/// What the choices of one campaign cost at its truth.
#[derive(Debug, Clone, Copy)]
pub struct Campaign {
    /// Expected loss of the choice by the posterior.
    pub by_posterior: f64,
    /// Expected loss of the choice by the most probable parameters.
    pub by_mode: f64,
    /// Least expected loss of all options.
    pub least: f64,
    /// Whether the two choices differ.
    pub differs: bool,
    /// Expected loss that the posterior stated for its choice.
    pub stated: f64,
}

/// What the choices of many campaigns cost.
#[derive(Debug)]
pub struct Tally(pub Vec<Campaign>);

impl Tally {
    /// Returns the mean of a value over the campaigns, with its standard error.
    pub fn mean(&self, value: impl Fn(&Campaign) -> f64) -> [f64; 2] {
        let values: Vec<f64> = self.0.iter().map(value).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
        [mean, (squares / (count - 1.0) / count).sqrt()]
    }

    /// Returns by how much the loss of the point estimate's choice exceeds that of the posterior's, with its standard error.
    pub fn gain(&self) -> [f64; 2] {
        self.mean(|campaign| campaign.by_mode - campaign.by_posterior)
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let differ: Vec<&Campaign> = self.0.iter().filter(|campaign| campaign.differs).collect();
        let better = differ.iter().filter(|c| c.by_posterior < c.by_mode).count();
        writeln!(
            f,
            "{} campaigns; the choices differ in {}, that of the posterior costs less in {better} of these",
            self.0.len(),
            differ.len()
        )?;
        for (name, [mean, error]) in [
            ("choice by expected loss", self.mean(|c| c.by_posterior)),
            ("choice by the most probable parameters", self.mean(|c| c.by_mode)),
            ("best option, if the truth were known", self.mean(|c| c.least)),
            (
                "loss that the posterior states for its choice",
                self.mean(|c| c.stated),
            ),
            ("point estimate less posterior", self.gain()),
        ] {
            writeln!(f, "  {name:<46} {mean:>8.0} ± {error:.0}")?;
        }
        Ok(())
    }
}

/// Decides in a number of campaigns, on all threads of the machine.
pub fn run(count: u64, seed: u64) -> Result<Tally, StudyError> {
    Ok(Tally(each(count, |number| campaign(number, seed))?))
}

fn campaign(number: u64, seed: u64) -> Result<Campaign, StudyError> {
    for attempt in 0..MAX_REFUSED {
        let blank = spec(&[[0.0; 3]; 6], seed)?;
        let mut stream = Stream::new(seed, STAGE, number, attempt);
        let truth = blank.prior().sample(&mut stream);
        let model = Evaluate::new(&blank.fit_variant)?;
        let Outcome::Evaluated(seen) = model.evaluate(blank.model_theta(&truth)) else {
            continue;
        };
        let noise = Stream::new(seed, STAGE + 1, number, 0).normals(18);
        let row = |run: usize| {
            std::array::from_fn(|k| {
                let (channel, sd) = MEASURED[k];
                seen.channel(channel)[run] + sd * noise[3 * run + k]
            })
        };
        let rows: [[f64; 3]; 6] = std::array::from_fn(row);
        let spec = spec(&rows, seed + 1 + number)?;
        // A truth that the model refuses on a way up the bank is no campaign.
        let Ok(losses) = decided(at(spec.clone(), vec![truth; 1 + COPIES])?) else {
            continue;
        };
        let decided = decided(finished(spec)?)?;
        let cost = |name: &Option<String>| {
            let option = losses
                .options
                .iter()
                .find(|option| Some(&option.name) == name.as_ref());
            option.map_or(f64::NAN, |option| option.expected_loss)
        };
        let stated = decided
            .options
            .iter()
            .find(|option| Some(&option.name) == decided.best.as_ref());
        let least = losses.options.iter().map(|option| option.expected_loss);
        return Ok(Campaign {
            by_posterior: cost(&decided.best),
            by_mode: cost(&decided.best_at_mode),
            least: least.fold(f64::INFINITY, f64::min),
            differs: decided.best != decided.best_at_mode,
            stated: stated.map_or(f64::NAN, |option| option.expected_loss),
        });
    }
    Err(format!("the model refused {MAX_REFUSED} draws of the prior in a row").into())
}

/// Returns the specification of a calibration of measured rows.
fn spec(rows: &[[f64; 3]; 6], seed: u64) -> Result<Spec, StudyError> {
    let mut runs = "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s".to_owned();
    for (channel, _) in MEASURED {
        runs += &format!(",{}", channel.column());
    }
    for (condition, row) in CONDITIONS.iter().zip(rows) {
        runs += &format!("\n{condition},{},{},{}", row[0], row[1], row[2]);
    }
    let files = FileSet {
        toml: EXPERIMENT.into(),
        files: [("runs.csv".to_owned(), runs + "\n")].into(),
    };
    let job = FileSet {
        toml: format!("{JOB}seed = {seed}\n"),
        files: Default::default(),
    };
    Ok(Spec::new("job.toml", &job, "experiment.toml", &files)?)
}

/// Decides by a posterior. Constraints are left out, so that every campaign has a choice by the losses alone.
fn decided(calibration: FinishedCalibration) -> Result<DecisionAnswer, StudyError> {
    let (mut decision, wheels) = read_decision("decision.toml", DECISION)?;
    decision.constraints.clear();
    let wheels: BTreeMap<_, _> = read_wheels("decision.toml", &wheels)?;
    let ensemble = Ensemble::new(Study::from(calibration), 1, wheels)?;
    let experiment = Arc::clone(&ensemble.asked().spec.experiment);
    let defaults = ConditionDefaults::new(&experiment, ensemble.wheels());
    let (runs, scenarios) = decision_runs(&decision, &defaults)?;
    let simulated = ensemble.simulate(runs, None, |question| simulate(&question))?;
    Ok(decide(&simulated, &decision, &scenarios)?)
}
