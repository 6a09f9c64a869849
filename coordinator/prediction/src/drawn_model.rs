//! The model of a calibration with its draws, for programs that simulate it themselves.

use job::{ConditionDefaults, PlannedCondition};
use result::FinishedCalibration;
use shared::experiment::RunUse;
use shared::model::DrawnModel;

use crate::ensemble::variant;
use crate::error::PredictionError;

/// Returns the model with one condition, and the parameters at the draws that predictions use.
///
/// # Arguments
/// - `stated`: the condition; slip, load and speed that it leaves out are the medians of the fitted runs, the slip angle is 0, the pass 1, and
///   the gravity the rig's.
///
/// # Errors
/// [`PredictionError::NoDraws`]; [`PredictionError::NoStoredDraws`]; [`PredictionError::Request`] names a quantity of the condition, or
/// says that the model is not ours. Checked by `simulators::a_service_gives_the_model_with_its_draws` of the tests of the farm.
pub fn drawn_model(
    calibration: &FinishedCalibration,
    stated: &PlannedCondition,
) -> Result<DrawnModel, PredictionError> {
    let id = calibration.row.id;
    if calibration.estimate().is_some() {
        return Err(PredictionError::NoDraws(id));
    }
    if calibration.spec.fit_variant.external.is_some() {
        let message = "a model that is not ours is simulated by its own program";
        return Err(PredictionError::Request(message.into()));
    }
    let experiment = &calibration.spec.experiment;
    let fitted = experiment.runs.iter().filter(|run| run.usage == RunUse::Fit);
    let mut slips: Vec<f64> = fitted.map(|run| run.slip).collect();
    slips.sort_by(f64::total_cmp);
    let slip = slips.get(slips.len().saturating_sub(1) / 2).copied();
    let defaults = ConditionDefaults::new(experiment, &experiment.wheels);
    let planned = defaults
        .run(stated, "run", slip)
        .map_err(PredictionError::Request)?;
    let draws: Vec<Vec<f64>> = calibration
        .predictive_draws()
        .iter()
        .map(|draw| calibration.spec.model_theta(&draw.theta).to_vec())
        .collect();
    if draws.is_empty() {
        return Err(PredictionError::NoStoredDraws(id));
    }
    let model_version = calibration.row.model_version.clone().unwrap_or_default();
    let variant = variant(calibration, &experiment.wheels, &planned);
    Ok(DrawnModel::new(
        id,
        calibration.spec.model_words(),
        model_version,
        variant,
        draws,
    ))
}
