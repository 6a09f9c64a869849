//! A job before it is submitted: what it would compute, what its model leaves out, and its cost.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use shared::api::NewExperiment;
use shared::file::FileSet;
use tokio::sync::Semaphore;
use utoipa::ToSchema;

use super::background::in_background;
use super::error::ServiceError;
use super::handle::Service;
use super::submission::specs_of;
use crate::embedded::LocalModels;
use crate::pilot::{JobCost, job_cost};
use job::{Spec, confounded_orders};
use report::model_limits;
use result::finished_calibration::prior_mean;
use search::untried::additions;

/// Longest duration of a pilot, for which somebody waits at a screen `[s]`.
const PILOT_S: f64 = 10.0;
/// One pilot runs at a time, because it takes a core.
static ONE_AT_A_TIME: Semaphore = Semaphore::const_new(1);

/// `POST /v1/check`: a job with its experiment, as they would be submitted.
#[derive(Debug, Clone, PartialEq, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct NewCheck {
    /// The experiment.
    pub experiment: NewExperiment,
    /// Text of `job.toml`.
    pub toml: String,
    /// Texts of the files that it names (its effect files).
    #[serde(default)]
    pub files: BTreeMap<String, String>,
}

/// What a job would compute.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct JobCheck {
    /// The models of the job, in their order.
    pub models: Vec<CheckedModel>,
    /// What a few more lines of the experiment would allow, in sentences.
    pub additions: Vec<String>,
    /// What may mislead, in sentences.
    pub warnings: Vec<String>,
}

/// A model of a job, and the cost of its calibration.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct CheckedModel {
    /// The model in words.
    pub model: String,
    /// The algorithm in words.
    pub algorithm: String,
    /// Number of fitted runs.
    pub fitted_runs: usize,
    /// Number of held-out runs.
    pub held_out_runs: usize,
    /// Number of measurements of the fitted runs.
    pub measurements: usize,
    /// The free parameters with their priors.
    pub parameters: Vec<CheckedParameter>,
    /// What the model leaves out of this job, in sentences.
    pub limits: Vec<String>,
    /// Expected cost of the calibration; null of a model that is not ours, or if its pilot failed.
    pub cost: Option<JobCost>,
    /// Why there is no cost.
    pub without_cost: Option<String>,
}

/// A free parameter with its prior, in its SI unit.
#[derive(Debug, Clone, PartialEq, Serialize, ToSchema)]
pub struct CheckedParameter {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Mean of the prior.
    pub prior_mean: f64,
    /// Standard deviation of the prior.
    pub prior_sd: f64,
    /// Lower bound of the prior; null without one.
    pub lower: Option<f64>,
    /// Upper bound of the prior; null without one.
    pub upper: Option<f64>,
}

impl Service {
    /// Reads a job with its experiment as a submission does, and estimates its cost. Nothing is stored.
    ///
    /// # Errors
    /// [`ServiceError`]: a submission would be refused.
    pub async fn check_job(&self, asked: NewCheck) -> Result<JobCheck, ServiceError> {
        let job = FileSet {
            toml: asked.toml,
            files: asked.files,
        };
        let experiment = FileSet {
            toml: asked.experiment.toml,
            files: asked.experiment.files,
        };
        let service_effects = self.listed_user_effects(&job).await?;
        // The semaphore is never closed. A thread that computes cannot be stopped, so it keeps the permit until it has ended.
        let turn = ONE_AT_A_TIME.acquire().await;
        let checked = in_background(move || {
            let _turn = turn;
            let specs = specs_of(&job, &service_effects, &experiment)?;
            check(specs, &job, &experiment)
        });
        checked.await
    }
}

fn check(specs: Vec<Spec>, job: &FileSet, experiment: &FileSet) -> Result<JobCheck, ServiceError> {
    let first = &specs[0];
    let additions = match first.fit_variant.conditions.is_empty() {
        true => Vec::new(),
        false => additions(job, experiment, first.model.is_smooth())?,
    };
    let orders = confounded_orders(&first.experiment, &first.fit_runs);
    Ok(JobCheck {
        additions,
        warnings: orders.iter().map(|order| order.words()).collect(),
        models: specs.into_iter().map(checked_model).collect(),
    })
}

fn checked_model(spec: Spec) -> CheckedModel {
    let parameter = |p: &job::FreeParameter| {
        let (lower, upper) = p.marginal.support();
        CheckedParameter {
            name: p.name.clone(),
            unit: p.unit.clone(),
            prior_mean: prior_mean(&p.marginal),
            prior_sd: p.marginal.sd(),
            lower: lower.is_finite().then_some(lower),
            upper: upper.is_finite().then_some(upper),
        }
    };
    let mut checked = CheckedModel {
        model: spec.model_words(),
        algorithm: spec.algorithm.words(),
        fitted_runs: spec.fit_runs.len(),
        held_out_runs: spec.experiment.runs.len() - spec.fit_runs.len(),
        measurements: spec.wheel_data(),
        parameters: spec.parameters.iter().map(parameter).collect(),
        limits: model_limits(&spec),
        cost: None,
        without_cost: None,
    };
    if spec.model.external.is_some() {
        checked.without_cost = Some("the model is not ours, so that no pilot runs here".into());
        return checked;
    }
    match job_cost(spec, &LocalModels::default(), PILOT_S) {
        Ok(cost) => checked.cost = Some(cost),
        Err(error) => checked.without_cost = Some(error.to_string()),
    }
    checked
}
