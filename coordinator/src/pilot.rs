//! A pilot: a smaller calibration in this process, from which the cost of a job is estimated before anything is stored.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use serde::Serialize;
use utoipa::ToSchema;

use crate::embedded::{Evaluate, LocalModels};
use farm::calibration::{BeginError, Calibration, CalibrationIdentity, ResultError, SimulationResult};
use job::{AlgorithmSettings, Spec};
use shared::api::Position;

/// The number of particles of the pilot. It suffices to fit the proposals of the stages, whose number hardly depends on it.
const PILOT_PARTICLES: usize = 300;

/// Why a pilot states no cost.
#[derive(Debug, thiserror::Error)]
pub enum PilotError {
    /// The algorithm of the job cannot begin.
    #[error(transparent)]
    Begin(#[from] BeginError),
    /// The model cannot be compiled.
    #[error("{0}")]
    Model(String),
    /// The model returned what no result is.
    #[error(transparent)]
    Result(#[from] ResultError),
    /// The algorithm failed.
    #[error("the pilot failed: {0}")]
    Failed(String),
}

/// The expected cost of a calibration, without the search that may follow it.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct JobCost {
    /// Number of evaluations.
    pub evaluations: f64,
    /// Number of simulations in one evaluation.
    pub runs: usize,
    /// Time of all simulations on one core `[s]`.
    pub core_s: f64,
    /// Number of cores of the machine that answers.
    pub cores: usize,
    /// Whether the pilot was stopped before its end, so that the calibration takes longer than this.
    pub is_lower_bound: bool,
    /// Share of the parameter vectors that the model rejected.
    pub rejected_share: f64,
    /// What the pilot was, in sentences.
    pub pilot: String,
}

impl JobCost {
    /// Returns the number of simulations.
    pub fn simulations(&self) -> f64 {
        self.evaluations * self.runs as f64
    }

    /// Returns the time of an evaluation on one core `[s]`.
    pub fn seconds_per_evaluation(&self) -> f64 {
        self.core_s / self.evaluations
    }
}

/// Estimates the cost of a calibration by a pilot, whose evaluations are extrapolated. It blocks.
///
/// # Arguments
/// - `longest_s`: longest duration of the pilot `[s]`.
///
/// # Errors
/// The model cannot be evaluated here, or the pilot fails.
pub fn job_cost(spec: Spec, models: &LocalModels, longest_s: f64) -> Result<JobCost, PilotError> {
    let algorithm = spec.algorithm;
    let pilot = pilot(spec, models, longest_s)?;
    let evaluations = pilot.expected(algorithm);
    Ok(JobCost {
        evaluations,
        runs: pilot.runs,
        core_s: evaluations * pilot.seconds_per_evaluation,
        cores: std::thread::available_parallelism().map_or(1, usize::from),
        is_lower_bound: !pilot.complete && pilot.algorithm.max_evaluations().is_none(),
        rejected_share: pilot.rejected_share,
        pilot: pilot.words(),
    })
}

struct Pilot {
    /// The algorithm that ran: a smaller sampler, or the fit or the search itself.
    algorithm: AlgorithmSettings,
    evaluations: u64,
    runs: usize,
    seconds_per_evaluation: f64,
    rejected_share: f64,
    exponent: f64,
    complete: bool,
}

impl Pilot {
    /// Returns the expected number of evaluations of the whole job. The number of stages hardly depends on the number of particles; a fit
    /// or a search has run as a whole.
    fn expected(&self, algorithm: AlgorithmSettings) -> f64 {
        match (algorithm, self.algorithm) {
            // The evaluations on an emulator do not depend on the number of particles.
            (AlgorithmSettings::Sample(whole), AlgorithmSettings::Sample(small)) if !whole.is_emulated() => {
                self.evaluations as f64 * whole.particles as f64 / small.particles as f64
            }
            (whole, _) if !self.complete => whole
                .max_evaluations()
                .map_or(self.evaluations as f64, |budget| budget as f64),
            _ => self.evaluations as f64,
        }
    }

    /// Describes the algorithm that ran, and how far it came.
    fn words(&self) -> String {
        let evaluations = self.evaluations;
        let ran = match self.algorithm {
            AlgorithmSettings::Sample(s) if s.is_emulated() => {
                format!("The sampler itself took {evaluations} evaluations.")
            }
            AlgorithmSettings::Sample(s) => {
                format!(
                    "A pilot of {} particles took {evaluations} evaluations.",
                    s.particles
                )
            }
            AlgorithmSettings::Fit(_) => format!("The fit itself took {evaluations} evaluations."),
            AlgorithmSettings::Evolve(_) | AlgorithmSettings::Discover { .. } => {
                format!("The search itself took {evaluations} evaluations.")
            }
        };
        let end = match (self.complete, self.algorithm.max_evaluations()) {
            (true, _) => String::new(),
            (false, None) => format!(
                "\nIt was stopped at tempering exponent {:.2e}: what follows is a lower bound.",
                self.exponent
            ),
            (false, Some(budget)) => {
                format!(
                    "\nIt was stopped before its end: what follows is its budget of {budget} evaluations."
                )
            }
        };
        ran + &end
    }
}

/// Runs the calibration in memory, with fewer particles where it samples.
fn pilot(mut spec: Spec, models: &LocalModels, longest_s: f64) -> Result<Pilot, PilotError> {
    let least = PILOT_PARTICLES.max(2 * spec.parameters.len() + 2);
    if let AlgorithmSettings::Sample(settings) = &mut spec.algorithm {
        settings.particles = settings.particles.min(least);
    }
    let algorithm = spec.algorithm;
    // Derivatives with respect to the stiffness need a second simulation of each condition.
    let runs = spec.fit_runs.len()
        * if spec.fit_variant.stiffness_sensitivity {
            2
        } else {
            1
        };
    let identity = CalibrationIdentity {
        id: 0,
        name: "pilot".into(),
        study: 0,
        experiment: 0,
    };
    let mut calibration = Calibration::new(identity, Arc::new(spec))?;
    let simulated_s = simulate(&mut calibration, models, longest_s)?;
    if let Some(message) = calibration.message {
        return Err(PilotError::Failed(message));
    }
    let evaluations = calibration.cost.evaluations.max(1);
    Ok(Pilot {
        algorithm,
        evaluations,
        runs,
        seconds_per_evaluation: simulated_s / evaluations as f64,
        rejected_share: calibration.cost.rejected as f64 / evaluations as f64,
        exponent: match calibration.engine().position() {
            Position::Sampler {
                tempering_exponent, ..
            } => tempering_exponent,
            Position::Fit { .. } | Position::Evolution { .. } | Position::Search { .. } => 1.0,
        },
        complete: calibration.engine().finding().is_some(),
    })
}

/// Simulates the calibration's evaluations, one at least, until it ends, or until the longest duration of a pilot. Returns the seconds that
/// simulations took.
fn simulate(calibration: &mut Calibration, models: &LocalModels, longest_s: f64) -> Result<f64, PilotError> {
    let mut compiled: BTreeMap<String, Evaluate> = BTreeMap::new();
    let began = Instant::now();
    let is_over = || began.elapsed().as_secs_f64() > longest_s;
    let mut simulated_s = 0.0;
    while calibration.engine().finding().is_none() && !calibration.state.is_final() {
        for evaluation in calibration.queue.asked() {
            let Some(question) = calibration.question(evaluation) else {
                break;
            };
            if !compiled.contains_key(question.variant)
                && let Some(variant) = calibration.variant(question.variant)
            {
                let model = Evaluate::with(variant, models).map_err(PilotError::Model)?;
                compiled.insert(question.variant.to_owned(), model);
            }
            let Some(model) = compiled.get(question.variant) else {
                break;
            };
            let start = Instant::now();
            let outcome = model.evaluate(question.theta);
            simulated_s += start.elapsed().as_secs_f64();
            calibration.complete(evaluation, SimulationResult::new(outcome)?, "pilot")?;
            calibration.step();
            // A round of a slow model may take hours.
            if is_over() {
                return Ok(simulated_s);
            }
        }
        if is_over() {
            break;
        }
    }
    Ok(simulated_s)
}

#[cfg(test)]
mod tests {
    use shared::file::FileSet;

    use super::*;
    use crate::example::EXAMPLES;

    #[test]
    fn a_pilot_ends_within_a_round() {
        let example = EXAMPLES[1];
        let set = |toml: &str, files: &[(&str, &str)]| FileSet {
            toml: toml.to_owned(),
            files: files
                .iter()
                .map(|&(name, text)| (name.to_owned(), text.to_owned()))
                .collect(),
        };
        let (job, experiment) = (set(example.job.1, &[]), set(example.experiment.1, example.files));
        let spec = Spec::new(example.job.0, &job, example.experiment.0, &experiment);
        let spec = spec.expect("the example is valid");
        let pilot = pilot(spec, &LocalModels::default(), 0.0).expect("it runs");
        assert_eq!((pilot.evaluations, pilot.complete), (1, false));
        assert!(pilot.seconds_per_evaluation > 0.0);
    }
}
