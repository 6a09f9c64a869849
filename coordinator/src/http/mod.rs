//! The REST interface under `/v1`. No other module uses axum.
//!
//! There is one file for each resource, which exports `routes()`; `api` collects them. The OpenAPI `document` is made from the handlers and
//! the `request_example`s. Every request passes `connections` (their number and duration; `client_stream` and `activity` record which ones
//! wait for their clients) and `gate` (the checks of `host`, `body` with `body_memory`, and `access`); `request_metrics` counts all
//! requests. `in_process` calls the routes without these checks.

mod access;
mod activity;
mod api;
mod body;
mod body_memory;
mod calibrations;
mod campaign;
mod client_stream;
mod connections;
mod document;
mod effects;
mod error;
mod events;
mod examples;
mod experiments;
mod gate;
mod growth;
mod host;
mod import;
mod in_process;
mod job_check;
mod library;
mod list_page;
mod metrics;
mod page;
mod predictions;
mod request_example;
mod request_metrics;
mod studies;
mod tls;
mod unchanged;
mod work;

use std::future::Future;

use axum::Router;
use axum::body::Bytes;
use axum::extract::DefaultBodyLimit;
use axum::http::header::CONTENT_TYPE;
use axum::routing::get;
use tokio::net::TcpListener;
use tokio_rustls::TlsAcceptor;
use tower_http::compression::CompressionLayer;

use crate::service::Service;
use record::Token;

use access::Access;
pub use access::TokenRule;
use api::api;
use body_memory::BodyMemory;
pub use error::HttpError;
use gate::Gate;
use host::Hosts;
pub use in_process::InProcess;
use request_metrics::RequestMetrics;
pub use tls::{TlsError, tls_acceptor};

/// How a service is reached: its names, its rule for tokens, its certificate.
#[derive(Clone)]
pub struct Exposure {
    pub listening: std::net::SocketAddr,
    /// Names besides the listening address.
    pub names: Vec<String>,
    /// When a token is required.
    pub token_rule: TokenRule,
    /// The tokens of the store at its start.
    pub tokens: Vec<Token>,
    /// The TLS acceptor, where the service speaks TLS itself.
    pub tls: Option<TlsAcceptor>,
}

/// Returns every route, behind the gate.
fn router(service: Service, gate: Gate) -> Router {
    let (router, document) = api().merge(metrics::routes()).split_for_parts();
    // Connections share the bytes, because the document as a value would take 1.7 MB for each clone of its route.
    let document = Bytes::from(
        document::complete(document)
            .to_json()
            .expect("the document has a form in JSON"),
    );
    let document = get(async move || ([(CONTENT_TYPE, "application/json")], document));
    router
        .merge(page::routes())
        .route("/openapi.json", document)
        .fallback(error::no_route)
        .method_not_allowed_fallback(error::no_method)
        .layer(axum::middleware::map_response(error::logged))
        // Answers are compressed for clients that accept it, as browsers do; workers do not.
        .layer(CompressionLayer::new())
        // The gate limits the size of bodies by route.
        .layer(DefaultBodyLimit::disable())
        .layer(axum::middleware::from_fn_with_state(gate, gate::pass))
        // This layer is outside the gate, so that refusals of the gate are counted.
        .layer(axum::middleware::from_fn_with_state(
            RequestMetrics::new(),
            request_metrics::measure,
        ))
        .with_state(service)
}

/// Serves until `shutdown` is ready.
pub async fn serve(
    listener: TcpListener,
    service: Service,
    exposure: Exposure,
    shutdown: impl Future<Output = ()> + Send + 'static,
) {
    let gate = Gate {
        hosts: Hosts::new(exposure.listening, exposure.names),
        access: Access::start(exposure.token_rule, exposure.tokens, service.store().reader()),
        body_memory: BodyMemory::new(),
        is_read_only: service.store().is_read_only(),
    };
    connections::serve(listener, exposure.tls, router(service, gate), shutdown).await;
}
