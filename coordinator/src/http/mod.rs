//! The REST interface under `/v1`; the only place that knows axum.
//!
//! One file per resource; each exports `routes()`. The OpenAPI document is made from the handlers.

mod calibrations;
mod effects;
mod error;
mod events;
mod experiments;
mod growth;
mod metrics;
mod studies;
mod work;

use std::future::Future;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::routing::get;
use tokio::net::TcpListener;
use utoipa::OpenApi;
use utoipa_axum::router::OpenApiRouter;

use crate::service::Service;

pub use error::HttpError;

/// Largest body: the results of a large batch, or the files of a large experiment `[bytes]`.
const BODY_LIMIT: usize = 64 << 20;

/// The document that the handlers complete.
#[derive(OpenApi)]
#[openapi(info(
    title = "Grouser coordinator",
    description = "Calibrates wheel-soil contact models by Bayesian updating on a farm of workers."
))]
struct Document;

/// Every route.
pub fn router(service: Service) -> Router {
    let (router, document) = OpenApiRouter::with_openapi(Document::openapi())
        .nest(
            "/v1",
            OpenApiRouter::new()
                .merge(experiments::routes())
                .merge(effects::routes())
                .merge(calibrations::routes())
                .merge(events::routes())
                .merge(studies::routes())
                .merge(work::routes())
                .merge(growth::routes()),
        )
        .merge(metrics::routes())
        .split_for_parts();
    let document = axum::Json(document);
    router
        .route("/openapi.json", get(async move || document))
        .fallback(error::no_route)
        .method_not_allowed_fallback(error::no_method)
        .layer(DefaultBodyLimit::max(BODY_LIMIT))
        .with_state(service)
}

/// Serves until `shutdown` is ready.
///
/// # Errors
/// The listener fails.
pub async fn serve(
    listener: TcpListener,
    service: Service,
    shutdown: impl Future<Output = ()> + Send + 'static,
) -> std::io::Result<()> {
    axum::serve(listener, router(service))
        .with_graceful_shutdown(shutdown)
        .await
}
