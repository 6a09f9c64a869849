//! The body of a request: its form, its size and its duration are checked before the handler gets it.

use std::error::Error;
use std::future::poll_fn;
use std::pin::Pin;
use std::time::Duration;

use axum::body::{Body, Bytes, HttpBody};
use axum::extract::Request;
use axum::http::Method;
use axum::http::header::CONTENT_TYPE;
use shared::api::ErrorKind;
use shared::wire::WireForm;

use super::body_memory::{BodyMemory, ORDINARY};
use super::error::HttpError;

/// The path to which workers post results.
const EXCHANGE: &str = "/v1/work/exchange";
/// The time within which a body must arrive.
const BODY_TIME: Duration = Duration::from_secs(120);

/// Returns the largest body of a route `[bytes]`. Large routes are the results of a large batch, the files of a large experiment, a table
/// of measurements, a job to check with its experiment, a job with the draws that it names, further runs, a recording, an effect file for a job, lists of runs, plans and decisions. Other bodies are as
/// small as the addition of an effect from the catalogue.
fn limit(path: &str) -> usize {
    match path.rsplit('/').next() {
        _ if path == EXCHANGE => 64 << 20,
        // A check brings the files of the experiment with the job.
        Some("experiments" | "check") => 64 << 20,
        Some("import" | "guess") => 32 << 20,
        Some("calibrations" | "runs") => 16 << 20,
        Some("follow" | "stream") => 16 << 20,
        Some("extend" | "what-if" | "predict" | "decide") => 1 << 20,
        _ => 64 << 10,
    }
}

/// Checks that a POST has the form of JSON or of a worker's message, because a browser does not let a page send these to another site
/// without a preflight request.
pub(super) fn check_form(request: &Request) -> Result<(), HttpError> {
    let path = request.uri().path();
    // The exchange checks its forms itself. A path outside `/v1` gets the answer 404.
    if request.method() != Method::POST || path.ends_with(EXCHANGE) {
        return Ok(());
    }
    let stated = request.headers().get(CONTENT_TYPE);
    let stated = stated.and_then(|value| value.to_str().ok()).unwrap_or_default();
    if WireForm::from_media_type(stated) == Some(WireForm::Json) {
        return Ok(());
    }
    let message = format!(
        "Content-Type \"{stated}\" must be {}",
        WireForm::Json.media_type()
    );
    Err(HttpError::new(ErrorKind::UnsupportedMediaType, message))
}

/// Reads the whole body of a request.
pub(super) async fn received(request: Request, memory: &BodyMemory) -> Result<Request, HttpError> {
    let path = request.uri().path();
    let (limit, is_of_worker) = (limit(path), path == EXCHANGE);
    let (parts, body) = request.into_parts();
    if body.is_end_stream() {
        return Ok(Request::from_parts(parts, body));
    }
    if body.size_hint().lower() > limit as u64 {
        return Err(too_large(limit));
    }
    let late = |_| {
        let message = format!("the body has not arrived within {} s", BODY_TIME.as_secs());
        HttpError::new(ErrorKind::Timeout, message)
    };
    let whole = whole(body, limit, memory, is_of_worker);
    let bytes = tokio::time::timeout(BODY_TIME, whole).await.map_err(late)??;
    Ok(Request::from_parts(parts, Body::from(bytes)))
}

fn too_large(limit: usize) -> HttpError {
    let message = format!("the body is above the limit of {limit} bytes for this route");
    HttpError::new(ErrorKind::TooLarge, message)
}

/// Reads a body into one allocation, because many small ones would fragment the memory of the process.
async fn whole(
    mut body: Body,
    limit: usize,
    memory: &BodyMemory,
    is_of_worker: bool,
) -> Result<Bytes, HttpError> {
    let stated = body
        .size_hint()
        .exact()
        .and_then(|size| usize::try_from(size).ok());
    let first = stated.unwrap_or(limit.min(ORDINARY));
    let mut room = memory.take(first, is_of_worker).await?;
    let mut bytes = Vec::with_capacity(stated.unwrap_or_default());
    while let Some(frame) = poll_fn(|context| Pin::new(&mut body).poll_frame(context)).await {
        // Frames that are not data, such as trailers, are ignored.
        let Ok(part) = frame.map_err(|error| unreadable(&error))?.into_data() else {
            continue;
        };
        if part.len() > limit - bytes.len() {
            return Err(too_large(limit));
        }
        if bytes.len() + part.len() > room.bytes() {
            drop(room);
            room = memory.take(limit, is_of_worker).await?;
        }
        bytes.extend_from_slice(&part);
    }
    Ok(room.holding(bytes))
}

fn unreadable(error: &axum::Error) -> HttpError {
    let mut cause: &dyn Error = error;
    while let Some(source) = cause.source() {
        cause = source;
    }
    let message = format!("the body cannot be read: {cause}");
    HttpError::new(ErrorKind::InvalidBody, message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_check_may_bring_a_whole_experiment() {
        assert_eq!(limit("/v1/check"), limit("/v1/experiments"));
        assert_eq!(limit("/v1/effects"), 64 << 10);
    }
}
