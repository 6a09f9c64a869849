//! Tables, summary, flags and report of a calibration, from what the store kept.
//!
//! Everything here is a pure function of an [`Outcome`], or of the [`Study`] that it belongs to; the decisions it states read no holdout row.

mod baseline;
mod comparison;
mod coverage;
mod csv;
pub mod diagnostics;
pub mod discovery;
mod entangled;
mod errors;
pub mod figure;
mod flags;
mod group;
mod level;
mod point_estimate;
mod predictive;
mod readings;
pub mod report;
mod settling;
mod study;
mod summary;
pub mod terminal;

use std::collections::BTreeMap;

use shared::api::{CalibrationState, CalibrationStatus};
use shared::outcome::SimulatedHistory;
use statistics::Marginal;

use crate::service::ServiceError;
use crate::store::{CalibrationRow, EstimateRow, Prediction, PriorDraw, Reader, Sample, StageRow, Subchains};
use job::{Method, Spec, is_discovery};

pub use comparison::{Comparison, ComparisonRow};
pub use csv::PosteriorTable;
pub use diagnostics::Diagnostics;
pub use discovery::{DiscoverySummary, Round};
pub use errors::{ChannelError, ErrorTable};
pub use figure::{ChannelHistory, Figures, ModelSeries, Series};
pub use flags::Flag;
pub use group::{ErrorGroup, GroupError};
pub use point_estimate::PointEstimate;
pub use predictive::Predictive;
pub use study::Study;
pub use summary::{CalibrationSummary, ParameterSummary, Summary};

/// A finished calibration with everything that the store kept of it.
#[derive(Debug)]
pub struct Outcome {
    /// Its row in the store.
    pub row: CalibrationRow,
    /// Its specification.
    pub spec: Spec,
    /// Name of its experiment.
    pub experiment: String,
    /// Its stages.
    pub stages: Vec<StageRow>,
    /// What a fit found; `None` where the posterior was sampled.
    pub estimate: Option<EstimateRow>,
    /// The equally weighted draws of the posterior; none of a fit.
    pub posterior: Vec<Sample>,
    /// The draws from the prior, then the populations at the end of the stages before the last; none of a fit.
    pub populations: Vec<Vec<Sample>>,
    /// The model's values of the fitted measurements at the draw of the highest likelihood.
    pub likeliest_values: Option<Vec<f64>>,
    /// The final draws, simulated on every run; the first is the most probable particle, of a fit the only one.
    pub predictions: Vec<Prediction>,
    /// What each fitted run felt over time at the likeliest parameters; `None` of a model that knows no time.
    pub simulated_histories: Option<Vec<SimulatedHistory>>,
    /// How often the model refused, by kind.
    pub rejections: BTreeMap<String, u64>,
    /// What a metamodel did; `None` where there was none.
    pub subchains: Option<Subchains>,
    /// The draws from the prior that a sampler began with; none of a fit.
    pub prior_draws: Vec<PriorDraw>,
    /// How often a lease failed, by what was said of it.
    pub faults: BTreeMap<String, u64>,
}

impl Outcome {
    /// Loads a finished calibration.
    ///
    /// # Errors
    /// [`ServiceError::Control`] where it is not finished; [`ServiceError::Effects`] where this program has other
    /// effects; others where the store cannot be read.
    pub async fn load(reader: &Reader, row: &CalibrationRow) -> Result<Outcome, ServiceError> {
        if row.state != CalibrationState::Finished {
            return Err(crate::farm::ControlError::NotFinished {
                id: row.id,
                state: row.state,
            }
            .into());
        }
        if is_discovery(&row.job.toml) {
            return Err(ServiceError::Search(row.id));
        }
        let stages = reader.stages(row.id).await?;
        let spec = spec_of(reader, row).await?;
        // Parameters and texts would be shown that the result was not computed with.
        if let Some(pinned) = &row.model_version {
            spec.check_effects(pinned)?;
        }
        let estimate = match spec.method {
            Method::Sample(_) | Method::Discover { .. } => None,
            Method::Fit(_) | Method::Evolve(_) => reader.estimate(row.id).await?,
        };
        let prior_draws = match spec.method {
            Method::Sample(_) => reader.prior_draws(row.id, spec.method.width()).await?,
            Method::Fit(_) | Method::Evolve(_) | Method::Discover { .. } => Vec::new(),
        };
        let mut populations = reader.populations(row.id).await?;
        let posterior = populations.pop().unwrap_or_default();
        if let Method::Sample(_) = spec.method {
            populations.insert(0, first_population(&spec, &prior_draws));
        }
        let likeliest_values = match likeliest(&posterior) {
            Some(sample) => reader.fitted_values(row.id, &sample.theta).await?,
            None => None,
        };
        Ok(Outcome {
            spec,
            estimate,
            prior_draws,
            experiment: row.name.clone(),
            posterior,
            populations,
            likeliest_values,
            predictions: reader.predictions(row.id).await?,
            simulated_histories: reader.histories(row.id).await?,
            rejections: reader.rejections(row.id).await?,
            subchains: reader.subchains(row.id).await?,
            faults: reader.faults(row.id).await?,
            stages,
            row: row.clone(),
        })
    }

    /// The draw of the highest likelihood; the first of equals.
    pub fn likeliest(&self) -> Option<&Sample> {
        likeliest(&self.posterior)
    }

    /// The predictions that results are made from: equally weighted draws, without the most probable particle, which is
    /// no random draw; of a fit, its one point.
    pub fn predictive_draws(&self) -> &[Prediction] {
        let first = usize::from(self.estimate.is_none()).min(self.predictions.len());
        &self.predictions[first..]
    }

    /// The most probable particle: highest likelihood times prior; the first of equals.
    pub fn most_probable(&self) -> Option<&Sample> {
        let score = |s: &Sample| s.log_likelihood.unwrap_or(f64::NEG_INFINITY) + s.log_prior;
        self.posterior
            .iter()
            .reduce(|best, s| if score(s) > score(best) { s } else { best })
    }

    /// The draws of one parameter.
    pub fn draws(&self, parameter: usize) -> Vec<f64> {
        self.posterior.iter().map(|s| s.theta[parameter]).collect()
    }
}

/// The population that a sampler begins with.
fn first_population(spec: &Spec, draws: &[PriorDraw]) -> Vec<Sample> {
    let prior = spec.prior();
    let score = |draw: &PriorDraw| {
        let values = draw.result.as_ref().ok()?;
        let scored = spec.likelihood.log_likelihood(values, &draw.theta).ok()?;
        Some(scored.value()).filter(|value| value.is_finite())
    };
    let sample = |draw: &PriorDraw| Sample {
        theta: draw.theta.clone(),
        log_likelihood: score(draw),
        log_prior: prior.log_density(&draw.theta),
    };
    draws.iter().map(sample).collect()
}

fn likeliest(draws: &[Sample]) -> Option<&Sample> {
    let score = |s: &Sample| s.log_likelihood.unwrap_or(f64::NEG_INFINITY);
    let best = draws
        .iter()
        .reduce(|best, s| if score(s) > score(best) { s } else { best });
    best.filter(|s| s.log_likelihood.is_some())
}

/// The mean of a prior; that of a symmetric one is integrated to zero but for rounding, which is not shown.
fn prior_mean(marginal: &Marginal) -> f64 {
    let mean = marginal.mean();
    if mean.abs() < 1e-12 * marginal.sd() {
        0.0
    } else {
        mean
    }
}

/// The specification of a stored calibration.
///
/// # Errors
/// [`ServiceError`].
pub async fn spec_of(reader: &Reader, row: &CalibrationRow) -> Result<Spec, ServiceError> {
    let experiment = reader
        .experiment(row.experiment)
        .await?
        .ok_or_else(|| ServiceError::NotFound {
            what: "experiment",
            id: row.experiment.to_string(),
        })?;
    Ok(Spec::new(
        "job.toml",
        &row.job,
        "experiment.toml",
        &experiment.files,
    )?)
}

/// Where a calibration stands that nobody has in hand.
pub fn stored_status(row: &CalibrationRow) -> CalibrationStatus {
    // A job that this version does not understand still has a line in every list.
    let model = job::Job::parse("job.toml", &row.job.toml).map(|job| job.model);
    CalibrationStatus {
        id: row.id,
        name: row.name.clone(),
        study: row.study,
        experiment: row.experiment,
        state: row.state,
        message: row.message.clone(),
        model_kind: model.ok().map(|m| m.kind.name().to_owned()),
        model_version: row.model_version.clone(),
        progress: None,
    }
}

#[cfg(test)]
mod tests {
    use statistics::Distribution;

    use super::*;

    #[test]
    fn a_prior_about_zero_has_the_mean_zero() {
        let of = |mean| prior_mean(&Marginal::new(Distribution::Normal { mean, sd: 0.2 }, None).unwrap());
        assert_eq!(of(0.0).to_bits(), 0.0_f64.to_bits());
        assert!((of(1e-6) - 1e-6).abs() < 1e-15);
    }
}
