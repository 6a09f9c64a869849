//! Predictions of conditions of one's own, and decisions.

use std::collections::BTreeMap;

use shared::api::{NewDecision, NewPrediction};
use shared::experiment::read_wheels;
use tokio::sync::Semaphore;

use super::background::in_background;
use super::error::ServiceError;
use super::finished_study::{check_finished, finished_study};
use super::handle::Service;
use super::simulation::simulate;
use job::{ConditionDefaults, read_decision};
use prediction::decision::{decide, decision_runs};
use prediction::prediction::predict;
use prediction::{
    DecisionAnswer, Ensemble, Prediction, PredictionError, PredictionGrid, Sweep, planned_runs,
    prediction_grid, read_statements,
};
use result::Study;

/// One prediction is computed at a time, because it takes all cores.
static ONE_AT_A_TIME: Semaphore = Semaphore::const_new(1);
/// Names of files in messages.
const WHEELS: &str = "wheels.toml";
const DECISION: &str = "decision.toml";
const JOB: &str = "job.toml";

impl Service {
    /// Predicts planned runs by the posterior of a calibration and of the other models of its study. A model that was taken out of the
    /// study has no weight.
    ///
    /// # Errors
    /// [`ServiceError`]: the calibration has no posterior, or the plan is malformed.
    pub async fn predict(&self, id: i64, asked: NewPrediction) -> Result<Prediction, ServiceError> {
        self.alone(id, move |study| predicted(study, id, &asked)).await
    }

    /// Computes the predictions of a calibration over a grid of conditions, as JSON.
    ///
    /// # Errors
    /// The same as of [`Service::predict`].
    pub(super) async fn computed_grid(&self, id: i64) -> Result<String, ServiceError> {
        let grid = self
            .alone(id, move |study| {
                prediction_grid(study, id, |question| simulate(&question))
            })
            .await?;
        Ok(serde_json::to_string(&grid).expect("results have a JSON form"))
    }

    /// Compares the options of a decision by their expected losses. The answer is kept until the study changes, or another is asked for.
    ///
    /// # Errors
    /// [`ServiceError`]: the calibration has no posterior, or the decision is malformed.
    pub async fn decide(&self, id: i64, asked: NewDecision) -> Result<DecisionAnswer, ServiceError> {
        let row = self.calibration_row(id).await?;
        let (stamp, _) = self.stamped_members(row.study).await?;
        let (name, file) = match asked.file {
            Some(file) => (DECISION, file),
            None => (JOB, row.job.toml.clone()),
        };
        let draws = asked.draws;
        let answer = self
            .alone(id, move |study| decided(study, id, (name, &file), draws))
            .await?;
        self.keep_decision(&row, stamp, &answer).await?;
        Ok(answer)
    }

    /// Computes from the study of a calibration outside the threads of the runtime, one at a time.
    pub(super) async fn alone<T: Send + 'static>(
        &self,
        id: i64,
        compute: impl FnOnce(Study) -> Result<T, PredictionError> + Send + 'static,
    ) -> Result<T, ServiceError> {
        let row = self.calibration_row(id).await?;
        check_finished(&row)?;
        // The semaphore is never closed. A thread that computes cannot be stopped, so it keeps the permit until it has ended.
        let turn = ONE_AT_A_TIME.acquire().await;
        let reader = self.store().reader();
        let (mut members, _) = reader.members_and_withdrawn(row.study).await?;
        // What was taken back predicts by itself alone, and is weighed with no other model.
        if !members.iter().any(|member| member.id == row.id) {
            members = vec![row.clone()];
        }
        let study = finished_study(&reader, &row, &members).await?;
        let computed = in_background(move || {
            let _turn = turn;
            Ok(compute(study)?)
        });
        computed.await
    }
}

/// Returns the predictions of the current model of a study over a grid; nothing where there are none, as of plates or of a fit.
pub(super) fn current_grid(study: &Study) -> Vec<PredictionGrid> {
    let Some(current) = study.current() else {
        return Vec::new();
    };
    let grid = prediction_grid(study.clone(), current.row.id, |question| simulate(&question));
    grid.ok().into_iter().collect()
}

/// Returns the decision that the job of the current model of a study states; `None` where it states none, or where it has no value.
pub(super) fn current_decision(study: &Study) -> Option<DecisionAnswer> {
    let current = study.current()?;
    let file = current.row.job.toml.clone();
    decided(study.clone(), current.row.id, (JOB, &file), None).ok()
}

fn predicted(study: Study, id: i64, asked: &NewPrediction) -> Result<Prediction, PredictionError> {
    let wheels = match &asked.wheels {
        Some(text) => read_wheels(WHEELS, text)?,
        None => BTreeMap::new(),
    };
    let statements = read_statements(&asked.statements)?;
    let sweep = asked.sweep.as_deref().map(Sweep::read).transpose()?;
    let ensemble = Ensemble::new(study, id, wheels)?;
    let defaults = ConditionDefaults::new(&ensemble.asked().spec.experiment, ensemble.wheels());
    let runs = planned_runs(asked.plan.as_deref(), sweep.as_ref(), &defaults)?;
    let simulated = ensemble.simulate(runs, asked.draws, |question| simulate(&question))?;
    Ok(predict(&simulated, &statements))
}

fn decided(
    study: Study,
    id: i64,
    (name, file): (&str, &str),
    draws: Option<usize>,
) -> Result<DecisionAnswer, PredictionError> {
    let (decision, wheels) = read_decision(name, file)?;
    let ensemble = Ensemble::new(study, id, read_wheels(name, &wheels)?)?;
    let defaults = ConditionDefaults::new(&ensemble.asked().spec.experiment, ensemble.wheels());
    let (runs, scenarios) = decision_runs(&decision, &defaults)?;
    let simulated = ensemble.simulate(runs, draws, |question| simulate(&question))?;
    decide(&simulated, &decision, &scenarios)
}
