//! The models of a study with their weights, simulated under planned conditions.

use std::collections::BTreeMap;
use std::sync::Arc;

use job::PlannedRun;
use record::RejectionReason;
use result::{FinishedCalibration, Study};
use shared::experiment::WheelGeometry;
use shared::model::{ModelKind, ModelVariant, RunCondition};
use shared::outcome::Observables;

use crate::error::PredictionError;

/// Smallest weight of a model that is simulated.
const MIN_WEIGHT: f64 = 1e-4;
/// Largest number of simulations of a request by a model in steady motion: seconds on one core.
const MAX_STEADY: usize = 200_000;
/// Largest number of simulations of a request by a model that rolls over terrain, or that is not ours: minutes.
const MAX_SLOW: usize = 2_000;
/// Smallest number of draws from which intervals are computed.
pub const MIN_DRAWS: usize = 20;

/// The weight of a model in predictions by all models.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ModelWeight {
    /// Id of the model's calibration.
    pub calibration: i64,
    /// Kind of the model, with its effects.
    pub name: String,
    /// Posterior probability among the models of the study, from equal prior probabilities; 0 of a model without evidence.
    pub weight: f64,
}

/// A calibration of the study with its weight.
#[derive(Debug)]
pub struct WeightedModel {
    /// The calibration; its last runs are the planned ones once it is simulated.
    pub calibration: FinishedCalibration,
    /// Its weight among the models that are simulated.
    pub weight: f64,
}

/// The models of a study that count for a prediction; the first is the one that was asked for.
#[derive(Debug)]
pub struct Ensemble {
    models: Vec<WeightedModel>,
    /// Weights of all models of the study.
    pub weights: Vec<ModelWeight>,
    wheels: BTreeMap<String, WheelGeometry>,
}

/// What a model is asked: each variant, which has one condition, at each parameter vector.
#[derive(Debug)]
pub struct Question {
    /// A variant for each planned run.
    pub variants: Vec<ModelVariant>,
    /// The parameters of the model at each draw, the most probable ones first.
    pub thetas: Vec<Vec<f64>>,
}

/// The results of a variant at each parameter vector.
pub type RunAnswers = Vec<Result<Observables, RejectionReason>>;

/// The answers to a question: those of each variant.
pub type Answers = Vec<RunAnswers>;

/// The models with the results of the planned runs.
#[derive(Debug)]
pub struct Simulated {
    /// The models; the first is the one that was asked for.
    pub models: Vec<WeightedModel>,
    /// Weights of all models of the study.
    pub weights: Vec<ModelWeight>,
    /// The planned runs.
    pub runs: Vec<PlannedRun>,
    /// Position of the first planned run in the experiment of each model.
    pub first: usize,
    /// Number of draws of each model.
    pub draws: usize,
    /// Whether more draws were asked for and would have been too many simulations.
    pub is_thinned: bool,
}

impl Ensemble {
    /// Chooses the models of a study that have draws and the measurements of a calibration, with weights proportional to their evidence.
    ///
    /// # Arguments
    /// - `id`: the calibration that is asked for. `wheels`: wheels that its experiment does not have.
    ///
    /// # Errors
    /// [`PredictionError::NoDraws`]; [`PredictionError::Request`] if a wheel has the name of one of the experiment.
    pub fn new(
        study: Study,
        id: i64,
        wheels: BTreeMap<String, WheelGeometry>,
    ) -> Result<Ensemble, PredictionError> {
        let of_ledger = study.ledger().chain(&study.other_models);
        let ledger: Vec<i64> = of_ledger.map(|calibration| calibration.row.id).collect();
        let asked = study.calibrations().find(|calibration| calibration.row.id == id);
        let experiment = asked.map(|calibration| calibration.row.experiment);
        let all = std::iter::once(study.lead)
            .chain(study.other_models)
            .chain(study.point_estimates)
            .chain(study.extensions);
        let counts = |calibration: &FinishedCalibration| {
            let is_of_study =
                ledger.contains(&calibration.row.id) && Some(calibration.row.experiment) == experiment;
            calibration.row.id == id || is_of_study && calibration.estimate().is_none()
        };
        let mut chosen: Vec<FinishedCalibration> = all.filter(counts).collect();
        chosen.sort_by_key(|calibration| (calibration.row.id != id, calibration.row.id));
        let Some(asked) = chosen
            .first()
            .filter(|calibration| calibration.estimate().is_none())
        else {
            return Err(PredictionError::NoDraws(id));
        };
        let known = &asked.spec.experiment.wheels;
        if let Some(name) = wheels.keys().find(|name| known.contains_key(*name)) {
            let message = format!("wheel \"{name}\" is in the experiment already: give yours another name");
            return Err(PredictionError::Request(message));
        }
        let weights = evidence_weights(&chosen);
        let stated = chosen
            .iter()
            .zip(&weights)
            .map(|(calibration, &weight)| ModelWeight {
                calibration: calibration.row.id,
                name: calibration.spec.model_words(),
                weight,
            });
        let stated: Vec<ModelWeight> = stated.collect();
        let known = known.clone();
        let models = chosen.into_iter().zip(weights);
        let models = models.map(|(calibration, weight)| WeightedModel { calibration, weight });
        let mut models: Vec<WeightedModel> = models.collect();
        // The model that was asked for is simulated whatever its weight.
        models.retain(|model| model.calibration.row.id == id || model.weight >= MIN_WEIGHT);
        let total: f64 = models.iter().map(|model| model.weight).sum();
        models.iter_mut().for_each(|model| model.weight /= total);
        Ok(Ensemble {
            models,
            weights: stated,
            wheels: known.into_iter().chain(wheels).collect(),
        })
    }

    /// Returns the wheels that a plan may name.
    pub fn wheels(&self) -> &BTreeMap<String, WheelGeometry> {
        &self.wheels
    }

    /// Returns the calibration that was asked for.
    pub fn asked(&self) -> &FinishedCalibration {
        &self.models[0].calibration
    }

    /// Simulates planned runs at the final draws of each model, or at evenly spaced ones where there would be too many simulations.
    ///
    /// # Arguments
    /// - `draws`: of each model, at most. `simulate`: answers a question.
    ///
    /// # Errors
    /// [`PredictionError::Request`] if there are too many runs or no draws are asked for; [`PredictionError::NoStoredDraws`];
    /// [`PredictionError::Model`] if a model cannot be evaluated. Checked by `tests::at_least_one_draw_is_asked_for`.
    pub fn simulate(
        self,
        runs: Vec<PlannedRun>,
        draws: Option<usize>,
        simulate: impl Fn(Question) -> Result<Answers, String>,
    ) -> Result<Simulated, PredictionError> {
        if draws == Some(0) {
            let message = "draws 0 of each model must be at least 1";
            return Err(PredictionError::Request(message.into()));
        }
        let mut available = usize::MAX;
        for calibration in self.models.iter().map(|model| &model.calibration) {
            match calibration.predictive_draws().len() {
                0 => return Err(PredictionError::NoStoredDraws(calibration.row.id)),
                stored => available = available.min(stored),
            }
        }
        let asked = draws.unwrap_or(available).min(available);
        let count = asked.min(self.affordable(runs.len()));
        if count < asked.min(MIN_DRAWS) || count == 0 {
            return Err(self.too_many(runs.len()));
        }
        let first = self.asked().spec.experiment.runs.len();
        let mut models = Vec::new();
        for mut model in self.models {
            let calibration = &mut model.calibration;
            thin(calibration, count);
            let question = Question {
                variants: runs
                    .iter()
                    .map(|run| variant(calibration, &self.wheels, run))
                    .collect(),
                thetas: calibration
                    .predictions
                    .iter()
                    .map(|draw| calibration.spec.model_theta(&draw.theta).to_vec())
                    .collect(),
            };
            let answers = simulate(question).map_err(PredictionError::Model)?;
            take(calibration, &runs, &self.wheels, answers);
            models.push(model);
        }
        Ok(Simulated {
            models,
            weights: self.weights,
            runs,
            first,
            draws: count,
            is_thinned: count < asked,
        })
    }

    /// Returns whether every model is in steady motion, so that a simulation takes less than a millisecond.
    pub fn is_fast(&self) -> bool {
        let mut kinds = self.models.iter().map(|model| model.calibration.spec.model.kind);
        kinds.all(|kind| limit(kind) == MAX_STEADY)
    }

    /// Returns the largest number of draws of each model at which a number of runs may be simulated in a request.
    ///
    /// # Errors
    /// [`PredictionError::Request`] if it is below [`MIN_DRAWS`].
    pub fn affordable_draws(&self, runs: usize) -> Result<usize, PredictionError> {
        match self.affordable(runs) {
            count if count < MIN_DRAWS => Err(self.too_many(runs)),
            count => Ok(count),
        }
    }

    fn too_many(&self, runs: usize) -> PredictionError {
        PredictionError::Request(format!(
            "{runs} runs are too many: at {MIN_DRAWS} draws of {} models they must be at most {}",
            self.models.len(),
            self.most_runs()
        ))
    }

    /// Returns the cost of a run at one draw of each model, as a share of what a request may cost.
    fn share_of_run(&self) -> f64 {
        let share = |model: &WeightedModel| 1.0 / limit(model.calibration.spec.model.kind) as f64;
        self.models.iter().map(share).sum()
    }

    /// Returns the number of draws at which a number of runs can be simulated.
    fn affordable(&self, runs: usize) -> usize {
        (1.0 / (self.share_of_run() * runs.max(1) as f64)) as usize
    }

    /// Returns the number of runs that can be simulated at the least number of draws.
    fn most_runs(&self) -> usize {
        (1.0 / (self.share_of_run() * MIN_DRAWS as f64)) as usize
    }
}

fn limit(kind: ModelKind) -> usize {
    match kind {
        ModelKind::QuasiStatic | ModelKind::WongReece | ModelKind::Rft => MAX_STEADY,
        _ => MAX_SLOW,
    }
}

/// Returns posterior probabilities from equal prior ones. Without any evidence, the first model has all weight.
fn evidence_weights(calibrations: &[FinishedCalibration]) -> Vec<f64> {
    let logs = || {
        calibrations
            .iter()
            .map(|calibration| calibration.row.log_evidence)
    };
    let max = logs().flatten().fold(f64::NEG_INFINITY, f64::max);
    if max == f64::NEG_INFINITY {
        return (0..calibrations.len())
            .map(|i| f64::from(u8::from(i == 0)))
            .collect();
    }
    let weight = |log: Option<f64>| log.map_or(0.0, |log| libm::exp(log - max));
    let total: f64 = logs().map(weight).sum();
    logs().map(|log| weight(log) / total).collect()
}

/// Keeps the most probable parameters and a number of evenly spaced draws.
fn thin(calibration: &mut FinishedCalibration, count: usize) {
    let draws = calibration.predictive_draws();
    let kept: Vec<_> = (0..count)
        .map(|i| draws[i * draws.len() / count].clone())
        .collect();
    calibration.predictions.truncate(1);
    calibration.predictions.extend(kept);
}

/// Returns the variant of a planned run alone. Soil and position in the series are those of the fitted runs; a drift is taken at the middle
/// of the series.
pub(crate) fn variant(
    calibration: &FinishedCalibration,
    wheels: &BTreeMap<String, WheelGeometry>,
    planned: &PlannedRun,
) -> ModelVariant {
    let fitted = &calibration.spec.fit_variant;
    let like = fitted.conditions.first();
    let run = &planned.run;
    ModelVariant {
        wheels: wheels.clone(),
        gravity_m_s2: planned.gravity_m_s2,
        conditions: Arc::new([RunCondition {
            wheel: run.wheel.clone(),
            slip: run.slip,
            wheel_load_n: run.wheel_load_n,
            sled_speed_m_s: run.sled_speed_m_s,
            slip_angle_deg: run.slip_angle_deg,
            pass: run.pass,
            repose_angle_deg: like.and_then(|condition| condition.repose_angle_deg),
            density_kg_m3: like.and_then(|condition| condition.density_kg_m3),
            order: like.and_then(|condition| condition.order).map(|_| 0.0),
        }]),
        transients: Vec::new(),
        plates: Vec::new(),
        rings: Vec::new(),
        ..fitted.clone()
    }
}

/// Puts the planned runs in the place of the held-out runs of a calibration, with their results at its draws.
fn take(
    calibration: &mut FinishedCalibration,
    runs: &[PlannedRun],
    wheels: &BTreeMap<String, WheelGeometry>,
    answers: Answers,
) {
    let experiment = Arc::make_mut(&mut calibration.spec.experiment);
    let first = experiment.runs.len();
    experiment.wheels = wheels.clone();
    experiment
        .runs
        .extend(runs.iter().map(|planned| planned.run.clone()));
    calibration.spec.holdout_runs = (first..first + runs.len()).collect();
    let one_by_one = || RejectionReason("the planned runs are simulated one by one".into());
    for draw in &mut calibration.predictions {
        draw.holdout = Some(Err(one_by_one()).into());
    }
    for (run, of_draws) in answers.into_iter().enumerate() {
        for (draw, result) in calibration.predictions.iter_mut().zip(of_draws) {
            if let Some(holdout) = &mut draw.holdout {
                holdout.alone.insert(run, result);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_least_one_draw_is_asked_for() {
        let ensemble = Ensemble {
            models: Vec::new(),
            weights: Vec::new(),
            wheels: BTreeMap::new(),
        };
        let refused = ensemble.simulate(Vec::new(), Some(0), |_| Ok(Vec::new()));
        let error = refused.unwrap_err().to_string();
        assert_eq!(error, "draws 0 of each model must be at least 1");
    }
}
