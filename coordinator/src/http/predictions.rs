//! The routes that predict conditions of one's own and compare options.

use axum::Json;
use axum::extract::State;
use axum::response::IntoResponse;
use job::PlannedCondition;
use prediction::recording::FollowedRecording;
use prediction::{DecisionAnswer, Prediction, PredictionGrid, drawn_model};
use shared::api::{ErrorBody, NewDecision, NewPrediction, NewRecording};
use shared::model::DrawnModel;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::calibrations::json;
use super::error::{Body, HttpError, Id, Query};
use crate::service::Service;
use crate::service::ServiceError;

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(predict))
        .routes(routes!(grid))
        .routes(routes!(decide))
        .routes(routes!(decision))
        .routes(routes!(drawn))
        .routes(routes!(stream))
}

/// Predicts conditions of one's own.
///
/// Channels, what follows from them (traction, power, efficiency, slopes, energy) and probabilities of statements, with intervals of the
/// parameters, of all models of the study by their evidence, and of a new measurement. Nothing is stored. A model in steady motion takes
/// seconds, one that rolls over terrain minutes.
#[utoipa::path(post, path = "/calibrations/{id}/predict", operation_id = "predict", tag = "results",
    params(("id" = i64, Path, description = "id of a calibration with a posterior")), request_body = NewPrediction, responses(
    (status = 200, description = "the predictions", body = Prediction),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "the calibration is not finished, has no draws, or its model cannot be evaluated here"),
    (status = 422, body = ErrorBody, description = "the plan, the sweep, a wheel or a statement is malformed"),
))]
async fn predict(
    State(service): State<Service>,
    Id(id): Id,
    Body(asked): Body<NewPrediction>,
) -> Result<Json<Prediction>, HttpError> {
    Ok(Json(service.predict(id, asked).await?))
}

/// The predictions over a grid of conditions.
///
/// What sliders move through: eleven slips, and three loads and speeds, as far as the fitted runs reach and some way beyond, with mean and 90 %
/// interval of every quantity by 40 draws of each model. It is kept. A model that rolls over terrain, or is not ours, has the axes alone.
#[utoipa::path(get, path = "/calibrations/{id}/prediction-grid", operation_id = "get_prediction_grid", tag = "results",
    params(("id" = i64, Path, description = "id of a calibration with a posterior")), responses(
    (status = 200, description = "the grid", body = PredictionGrid),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "the calibration is not finished, has no draws, or its model cannot be evaluated here"),
    (status = 422, body = ErrorBody, description = "no wheel run is fitted"),
))]
async fn grid(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(service.prediction_grid(id).await?))
}

/// Compares the options of a decision.
///
/// Expected losses over the posterior of all models of the study, the best option and by how much, what decides it, and what one more run
/// is worth against its cost. The answer is kept for the page and the report until the study changes or another decision is asked for.
#[utoipa::path(post, path = "/calibrations/{id}/decide", operation_id = "decide", tag = "results",
    params(("id" = i64, Path, description = "id of a calibration with a posterior")), request_body = NewDecision, responses(
    (status = 200, description = "the losses of the options", body = DecisionAnswer),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "the calibration is not finished, has no draws, or its model cannot be evaluated here"),
    (status = 422, body = ErrorBody, description = "the decision is malformed, or a loss has no value"),
))]
async fn decide(
    State(service): State<Service>,
    Id(id): Id,
    Body(asked): Body<NewDecision>,
) -> Result<Json<DecisionAnswer>, HttpError> {
    Ok(Json(service.decide(id, asked).await?))
}

/// The decision by a calibration.
///
/// The answer to the decision that was asked for last or, without one, to the table `[decision]` of the calibration's job; null where there
/// is neither.
#[utoipa::path(get, path = "/calibrations/{id}/decision", operation_id = "get_decision", tag = "results",
    params(("id" = i64, Path, description = "id of a calibration with a posterior")), responses(
    (status = 200, description = "the losses of the options, or null", body = Option<DecisionAnswer>),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "the calibration is not finished, has no draws, or its model cannot be evaluated here"),
    (status = 422, body = ErrorBody, description = "the decision of the job is malformed, or a loss has no value"),
))]
async fn decision(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(service.decision(id).await?))
}

/// The model with its draws.
///
/// What another program needs to simulate the calibrated model: the model with one condition, which it replaces by its own, and the
/// parameters at each draw that predictions use. Slip, load and speed that the query leaves out are the medians of the fitted runs, the slip
/// angle is 0, the pass 1, and the gravity the rig's. 422 of a model that is not ours.
#[utoipa::path(get, path = "/calibrations/{id}/drawn-model", operation_id = "get_drawn_model", tag = "results",
    params(
        ("id" = i64, Path),
        ("wheel" = Option<String>, Query, description = "wheel, if the fitted runs have several"),
        ("slip" = Option<f64>, Query, description = "slip"),
        ("wheel_load_n" = Option<f64>, Query, description = "load in N"),
        ("sled_speed_m_s" = Option<f64>, Query, description = "speed of travel in m/s"),
        ("slip_angle_deg" = Option<f64>, Query, description = "from wheel heading to travel in deg"),
        ("pass" = Option<u32>, Query, description = "number of the pass"),
        ("gravity_m_s2" = Option<f64>, Query, description = "acceleration of gravity in m/s^2"),
    ), responses(
    (status = 200, description = "the model with its draws", body = DrawnModel),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "the calibration is not finished, or has no draws"),
    (status = 422, body = ErrorBody, description = "the condition is malformed"),
))]
async fn drawn(
    State(service): State<Service>,
    Id(id): Id,
    Query(stated): Query<PlannedCondition>,
) -> Result<Json<DrawnModel>, HttpError> {
    let calibration = service.finished_calibration(id).await?;
    let model = drawn_model(&calibration, &stated).map_err(ServiceError::from)?;
    Ok(Json(model))
}

/// Follows a recording.
///
/// The parameters of the soil after each second of a recording at 10 Hz, with intervals that forget by a walk whose size is inferred, and
/// the changes of the soil with their times. What is said of a time rests on the samples until then alone. Nothing is stored. 422 of a model
/// that does not move steadily.
#[utoipa::path(post, path = "/calibrations/{id}/stream", operation_id = "stream", tag = "results",
    params(("id" = i64, Path, description = "id of a calibration with a posterior")), request_body = NewRecording, responses(
    (status = 200, description = "the parameters in time, and the changes", body = FollowedRecording),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "the calibration is not finished, has no draws, or its model cannot be evaluated here"),
    (status = 422, body = ErrorBody, description = "a row or the name of a parameter is malformed, or the model is too slow"),
))]
async fn stream(
    State(service): State<Service>,
    Id(id): Id,
    Body(asked): Body<NewRecording>,
) -> Result<Json<FollowedRecording>, HttpError> {
    Ok(Json(service.stream(id, asked).await?))
}
