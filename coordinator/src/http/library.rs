//! `/v1/library`: laws that every later search tries, with what the studies say of them.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use shared::api::{ErrorBody, LibraryLawRemoved, NewLibraryLaw};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::access::Caller;
use super::error::{Body, HttpError, Name};
use crate::effect::library::LibraryLaw;
use crate::service::Service;

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(list, add))
        .routes(routes!(remove))
}

/// Lists the laws that joined the library.
///
/// Each comes with the studies whose searches tried it: where it held, where it did not, and their evidence together. The study that
/// found a law does not count, and measurements that several studies have count once.
#[utoipa::path(get, path = "/library", operation_id = "list_library", tag = "effects",
    responses((status = 200, description = "the laws, by name", body = Vec<LibraryLaw>)))]
async fn list(State(service): State<Service>) -> Result<Json<Vec<LibraryLaw>>, HttpError> {
    Ok(Json(service.library().await?))
}

/// Adds a law to the library.
///
/// It is a candidate of every search that begins from now on and whose model can have it; a search that is running goes on without it.
#[utoipa::path(post, path = "/library", operation_id = "add_to_library", tag = "effects",
    request_body = NewLibraryLaw, responses(
    (status = 201, body = LibraryLaw, description = "the law, as later searches try it"),
    (status = 400, body = ErrorBody, description = "the request names no law, or the search found none of this name"),
    (status = 404, body = ErrorBody, description = "there is no such calibration, or no search of it"),
    (status = 409, body = ErrorBody, description = "the name belongs to the catalogue, or the search is not finished"),
    (status = 422, body = ErrorBody, description = "the file is malformed"),
))]
async fn add(
    State(service): State<Service>,
    by: Caller,
    Body(new): Body<NewLibraryLaw>,
) -> Result<(StatusCode, Json<LibraryLaw>), HttpError> {
    let log_name = by.to_string();
    let law = service.add_to_library(new, by.into_name()).await?;
    tracing::info!(
        law = law.name,
        version = law.version,
        by = log_name,
        "law added to the library"
    );
    Ok((StatusCode::CREATED, Json(law)))
}

/// Removes a law from the library.
///
/// Later searches do not try it; its effect stays in the catalogue of the service, and results stay as they are.
#[utoipa::path(delete, path = "/library/{name}", operation_id = "remove_from_library", tag = "effects",
    params(("name" = String, Path, description = "name of the law")), responses(
    (status = 200, description = "what was removed", body = LibraryLawRemoved),
    (status = 404, body = ErrorBody)))]
async fn remove(
    State(service): State<Service>,
    by: Caller,
    Name(name): Name,
) -> Result<Json<LibraryLawRemoved>, HttpError> {
    service.remove_from_library(&name).await?;
    tracing::info!(law = name, %by, "law removed from the library");
    Ok(Json(LibraryLawRemoved { name }))
}
