//! `/v1/effects`: the catalogue.

use axum::Json;
use axum::extract::Path;
use formula::catalogue::{catalogue, find};
use serde::Serialize;
use shared::api::{ErrorBody, ErrorKind};
use shared::model::ModelKind;
use shared::model::settings::unknown_effect;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::HttpError;
use crate::effect::EffectCard;
use crate::effect::signature::{Signature, signature};
use crate::service::Service;

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(list, add))
        .routes(routes!(show))
}

/// An effect of the catalogue, with its file and what it does.
#[derive(Debug, Serialize, utoipa::ToSchema)]
struct EffectPage {
    effect: EffectCard,
    text: String,
    signature: Signature,
}

/// Every effect of the catalogue, in the order of evaluation.
#[utoipa::path(get, path = "/effects", responses((status = 200, body = Vec<EffectCard>)))]
async fn list() -> Json<Vec<EffectCard>> {
    Json(catalogue().iter().map(EffectCard::of).collect())
}

/// An effect of the catalogue: its file, and what it does in the quasi-static model.
#[utoipa::path(get, path = "/effects/{name}", params(("name" = String, Path)), responses(
    (status = 200, body = EffectPage), (status = 404, body = ErrorBody)))]
async fn show(Path(name): Path<String>) -> Result<Json<EffectPage>, HttpError> {
    let effect = find(&name).ok_or_else(|| HttpError::new(ErrorKind::NotFound, unknown_effect(&name)))?;
    let computed = tokio::task::spawn_blocking(|| signature(effect, ModelKind::QuasiStatic)).await;
    let internal = |e: String| HttpError::new(ErrorKind::Internal, e);
    let signature = computed.map_err(|e| internal(e.to_string()))?.map_err(internal)?;
    Ok(Json(EffectPage {
        effect: EffectCard::of(effect),
        text: effect.text.clone(),
        signature,
    }))
}

/// Adds an effect to the catalogue. Not available in this version.
#[utoipa::path(post, path = "/effects", responses((status = 501, body = ErrorBody)))]
async fn add() -> HttpError {
    HttpError::not_available("adding an effect to the catalogue")
}
