//! `/`, `/docs` and `/page/…`: the embedded files of the page and of the description of the interface. They need no token; the page sends
//! its user's token with its requests.

use axum::Router;
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, ETAG, IF_NONE_MATCH, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderMap, StatusCode, Uri};
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use page::asset::{DOCS, INDEX, asset};
use tower_http::CompressionLevel;
use tower_http::compression::CompressionLayer;

use super::error::{Name, no_route};
use crate::service::Service;

/// The path of the page's files.
pub(super) const FOLDER: &str = "/page/";
/// The path of the description of the interface.
pub(super) const DOCS_PATH: &str = "/docs";
/// The content security policy: the page runs only its own modules, sends requests only to this service, and is shown in no frame. The
/// pictures need styles in elements.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

pub(super) fn routes() -> Router<Service> {
    Router::new()
        .route(
            "/",
            get(async |uri: Uri, headers: HeaderMap| file(INDEX, uri, headers).await),
        )
        .route(
            DOCS_PATH,
            get(async |uri: Uri, headers: HeaderMap| file(DOCS, uri, headers).await),
        )
        .route(
            &format!("{FOLDER}{{*path}}"),
            get(async |Name(path): Name, uri: Uri, headers: HeaderMap| file(&path, uri, headers).await),
        )
        // A browser keeps these files, so they are worth more time than answers; the layer of all routes leaves them as they are.
        .layer(CompressionLayer::new().quality(CompressionLevel::Best))
}

/// Returns a file, or the status 304 if the browser has it.
async fn file(path: &str, uri: Uri, headers: HeaderMap) -> Response {
    let Some(asset) = asset(path) else {
        return no_route(uri).await.into_response();
    };
    let tag = format!("\"{}\"", asset.tag);
    let common = [
        (CONTENT_TYPE, asset.media_type),
        (CONTENT_SECURITY_POLICY, POLICY),
        (REFERRER_POLICY, "no-referrer"),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        // The browser must ask each time, because a new program has other files under the same names.
        (CACHE_CONTROL, "no-cache"),
    ];
    let is_known = headers
        .get(IF_NONE_MATCH)
        .and_then(|value| value.to_str().ok())
        .is_some_and(|tags| {
            tags.split(',')
                .any(|stated| stated.trim().trim_start_matches("W/") == tag)
        });
    let tag = [(ETAG, tag)];
    match is_known {
        true => (StatusCode::NOT_MODIFIED, common, tag).into_response(),
        false => (common, tag, asset.content).into_response(),
    }
}
