//! The REST interface under `/v1`; the only place that knows axum.
//!
//! One file per resource; each exports `routes()`, which `api` gathers. The OpenAPI `document` is made from the handlers, with `request_example`s. Before these stand
//! `connections` (how many, how long; `client_stream` and `activity` tell which ones wait for their clients) and `gate` (`host`, `body` with
//! `body_memory`, `access`: what is let through); `request_metrics` counts around them. `in_process` asks the routes without all of these.

mod access;
mod activity;
mod api;
mod body;
mod body_memory;
mod calibrations;
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
mod metrics;
mod page;
mod request_example;
mod request_metrics;
mod studies;
mod tls;
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

/// How a service shows itself: by which names it is reached, and when it asks for tokens.
#[derive(Clone)]
pub struct Exposure {
    pub listening: std::net::SocketAddr,
    /// Names besides the listening address.
    pub names: Vec<String>,
    /// When a token is asked for.
    pub token_rule: TokenRule,
    /// The tokens of the store, as of its start.
    pub tokens: Vec<Token>,
    /// The certificate, where the service speaks TLS itself.
    pub tls: Option<TlsAcceptor>,
}

/// Every route, behind the gate.
fn router(service: Service, gate: Gate) -> Router {
    let (router, document) = api().merge(metrics::routes()).split_for_parts();
    // Connections share the bytes; the document as a value would take 1.7 MB for each clone of its route.
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
        // Answers are compressed for clients that accept it: browsers do, workers do not.
        .layer(CompressionLayer::new())
        // The gate bounds bodies, by route.
        .layer(DefaultBodyLimit::disable())
        .layer(axum::middleware::from_fn_with_state(gate, gate::pass))
        // Refusals of the gate count too.
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
