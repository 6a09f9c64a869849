//! The routes that predict conditions of one's own and compare options.

use axum::Json;
use axum::extract::State;
use prediction::{DecisionAnswer, Prediction};
use shared::api::{ErrorBody, NewDecision, NewPrediction};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::{Body, HttpError, Id};
use crate::service::Service;

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(predict))
        .routes(routes!(decide))
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

/// Compares the options of a decision.
///
/// Expected losses over the posterior of all models of the study, the best option and by how much, what decides it, and what one more run
/// is worth against its cost. Nothing is stored.
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
