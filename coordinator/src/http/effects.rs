//! `/v1/effects`: the catalogue, with the effects of the library and those that users add.

use axum::Json;
use axum::extract::State;
use axum::http::StatusCode;
use formula::Effect;
use formula::catalogue::{catalogue, find};
use serde::Serialize;
use shared::api::{ErrorBody, ErrorKind, NewEffect};
use shared::model::ModelKind;
use shared::model::settings::unknown_effect;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::access::Caller;
use super::error::{Body, HttpError, Name, Query};
use super::list_page::NamesPage;
use crate::effect::EffectCard;
use crate::effect::signature::{Signature, signature};
use crate::service::{Service, in_background};
use store::{EffectVersion, StoreError, StoredEffect};

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(list, add))
        .routes(routes!(show))
}

/// An effect of the catalogue, with its file and what it does.
#[derive(Debug, Serialize, utoipa::ToSchema)]
struct EffectPage {
    /// Entry of the effect in the catalogue.
    effect: EffectCard,
    /// The text of the effect file.
    text: String,
    /// Influence of the effect in the quasi-static model; null if this model cannot express it.
    signature: Option<Signature>,
    /// Why there is no signature.
    no_signature: Option<String>,
    /// Every version, the first one first; none of the library's.
    versions: Vec<EffectVersion>,
}

/// An effect that was added.
#[derive(Debug, Serialize, utoipa::ToSchema)]
struct EffectAdded {
    /// Name of the effect.
    name: String,
    /// The version that has its text.
    version: EffectVersion,
}

/// Lists the effects of the catalogue.
///
/// First come the effects of the library in the order of evaluation, then the last versions of the effects that users have
/// added, by name.
#[utoipa::path(get, path = "/effects", operation_id = "list_effects", tag = "effects",
    params(
        ("limit" = Option<u32>, Query, minimum = 1, maximum = 10000, description = "the largest number of entries; without it, all"),
        ("after" = Option<String>, Query, description = "the name of the last entry of the page before")),
    responses((status = 200, description = "cards of the effects", body = Vec<EffectCard>)))]
async fn list(
    State(service): State<Service>,
    Query(which): Query<NamesPage>,
) -> Result<Json<Vec<EffectCard>>, HttpError> {
    let added = service.store().reader().user_effects().await?;
    let cards = in_background(move || {
        let library = catalogue().iter().map(|effect| Ok(EffectCard::new(effect)));
        let added = added
            .iter()
            .map(|stored| Ok(EffectCard::user(&read(stored)?, stored.version.version)));
        let cards = library.chain(added).collect::<Result<Vec<_>, HttpError>>()?;
        which.cut(cards, |card| &card.name)
    });
    Ok(Json(cards.await?))
}

/// An effect with its file and influence.
///
/// The influence on the measured quantities is computed in the quasi-static model, if this model can express the effect.
#[utoipa::path(get, path = "/effects/{name}", operation_id = "get_effect", tag = "effects",
    params(("name" = String, Path, description = "`NAME`; of one that a user has added also `NAME@VERSION`")),
    responses((status = 200, description = "the effect", body = EffectPage), (status = 404, body = ErrorBody)))]
async fn show(State(service): State<Service>, Name(name): Name) -> Result<Json<EffectPage>, HttpError> {
    let (effect, card, versions) = match find(&name) {
        Some(effect) => (effect.clone(), EffectCard::new(effect), Vec::new()),
        None => {
            let stored = service.user_effect(&name).await?;
            let (versions, meant) =
                stored.ok_or_else(|| HttpError::new(ErrorKind::NotFound, unknown_effect(&name)))?;
            let effect = read(&meant)?;
            let card = EffectCard::user(&effect, meant.version.version);
            (
                effect,
                card,
                versions.into_iter().map(|stored| stored.version).collect(),
            )
        }
    };
    let text = effect.text.clone();
    let computed = in_background(move || Ok::<_, HttpError>(signature(&effect, ModelKind::QuasiStatic)));
    let (signature, no_signature) = match computed.await? {
        Ok(signature) => (Some(signature), None),
        Err(reason) => (None, Some(reason)),
    };
    Ok(Json(EffectPage {
        effect: card,
        text,
        signature,
        no_signature,
        versions,
    }))
}

/// Reads the effect of a stored file, which was validated when it was added.
fn read(stored: &StoredEffect) -> Result<Effect, HttpError> {
    let corrupt = |error| {
        let version = stored.version.version;
        StoreError::Corrupt(format!("effect {} version {version}: {error}", stored.name))
    };
    Ok(Effect::read(&stored.text).map_err(corrupt)?)
}

/// Adds an effect to the catalogue.
///
/// It becomes the next version of its name. Jobs name it as they name the library's; a study keeps the version that
/// it began with.
#[utoipa::path(post, path = "/effects", operation_id = "add_effect", tag = "effects",
    request_body = NewEffect, responses(
    (status = 201, body = EffectAdded, description = "a new version"),
    (status = 200, body = EffectAdded, description = "a version has this text already"),
    (status = 409, body = ErrorBody, description = "the name belongs to the library"),
    (status = 422, body = ErrorBody, description = "the file is malformed"),
))]
async fn add(
    State(service): State<Service>,
    by: Caller,
    Body(new): Body<NewEffect>,
) -> Result<(StatusCode, Json<EffectAdded>), HttpError> {
    let text = match (new.text, new.effect) {
        (Some(text), None) => text,
        (None, Some(effect)) => effect.to_string(),
        _ => {
            let message = "an effect is {\"text\": TEXT}, the text of its file, or {\"effect\": {...}}, the keys of its file";
            return Err(HttpError::new(ErrorKind::InvalidBody, message));
        }
    };
    let log_name = by.to_string();
    let added = service.add_effect(text, by.into_name()).await?;
    let status = if added.is_new {
        StatusCode::CREATED
    } else {
        StatusCode::OK
    };
    tracing::info!(
        effect = added.name,
        version = added.version.version,
        is_new = added.is_new,
        by = log_name,
        "effect added"
    );
    Ok((
        status,
        Json(EffectAdded {
            name: added.name,
            version: added.version,
        }),
    ))
}
