//! `/v1/calibrations`: jobs, where they stand, what came out.

use axum::Json;
use axum::extract::State;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{Html, IntoResponse};
use serde::Deserialize;
use shared::api::{CalibrationCreated, CalibrationState, CalibrationStatus, ErrorBody, NewCalibration};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::access::Caller;
use super::error::{Body, HttpError, Id, Query};
use super::studies::WithArchived;
use crate::farm::Control;
use crate::service::{Service, finished_calibration};
use page::report::showing;
use record::{Sample, StageRow};
use result::{
    CalibrationFigures, ChannelHistory, Comparison, Diagnostics, FinishedCalibration, Flag, PosteriorTable,
    Provenance, StudyFile, StudySummary,
};

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(create, list))
        .routes(routes!(status))
        .routes(routes!(cancel))
        .routes(routes!(pause))
        .routes(routes!(resume))
        .routes(routes!(stages))
        .routes(routes!(samples))
        .routes(routes!(posterior))
        .routes(routes!(comparison))
        .routes(routes!(diagnostics))
        .routes(routes!(histories))
        .routes(routes!(provenance))
        .routes(routes!(flags))
        .routes(routes!(summary))
        .routes(routes!(figures))
        .routes(routes!(report_page))
}

/// Validates a job, stores it and takes it in hand, with the point estimates that it asks for beside it.
#[utoipa::path(post, path = "/calibrations", request_body = NewCalibration, responses(
    (status = 201, body = CalibrationCreated, headers(("Location" = String))),
    (status = 404, body = ErrorBody, description = "no such experiment"),
    (status = 422, body = ErrorBody, description = "a file is malformed"),
))]
async fn create(
    State(service): State<Service>,
    by: Caller,
    Body(new): Body<NewCalibration>,
) -> Result<(StatusCode, HeaderMap, Json<CalibrationCreated>), HttpError> {
    let name = new.name.clone();
    let created = service.add_calibration(new).await?;
    tracing::info!(calibration = created.id, name, %by, "submitted");
    let mut headers = HeaderMap::new();
    if let Ok(location) = HeaderValue::from_str(&format!("/v1/calibrations/{}", created.id)) {
        headers.insert(header::LOCATION, location);
    }
    Ok((StatusCode::CREATED, headers, Json(created)))
}

/// Every calibration, oldest first; those of archived studies with `archived=true` alone.
#[utoipa::path(get, path = "/calibrations", params(("archived" = Option<bool>, Query)), responses(
    (status = 200, body = Vec<CalibrationStatus>)))]
async fn list(
    State(service): State<Service>,
    Query(which): Query<WithArchived>,
) -> Result<Json<Vec<CalibrationStatus>>, HttpError> {
    Ok(Json(service.list(which.archived).await?))
}

/// The status of a calibration.
#[utoipa::path(get, path = "/calibrations/{id}", params(("id" = i64, Path)), responses(
    (status = 200, body = CalibrationStatus), (status = 404, body = ErrorBody)))]
async fn status(State(service): State<Service>, Id(id): Id) -> Result<Json<CalibrationStatus>, HttpError> {
    Ok(Json(service.status(id).await?))
}

/// The state after a command.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct NewState {
    state: CalibrationState,
}

async fn control(
    service: &Service,
    id: i64,
    control: Control,
    by: &Caller,
) -> Result<Json<NewState>, HttpError> {
    let state = service.control(id, control).await?;
    let name = service.calibration_row(id).await?.name;
    tracing::info!(calibration = id, name, %by, state = state.name(), ?control, "told");
    Ok(Json(NewState { state }))
}

/// Stops a calibration for good.
#[utoipa::path(post, path = "/calibrations/{id}/cancel", params(("id" = i64, Path)), responses(
    (status = 200, body = NewState), (status = 404, body = ErrorBody), (status = 409, body = ErrorBody)))]
async fn cancel(State(service): State<Service>, by: Caller, Id(id): Id) -> Result<Json<NewState>, HttpError> {
    control(&service, id, Control::Cancel, &by).await
}

/// Leases nothing more until resumed.
#[utoipa::path(post, path = "/calibrations/{id}/pause", params(("id" = i64, Path)), responses(
    (status = 200, body = NewState), (status = 404, body = ErrorBody), (status = 409, body = ErrorBody)))]
async fn pause(State(service): State<Service>, by: Caller, Id(id): Id) -> Result<Json<NewState>, HttpError> {
    control(&service, id, Control::Pause, &by).await
}

/// How to go on after a pause.
#[derive(Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Resume {
    #[serde(default)]
    skip_faults: bool,
}

/// Goes on after a pause. With `skip_faults`, evaluations that had used up their attempts count as rejected.
#[utoipa::path(post, path = "/calibrations/{id}/resume", params(("id" = i64, Path), ("skip_faults" = Option<bool>, Query)), responses(
    (status = 200, body = NewState), (status = 404, body = ErrorBody), (status = 409, body = ErrorBody)))]
async fn resume(
    State(service): State<Service>,
    by: Caller,
    Id(id): Id,
    Query(resume): Query<Resume>,
) -> Result<Json<NewState>, HttpError> {
    let skip_faults = resume.skip_faults;
    control(&service, id, Control::Resume { skip_faults }, &by).await
}

/// The stages so far: tempering exponents, acceptance, drift.
#[utoipa::path(get, path = "/calibrations/{id}/stages", params(("id" = i64, Path)), responses(
    (status = 200, body = Vec<StageRow>), (status = 404, body = ErrorBody)))]
async fn stages(State(service): State<Service>, Id(id): Id) -> Result<Json<Vec<StageRow>>, HttpError> {
    service.calibration_row(id).await?;
    Ok(Json(service.store().reader().stages(id).await?))
}

/// Which population, and how much of it.
#[derive(Debug, Deserialize, utoipa::IntoParams)]
#[serde(deny_unknown_fields)]
struct WhichSamples {
    /// Stage, counted from 0; the last one where nothing is said.
    stage: Option<u32>,
    /// Most draws: of a larger population, as many equally spaced ones.
    most: Option<u32>,
}

/// The population at the end of a stage, or a part of it.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct Population {
    /// Names of the parameters, in the order of `theta`.
    parameters: Vec<String>,
    /// Size of the population.
    of: u64,
    /// Its draws in their order, or equally spaced ones of them.
    samples: Vec<Sample>,
}

/// The population at the end of a stage; with `most`, at most so many equally spaced draws of it.
#[utoipa::path(get, path = "/calibrations/{id}/samples", params(("id" = i64, Path), WhichSamples), responses(
    (status = 200, body = Population), (status = 404, body = ErrorBody)))]
async fn samples(
    State(service): State<Service>,
    Id(id): Id,
    Query(which): Query<WhichSamples>,
) -> Result<Json<Population>, HttpError> {
    let row = service.calibration_row(id).await?;
    let spec = service.spec_of(&row).await?;
    let parameters = spec.parameters.into_iter().map(|p| p.name).collect();
    let reader = service.store().reader();
    let (samples, of) = match which.most {
        None => {
            let samples = reader.samples(id, which.stage).await?;
            let of = samples.len() as u64;
            (samples, of)
        }
        Some(most) => reader.thinned_samples(id, which.stage, most).await?,
    };
    Ok(Json(Population {
        parameters,
        of,
        samples,
    }))
}

async fn outcome(service: &Service, id: i64) -> Result<FinishedCalibration, HttpError> {
    let row = service.calibration_row(id).await?;
    Ok(finished_calibration(&service.store().reader(), &row).await?)
}

/// The equally weighted draws of the posterior.
#[utoipa::path(get, path = "/calibrations/{id}/posterior", params(("id" = i64, Path)), responses(
    (status = 200, body = PosteriorTable), (status = 404, body = ErrorBody), (status = 409, body = ErrorBody)))]
async fn posterior(State(service): State<Service>, Id(id): Id) -> Result<Json<PosteriorTable>, HttpError> {
    Ok(Json(outcome(&service, id).await?.posterior_table()))
}

/// Model against measurement, run by run.
#[utoipa::path(get, path = "/calibrations/{id}/comparison", params(("id" = i64, Path)), responses(
    (status = 200, body = Comparison), (status = 404, body = ErrorBody), (status = 409, body = ErrorBody)))]
async fn comparison(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(service.calibration_file(id, StudyFile::Comparison).await?))
}

/// A text that is JSON already.
fn json(text: String) -> impl IntoResponse {
    ([(header::CONTENT_TYPE, "application/json")], text)
}

/// How far the result can be trusted, and where the model fails.
#[utoipa::path(get, path = "/calibrations/{id}/diagnostics", params(("id" = i64, Path)), responses(
    (status = 200, body = Diagnostics), (status = 404, body = ErrorBody), (status = 409, body = ErrorBody)))]
async fn diagnostics(State(service): State<Service>, Id(id): Id) -> Result<Json<Diagnostics>, HttpError> {
    Ok(Json(service.diagnostics(id).await?))
}

/// Measured and simulated histories of each fitted run, filtered, at the likeliest parameters; null of a model that knows no
/// time.
#[utoipa::path(get, path = "/calibrations/{id}/histories", params(("id" = i64, Path)), responses(
    (status = 200, body = Option<Vec<ChannelHistory>>), (status = 404, body = ErrorBody), (status = 409, body = ErrorBody)))]
async fn histories(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(service.calibration_file(id, StudyFile::Histories).await?))
}

/// How it came about: what it reached in sentences, its inputs and versions.
#[utoipa::path(get, path = "/calibrations/{id}/provenance", params(("id" = i64, Path)), responses(
    (status = 200, body = Provenance), (status = 404, body = ErrorBody), (status = 409, body = ErrorBody)))]
async fn provenance(State(service): State<Service>, Id(id): Id) -> Result<Json<Provenance>, HttpError> {
    Ok(Json(outcome(&service, id).await?.provenance()))
}

/// What deserves attention.
#[utoipa::path(get, path = "/calibrations/{id}/flags", params(("id" = i64, Path)), responses(
    (status = 200, body = Vec<Flag>), (status = 404, body = ErrorBody), (status = 409, body = ErrorBody)))]
async fn flags(State(service): State<Service>, Id(id): Id) -> Result<Json<Vec<Flag>>, HttpError> {
    Ok(Json(service.diagnostics(id).await?.flags))
}

/// The summary of its study, as `summary.json` has it.
#[utoipa::path(get, path = "/calibrations/{id}/summary", params(("id" = i64, Path)), responses(
    (status = 200, body = StudySummary), (status = 404, body = ErrorBody), (status = 409, body = ErrorBody)))]
async fn summary(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(service.study_file(id, StudyFile::Summary).await?))
}

/// What its figures show, as numbers: marginal and joint densities, convergence, histories, prediction errors.
#[utoipa::path(get, path = "/calibrations/{id}/figures", params(("id" = i64, Path)), responses(
    (status = 200, body = CalibrationFigures), (status = 404, body = ErrorBody), (status = 409, body = ErrorBody)))]
async fn figures(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(service.calibration_file(id, StudyFile::Figures).await?))
}

/// The report of its study, as `report.html` has it, with its own model first.
#[utoipa::path(get, path = "/calibrations/{id}/report", params(("id" = i64, Path)), responses(
    (status = 200, content_type = "text/html", body = String), (status = 404, body = ErrorBody)))]
async fn report_page(State(service): State<Service>, Id(id): Id) -> Result<Html<String>, HttpError> {
    let report = service.study_file(id, StudyFile::Report).await?;
    Ok(Html(showing(&report, id)))
}
