//! `/v1/studies`: lines of calibrations on one experiment, with their error ledger.

use axum::Json;
use axum::extract::State;
use axum::http::HeaderMap;
use axum::response::Response;
use shared::api::{ErrorBody, StudyArchived, StudyDeleted};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::access::Caller;
use super::error::{Body, HttpError, Id, Query};
use super::list_page::StudiesPage;
use super::unchanged;
use crate::service::Service;
use record::StudyDetails;
use report::{StudyListItem, StudyOverview};

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(list))
        .routes(routes!(overview, delete))
        .routes(routes!(archive))
        .routes(routes!(restore))
        .routes(routes!(describe))
}

/// Lists the studies.
///
/// Every study, or a page of them, oldest first; archived ones with `archived=true` alone. Error and verdict of a study that has just
/// changed are null until they are computed. The answer has a tag, and is not sent again to who has it.
#[utoipa::path(get, path = "/studies", operation_id = "list_studies", tag = "studies",
    params(("archived" = Option<bool>, Query, description = "whether archived studies are listed too"),
        ("limit" = Option<u32>, Query, minimum = 1, maximum = 10000, description = "the largest number of entries; without it, all"),
        ("after" = Option<i64>, Query, description = "the number of the last entry of the page before")), responses(
    (status = 200, description = "studies with state, error and verdict", body = Vec<StudyListItem>),
    (status = 304, description = "the client has this answer: `If-None-Match` names its tag")))]
async fn list(
    State(service): State<Service>,
    Query(which): Query<StudiesPage>,
    headers: HeaderMap,
) -> Result<Response, HttpError> {
    unchanged::answer(&headers, &service.studies(which.archived, which.page()?).await?)
}

/// Deletes a study for good.
///
/// Deletes its calibrations and results, too, and its experiments if no other study has them.
#[utoipa::path(delete, path = "/studies/{id}", operation_id = "delete_study", tag = "studies",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "what was deleted", body = StudyDeleted), (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "one of its calibrations is not over")))]
async fn delete(
    State(service): State<Service>,
    by: Caller,
    Id(id): Id,
) -> Result<Json<StudyDeleted>, HttpError> {
    let calibrations = service.delete_study(id).await?;
    tracing::info!(study = id, ?calibrations, %by, "deleted");
    Ok(Json(StudyDeleted { id, calibrations }))
}

/// Takes a study out of the lists.
///
/// It stays readable by its number, and no longer grows.
#[utoipa::path(post, path = "/studies/{id}/archive", operation_id = "archive_study", tag = "studies",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "the study is archived", body = StudyArchived), (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "one of its calibrations is not over")))]
async fn archive(
    State(service): State<Service>,
    by: Caller,
    Id(id): Id,
) -> Result<Json<StudyArchived>, HttpError> {
    service.archive_study(id).await?;
    tracing::info!(study = id, %by, "archived");
    Ok(Json(StudyArchived { id, archived: true }))
}

/// Takes an archived study back.
///
/// It is in the lists again, and may grow.
#[utoipa::path(post, path = "/studies/{id}/restore", operation_id = "restore_study", tag = "studies",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "the study is in the lists", body = StudyArchived), (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "one of its calibrations is not over")))]
async fn restore(
    State(service): State<Service>,
    by: Caller,
    Id(id): Id,
) -> Result<Json<StudyArchived>, HttpError> {
    service.restore_study(id).await?;
    tracing::info!(study = id, %by, "restored");
    Ok(Json(StudyArchived { id, archived: false }))
}

/// Says what people say of a study.
///
/// Name, author, tags and a note, all in the place of earlier ones; no result changes. A study that is submitted with a
/// token begins with the token's name as its author.
#[utoipa::path(post, path = "/studies/{id}/details", operation_id = "describe_study", tag = "studies",
    params(("id" = i64, Path)), request_body = StudyDetails, responses(
    (status = 200, description = "what is kept", body = StudyDetails), (status = 404, body = ErrorBody),
    (status = 400, body = ErrorBody, description = "a line is blank or too long")))]
async fn describe(
    State(service): State<Service>,
    by: Caller,
    Id(id): Id,
    Body(details): Body<StudyDetails>,
) -> Result<Json<StudyDetails>, HttpError> {
    service.describe_study(id, details.clone()).await?;
    tracing::info!(study = id, %by, "described");
    Ok(Json(details))
}

/// A study with its error ledger.
///
/// Members, error ledger and flags; of a study in progress, what is finished.
#[utoipa::path(get, path = "/studies/{id}", operation_id = "get_study", tag = "studies",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "the study", body = StudyOverview), (status = 404, body = ErrorBody)))]
async fn overview(State(service): State<Service>, Id(id): Id) -> Result<Json<StudyOverview>, HttpError> {
    Ok(Json(service.study_overview(id).await?))
}
