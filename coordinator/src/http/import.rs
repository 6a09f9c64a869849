//! `/v1/import`: users' tables of measurements to runs.csv.

use axum::Json;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use import::{Converted, Guess, SourceFile, convert, guess};
use serde::Deserialize;
use shared::api::{ErrorBody, ErrorKind};
use tokio::sync::Semaphore;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::{Body, HttpError};
use crate::service::Service;

/// A table may take some hundred megabytes while it is read.
static ONE_AT_A_TIME: Semaphore = Semaphore::const_new(1);

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(import_table))
        .routes(routes!(guess_map))
}

/// A table of measurements, and where each column of runs.csv comes from.
#[derive(Debug, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
struct ImportRequest {
    /// Name of the file, for messages: `Messung.xlsx`.
    name: String,
    /// Its bytes in base64: text with separators, .xlsx, .ods, or .mat.
    content_base64: String,
    /// Text of the map, TOML.
    map: String,
}

/// A table of measurements.
#[derive(Debug, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
struct GuessRequest {
    /// Name of the file, for messages: `Messung.xlsx`.
    name: String,
    /// Its bytes in base64: text with separators, .xlsx, .ods, or .mat.
    content_base64: String,
    /// The sheet, or the struct of a MATLAB file; the largest one where none is named.
    sheet: Option<String>,
}

/// Converts a table to runs.csv.
///
/// The answer has runs.csv, the notes and the histories, or every mistake of the file and the map with its place. Nothing is stored.
/// The service does not read .xls files.
#[utoipa::path(post, path = "/import", operation_id = "import_table", tag = "import",
    request_body = ImportRequest,
    responses(
        (status = 200, body = Converted, description = "the files, or every mistake"),
        (status = 422, body = ErrorBody, description = "the content is not base64, or no reader gets through it"),
    ))]
async fn import_table(Body(asked): Body<ImportRequest>) -> Result<Json<Converted>, HttpError> {
    let bytes = decoded(&asked.content_base64)?;
    let converted = alone(move || {
        let source = SourceFile {
            name: &asked.name,
            bytes: &bytes,
            is_own: false,
        };
        convert(&source, ("map.toml", &asked.map), "runs")
    });
    Ok(Json(converted.await?))
}

/// Proposes a map for a table.
///
/// What the file states is taken: titles, units, the decimal mark. What it does not state is a question, and the map is refused
/// until it is answered. Nothing is stored.
#[utoipa::path(post, path = "/import/guess", operation_id = "guess_import_map", tag = "import",
    request_body = GuessRequest,
    responses(
        (status = 200, body = Guess, description = "a map, and what it is made from"),
        (status = 422, body = ErrorBody, description = "the content is not base64, or is no table"),
    ))]
async fn guess_map(Body(asked): Body<GuessRequest>) -> Result<Json<Guess>, HttpError> {
    let bytes = decoded(&asked.content_base64)?;
    let found = alone(move || {
        let source = SourceFile {
            name: &asked.name,
            bytes: &bytes,
            is_own: false,
        };
        guess(&source, asked.sheet.as_deref())
    });
    let found = found.await?;
    Ok(Json(found.map_err(|complaint| {
        HttpError::new(ErrorKind::InvalidFile, complaint.to_string())
    })?))
}

fn decoded(content: &str) -> Result<Vec<u8>, HttpError> {
    let bytes = BASE64_STANDARD.decode(content);
    bytes.map_err(|e| {
        HttpError::new(
            ErrorKind::InvalidFile,
            format!("content_base64 is no base64: {e}"),
        )
    })
}

/// Reads a table off the threads that serve, one at a time.
async fn alone<T: Send + 'static>(read: impl FnOnce() -> T + Send + 'static) -> Result<T, HttpError> {
    // The semaphore is never closed.
    let _turn = ONE_AT_A_TIME.acquire().await;
    tokio::task::spawn_blocking(read).await.map_err(|_| {
        HttpError::new(
            ErrorKind::InvalidFile,
            "the file is damaged: no reader gets through it",
        )
    })
}
