//! The log Bayes factors of the search beside those of full evidences by the sampler.

use coordinator::embedded::Evaluate;
use record::Extension;
use search::candidate::extended;
use shared::file::FileSet;
use shared::outcome::Outcome;

use crate::error::StudyError;
use crate::hidden_effect::study::case::{SyntheticCase, spec};
use crate::hidden_effect::study::draw::draw;
use crate::hidden_effect::study::kind::HiddenKind;
use crate::hidden_effect::study::local_search::LocalSearch;
use crate::hidden_effect::study::posterior::{PosteriorSample, sample};
use crate::hidden_effect::study::rate::{mean, median};
use crate::parallel::each;

/// With fewer particles or moves, evidences differ between seeds by more than between search and sampler.
const SAMPLER: &str = "[sampler]\nparticles = 1000\nmoves = [5, 10]\n";
/// The largest difference that counts as agreement \[nats\].
const CLOSE: f64 = 1.0;
/// The smallest share of experiments that must agree.
const MIN_SHARE: f64 = 0.97;
/// The largest amount by which the search may fall short of the sampler \[nats\].
const MAX_SHORT: f64 = 3.0;
/// The number of the first truth, which no other kind uses.
const FIRST: u64 = 2_000_000;

/// The log Bayes factors of the truth of one experiment \[nats\].
struct Compared {
    search: f64,
    sampler: f64,
}

/// Compares a number of experiments, with each effect in turn, and prints the differences.
pub fn run(count: u64, seed: u64) -> Result<(), StudyError> {
    let compared = each(count, |number| one(seed, number))?;
    let differences: Vec<f64> = compared.iter().map(|c| c.search - c.sampler).collect();
    let [bias, error] = mean(&differences);
    let sd = error * (differences.len() as f64).sqrt();
    let close = differences.iter().filter(|d| d.abs() <= CLOSE).count();
    let lowest = differences.iter().copied().fold(f64::INFINITY, f64::min);
    println!(
        "search less sampler: mean {bias:.2} ± {error:.2} nats, sd {sd:.2}, median {:.2}, least {lowest:.2}; {close} of {count} within \
         {CLOSE}",
        median(&differences)
    );
    if (close as f64) < MIN_SHARE * count as f64 || lowest < -MAX_SHORT {
        return Err(format!("less than {MIN_SHARE} within {CLOSE}, or one below -{MAX_SHORT}").into());
    }
    Ok(())
}

fn one(seed: u64, number: u64) -> Result<Compared, StudyError> {
    let case = draw(HiddenKind::One, seed, FIRST + number)?;
    let name = &case.hidden[0];
    let mut local = LocalSearch::new(&case.plan.job(), &case.experiment(), 1)?;
    let conclusion = local.run()?;
    let task = local.models.task();
    let truth = task.library.iter().position(|c| c.name == *name);
    let truth = truth.ok_or("the truth is no candidate")?;
    let truth = conclusion
        .ranking
        .effect(Some(truth))
        .ok_or("the model rejected the truth")?;
    let base = sampled(&case, &case.plan.job(), seed)?;
    let added = Extension::Effect(name.clone());
    let job = extended("job.toml", &case.plan.job(), &[&added])?;
    let with = sampled(&case, &job, seed)?;
    let compared = Compared {
        search: truth.stated_log_bayes_factor,
        sampler: with.log_evidence - base.log_evidence,
    };
    println!(
        "tmcmc {number} {name}: search {:.2} ({:?}, {:.1} prior sds), sampler {:.2}; highest ln L of the base {:.1} and {:.1}, with it {:.1} \
         and {:.1}",
        compared.search,
        truth.method,
        truth.prior_sds,
        compared.sampler,
        log_likelihood(&case, &case.plan.job(), conclusion.base.draws.first())?,
        base.highest(),
        log_likelihood(&case, &job, Some(&truth.theta))?,
        with.highest()
    );
    Ok(compared)
}

fn sampled(case: &SyntheticCase, job: &FileSet, seed: u64) -> Result<PosteriorSample, StudyError> {
    sample(job, &case.experiment(), SAMPLER, seed)
}

/// ln p(data | theta); NaN without a parameter vector or if the model rejects it.
fn log_likelihood(case: &SyntheticCase, job: &FileSet, theta: Option<&Vec<f64>>) -> Result<f64, StudyError> {
    let spec = spec(job, &case.experiment())?;
    let Some(theta) = theta else {
        return Ok(f64::NAN);
    };
    let Outcome::Evaluated(seen) = Evaluate::new(&spec.fit_variant)?.evaluate(spec.model_theta(theta)) else {
        return Ok(f64::NAN);
    };
    let values = spec.predicted_values(&seen);
    Ok(spec.likelihood.log_likelihood(&values, theta)?.value())
}
