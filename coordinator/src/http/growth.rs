//! The routes that extend studies: extensions of calibrations, searches for missing effects, further runs.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use shared::api::{
    CalibrationCreated, ErrorBody, ErrorKind, NewExtension, NewRuns, RunsAdded, WhatIf, Withdrawn,
};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::access::Caller;
use super::error::{Body, HttpError, Id};
use crate::service::Service;
use record::{Discovery, Extension};

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(extend))
        .routes(routes!(discovery, discover))
        .routes(routes!(add_runs))
        .routes(routes!(what_if))
        .routes(routes!(withdraw))
}

/// Calibrates with one more effect.
///
/// Adds a calibration to the study of another: the same job with one more effect, of the catalogue or of a file. If the
/// study already has such a calibration, the answer names it.
#[utoipa::path(post, path = "/calibrations/{id}/extend", operation_id = "extend_calibration", tag = "studies",
    params(("id" = i64, Path)), request_body = NewExtension, responses(
    (status = 201, description = "the new calibration", body = CalibrationCreated), (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "the calibration is a search"),
    (status = 422, body = ErrorBody, description = "the effect is unknown, malformed, or there already"),
))]
async fn extend(
    State(service): State<Service>,
    by: Caller,
    Id(id): Id,
    Body(new): Body<NewExtension>,
) -> Result<(StatusCode, Json<CalibrationCreated>), HttpError> {
    let created = service.extend(id, extension(new)?).await?;
    tracing::info!(calibration = created.id, extends = id, %by, "submitted");
    Ok((StatusCode::CREATED, Json(created)))
}

fn extension(new: NewExtension) -> Result<Extension, HttpError> {
    match (new.effect, new.wheel, new.effect_file) {
        (Some(effect), None, None) => Ok(Extension::Effect(effect)),
        (Some(effect), Some(wheel), None) => Ok(Extension::OnWheel { effect, wheel }),
        (None, None, Some(file)) => Ok(Extension::File {
            name: file.name,
            text: file.text,
        }),
        _ => Err(HttpError::new(
            ErrorKind::InvalidBody,
            "an extension is {\"effect\": NAME}, with \"wheel\": NAME on one wheel alone, or {\"effect_file\": {\"name\": NAME, \"text\": TEXT}}",
        )),
    }
}

/// Searches for a missing effect.
///
/// Starts the search of a calibration's model, unless there is one already.
#[utoipa::path(post, path = "/calibrations/{id}/discovery", operation_id = "start_discovery", tag = "studies",
    params(("id" = i64, Path)), responses(
    (status = 201, body = CalibrationCreated, description = "the search"), (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "the calibration is a search itself"),
))]
async fn discover(
    State(service): State<Service>,
    by: Caller,
    Id(id): Id,
) -> Result<(StatusCode, Json<CalibrationCreated>), HttpError> {
    let created = service.discover(id).await?;
    tracing::info!(calibration = created.id, searches = id, %by, "submitted");
    Ok((StatusCode::CREATED, Json(created)))
}

/// What the search found.
///
/// Probabilities of the effects and of the sets of effects, their predictions of the measurements, and what a further run
/// would distinguish.
#[utoipa::path(get, path = "/calibrations/{id}/discovery", operation_id = "get_discovery", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "the outcome of the search", body = Discovery),
    (status = 404, body = ErrorBody, description = "no search was asked for"),
    (status = 409, body = ErrorBody, description = "the search is not finished"),
))]
async fn discovery(State(service): State<Service>, Id(id): Id) -> Result<Json<Discovery>, HttpError> {
    Ok(Json(service.finished_search(id).await?))
}

/// Adds measurements to a study.
///
/// A calibration of all runs follows, with the job of `calibration`, by default the last of the ledger.
#[utoipa::path(post, path = "/studies/{id}/runs", operation_id = "add_runs", tag = "studies",
    params(("id" = i64, Path)), request_body = NewRuns, responses(
    (status = 201, description = "the new calibration and experiment", body = RunsAdded),
    (status = 404, body = ErrorBody),
    (status = 422, body = ErrorBody, description = "a row is malformed, or its run is there already"),
))]
async fn add_runs(
    State(service): State<Service>,
    by: Caller,
    Id(id): Id,
    Body(new): Body<NewRuns>,
) -> Result<(StatusCode, Json<RunsAdded>), HttpError> {
    let added = service.add_runs(id, new.runs, new.calibration).await?;
    tracing::info!(calibration = added.id, study = id, %by, "submitted");
    Ok((StatusCode::CREATED, Json(added)))
}

/// Calibrates without some runs.
///
/// Begins a study with the job of a calibration in which some fitted runs are held out, with a search for a missing
/// effect.
#[utoipa::path(post, path = "/calibrations/{id}/what-if", operation_id = "create_what_if", tag = "studies",
    params(("id" = i64, Path)), request_body = WhatIf, responses(
    (status = 201, description = "the new calibration and study", body = CalibrationCreated),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "the calibration is a search"),
    (status = 422, body = ErrorBody, description = "a run is unknown or held out already, or none is left to fit"),
))]
async fn what_if(
    State(service): State<Service>,
    by: Caller,
    Id(id): Id,
    Body(new): Body<WhatIf>,
) -> Result<(StatusCode, Json<CalibrationCreated>), HttpError> {
    let created = service.what_if(id, new.without).await?;
    tracing::info!(calibration = created.id, what_if = id, %by, "submitted");
    Ok((StatusCode::CREATED, Json(created)))
}

/// Takes back what was added to a study.
///
/// Takes a calibration of an added effect, law or further runs out of its study, with all that follows from it; what is not
/// over is cancelled. Its results stay readable by its number. The same addition takes it in again with its point estimates
/// and its search; what else followed from it stays out.
#[utoipa::path(post, path = "/calibrations/{id}/withdraw", operation_id = "withdraw_calibration", tag = "studies",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "what is no longer part of the study", body = Withdrawn),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody, description = "the study began with the calibration"),
))]
async fn withdraw(
    State(service): State<Service>,
    by: Caller,
    Id(id): Id,
) -> Result<Json<Withdrawn>, HttpError> {
    let (study, calibrations) = service.withdraw(id).await?;
    tracing::info!(study, ?calibrations, %by, "taken back");
    Ok(Json(Withdrawn { study, calibrations }))
}
