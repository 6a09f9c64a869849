//! How well noise-free measurements determine the truth.

use coordinator::embedded::Evaluate;
use discovery::{EffectRanking, EffectSearch, SearchSettings, Starts};
use record::Extension;
use search::candidate::extended;
use shared::file::FileSet;
use shared::outcome::Outcome;
use statistics::{Likelihood, LogLikelihood};

use super::case::{SyntheticCase, spec};
use super::local_search::{LocalSearch, run};
use crate::error::StudyError;

/// Nats by which the truth must exceed every rival in a trial that counts.
pub const MIN_SEPARATION: f64 = 10.0;

/// Returns the log-likelihood of the truth for noise-free data, which is the maximum.
fn perfect(likelihood: &Likelihood) -> Result<f64, StudyError> {
    let values: Vec<f64> = likelihood.data().iter().map(|d| d.value).collect();
    match likelihood.log_likelihood(&values, &[]) {
        Ok(LogLikelihood::Finite(nats)) => Ok(nats.get()),
        other => Err(format!("noise-free values are impossible: {other:?}").into()),
    }
}

/// Nats by which the base with some of the effects falls short of the truth for noise-free data; the fit starts at the truth.
pub fn shortfall(case: &SyntheticCase, effects: &[&Extension]) -> Result<f64, StudyError> {
    let job = extended("job.toml", &case.plan.job(), effects)?;
    let truth = spec(&case.truth_job, &case.noise_free())?.parameters;
    let parameters = spec(&job, &case.noise_free())?.parameters;
    let place = |name: &String| truth.iter().position(|p| p.name == *name);
    let start = parameters
        .iter()
        .filter_map(|p| Some(case.theta[place(&p.name)?]));
    job_shortfall(&job, &case.noise_free(), start.collect())
}

/// Nats by which a job falls short of the truth for noise-free data; the fit starts at these parameters.
pub fn job_shortfall(job: &FileSet, noise_free: &FileSet, start: Vec<f64>) -> Result<f64, StudyError> {
    let spec = spec(job, noise_free)?;
    let settings = SearchSettings {
        starts: Starts::Draws(vec![start]),
        ..SearchSettings::default()
    };
    let prior = spec.prior();
    let search = EffectSearch::new(&prior, spec.likelihood.clone(), &[], &settings)?;
    let evaluate = Evaluate::new(&spec.fit_variant)?;
    let ranking = run(search, |request| {
        Ok(match evaluate.evaluate(&request.theta) {
            Outcome::Evaluated(observables) => Some(spec.predicted_values(&observables)),
            Outcome::Rejected(_) | Outcome::Fault(_) => None,
        })
    })?;
    Ok(perfect(&spec.likelihood)? - ranking.effects[0].log_likelihood)
}

/// The ranking of the library for noise-free data.
pub struct NoiseFree {
    ranking: EffectRanking,
    perfect: f64,
}

impl NoiseFree {
    pub fn new(case: &SyntheticCase, local: &mut LocalSearch) -> Result<Self, StudyError> {
        let likelihood = spec(&case.plan.job(), &case.noise_free())?.likelihood;
        Ok(Self {
            perfect: perfect(&likelihood)?,
            ranking: local.library(likelihood)?,
        })
    }

    /// Nats by which the base falls short of the truth.
    pub fn over_base(&self) -> f64 {
        self.perfect - self.ranking.effects[0].log_likelihood
    }

    /// Nats by which the best rival outside the class of an effect falls short of the truth; with `None`, the best effect of all.
    pub fn separation(&self, effect: Option<usize>) -> f64 {
        let class = effect.and_then(|k| self.ranking.effect(Some(k))).map(|j| j.class);
        let rivals = self.ranking.effects.iter().filter(|j| Some(j.class) != class);
        self.perfect - rivals.map(|j| j.log_likelihood).fold(f64::NEG_INFINITY, f64::max)
    }
}
