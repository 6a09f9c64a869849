//! `/v1/experiments`: measured data sets.

use std::collections::BTreeMap;

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use shared::api::{ErrorBody, ExperimentCreated, NewExperiment};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::{Body, HttpError, Id, Query};
use super::list_page::NumbersPage;
use crate::service::Service;

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(create, list))
        .routes(routes!(files))
}

/// Stores an experiment.
///
/// The files are validated; a calibration then refers to the experiment by its number.
#[utoipa::path(post, path = "/experiments", operation_id = "create_experiment", tag = "experiments",
    request_body = NewExperiment, responses(
    (status = 201, description = "the number of the experiment", body = ExperimentCreated),
    (status = 422, body = ErrorBody, description = "a file is malformed"),
))]
async fn create(
    State(service): State<Service>,
    Body(new): Body<NewExperiment>,
) -> Result<(StatusCode, Json<ExperimentCreated>), HttpError> {
    let id = service.add_experiment(new).await?;
    Ok((StatusCode::CREATED, Json(ExperimentCreated { id })))
}

/// A stored experiment.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct ListedExperiment {
    /// Id of the experiment.
    id: i64,
    /// The studies that have a calibration on it.
    studies: Vec<i64>,
}

/// The files of an experiment.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct ExperimentFiles {
    /// Id of the experiment.
    id: i64,
    /// Text of `experiment.toml`.
    toml: String,
    /// Texts of the files that it names, by name.
    files: BTreeMap<String, String>,
}

/// Lists the experiments.
///
/// Every experiment, or a page of them, oldest first, with the studies that have a calibration on it.
#[utoipa::path(get, path = "/experiments", operation_id = "list_experiments", tag = "experiments",
    params(
        ("limit" = Option<u32>, Query, minimum = 1, maximum = 10000, description = "the largest number of entries; without it, all"),
        ("after" = Option<i64>, Query, description = "the number of the last entry of the page before")),
    responses((status = 200, description = "experiments with their studies", body = Vec<ListedExperiment>)))]
async fn list(
    State(service): State<Service>,
    Query(which): Query<NumbersPage>,
) -> Result<Json<Vec<ListedExperiment>>, HttpError> {
    let experiments = service.store().reader().experiments(which.page()?).await?;
    let listed = experiments
        .into_iter()
        .map(|(id, studies)| ListedExperiment { id, studies });
    Ok(Json(listed.collect()))
}

/// The files of an experiment.
///
/// As they were submitted, to the byte.
#[utoipa::path(get, path = "/experiments/{id}", operation_id = "get_experiment", tag = "experiments",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "the files", body = ExperimentFiles), (status = 404, body = ErrorBody)))]
async fn files(State(service): State<Service>, Id(id): Id) -> Result<Json<ExperimentFiles>, HttpError> {
    let files = service.experiment(id).await?;
    Ok(Json(ExperimentFiles {
        id,
        toml: files.toml,
        files: files.files,
    }))
}
