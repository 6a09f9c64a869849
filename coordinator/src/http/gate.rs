//! The checks of every request before its handler: host and origin, form, token, body.

use std::sync::Arc;

use axum::Extension;
use axum::extract::{Request, State};
use axum::http::Method;
use axum::middleware::Next;
use axum::response::Response;
use shared::api::ErrorKind;

use super::access::Access;
use super::activity::Activity;
use super::body;
use super::body_memory::BodyMemory;
use super::error::HttpError;
use super::host::Hosts;

/// The settings of these checks.
#[derive(Debug, Clone)]
pub(super) struct Gate {
    pub(super) hosts: Hosts,
    pub(super) access: Access,
    pub(super) body_memory: BodyMemory,
    /// Whether every change is refused.
    pub(super) is_read_only: bool,
}

/// Passes an admitted request to its handler, with its [`super::access::Caller`] and its whole body.
pub(super) async fn pass(
    State(gate): State<Gate>,
    Extension(activity): Extension<Arc<Activity>>,
    mut request: Request,
    next: Next,
) -> Result<Response, HttpError> {
    gate.hosts.check(request.headers())?;
    body::check_form(&request)?;
    let path = request.uri().path();
    let caller = gate.access.caller(request.method(), path, request.headers())?;
    if gate.is_read_only && !changes_nothing(request.method(), path) {
        let message = "this service only reads: it was started with --read-only";
        return Err(HttpError::new(ErrorKind::Forbidden, message));
    }
    request.extensions_mut().insert(caller);
    let request = body::received(request, &gate.body_memory).await?;
    let answering = activity.answer();
    Ok(answering.through(next.run(request).await))
}

/// Returns whether a request changes no study: it reads, which may keep a computed result, or it asks what follows from a calibration.
fn changes_nothing(method: &Method, path: &str) -> bool {
    [Method::GET, Method::HEAD].contains(method) || method == Method::POST && asks_of_a_calibration(path)
}

/// Returns whether a path is `/v1/calibrations/ID/` and `predict`, `decide`, `follow` or `stream`.
fn asks_of_a_calibration(path: &str) -> bool {
    let rest = path.strip_prefix("/v1/calibrations/");
    let parts = rest.and_then(|rest| rest.split_once('/'));
    parts
        .is_some_and(|(id, verb)| !id.is_empty() && ["predict", "decide", "follow", "stream"].contains(&verb))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_service_that_only_reads_answers_predictions_and_decisions_alone() {
        for (method, path, expected) in [
            (Method::GET, "/v1/studies", true),
            (Method::POST, "/v1/calibrations/3/predict", true),
            (Method::POST, "/v1/calibrations/3/decide", true),
            (Method::POST, "/v1/calibrations/3/follow", true),
            (Method::POST, "/v1/calibrations/3/stream", true),
            (Method::DELETE, "/v1/calibrations/3/predict", false),
            (Method::POST, "/v1/calibrations/3/cancel", false),
            (Method::PUT, "/v1/effects/predict", false),
            (Method::POST, "/v1/effects/decide", false),
            (Method::POST, "/v1/calibrations//predict", false),
            (Method::POST, "/v1/calibrations/3/more/predict", false),
        ] {
            assert_eq!(changes_nothing(&method, path), expected, "{method} {path}");
        }
    }
}
