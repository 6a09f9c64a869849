//! `coordinator check`: validates a job and estimates its cost.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

use super::job_on_disk;
use super::output::say;
use crate::config::CheckArguments;
use crate::embedded::{Evaluate, LocalModels};
use farm::calibration::{Calibration, CalibrationIdentity, SimulationResult};
use job::{AlgorithmSettings, Spec, confounded_orders};
use report::{model_limits, terminal};
use search::untried::additions;
use shared::api::Position;

/// The number of particles of the pilot. It suffices to fit the proposals of the stages, whose number hardly depends on it.
const PILOT_PARTICLES: usize = 300;
/// The longest duration of the pilot, whose evaluations are then extrapolated `[s]`.
const PILOT_S: f64 = 30.0;

pub(super) async fn check(config: &CheckArguments) -> anyhow::Result<()> {
    let job = job_on_disk::read(&config.file, &[])?;
    let allowed = Arc::new(LocalModels::new(&config.models.allow_model).map_err(anyhow::Error::msg)?);
    let models: Vec<Spec> = std::iter::once(job.spec.clone())
        .chain(job.alternatives)
        .collect();
    let mut text = String::new();
    for (number, spec) in models.iter().enumerate() {
        if models.len() > 1 {
            text += &format!(
                "{}model {} of {}\n",
                ["\n", ""][usize::from(number == 0)],
                number + 1,
                models.len()
            );
        }
        text += &terminal::specification(spec);
        for note in model_limits(spec) {
            text += &format!("note: {note}\n");
        }
    }
    if !job.spec.fit_variant.conditions.is_empty() {
        for line in additions(&job.job, &job.experiment, job.spec.model.is_smooth())? {
            text += &format!("note: {line}\n");
        }
    }
    for order in confounded_orders(&job.spec.experiment, &job.spec.fit_runs) {
        text += &format!("warning: {}\n", order.words());
    }
    text += &terminal::rig(&job.spec);
    say(&text)?;
    let several = models.len() > 1;
    let mut core_s = 0.0;
    for spec in models {
        let kind = spec.model.kind.name();
        if spec.model.external.is_some() && config.models.allow_model.is_empty() {
            say(&format!(
                "\n{kind}: the model is not ours; --allow-model lets a pilot run it, to estimate evaluations and hours\n"
            ))?;
            continue;
        }
        let (text, own_s) = cost(spec, Arc::clone(&allowed)).await?;
        core_s += own_s;
        let heading = if several {
            format!("\n{kind}:")
        } else {
            String::new()
        };
        say(&(heading + &text))?;
    }
    if several {
        let hours = core_s / 3600.0;
        say(&format!("\nall models: {hours:.3} expected core hours\n"))?;
    }
    Ok(())
}

/// Estimates the cost of a calibration. Returns it in words, and in seconds of a core.
async fn cost(spec: Spec, models: Arc<LocalModels>) -> anyhow::Result<(String, f64)> {
    let algorithm = spec.algorithm;
    let point_estimates = spec.point_estimates.clone();
    let pilot = tokio::task::spawn_blocking(move || pilot(spec, &models)).await??;
    let evaluations = pilot.expected(algorithm);
    let simulations = evaluations * pilot.runs as f64;
    let core_s = evaluations * pilot.seconds_per_evaluation;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let mut text = pilot.words();
    text += &format!(
        "expected evaluations   {evaluations:>12.0}   (one evaluation: {} run{})\n",
        pilot.runs,
        if pilot.runs == 1 { "" } else { "s" }
    );
    text += &format!("expected simulations   {simulations:>12.0}\n");
    text += &format!("expected core hours    {:>12.3}\n", core_s / 3600.0);
    text += &format!(
        "on {cores} cores            {:>12.3} h = {:.0} s\n",
        core_s / 3600.0 / cores as f64,
        core_s / cores as f64
    );
    for algorithm in point_estimates {
        // The budget is the estimate, because the number of evaluations until convergence is unknown.
        let budget = algorithm.max_evaluations().unwrap_or_default() as f64;
        text += &format!(
            "point estimate {}: at most {:.3} core hours\n",
            algorithm.words(),
            budget * pilot.seconds_per_evaluation / 3600.0
        );
    }
    if pilot.rejected_share > 0.0 {
        text += &format!(
            "the model rejected {:.0} % of the pilot's parameter vectors\n",
            100.0 * pilot.rejected_share
        );
    }
    Ok((text, core_s))
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
                format!("\nThe sampler itself took {evaluations} evaluations.\n")
            }
            AlgorithmSettings::Sample(s) => {
                format!(
                    "\nA pilot of {} particles took {evaluations} evaluations.\n",
                    s.particles
                )
            }
            AlgorithmSettings::Fit(_) => format!("\nThe fit itself took {evaluations} evaluations.\n"),
            AlgorithmSettings::Evolve(_) | AlgorithmSettings::Discover { .. } => {
                format!("\nThe search itself took {evaluations} evaluations.\n")
            }
        };
        let end = match (self.complete, self.algorithm.max_evaluations()) {
            (true, _) => String::new(),
            (false, None) => format!(
                "It was stopped at tempering exponent {:.2e}: what follows is a lower bound.\n",
                self.exponent
            ),
            (false, Some(budget)) => {
                format!(
                    "It was stopped before its end: what follows is its budget of {budget} evaluations.\n"
                )
            }
        };
        ran + &end
    }
}

/// Runs the calibration in memory, with fewer particles where it samples.
fn pilot(mut spec: Spec, models: &LocalModels) -> anyhow::Result<Pilot> {
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
    let simulated_s = simulate(&mut calibration, models)?;
    if let Some(message) = calibration.message {
        anyhow::bail!("the pilot failed: {message}");
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

/// Simulates the calibration's evaluations until it ends, or until the longest duration of a pilot. Returns the seconds that simulations
/// took.
fn simulate(calibration: &mut Calibration, models: &LocalModels) -> anyhow::Result<f64> {
    let mut compiled: BTreeMap<String, Evaluate> = BTreeMap::new();
    let began = Instant::now();
    let mut simulated_s = 0.0;
    while calibration.engine().finding().is_none() && !calibration.state.is_final() {
        if began.elapsed().as_secs_f64() > PILOT_S {
            break;
        }
        for evaluation in calibration.queue.asked() {
            let Some(question) = calibration.question(evaluation) else {
                break;
            };
            if !compiled.contains_key(question.variant)
                && let Some(variant) = calibration.variant(question.variant)
            {
                let model = Evaluate::with(variant, models).map_err(anyhow::Error::msg)?;
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
        }
    }
    Ok(simulated_s)
}
