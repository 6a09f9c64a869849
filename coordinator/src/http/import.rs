//! `/v1/import`: conversion of users' tables of measurements to runs.csv.

use std::borrow::Cow;
use std::cell::Cell;
use std::collections::BTreeMap;

use axum::Json;
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use import::{Converted, Files, Guess, SourceFile, convert_all, files_of, guess};
use serde::Deserialize;
use shared::api::{ErrorBody, ErrorKind};
use tokio::sync::Semaphore;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::error::{Body, HttpError};
use crate::service::Service;

/// Maximum size of what a request reads `[bytes]`; each recording reads its joined and taring files again.
const MAX_READ_BYTES: usize = 256 << 20;
/// One table is read at a time, because it may take some hundred megabytes of memory.
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
    /// Content of the file in base64: text with separators, .xlsx, .ods, .mat, or .bag.
    content_base64: String,
    /// Text of the map, TOML.
    map: String,
    /// Files that the map names beside this one: joined and taring files, and further recordings that fit its `file`.
    #[serde(default)]
    others: Vec<OtherFile>,
}

/// A file beside the one that is converted.
#[derive(Debug, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
struct OtherFile {
    /// Name of the file, as the map says it.
    name: String,
    /// Content of the file in base64.
    content_base64: String,
}

/// A table of measurements.
#[derive(Debug, Deserialize, utoipa::ToSchema)]
#[serde(deny_unknown_fields)]
struct GuessRequest {
    /// Name of the file, for messages: `Messung.xlsx`.
    name: String,
    /// Content of the file in base64: text with separators, .xlsx, .ods, .mat, or .bag.
    content_base64: String,
    /// The sheet, or the struct of a MATLAB file; the largest one where none is named.
    sheet: Option<String>,
}

/// Converts a table, or recordings, to runs.csv.
///
/// The answer has runs.csv, the notes and the histories, or every mistake of the file and the map with its place. Nothing is stored.
/// The service does not read .xls files. All files together are at most one request.
#[utoipa::path(post, path = "/import", operation_id = "import_table", tag = "import",
    request_body = ImportRequest,
    responses(
        (status = 200, body = Converted, description = "the files, or every mistake"),
        (status = 422, body = ErrorBody, description = "the content is not base64, or no reader gets through it"),
    ))]
async fn import_table(Body(asked): Body<ImportRequest>) -> Result<Json<Converted>, HttpError> {
    let ImportRequest {
        name,
        content_base64,
        map,
        others,
    } = asked;
    let converted = alone(move || {
        let mut contents = BTreeMap::from([(name.clone(), decoded(content_base64)?)]);
        let mut others_names = Vec::with_capacity(others.len());
        for other in others {
            if other.name != name {
                others_names.push(other.name.clone());
                contents.insert(other.name, decoded(other.content_base64)?);
            }
        }
        let mut names = vec![name];
        names.extend(files_of(&map, &others_names).unwrap_or_default());
        let read = Cell::new(0);
        let open = |name: &str| {
            let bytes = contents.get(name).ok_or("there is no such file among `others`")?;
            read.set(read.get() + bytes.len());
            if read.get() > MAX_READ_BYTES {
                return Err(format!(
                    "the files of a request are read again and again, more than {MAX_READ_BYTES} bytes: send fewer recordings at once"
                ));
            }
            Ok(Cow::Borrowed(bytes.as_slice()))
        };
        let files = Files {
            names: &names,
            open: &open,
            is_own: false,
        };
        Ok(convert_all(files, ("map.toml", &map), "runs"))
    });
    converted.await?.map(Json)
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
    let GuessRequest {
        name,
        content_base64,
        sheet,
    } = asked;
    let guessed = read_alone(name, content_base64, move |source| {
        guess(source, sheet.as_deref())
    });
    let guessed = guessed.await?;
    guessed
        .map(Json)
        .map_err(|complaint| HttpError::new(ErrorKind::InvalidFile, complaint.to_string()))
}

/// Reads a file that was sent in base64, when no other table is being read.
async fn read_alone<T: Send + 'static>(
    name: String,
    content: String,
    read: impl FnOnce(&SourceFile<'_>) -> T + Send + 'static,
) -> Result<T, HttpError> {
    let read = move || {
        let bytes = decoded(content)?;
        Ok(read(&SourceFile {
            name: &name,
            bytes: &bytes,
            is_own: false,
        }))
    };
    alone(read).await?
}

/// Decodes the bytes of a file, and frees the memory of its text at once.
fn decoded(content: String) -> Result<Vec<u8>, HttpError> {
    let bytes = BASE64_STANDARD.decode(content);
    bytes.map_err(|e| {
        HttpError::new(
            ErrorKind::InvalidFile,
            format!("content_base64 is no base64: {e}"),
        )
    })
}

/// Reads a table outside the threads of the runtime, one at a time.
async fn alone<T: Send + 'static>(read: impl FnOnce() -> T + Send + 'static) -> Result<T, HttpError> {
    // The semaphore is never closed.
    let turn = ONE_AT_A_TIME.acquire().await;
    // A thread that reads cannot be stopped. It keeps the permit until it has ended, because this future is dropped when its client
    // disconnects.
    let read = move || {
        let _turn = turn;
        read()
    };
    tokio::task::spawn_blocking(read).await.map_err(|_| {
        HttpError::new(
            ErrorKind::InvalidFile,
            "the file is damaged: no reader gets through it",
        )
    })
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use super::*;

    #[tokio::test]
    async fn a_table_keeps_its_turn_when_its_client_hangs_up() {
        let (begun, begins) = mpsc::channel();
        let (release, released) = mpsc::channel::<()>();
        let reading = tokio::spawn(alone(move || {
            begun.send(()).expect("the test waits for it");
            released.recv()
        }));
        tokio::task::spawn_blocking(move || begins.recv())
            .await
            .expect("no panic")
            .expect("the reading begins");
        reading.abort();
        assert!(reading.await.is_err_and(|e| e.is_cancelled()));
        assert_eq!(ONE_AT_A_TIME.available_permits(), 0, "the thread still reads");
        release.send(()).expect("the thread waits for it");
        let next = alone(|| 1).await;
        assert!(matches!(next, Ok(1)), "the next table is read");
    }
}
