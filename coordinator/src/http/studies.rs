//! `/v1/studies`: lines of calibrations on one experiment, with their error ledger.

use axum::Json;
use axum::extract::State;
use shared::api::{CalibrationState, ErrorBody, ErrorKind, StudyArchived, StudyDeleted};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::access::Caller;
use super::error::{HttpError, Id, Query};
use crate::service::{Service, finished_calibration};
use crate::store::StoredStudy;
use job::is_discovery;
use result::{CalibrationSummary, FixedSigmas, PointEstimate};

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(list))
        .routes(routes!(ledger, delete))
        .routes(routes!(archive))
        .routes(routes!(restore))
}

/// Whether archived studies are listed too.
#[derive(Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WithArchived {
    #[serde(default)]
    pub(super) archived: bool,
}

/// A study.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct Study {
    id: i64,
    experiment: i64,
    calibrations: Vec<i64>,
    archived: bool,
}

/// A study with the error ledger of its finished calibrations.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct Ledger {
    id: i64,
    experiment: i64,
    calibrations: Vec<i64>,
    ledger: Vec<CalibrationSummary>,
    point_estimates: Vec<PointEstimate>,
}

/// Every study, oldest first; archived ones with `archived=true` alone.
#[utoipa::path(get, path = "/studies", params(("archived" = Option<bool>, Query)), responses(
    (status = 200, body = Vec<Study>)))]
async fn list(
    State(service): State<Service>,
    Query(which): Query<WithArchived>,
) -> Result<Json<Vec<Study>>, HttpError> {
    let reader = service.store().reader();
    let archived = reader.archived().await?;
    let studies = reader.studies().await?.into_iter().map(|study| Study {
        archived: archived.iter().any(|&(id, _)| id == study.id),
        id: study.id,
        experiment: study.experiment,
        calibrations: study.calibrations,
    });
    Ok(Json(studies.filter(|s| which.archived || !s.archived).collect()))
}

/// Deletes a study with its calibrations and results, and with its experiments where no other study has them.
#[utoipa::path(delete, path = "/studies/{id}", params(("id" = i64, Path)), responses(
    (status = 200, body = StudyDeleted), (status = 404, body = ErrorBody),
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

/// Takes a study out of the lists; it stays readable by its number, and no longer grows.
#[utoipa::path(post, path = "/studies/{id}/archive", params(("id" = i64, Path)), responses(
    (status = 200, body = StudyArchived), (status = 404, body = ErrorBody),
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

/// Takes an archived study back into the lists.
#[utoipa::path(post, path = "/studies/{id}/restore", params(("id" = i64, Path)), responses(
    (status = 200, body = StudyArchived), (status = 404, body = ErrorBody),
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

/// A study with its error ledger.
#[utoipa::path(get, path = "/studies/{id}", params(("id" = i64, Path)), responses(
    (status = 200, body = Ledger), (status = 404, body = ErrorBody)))]
async fn ledger(State(service): State<Service>, Id(id): Id) -> Result<Json<Ledger>, HttpError> {
    let reader = service.store().reader();
    let StoredStudy {
        id,
        experiment,
        calibrations,
    } = reader
        .studies()
        .await?
        .into_iter()
        .find(|study| study.id == id)
        .ok_or_else(|| HttpError::new(ErrorKind::NotFound, format!("there is no study {id}")))?;
    // Those of the first calibration, by which all are measured.
    let mut sigmas = None;
    let (mut ledger, mut point_estimates) = (Vec::new(), Vec::new());
    for &calibration in &calibrations {
        let row = service.calibration_row(calibration).await?;
        if row.state == CalibrationState::Finished && !is_discovery(&row.job.toml) {
            let outcome = finished_calibration(&reader, &row).await?;
            let sigmas = sigmas.get_or_insert_with(|| FixedSigmas::of(&outcome));
            ledger.extend(
                outcome
                    .calibration_summary()
                    .map(|line| line.in_fixed_sigmas(sigmas)),
            );
            point_estimates.extend(outcome.point_estimate().map(|own| own.in_fixed_sigmas(sigmas)));
        }
    }
    Ok(Json(Ledger {
        id,
        experiment,
        calibrations,
        ledger,
        point_estimates,
    }))
}
