//! `/metrics` for Prometheus and `/health` for programs that restart the service.

use std::sync::atomic::{AtomicU64, Ordering};

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
use farm::{FarmCounters, FarmMetrics};
use store::{Store, StoreError};

/// The metrics of one answer.
struct Figures(Registry);

impl Figures {
    fn counter(&mut self, name: &str, help: &str, value: u64) {
        let counter: Counter = Counter::default();
        counter.inc_by(value);
        self.0.register(name, help, counter);
    }

    fn gauge(&mut self, name: &str, help: &str, value: impl TryInto<i64>) {
        let gauge: Gauge = Gauge::default();
        gauge.set(value.try_into().unwrap_or(i64::MAX));
        self.0.register(name, help, gauge);
    }

    /// Adds leases and results since the start.
    fn results(&mut self, counters: &FarmCounters) {
        let refused = "Results whose seal does not prove that they answer a lease of their worker, or of a quarantined worker";
        let lost = "Leases that never reached their worker and were given to others";
        let confirmed = "Results that a second worker has computed with the same bits";
        let unconfirmed = "Results that were to be verified when no second worker was there";
        for (name, help, value) in [
            (
                "evaluations_completed",
                "Results that counted",
                counters.completed,
            ),
            (
                "evaluations_duplicate",
                "Results that changed nothing",
                counters.duplicates,
            ),
            ("evaluations_refused", refused, counters.refused),
            ("leases_given", "Leases given out", counters.leased),
            ("leases_lost", lost, counters.lost),
            (
                "leases_failed",
                "Leases that expired or ended in a fault",
                counters.failed_leases,
            ),
            ("evaluations_confirmed", confirmed, counters.confirmed),
            ("evaluations_unconfirmed", unconfirmed, counters.unanswered),
        ] {
            self.counter(name, help, value);
        }
    }

    /// Adds the evaluations, calibrations and workers of the farm.
    fn farm(&mut self, farm: &FarmMetrics) {
        self.gauge(
            "verifications_waiting",
            "Results that wait for the answer of a second worker",
            farm.unconfirmed,
        );
        self.gauge(
            "workers_quarantined",
            "Workers that compute wrongly and get no leases",
            farm.quarantined,
        );
        self.gauge(
            "evaluations_queued",
            "Evaluations that wait for a worker",
            farm.queued,
        );
        self.gauge("leases_out", "Leases that are out", farm.leased);
        self.gauge(
            "calibrations_in_hand",
            "Calibrations that are not over",
            farm.calibrations,
        );
        self.gauge(
            "steps_under_way",
            "Calibrations whose next round is being computed",
            farm.stepping,
        );
        self.gauge(
            "workers_connected",
            "Workers heard of in the last minute",
            farm.workers,
        );
    }

    /// Adds the writes of the store, and the facts that wait for it.
    fn store(&mut self, store: &Store) {
        let health = store.writer().health();
        let stored = |value: &AtomicU64| value.load(Ordering::Relaxed);
        let busy = "Time spent writing and committing";
        let faults = "Late duplicates that differed from what is stored";
        self.counter("store_commits", "Commits of the store", stored(&health.commits));
        self.counter("store_facts", "Facts committed", stored(&health.facts));
        self.counter("store_busy_microseconds", busy, stored(&health.busy_us));
        self.counter("determinism_faults", faults, stored(&health.differing_duplicates));
        if let Some([file, log]) = store.sizes_bytes() {
            self.gauge("store_bytes", "Size of the store", file);
            self.gauge("store_log_bytes", "Size of its write-ahead log", log);
        }
        let backlog = store.writer().backlog();
        self.gauge("store_backlog_facts", "Facts that wait to be stored", backlog);
        self.gauge(
            "store_locked",
            "1 while a lock of another program keeps the store from being written",
            i64::from(health.is_locked.load(Ordering::Relaxed)),
        );
    }

    /// Adds the number of calibrations in each state, also 0.
    fn states(&mut self, counts: &[(String, i64)]) {
        let family = Family::<InState, Gauge>::default();
        for state in CalibrationState::ALL.iter().map(|state| state.name()) {
            let count = counts.iter().find(|(name, _)| name == state);
            let count = count.map_or(0, |&(_, count)| count);
            family.get_or_create(&InState { state }).set(count);
        }
        let help = "Calibrations of the store by state";
        self.0.register("calibrations", help, family);
    }
}

#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct InState {
    state: &'static str,
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
    let farm = service.dispatcher().metrics().await?;
    let mut figures = Figures(Registry::with_prefix("grouser"));
    figures.results(&farm.counters);
    figures.farm(&farm);
    figures.gauge(
        "calibrations_left_alone",
        "Calibrations that could not be resumed at the start",
        service.count_left_alone(),
    );
    figures.states(&service.store().reader().states().await?);
    figures.store(service.store());
    requests.register(&mut figures.0);
    let mut text = String::new();
    encode(&mut text, &figures.0).map_err(|_| HttpError::new(shared::api::ErrorKind::Internal, "metrics"))?;
    Ok(text)
}

/// The body of the answer of `/health`.
#[derive(serde::Serialize, utoipa::ToSchema)]
struct Health {
    /// State of the service; always `ok`.
    status: &'static str,
    /// Version of the coordinator.
    version: &'static str,
    /// How long the farm's thread has been at its present message `[s]`: exchanges and answers about calibrations wait for its end.
    farm_step_s: f64,
}

/// Whether the service works.
///
/// Answers while farm and store work, without waiting for either; needs no token.
#[utoipa::path(get, path = "/health", operation_id = "get_health", tag = "service", security(()),
    responses((status = 200, description = "it works", body = Health)))]
async fn health(State(service): State<Service>) -> Result<Json<Health>, HttpError> {
    // The answer does not query farm and store: a restart of the service would only delay what keeps them busy.
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
