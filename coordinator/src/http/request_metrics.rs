//! Metrics of requests by route: their number, statuses and durations.

use std::time::Instant;

use axum::extract::{MatchedPath, Request, State};
use axum::middleware::Next;
use axum::response::Response;
use prometheus_client::encoding::EncodeLabelSet;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::histogram::Histogram;
use prometheus_client::registry::Registry;

/// Upper bounds of the histogram `[s]`; the longest poll lasts 30 s.
const BOUNDS_S: [f64; 12] = [
    0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 20.0, 31.0, 60.0,
];

#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Route {
    method: String,
    route: String,
}

#[derive(Debug, Clone, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Answer {
    method: String,
    route: String,
    status: u16,
}

/// Requests since the start; clones share them.
#[derive(Debug, Clone)]
pub(super) struct RequestMetrics {
    seconds: Family<Route, Histogram, fn() -> Histogram>,
    answers: Family<Answer, Counter>,
}

impl RequestMetrics {
    pub(super) fn new() -> Self {
        RequestMetrics {
            seconds: Family::new_with_constructor(|| Histogram::new(BOUNDS_S)),
            answers: Family::default(),
        }
    }

    pub(super) fn register(&self, registry: &mut Registry) {
        registry.register(
            "request_seconds",
            "Time to the answer's head; of an exchange with its wait for work",
            self.seconds.clone(),
        );
        registry.register(
            "requests",
            "Requests by status of the answer",
            self.answers.clone(),
        );
    }
}

/// Measures a request. All unknown paths count under one name, so that a client cannot create labels.
pub(super) async fn measure(
    State(metrics): State<RequestMetrics>,
    mut request: Request,
    next: Next,
) -> Response {
    let route = request.extensions().get::<MatchedPath>();
    let route = route.map_or("none", MatchedPath::as_str).to_owned();
    let method = match request.method().as_str() {
        method @ ("GET" | "HEAD" | "POST" | "DELETE") => method,
        _ => "other",
    };
    let method = method.to_owned();
    request.extensions_mut().insert(metrics.clone());
    let began = Instant::now();
    let response = next.run(request).await;
    let status = response.status().as_u16();
    let of_route = Route {
        method: method.clone(),
        route: route.clone(),
    };
    metrics
        .seconds
        .get_or_create(&of_route)
        .observe(began.elapsed().as_secs_f64());
    metrics
        .answers
        .get_or_create(&Answer {
            method,
            route,
            status,
        })
        .inc();
    response
}
