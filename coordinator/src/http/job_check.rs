//! `/v1/check`: a job before it is submitted.

use axum::Json;
use axum::extract::State;
use shared::api::ErrorBody;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::{Body, HttpError};
use crate::service::{JobCheck, NewCheck, Service};

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new().routes(routes!(check_job))
}

/// Checks a job before it is submitted.
///
/// Its models with their priors, what they leave out, and the expected cost of each calibration by a pilot of at most ten seconds. What a
/// submission would refuse is refused with the same message. Nothing is stored.
#[utoipa::path(post, path = "/check", operation_id = "check_job", tag = "calibrations",
    request_body = NewCheck, responses(
    (status = 200, description = "what the job would compute", body = JobCheck),
    (status = 422, body = ErrorBody, description = "the job, its experiment or a file of theirs is malformed"),
))]
async fn check_job(
    State(service): State<Service>,
    Body(asked): Body<NewCheck>,
) -> Result<Json<JobCheck>, HttpError> {
    Ok(Json(service.check_job(asked).await?))
}
