//! `/v1/work`: what workers talk to; `/v1/workers`: who they are.

use std::collections::BTreeMap;

use axum::Json;
use axum::extract::{Path, State};
use shared::api::{ErrorBody, ErrorKind};
use shared::exchange::{ExchangeRequest, ExchangeResponse, PROTOCOL_VERSION};
use shared::model::ModelVariant;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::{Body, HttpError};
use crate::farm::WorkerRecord;
use crate::service::Service;

/// A poll may last so long `[ms]`.
const LONGEST_WAIT_MS: u64 = 30_000;

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(exchange))
        .routes(routes!(variant))
        .routes(routes!(workers))
}

/// Takes results and gives leases; waits for work up to `wait_ms`. The answer means: results are durable.
#[utoipa::path(post, path = "/work/exchange", request_body = ExchangeRequest, responses(
    (status = 200, body = ExchangeResponse),
    (status = 426, body = ErrorBody, description = "another version of the protocol"),
    (status = 429, body = ErrorBody, description = "more results wait than the store takes; try again"),
))]
async fn exchange(
    State(service): State<Service>,
    Body(mut request): Body<ExchangeRequest>,
) -> Result<Json<ExchangeResponse>, HttpError> {
    if request.protocol != PROTOCOL_VERSION {
        let message = format!(
            "worker {} speaks protocol {}, this coordinator {PROTOCOL_VERSION}",
            request.worker, request.protocol
        );
        return Err(HttpError::new(ErrorKind::ProtocolMismatch, message));
    }
    request.wait_ms = request.wait_ms.min(LONGEST_WAIT_MS);
    Ok(Json(service.exchange(request).await?))
}

/// The variant of a hash, for a worker to keep.
#[utoipa::path(get, path = "/work/variants/{hash}", params(("hash" = String, Path)), responses(
    (status = 200, body = ModelVariant), (status = 404, body = ErrorBody)))]
async fn variant(
    State(service): State<Service>,
    Path(hash): Path<String>,
) -> Result<Json<ModelVariant>, HttpError> {
    let variant = service.dispatcher().variant(hash.clone()).await?;
    variant.map(Json).ok_or_else(|| {
        HttpError::new(
            ErrorKind::NotFound,
            format!("no calibration in progress uses variant {hash}"),
        )
    })
}

/// The workers heard of lately, by name.
#[utoipa::path(get, path = "/workers", responses((status = 200, body = BTreeMap<String, WorkerRecord>)))]
async fn workers(State(service): State<Service>) -> Result<Json<BTreeMap<String, WorkerRecord>>, HttpError> {
    Ok(Json(service.dispatcher().workers().await?))
}
