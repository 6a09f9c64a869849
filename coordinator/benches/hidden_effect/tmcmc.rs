//! The search's log Bayes factors beside those of full evidences by the sampler.

use std::sync::Arc;

use coordinator::calibration::{Calibration, CalibrationIdentity, CalibrationResult, result_of};
use coordinator::embedded::Evaluate;
use coordinator::missing_effect::candidate::extended;
use record::Extension;
use shared::file::FileSet;
use shared::outcome::Outcome;

use crate::study::case::{SyntheticCase, spec};
use crate::study::design::Plan;
use crate::study::error::StudyError;
use crate::study::parallel::each;

use crate::study::local_search::LocalSearch;
use crate::study::rate::{mean, median};
use crate::study::trial::draw_detectable;

/// Fewer repeat worse than the factors are read to \[DISCOVERY 1\].
const SAMPLER: &str = "[sampler]\nparticles = 1000\nmoves = [5, 10]\n";
/// Differences that no verdict turns on \[nats\].
const CLOSE: f64 = 1.0;
/// The truths are others than those of the other kinds.
const FIRST: u64 = 2_000_000;

/// One effect, and what both say of the best: nats.
struct Compared {
    search: f64,
    sampler: f64,
}

/// Compares so many and prints the differences.
pub(crate) fn run(count: u64, seed: u64) -> Result<(), StudyError> {
    let compared = each(count, |number| one(seed, number))?;
    let compared: Vec<Compared> = compared.into_iter().collect::<Result<_, StudyError>>()?;
    let differences: Vec<f64> = compared.iter().map(|c| c.search - c.sampler).collect();
    let [bias, error] = mean(&differences);
    let sd = error * (differences.len() as f64).sqrt();
    let close = differences.iter().filter(|d| d.abs() <= CLOSE).count();
    println!(
        "search less sampler: mean {bias:.2} ± {error:.2} nats, sd {sd:.2}, median {:.2}; {close} of {count} within {CLOSE}",
        median(&differences)
    );
    Ok(())
}

fn one(seed: u64, number: u64) -> Result<Compared, StudyError> {
    let case = draw_detectable(Plan::Full, 1, seed, FIRST + number)?;
    let mut local = LocalSearch::new(&case.plan.job(), &case.experiment(), 1)?;
    let conclusion = local.run()?;
    let effects = conclusion
        .ranking
        .effects
        .iter()
        .filter(|j| j.candidate.is_some());
    let best = effects.reduce(|a, b| {
        if b.log_bayes_factor > a.log_bayes_factor {
            b
        } else {
            a
        }
    });
    let best = best.ok_or("nothing was judged")?;
    let name = best
        .candidate
        .map(|k| local.models.task().library[k].name.clone());
    let name = name.ok_or("the best has no name")?;
    let base = Sampled::new(&case, &case.plan.job(), seed)?;
    let added = Extension::Effect(name.clone());
    let job = extended("job.toml", &case.plan.job(), &[&added])?;
    let with = Sampled::new(&case, &job, seed)?;
    let compared = Compared {
        search: best.log_bayes_factor,
        sampler: with.log_evidence - base.log_evidence,
    };
    let own = conclusion.best.effects.as_slice() == best.candidate.as_slice();
    let fitted = own.then(|| conclusion.best.draws.first()).flatten();
    println!(
        "tmcmc {number} {} hidden, {name} best: search {:.2} ({:?}), sampler {:.2}; highest ln L of the base {:.1} and {:.1}, with it {:.1} and {:.1}",
        case.hidden[0],
        compared.search,
        best.method,
        compared.sampler,
        log_likelihood(&case, &case.plan.job(), conclusion.base.draws.first())?,
        base.highest,
        log_likelihood(&case, &job, fitted)?,
        with.highest
    );
    Ok(compared)
}

/// ln p(data | theta) where the search ended; NaN where it ended elsewhere.
fn log_likelihood(case: &SyntheticCase, job: &FileSet, theta: Option<&Vec<f64>>) -> Result<f64, StudyError> {
    let spec = spec(job, &case.experiment())?;
    let Some(theta) = theta else {
        return Ok(f64::NAN);
    };
    let Outcome::Evaluated(seen) = Evaluate::new(&spec.fit_variant)?.evaluate(spec.model_theta(theta)) else {
        return Ok(f64::NAN);
    };
    let scored = spec
        .likelihood
        .log_likelihood(&spec.predicted_values(&seen), theta);
    Ok(scored?.value())
}

/// What the sampler says of a job.
struct Sampled {
    log_evidence: f64,
    /// The highest ln p(data | theta) among the particles.
    highest: f64,
}

impl Sampled {
    fn new(case: &SyntheticCase, job: &FileSet, seed: u64) -> Result<Self, StudyError> {
        let job = FileSet {
            toml: format!("{}{SAMPLER}seed = {seed}\n", job.toml),
            files: job.files.clone(),
        };
        let spec = spec(&job, &case.experiment())?;
        let model = Evaluate::new(&spec.fit_variant)?;
        let identity = CalibrationIdentity {
            id: 0,
            name: "hidden effect".into(),
            study: 0,
            experiment: 0,
        };
        let mut calibration = Calibration::new(identity, Arc::new(spec))?;
        loop {
            if let Some(CalibrationResult::Posterior(posterior)) = calibration.engine().finding() {
                let particles = posterior.particles.iter().map(|p| p.log_likelihood.value());
                return Ok(Self {
                    log_evidence: posterior.log_evidence,
                    highest: particles.fold(f64::NEG_INFINITY, f64::max),
                });
            }
            if let Some(message) = &calibration.message {
                return Err(message.clone().into());
            }
            for evaluation in calibration.queue.asked() {
                let Some(question) = calibration.question(evaluation) else {
                    break;
                };
                let outcome = result_of(model.evaluate(question.theta))?;
                calibration.complete(evaluation, outcome, "hidden effect")?;
            }
        }
    }
}
