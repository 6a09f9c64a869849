//! `/v1/experiments`: measured data sets.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use shared::api::{ErrorBody, ExperimentCreated, NewExperiment};
use shared::file::FileSet;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::{Body, HttpError, Id};
use crate::service::Service;

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(create))
        .routes(routes!(files))
}

/// Validates and stores an experiment.
#[utoipa::path(post, path = "/experiments", request_body = NewExperiment, responses(
    (status = 201, body = ExperimentCreated),
    (status = 422, body = ErrorBody, description = "a file is malformed"),
))]
async fn create(
    State(service): State<Service>,
    Body(new): Body<NewExperiment>,
) -> Result<(StatusCode, Json<ExperimentCreated>), HttpError> {
    let id = service.add_experiment(new).await?;
    Ok((StatusCode::CREATED, Json(ExperimentCreated { id })))
}

/// The files of an experiment.
#[utoipa::path(get, path = "/experiments/{id}", params(("id" = i64, Path)), responses(
    (status = 200, body = NewExperiment), (status = 404, body = ErrorBody)))]
async fn files(State(service): State<Service>, Id(id): Id) -> Result<Json<NewExperiment>, HttpError> {
    let FileSet { toml, files } = service.experiment(id).await?;
    Ok(Json(NewExperiment { toml, files }))
}
