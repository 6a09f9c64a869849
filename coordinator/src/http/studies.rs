//! `/v1/studies`: lines of calibrations on one experiment, with their error ledger.

use axum::Json;
use axum::extract::State;
use shared::api::{CalibrationState, ErrorBody, ErrorKind};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::{HttpError, Id};
use crate::service::{Service, finished_calibration};
use job::is_discovery;
use result::{CalibrationSummary, FixedSigmas, PointEstimate};

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new().routes(routes!(list)).routes(routes!(ledger))
}

/// A study.
#[derive(Debug, serde::Serialize, utoipa::ToSchema)]
struct Study {
    id: i64,
    experiment: i64,
    calibrations: Vec<i64>,
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

/// Every study, oldest first.
#[utoipa::path(get, path = "/studies", responses((status = 200, body = Vec<Study>)))]
async fn list(State(service): State<Service>) -> Result<Json<Vec<Study>>, HttpError> {
    let studies = service.store().reader().studies().await?;
    let studies = studies.into_iter().map(|(id, experiment, calibrations)| Study {
        id,
        experiment,
        calibrations,
    });
    Ok(Json(studies.collect()))
}

/// A study with its error ledger.
#[utoipa::path(get, path = "/studies/{id}", params(("id" = i64, Path)), responses(
    (status = 200, body = Ledger), (status = 404, body = ErrorBody)))]
async fn ledger(State(service): State<Service>, Id(id): Id) -> Result<Json<Ledger>, HttpError> {
    let reader = service.store().reader();
    let (id, experiment, calibrations) = reader
        .studies()
        .await?
        .into_iter()
        .find(|study| study.0 == id)
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
