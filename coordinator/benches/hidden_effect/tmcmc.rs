//! The search's log Bayes factors beside those of full evidences by the sampler.

use std::sync::Arc;

use coordinator::calibration::{Calibration, Finding, Identity, result_of};
use coordinator::discovery::Extension;
use coordinator::discovery::candidate::extended;
use coordinator::embedded::Evaluate;
use shared::file::FileSet;

use crate::study::case::{Case, spec};
use crate::study::design::Plan;
use crate::study::each;
use crate::study::kind::draw_clear;
use crate::study::pipeline::Asking;
use crate::study::rate::mean;

/// Fewer repeat worse than the factors are read to \[DISCOVERY 1\].
const SAMPLER: &str = "[sampler]\nparticles = 1000\nmoves = [5, 10]\n";
/// The truths are others than those of the other kinds.
const FIRST: u64 = 2_000_000;

/// One effect, and what both say of the best: nats.
struct Compared {
    search: f64,
    sampler: f64,
}

/// Compares so many and prints the differences.
pub(crate) fn run(count: u64, seed: u64) -> Result<(), String> {
    let compared = each(count, |number| one(seed, number))?;
    let compared: Vec<Compared> = compared.into_iter().collect::<Result<_, String>>()?;
    let differences: Vec<f64> = compared.iter().map(|c| c.search - c.sampler).collect();
    let [bias, error] = mean(&differences);
    let sd = error * (differences.len() as f64).sqrt();
    println!("search less sampler: mean {bias:.2} ± {error:.2} nats, sd {sd:.2}, of {count}");
    Ok(())
}

fn one(seed: u64, number: u64) -> Result<Compared, String> {
    let case = draw_clear(Plan::Full, 1, seed, FIRST + number)?;
    let mut asking = Asking::new(&case.plan.job(), &case.experiment(), 1)?;
    let answer = asking.inquire()?;
    let effects = answer.judged.iter().filter(|j| j.candidate.is_some());
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
        .map(|k| asking.models.task().library[k].name.clone());
    let name = name.ok_or("the best has no name")?;
    let base = evidence(&case, &case.plan.job(), seed)?;
    let added = Extension::Effect(name.clone());
    let job = extended("job.toml", &case.plan.job(), &[&added]).map_err(|e| e.to_string())?;
    let compared = Compared {
        search: best.log_bayes_factor,
        sampler: evidence(&case, &job, seed)? - base,
    };
    println!(
        "tmcmc {number} {} hidden, {name} best: search {:.2} ({:?}), sampler {:.2}",
        case.hidden[0], compared.search, best.method, compared.sampler
    );
    Ok(compared)
}

/// The log-evidence of a job by the sampler.
fn evidence(case: &Case, job: &FileSet, seed: u64) -> Result<f64, String> {
    let job = FileSet {
        toml: format!("{}{SAMPLER}seed = {seed}\n", job.toml),
        files: job.files.clone(),
    };
    let spec = spec(&job, &case.experiment())?;
    let model = Evaluate::new(&spec.fit_variant)?;
    let identity = Identity {
        id: 0,
        name: "hidden effect".into(),
        study: 0,
        experiment: 0,
    };
    let mut calibration = Calibration::new(identity, Arc::new(spec)).map_err(|e| e.to_string())?;
    loop {
        if let Some(Finding::Posterior(posterior)) = calibration.engine().finding() {
            return Ok(posterior.log_evidence);
        }
        if let Some(message) = &calibration.message {
            return Err(message.clone());
        }
        for evaluation in calibration.queue.asked() {
            let Some(question) = calibration.question(evaluation) else {
                break;
            };
            let outcome = result_of(model.evaluate(question.theta))?;
            calibration
                .complete(evaluation, outcome, "hidden effect")
                .map_err(|e| e.to_string())?;
        }
    }
}
