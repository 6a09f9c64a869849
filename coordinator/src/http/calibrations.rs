//! `/v1/calibrations`: jobs, where they stand, what came out.

use std::collections::BTreeMap;

use axum::Json;
use axum::extract::State;
use axum::http::{HeaderMap, HeaderValue, StatusCode, header};
use axum::response::{Html, IntoResponse};
use serde::Deserialize;
use shared::api::{
    CalibrationCreated, CalibrationState, CalibrationStatus, ErrorBody, ErrorKind, NewCalibration,
};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::access::Caller;
use super::error::{Body, HttpError, Id, Query};
use super::list_page::StudiesPage;
use super::work::LONGEST_NAME;
use crate::service::Service;
use export::InferenceData;
use farm::Control;
use inference::Particle;
use page::report::showing;
use record::{StageRow, StudyDetails};
use report::{CalibrationFile, Provenance, StudyFile, StudySummary};
use result::{
    CalibrationFigures, ChannelHistory, Comparison, Diagnostics, Flag, PosteriorTable, PredictionRow,
    ResponseSurface,
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
        .routes(routes!(inference_data))
        .routes(routes!(comparison))
        .routes(routes!(predictions))
        .routes(routes!(diagnostics))
        .routes(routes!(histories))
        .routes(routes!(response_surface))
        .routes(routes!(provenance))
        .routes(routes!(job))
        .routes(routes!(flags))
        .routes(routes!(summary))
        .routes(routes!(figures))
        .routes(routes!(report_page))
}

/// Submits a job.
///
/// The job is validated, stored and started, with the point estimates that it asks for beside it. A job that is
/// posted twice is calibrated twice.
#[utoipa::path(post, path = "/calibrations", operation_id = "create_calibration", tag = "calibrations",
    request_body = NewCalibration, responses(
    (status = 201, description = "the calibration, its study and its point estimates", body = CalibrationCreated,
        headers(("Location" = String, description = "path of the calibration"))),
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
    if let Some(author) = by.into_name() {
        let details = StudyDetails {
            author: Some(author),
            ..StudyDetails::default()
        };
        service.describe_study(created.study, details).await?;
    }
    let mut headers = HeaderMap::new();
    if let Ok(location) = HeaderValue::from_str(&format!("/v1/calibrations/{}", created.id)) {
        headers.insert(header::LOCATION, location);
    }
    Ok((StatusCode::CREATED, headers, Json(created)))
}

/// Lists the calibrations.
///
/// Every calibration, or a page of them, oldest first; those of archived studies with `archived=true` alone.
#[utoipa::path(get, path = "/calibrations", operation_id = "list_calibrations", tag = "calibrations",
    params(("archived" = Option<bool>, Query, description = "whether those of archived studies are listed too"),
        ("limit" = Option<u32>, Query, minimum = 1, maximum = 10000, description = "the largest number of entries; without it, all"),
        ("after" = Option<i64>, Query, description = "the number of the last entry of the page before")), responses(
    (status = 200, description = "calibrations with state and progress", body = Vec<CalibrationStatus>)))]
async fn list(
    State(service): State<Service>,
    Query(which): Query<StudiesPage>,
) -> Result<Json<Vec<CalibrationStatus>>, HttpError> {
    Ok(Json(service.list(which.archived, which.page()?).await?))
}

/// State and progress of a calibration.
///
/// `progress` is null before the sampler starts and when it is over. Poll it, or watch
/// `/v1/calibrations/{id}/events`.
#[utoipa::path(get, path = "/calibrations/{id}", operation_id = "get_calibration", tag = "calibrations",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "where it stands", body = CalibrationStatus), (status = 404, body = ErrorBody)))]
async fn status(State(service): State<Service>, Id(id): Id) -> Result<Json<CalibrationStatus>, HttpError> {
    Ok(Json(service.status(id).await?))
}

/// The state after a command.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct NewState {
    /// State of the calibration after the command.
    state: CalibrationState,
}

async fn control(
    service: &Service,
    id: i64,
    control: Control,
    by: &Caller,
) -> Result<Json<NewState>, HttpError> {
    let state = service.control(id, control.clone()).await?;
    let name = service.calibration_row(id).await?.name;
    tracing::info!(calibration = id, name, %by, state = state.name(), ?control, "told");
    Ok(Json(NewState { state }))
}

/// Stops a calibration for good.
///
/// No further evaluations are leased, and what workers still send of it is discarded. It cannot be resumed.
#[utoipa::path(post, path = "/calibrations/{id}/cancel", operation_id = "cancel_calibration", tag = "calibrations",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "its new state", body = NewState),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn cancel(State(service): State<Service>, by: Caller, Id(id): Id) -> Result<Json<NewState>, HttpError> {
    control(&service, id, Control::Cancel, &by).await
}

/// Pauses a calibration.
///
/// No further evaluations are leased until it is resumed; results of those under way still count.
#[utoipa::path(post, path = "/calibrations/{id}/pause", operation_id = "pause_calibration", tag = "calibrations",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "its new state", body = NewState),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn pause(State(service): State<Service>, by: Caller, Id(id): Id) -> Result<Json<NewState>, HttpError> {
    control(&service, id, Control::Pause, &by).await
}

/// How to go on after a pause.
#[derive(Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Resume {
    #[serde(default)]
    skip_faults: bool,
    version: Option<String>,
}

/// Resumes a paused calibration.
///
/// Evaluations that had used up their attempts are tried again; with `skip_faults=true` they count as rejected. With
/// `version`, workers that compute this version of the equations go on, whatever version a first result has pinned:
/// results of another version are dropped. The calibration need not be paused for that.
#[utoipa::path(post, path = "/calibrations/{id}/resume", operation_id = "resume_calibration", tag = "calibrations",
    params(("id" = i64, Path), ("skip_faults" = Option<bool>, Query, description = "whether evaluations that used up their attempts count as rejected"),
        ("version" = Option<String>, Query, description = "the version of the equations that computes on, as `/v1/workers` states it")), responses(
    (status = 200, description = "its new state", body = NewState),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn resume(
    State(service): State<Service>,
    by: Caller,
    Id(id): Id,
    Query(resume): Query<Resume>,
) -> Result<Json<NewState>, HttpError> {
    let skip_faults = resume.skip_faults;
    let command = match resume.version {
        None => Control::Resume { skip_faults },
        Some(_) if skip_faults => {
            let message =
                "version and skip_faults exclude each other: another version tries every evaluation again";
            return Err(HttpError::new(ErrorKind::InvalidBody, message));
        }
        Some(version) if version.is_empty() || version.len() > LONGEST_NAME => {
            let message = format!(
                "version of {} bytes must have 1 to {LONGEST_NAME} bytes",
                version.len()
            );
            return Err(HttpError::new(ErrorKind::InvalidBody, message));
        }
        Some(version) => Control::ComputeWith(version),
    };
    control(&service, id, command, &by).await
}

/// Stages of the sampler so far.
///
/// Tempering exponents, acceptance, drift and evidence of each stage, also while it runs; none of a fit.
#[utoipa::path(get, path = "/calibrations/{id}/stages", operation_id = "get_stages", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "stages in their order", body = Vec<StageRow>), (status = 404, body = ErrorBody)))]
async fn stages(State(service): State<Service>, Id(id): Id) -> Result<Json<Vec<StageRow>>, HttpError> {
    service.calibration_row(id).await?;
    Ok(Json(service.store().reader().stages(id).await?))
}

/// The population to return, and the maximum number of its draws.
#[derive(Debug, Deserialize, utoipa::IntoParams)]
#[serde(deny_unknown_fields)]
struct WhichSamples {
    /// Stage, counted from 0; by default, the last stage.
    stage: Option<u32>,
    /// Maximum number of draws; from a larger population, this many equally spaced draws are returned.
    #[serde(rename = "most")]
    max_draws: Option<u32>,
}

/// A draw of a population.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct Sample {
    /// Parameter vector.
    theta: Vec<f64>,
    /// Log-likelihood; `None` where the model rejected.
    log_likelihood: Option<f64>,
    /// Log-density of the prior.
    log_prior: f64,
}

impl From<Particle> for Sample {
    fn from(particle: Particle) -> Self {
        let log_likelihood = particle.log_likelihood.value();
        Sample {
            theta: particle.theta,
            log_likelihood: Some(log_likelihood).filter(|l| l.is_finite()),
            log_prior: particle.log_prior,
        }
    }
}

/// The population at the end of a stage, or a part of it.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct Population {
    /// Names of the parameters, in the order of `theta`.
    parameters: Vec<String>,
    /// Units of the parameters, in the same order; `1` for a dimensionless parameter.
    units: Vec<String>,
    /// Size of the population.
    #[serde(rename = "of")]
    size: u64,
    /// Draws of the population in their order, or equally spaced ones.
    samples: Vec<Sample>,
}

/// The population at the end of a stage.
///
/// By default, the population of the last stage is returned. With `most`, at most this many of its draws are returned, equally spaced.
#[utoipa::path(get, path = "/calibrations/{id}/samples", operation_id = "get_samples", tag = "results",
    params(("id" = i64, Path), WhichSamples), responses(
    (status = 200, description = "parameter names, units, size and draws", body = Population),
    (status = 404, body = ErrorBody)))]
async fn samples(
    State(service): State<Service>,
    Id(id): Id,
    Query(which): Query<WhichSamples>,
) -> Result<Json<Population>, HttpError> {
    let row = service.calibration_row(id).await?;
    let spec = service.spec_of(&row).await?;
    let parameters = spec.parameters.into_iter().map(|p| (p.name, p.unit));
    let (parameters, units) = parameters.unzip();
    let reader = service.store().reader();
    let (samples, size) = match which.max_draws {
        None => {
            let samples = reader.samples(id, which.stage).await?;
            let size = samples.len() as u64;
            (samples, size)
        }
        Some(count) => reader.thinned_samples(id, which.stage, count).await?,
    };
    Ok(Json(Population {
        parameters,
        units,
        size,
        samples: samples.into_iter().map(Sample::from).collect(),
    }))
}

/// The draws of the posterior.
///
/// Equally weighted draws as a table with `log_likelihood`, `log_prior` and the parameters; no rows of a fit without
/// a normal approximation.
#[utoipa::path(get, path = "/calibrations/{id}/posterior", operation_id = "get_posterior", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "a table of draws", body = PosteriorTable),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn posterior(State(service): State<Service>, Id(id): Id) -> Result<Json<PosteriorTable>, HttpError> {
    Ok(Json(service.finished_calibration(id).await?.posterior_table()))
}

/// The calibration as inference data.
///
/// Groups of variables as ArviZ names them: `posterior`, `sample_stats`, `prior`, `log_likelihood`,
/// `posterior_predictive`, `observed_data`, `constant_data`, of held-out runs `predictions` and
/// `predictions_constant_data`. Values stand flat, the last dimension varying fastest. 409 of a fit without draws.
#[utoipa::path(get, path = "/calibrations/{id}/inference-data", operation_id = "get_inference_data", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "groups of variables", body = InferenceData),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn inference_data(
    State(service): State<Service>,
    Id(id): Id,
) -> Result<Json<InferenceData>, HttpError> {
    let calibration = service.finished_calibration(id).await?;
    Ok(Json(export::inference_data(&calibration)?))
}

/// Model against measurement.
///
/// Measured and predicted values of every run and channel, with intervals and errors, fitted and held-out runs apart.
#[utoipa::path(get, path = "/calibrations/{id}/comparison", operation_id = "get_comparison", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "the comparison", body = Comparison),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn comparison(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(
        service.calibration_file(id, CalibrationFile::Comparison).await?,
    ))
}

/// Every run as the models of the study predict it.
///
/// The content of `predictions.csv`: measured, by the current model of the study, by that model corrected, by all models together, and
/// interpolated.
#[utoipa::path(get, path = "/calibrations/{id}/predictions", operation_id = "get_predictions", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "a row for each run and channel", body = Vec<PredictionRow>),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn predictions(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(service.study_file(id, StudyFile::PredictionRows).await?))
}

/// Returns a text that is JSON already.
pub(super) fn json(text: String) -> impl IntoResponse {
    ([(header::CONTENT_TYPE, "application/json")], text)
}

/// How far the result can be trusted.
///
/// Diagnostics of the sampler, of every parameter and of the residuals: where the model fails, by channel and
/// condition.
#[utoipa::path(get, path = "/calibrations/{id}/diagnostics", operation_id = "get_diagnostics", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "the diagnostics", body = Diagnostics),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn diagnostics(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(
        service.calibration_file(id, CalibrationFile::Diagnostics).await?,
    ))
}

/// Time histories of the fitted runs.
///
/// Measured and simulated histories, filtered, at the likeliest parameters; null of a model that knows no time.
#[utoipa::path(get, path = "/calibrations/{id}/histories", operation_id = "get_histories", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "histories of each fitted run, or null", body = Option<Vec<ChannelHistory>>),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn histories(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(
        service.calibration_file(id, CalibrationFile::Histories).await?,
    ))
}

/// The response surface over the posterior.
///
/// The model's outputs at the measured runs as polynomials of its parameters, fitted to the final draws; null if there are no draws, or
/// too few for a surface. Its schema states how to evaluate it.
#[utoipa::path(get, path = "/calibrations/{id}/response-surface", operation_id = "get_response_surface", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "coordinates, ranges, errors and coefficients, or null", body = Option<ResponseSurface>),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn response_surface(
    State(service): State<Service>,
    Id(id): Id,
) -> Result<impl IntoResponse, HttpError> {
    let file = CalibrationFile::ResponseSurface;
    Ok(json(service.calibration_file(id, file).await?))
}

/// How the result came about.
///
/// What it reached, in sentences, with its inputs and versions.
#[utoipa::path(get, path = "/calibrations/{id}/provenance", operation_id = "get_provenance", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "the provenance", body = Provenance),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn provenance(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(
        service.calibration_file(id, CalibrationFile::Provenance).await?,
    ))
}

/// The files of a job.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct JobFiles {
    /// Id of the calibration.
    id: i64,
    /// Id of the experiment that it is about.
    experiment: i64,
    /// Text of the job.
    toml: String,
    /// Texts of the files that the job names, by name.
    files: BTreeMap<String, String>,
}

/// The files of a job.
///
/// As they are stored, of every calibration, also of one that has failed.
#[utoipa::path(get, path = "/calibrations/{id}/job", operation_id = "get_job", tag = "calibrations",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "the files", body = JobFiles), (status = 404, body = ErrorBody)))]
async fn job(State(service): State<Service>, Id(id): Id) -> Result<Json<JobFiles>, HttpError> {
    let row = service.calibration_row(id).await?;
    Ok(Json(JobFiles {
        id,
        experiment: row.experiment,
        toml: row.job.toml,
        files: row.job.files,
    }))
}

/// What deserves attention.
///
/// Each flag has a kind of a closed list and a sentence that says what to do.
#[utoipa::path(get, path = "/calibrations/{id}/flags", operation_id = "get_flags", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "the flags; none if all is well", body = Vec<Flag>),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn flags(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(service.flags(id).await?))
}

/// The summary of the study.
///
/// The content of `summary.json`: parameters, errors and search of every calibration of the study.
#[utoipa::path(get, path = "/calibrations/{id}/summary", operation_id = "get_summary", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "the summary", body = StudySummary),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn summary(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(service.study_file(id, StudyFile::Summary).await?))
}

/// The numbers behind the figures.
///
/// Marginal and joint densities from at most 2,000 draws, convergence, histories, prediction errors.
#[utoipa::path(get, path = "/calibrations/{id}/figures", operation_id = "get_figures", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "the numbers of each figure", body = CalibrationFigures),
    (status = 404, body = ErrorBody),
    (status = 409, body = ErrorBody)))]
async fn figures(State(service): State<Service>, Id(id): Id) -> Result<impl IntoResponse, HttpError> {
    Ok(json(service.study_file(id, StudyFile::Figures(id)).await?))
}

/// The report of the study.
///
/// The content of `report.html`: one document without references to others, which shows this calibration first.
#[utoipa::path(get, path = "/calibrations/{id}/report", operation_id = "get_report", tag = "results",
    params(("id" = i64, Path)), responses(
    (status = 200, description = "an HTML document", content_type = "text/html", body = String),
    (status = 404, body = ErrorBody), (status = 409, body = ErrorBody)))]
async fn report_page(State(service): State<Service>, Id(id): Id) -> Result<Html<String>, HttpError> {
    let report = service.study_file(id, StudyFile::Report).await?;
    Ok(Html(showing(&report, id)))
}
