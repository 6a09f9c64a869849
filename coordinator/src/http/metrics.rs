//! `/metrics` for Prometheus and `/health` for whoever restarts us.

use std::sync::atomic::Ordering;

use axum::extract::State;
use axum::{Extension, Json};
use prometheus_client::encoding::EncodeLabelSet;
use prometheus_client::encoding::text::encode;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::registry::Registry;
use shared::api::CalibrationState;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::HttpError;
use super::request_metrics::RequestMetrics;
use crate::service::Service;
use farm::dispatch::Stopped;
use store::StoreError;

fn counter(registry: &mut Registry, name: &str, help: &str, value: u64) {
    let counter: Counter = Counter::default();
    counter.inc_by(value);
    registry.register(name, help, counter);
}

fn gauge(registry: &mut Registry, name: &str, help: &str, value: usize) {
    let gauge: Gauge = Gauge::default();
    gauge.set(i64::try_from(value).unwrap_or(i64::MAX));
    registry.register(name, help, gauge);
}

#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct InState {
    state: &'static str,
}

/// Calibrations of the store by state; of a state without any, 0.
fn states(registry: &mut Registry, counts: &[(String, i64)]) {
    let family = Family::<InState, Gauge>::default();
    for state in CalibrationState::ALL.map(CalibrationState::name) {
        let count = counts.iter().find(|(name, _)| name == state);
        let count = count.map_or(0, |&(_, count)| count);
        family.get_or_create(&InState { state }).set(count);
    }
    registry.register("calibrations", "Calibrations of the store by state", family);
}

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(metrics))
        .routes(routes!(health))
}

/// Figures for Prometheus.
///
/// Numbers of farm, store and requests in the text format of Prometheus.
#[utoipa::path(get, path = "/metrics", operation_id = "get_metrics", tag = "service",
    responses((status = 200, description = "the figures", content_type = "text/plain", body = String)))]
async fn metrics(
    State(service): State<Service>,
    Extension(requests): Extension<RequestMetrics>,
) -> Result<String, HttpError> {
    let metrics = service.dispatcher().metrics().await?;
    let health = service.store().writer().health();
    let stored = |value: &std::sync::atomic::AtomicU64| value.load(Ordering::Relaxed);
    let mut registry = Registry::with_prefix("grouser");
    let r = &mut registry;
    counter(
        r,
        "evaluations_completed",
        "Results that counted",
        metrics.counters.completed,
    );
    counter(
        r,
        "evaluations_duplicate",
        "Results that changed nothing",
        metrics.counters.duplicates,
    );
    counter(
        r,
        "evaluations_refused",
        "Results whose seal does not prove that they answer a lease of their worker, or of a quarantined worker",
        metrics.counters.refused,
    );
    counter(r, "leases_given", "Leases given out", metrics.counters.leased);
    counter(
        r,
        "leases_lost",
        "Leases that never reached their worker and were given to others",
        metrics.counters.lost,
    );
    counter(
        r,
        "leases_failed",
        "Leases that expired or ended in a fault",
        metrics.counters.failed_leases,
    );
    counter(
        r,
        "evaluations_confirmed",
        "Results that a second worker has computed with the same bits",
        metrics.counters.confirmed,
    );
    counter(
        r,
        "evaluations_unconfirmed",
        "Results that were to be verified when no second worker was there",
        metrics.counters.unanswered,
    );
    gauge(
        r,
        "verifications_waiting",
        "Results that wait for the answer of a second worker",
        metrics.unconfirmed,
    );
    gauge(
        r,
        "workers_quarantined",
        "Workers that compute wrongly and get no leases",
        metrics.quarantined,
    );
    gauge(
        r,
        "evaluations_queued",
        "Evaluations that wait for a worker",
        usize::try_from(metrics.queued).unwrap_or(usize::MAX),
    );
    gauge(r, "leases_out", "Leases that are out", metrics.leased);
    gauge(
        r,
        "calibrations_in_hand",
        "Calibrations that are not over",
        metrics.calibrations,
    );
    gauge(
        r,
        "calibrations_left_alone",
        "Calibrations that could not be resumed at the start",
        service.count_left_alone(),
    );
    states(r, &service.store().reader().states().await?);
    gauge(
        r,
        "workers_connected",
        "Workers heard of in the last minute",
        metrics.workers,
    );
    counter(
        r,
        "store_commits",
        "Commits of the store",
        stored(&health.commits),
    );
    counter(r, "store_facts", "Facts committed", stored(&health.facts));
    counter(
        r,
        "store_busy_microseconds",
        "Time spent writing and committing",
        stored(&health.busy_us),
    );
    counter(
        r,
        "determinism_faults",
        "Late duplicates that differed from what is stored",
        stored(&health.differing_duplicates),
    );
    if let Some(sizes) = service.store().sizes_bytes() {
        let [file, log] = sizes.map(|bytes| usize::try_from(bytes).unwrap_or(usize::MAX));
        gauge(r, "store_bytes", "Size of the store", file);
        gauge(r, "store_log_bytes", "Size of its write-ahead log", log);
    }
    let backlog = usize::try_from(service.store().writer().backlog()).unwrap_or(usize::MAX);
    gauge(r, "store_backlog_facts", "Facts that wait to be stored", backlog);
    gauge(
        r,
        "store_locked",
        "1 while a lock of another program keeps the store from being written",
        usize::from(health.is_locked.load(Ordering::Relaxed)),
    );
    requests.register(r);
    let mut text = String::new();
    encode(&mut text, &registry).map_err(|_| HttpError::new(shared::api::ErrorKind::Internal, "metrics"))?;
    Ok(text)
}

/// What `/health` says.
#[derive(serde::Serialize, utoipa::ToSchema)]
struct Health {
    /// `ok`.
    status: &'static str,
    /// Version of the coordinator.
    version: &'static str,
    /// How long the farm's thread has been at its present step `[s]`: exchanges and answers about calibrations wait for its end.
    farm_step_s: f64,
}

/// Whether the service works.
///
/// Answers while farm and store work, also in the middle of a long step of the farm; needs no token.
#[utoipa::path(get, path = "/health", operation_id = "get_health", tag = "service", security(()),
    responses((status = 200, description = "it works", body = Health)))]
async fn health(State(service): State<Service>) -> Result<Json<Health>, HttpError> {
    // Neither is asked: a large step of a sampler takes seconds, and whoever restarts a service that does not answer makes it worse.
    let step = service.dispatcher().pulse().step().ok_or(Stopped)?;
    if !service.store().is_read_only() && service.store().writer().has_ended() {
        return Err(StoreError::Stopped.into());
    }
    Ok(Json(Health {
        status: "ok",
        version: env!("CARGO_PKG_VERSION"),
        farm_step_s: step.as_secs_f64(),
    }))
}
