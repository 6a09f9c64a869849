//! Further runs of a campaign while it lasts: the posterior, the models and the verdict with them, without a new calibration.

use std::collections::BTreeMap;
use std::sync::Arc;

use shared::api::{NewFollow, SearchProgress};
use shared::experiment::Experiment;
use shared::file::FileSet;
use shared::outcome::Outcome;

use super::campaign::Answers;
use super::error::ServiceError;
use super::finished_study::check_finished;
use super::handle::Service;
use super::simulation::{in_parallel, simulate};
use super::stored_calibration::FILES;
use crate::embedded::Evaluate;
use farm::calibration::MAX_EFFECTS_TOGETHER;
use inference::{PosteriorUpdate, UpdateProgress, UpdatedPosterior};
use job::{Job, PlannedRun, Spec, continued_job};
use prediction::follow::{Followed, FollowedModel, FollowedSearch, parameters, stop, unfinished, weigh};
use prediction::surprise::expectations;
use prediction::{Ensemble, PredictionError, Question};
use record::Discovery;
use result::{FinishedCalibration, Outcome as Found, Study};
use search::{RunningDiscovery, SearchModels};

/// Largest number of evaluations of a search by models in steady motion, where the request states none: some three times those of the
/// searches of `examples/cmu-sand/all-runs.toml`, which take 27,000 to 30,000.
const STEADY_EVALUATIONS: usize = 100_000;
/// The same of a search by any other model: minutes.
const SLOW_EVALUATIONS: usize = 2_000;

impl Service {
    /// Adds runs to a calibration without storing anything: the posterior of each model of its study, their weights, the verdict of a search,
    /// the next run, and which run contradicts the others.
    ///
    /// # Errors
    /// [`ServiceError`]: the calibration has no posterior, or a row is malformed.
    pub async fn follow(&self, id: i64, asked: NewFollow) -> Result<Followed, ServiceError> {
        let row = self.calibration_row(id).await?;
        let files = self.experiment(row.experiment).await?;
        let answer = self
            .alone(id, move |study| followed(study, id, &files, asked))
            .await?;
        self.campaigns.tell(answer.clone());
        Ok(answer)
    }

    /// Returns the answers to the further runs of a calibration, from the last one on.
    ///
    /// # Errors
    /// [`ServiceError::NotFound`]; [`ServiceError::Control`] if it is not finished.
    pub async fn campaign(&self, id: i64) -> Result<Answers, ServiceError> {
        check_finished(&self.calibration_row(id).await?)?;
        Ok(self.campaigns.answers(id))
    }
}

fn followed(study: Study, id: i64, files: &FileSet, asked: NewFollow) -> Result<Followed, PredictionError> {
    let (enlarged, _) = Experiment::with_runs(FILES[1], files, &asked.runs)?;
    let experiment = Arc::new(Experiment::parse(FILES[1], &enlarged)?);
    let ensemble = Ensemble::new(study, id, BTreeMap::new())?;
    // A posterior is updated by simulations of all runs, in up to nine rounds of this many draws.
    let most_draws = ensemble.affordable_draws(experiment.runs.len())?;
    let max_evaluations = asked.max_evaluations.unwrap_or(match ensemble.is_fast() {
        true => STEADY_EVALUATIONS,
        false => SLOW_EVALUATIONS,
    });
    let before = ensemble.asked().spec.experiment.runs.len();
    let gravity_m_s2 = experiment.rig.gravity_m_s2;
    let added = experiment.runs[before..].iter().map(|run| PlannedRun {
        run: run.clone(),
        weight_n: run.wheel_load_n,
        gravity_m_s2,
        slope_deg: 0.0,
    });
    let added: Vec<PlannedRun> = added.collect();
    let simulated = ensemble.simulate(added.clone(), None, |question| simulate(&question))?;
    let mut models = Vec::new();
    let mut of_asked = Vec::new();
    for model in &simulated.models {
        let calibration = &model.calibration;
        let spec = enlarged_spec(calibration, &experiment)?;
        let updated = updated(calibration, &spec, most_draws)?;
        let row = &calibration.row;
        models.push(FollowedModel::new(
            row.id,
            calibration.spec.model_words(),
            model.weight,
            updated.as_ref(),
        ));
        if row.id == id
            && let Some(updated) = &updated
        {
            of_asked = parameters(&spec, updated);
        }
    }
    weigh(&mut models);
    let job = &simulated.models[0].calibration.row.job;
    let search = searched(&continued_job(FILES[0], job)?, &enlarged, max_evaluations)?;
    let found = search.found.as_ref();
    Ok(Followed {
        calibration: id,
        runs: added.iter().map(|planned| planned.run.name.clone()).collect(),
        expectations: expectations(&simulated, &added),
        models,
        parameters: of_asked,
        verdict: match found {
            Some(found) => found.text.clone(),
            None => unfinished(max_evaluations, &search.progress),
        },
        search: FollowedSearch {
            evaluations: search.evaluations,
            max_evaluations,
            is_at_bound: found.is_none(),
            leaders: found.map_or(search.progress.leaders, |_| Vec::new()),
        },
        next_runs: found.map_or_else(Vec::new, |found| found.next_runs.clone()),
        stop: found.and_then(|found| stop(found.verdict, &found.next_runs)),
        rows: asked.runs,
    })
}

/// Returns the specification of a calibration with all runs.
fn enlarged_spec(
    calibration: &FinishedCalibration,
    experiment: &Arc<Experiment>,
) -> Result<Spec, PredictionError> {
    let job = Job::read(FILES[0], &continued_job(FILES[0], &calibration.row.job)?)?;
    Ok(Spec::from_values(
        FILES[0],
        job,
        FILES[1],
        Arc::clone(experiment),
    )?)
}

/// Updates the posterior of a calibration; `None` if it must be calibrated again: too few draws count, or the runs bring parameters of their
/// own. Of more than `most_draws` draws, this many evenly spaced ones stand for the posterior.
fn updated(
    calibration: &FinishedCalibration,
    spec: &Spec,
    most_draws: usize,
) -> Result<Option<UpdatedPosterior>, PredictionError> {
    let draws = match &calibration.outcome {
        Found::Sampled(sampled) => &sampled.draws,
        Found::Approximated { draws, .. } => draws,
        Found::Estimated(_) => return Ok(None),
    };
    let names = |spec: &Spec| spec.parameters.iter().map(|p| p.name.clone()).collect::<Vec<_>>();
    let Some(log_evidence) = calibration
        .row
        .log_evidence
        .filter(|_| names(spec) == names(&calibration.spec))
    else {
        return Ok(None);
    };
    let seed = spec.algorithm.seed();
    let draws = spaced(draws, most_draws);
    let mut update = PosteriorUpdate::new(spec.prior(), &draws, log_evidence, seed);
    loop {
        let thetas = update.asked().iter();
        let question = Question {
            variants: vec![spec.sampled_variant()],
            thetas: thetas.map(|theta| spec.model_theta(theta).to_vec()).collect(),
        };
        let answers = simulate(&question).map_err(PredictionError::Model)?;
        let told = answers.iter().flatten().zip(update.asked());
        let told = told.map(|(answer, theta)| spec.log_likelihood(answer.as_ref().ok(), theta));
        let told = told
            .collect::<Result<Vec<_>, _>>()
            .map_err(|e| PredictionError::Model(e.to_string()))?;
        match update.tell(&told) {
            UpdateProgress::Asks(next) => update = next,
            UpdateProgress::Updated(updated) => return Ok(Some(updated)),
            UpdateProgress::Failed => return Ok(None),
        }
    }
}

/// Returns evenly spaced elements, or all where they are few.
fn spaced<T: Clone>(all: &[T], most: usize) -> Vec<T> {
    let count = all.len().min(most);
    (0..count).map(|i| all[i * all.len() / count].clone()).collect()
}

/// A search in all runs.
struct Searched {
    /// What it found; `None` where it was ended at its bound.
    found: Option<Discovery>,
    /// Number of evaluations that it took.
    evaluations: usize,
    /// Where it was when it ended.
    progress: SearchProgress,
}

/// Searches the model of a job for a missing effect, as the farm does, in this process. The search is ended before the round with which it
/// would take more than `max_evaluations`.
fn searched(
    job: &FileSet,
    experiment: &FileSet,
    max_evaluations: usize,
) -> Result<Searched, PredictionError> {
    let model = |e: &dyn std::fmt::Display| PredictionError::Model(e.to_string());
    let models = SearchModels::new(job, experiment, MAX_EFFECTS_TOGETHER)?;
    let mut running = RunningDiscovery::new(models).map_err(|e| model(&e))?;
    let mut evaluations = 0;
    loop {
        let found = running.record();
        let asked: Vec<usize> = running.pending().iter().map(|query| query.particle).collect();
        if found.is_some() || evaluations + asked.len() > max_evaluations {
            return Ok(Searched {
                found,
                evaluations,
                progress: running.progress(),
            });
        }
        evaluations += asked.len();
        let answer = |place: usize| -> Result<Option<Vec<f64>>, String> {
            let particle = asked[place];
            let Some((variant, theta)) = running
                .lease(particle)
                .and_then(|(hash, theta)| Some((running.variant(hash)?, theta)))
            else {
                return Err("a query of the search has no variant".into());
            };
            Ok(match Evaluate::new(variant)?.evaluate(theta) {
                Outcome::Evaluated(observables) => running.values(particle, &observables),
                Outcome::Rejected(_) => None,
                Outcome::Fault(fault) => return Err(fault.message),
            })
        };
        let answers = in_parallel(asked.len(), answer).map_err(PredictionError::Model)?;
        if asked.is_empty() {
            return Err(PredictionError::Model(
                "the search has ended without a result".into(),
            ));
        }
        for (particle, values) in asked.into_iter().zip(answers) {
            let values = values.map_err(PredictionError::Model)?;
            running.tell(particle, values.as_deref()).map_err(|e| model(&e))?;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_posterior_with_too_many_draws_is_thinned_evenly() {
        let all: Vec<usize> = (0..10).collect();
        assert_eq!(spaced(&all, 5), [0, 2, 4, 6, 8]);
        assert_eq!(spaced(&all, 20), all);
    }
}
