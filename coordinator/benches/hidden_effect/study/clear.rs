//! What the measurements could say without noise: by how much the truth beats what is not the truth.

use coordinator::embedded::Evaluate;
use coordinator::missing_effect::candidate::extended;
use discovery::{Engine, Finding, Settings, Starts};
use record::Extension;
use shared::outcome::Outcome;
use statistics::{Likelihood, LogLikelihood};

use super::case::{Case, spec};
use super::pipeline::{Asking, run};

/// Nats by which the truth must beat a rival for the targets to count \[DISCOVERY 4\].
pub(crate) const CLEAR: f64 = 10.0;

/// The log-likelihood of the truth without noise: nothing is higher.
fn perfect(likelihood: &Likelihood) -> Result<f64, String> {
    let values: Vec<f64> = likelihood.data().iter().map(|d| d.value).collect();
    match likelihood.log_likelihood(&values, &[]) {
        Ok(LogLikelihood::Finite(nats)) => Ok(nats.get()),
        other => Err(format!("noise-free values are impossible: {other:?}")),
    }
}

/// Nats by which the base with some of the effects falls short of the truth without noise, at its best near the truth.
pub(crate) fn shortfall(case: &Case, effects: &[&Extension]) -> Result<f64, String> {
    let job = extended("job.toml", &case.plan.job(), effects).map_err(|e| e.to_string())?;
    let truth = spec(&case.truth_job, &case.clear())?.parameters;
    let spec = spec(&job, &case.clear())?;
    let place = |name: &String| truth.iter().position(|p| p.name == *name);
    let start = spec
        .parameters
        .iter()
        .filter_map(|p| Some(case.theta[place(&p.name)?]));
    let start = start.collect();
    let settings = Settings {
        starts: Starts::Draws(vec![start]),
        ..Settings::default()
    };
    let prior: Vec<_> = spec.parameters.iter().map(|p| p.marginal.clone()).collect();
    let engine = Engine::new(&prior, spec.likelihood.clone(), Vec::new(), &settings);
    let evaluate = Evaluate::new(&spec.fit_variant)?;
    let finding = run(engine.map_err(|e| e.to_string())?, |_, theta| {
        Ok(match evaluate.evaluate(theta) {
            Outcome::Evaluated(observables) => Some(spec.predicted_values(&observables)),
            Outcome::Rejected(_) | Outcome::Fault(_) => None,
        })
    })?;
    let perfect = perfect(&spec.likelihood)?;
    Ok(perfect - finding.judged[0].log_likelihood)
}

/// What the library says without noise.
pub(crate) struct Clear {
    finding: Finding,
    perfect: f64,
}

impl Clear {
    pub(crate) fn new(case: &Case, asking: &mut Asking) -> Result<Self, String> {
        let likelihood = spec(&case.plan.job(), &case.clear())?.likelihood;
        Ok(Self {
            perfect: perfect(&likelihood)?,
            finding: asking.library(likelihood)?,
        })
    }

    /// Nats by which the base falls short.
    pub(crate) fn over_base(&self) -> f64 {
        self.perfect - self.finding.judged[0].log_likelihood
    }

    /// Nats by which the best rival falls short that is not of the class of an effect; of `None`, of any class.
    pub(crate) fn separation(&self, effect: Option<usize>) -> f64 {
        let own = effect.and_then(|k| self.finding.of(Some(k))).map(|j| j.class);
        let rivals = self.finding.judged.iter().filter(|j| Some(j.class) != own);
        self.perfect - rivals.map(|j| j.log_likelihood).fold(f64::NEG_INFINITY, f64::max)
    }
}
