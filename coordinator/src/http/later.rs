//! Routes of the contract that a later version brings; they answer 501.

use shared::api::ErrorBody;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::HttpError;
use crate::service::Service;

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(discovery, start_discovery))
        .routes(routes!(extend))
}

/// Which effect is missing. Not available in this version.
#[utoipa::path(get, path = "/calibrations/{id}/discovery", params(("id" = i64, Path)), responses(
    (status = 501, body = ErrorBody)))]
async fn discovery() -> HttpError {
    HttpError::not_available("discovery")
}

/// Starts the search for a missing effect. Not available in this version.
#[utoipa::path(post, path = "/calibrations/{id}/discovery", params(("id" = i64, Path)), responses(
    (status = 501, body = ErrorBody)))]
async fn start_discovery() -> HttpError {
    HttpError::not_available("discovery")
}

/// Adds an effect to a calibration. Not available in this version.
#[utoipa::path(post, path = "/calibrations/{id}/extend", params(("id" = i64, Path)), responses(
    (status = 501, body = ErrorBody)))]
async fn extend() -> HttpError {
    HttpError::not_available("extending a calibration by an effect")
}
