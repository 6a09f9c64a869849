//! Error answers: one status for each kind of error, and one form of the body.

use axum::Json;
use axum::extract::FromRequest;
use axum::extract::rejection::{BytesRejection, JsonRejection, PathRejection, QueryRejection};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use export::ExportError;
use prediction::PredictionError;
use shared::api::{ErrorBody, ErrorDetail, ErrorKind};
use shared::sentence::one_line;

use crate::service::ServiceError;
use store::StoreError;

/// An error that goes to a client. It is attached to its response, so that the log, and a caller in this process, can read its cause.
#[derive(Debug, Clone, thiserror::Error)]
#[error("{}", .cause.as_ref().unwrap_or(.message))]
pub struct HttpError {
    kind: ErrorKind,
    message: String,
    /// The cause of an internal error, which a client over a network does not get.
    cause: Option<String>,
}

impl HttpError {
    /// Makes an error of a kind with its message.
    pub fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        HttpError {
            kind,
            // The message may repeat text of the client.
            message: one_line(&message.into()).into_owned(),
            cause: None,
        }
    }

    /// Makes an internal error, whose cause only the log states.
    pub(super) fn internal(cause: &dyn std::error::Error) -> Self {
        HttpError {
            kind: ErrorKind::Internal,
            message: "internal error of the coordinator; see its log".into(),
            cause: Some(cause.to_string()),
        }
    }

    fn status(&self) -> StatusCode {
        match self.kind {
            ErrorKind::InvalidBody => StatusCode::BAD_REQUEST,
            ErrorKind::UnsupportedMediaType => StatusCode::UNSUPPORTED_MEDIA_TYPE,
            ErrorKind::Timeout => StatusCode::REQUEST_TIMEOUT,
            ErrorKind::Unauthorized => StatusCode::UNAUTHORIZED,
            ErrorKind::Forbidden => StatusCode::FORBIDDEN,
            ErrorKind::InvalidFile => StatusCode::UNPROCESSABLE_ENTITY,
            ErrorKind::NotFound => StatusCode::NOT_FOUND,
            ErrorKind::Conflict => StatusCode::CONFLICT,
            ErrorKind::TooLarge => StatusCode::PAYLOAD_TOO_LARGE,
            ErrorKind::ProtocolMismatch => StatusCode::UPGRADE_REQUIRED,
            ErrorKind::Busy => StatusCode::TOO_MANY_REQUESTS,
            ErrorKind::Internal => StatusCode::INTERNAL_SERVER_ERROR,
        }
    }
}

impl IntoResponse for HttpError {
    fn into_response(self) -> Response {
        let status = self.status();
        let demand = match self.kind {
            ErrorKind::Busy => Some((header::RETRY_AFTER, "1")),
            ErrorKind::Unauthorized => Some((header::WWW_AUTHENTICATE, "Bearer")),
            _ => None,
        };
        let body = ErrorBody {
            error: ErrorDetail {
                kind: self.kind,
                message: self.message.clone(),
            },
        };
        let mut response = match demand {
            Some(demand) => (status, [demand], Json(body)).into_response(),
            None => (status, Json(body)).into_response(),
        };
        response.extensions_mut().insert(self);
        response
    }
}

/// Logs an internal error before the response is sent.
pub(super) async fn logged(response: Response) -> Response {
    let error = response.extensions().get::<HttpError>();
    if let Some(error) = error.filter(|error| error.kind == ErrorKind::Internal) {
        tracing::error!(%error, "internal error");
    }
    response
}

impl From<ServiceError> for HttpError {
    fn from(error: ServiceError) -> Self {
        let kind = match &error {
            ServiceError::File(_) | ServiceError::Begin(_) | ServiceError::Webhook(_) => {
                ErrorKind::InvalidFile
            }
            ServiceError::Prediction(PredictionError::File(_) | PredictionError::Request(_)) => {
                ErrorKind::InvalidFile
            }
            ServiceError::NotFound { .. } | ServiceError::NoVersion { .. } => ErrorKind::NotFound,
            ServiceError::Control(_)
            | ServiceError::Effects(_)
            | ServiceError::OfLibrary(_)
            | ServiceError::Prediction(
                PredictionError::NoDraws(_) | PredictionError::NoStoredDraws(_) | PredictionError::Model(_),
            )
            | ServiceError::Search(_)
            | ServiceError::LeftAlone { .. }
            | ServiceError::InProgress { .. }
            | ServiceError::Archived(_)
            | ServiceError::Submitted(_) => ErrorKind::Conflict,
            ServiceError::Details(_) => ErrorKind::InvalidBody,
            // A worker sends its message again, to the next start or to a standby.
            ServiceError::Busy(_) | ServiceError::Stopped(_) => ErrorKind::Busy,
            ServiceError::Store(_)
            | ServiceError::Replay(_)
            | ServiceError::Thread(_)
            | ServiceError::Panicked(_) => ErrorKind::Internal,
        };
        match &error {
            // The owner of the store needs to know which row is corrupt.
            ServiceError::Store(StoreError::Corrupt(_)) => HttpError::new(kind, error.to_string()),
            _ if kind == ErrorKind::Internal => HttpError::internal(&error),
            _ => HttpError::new(kind, error.to_string()),
        }
    }
}

impl From<StoreError> for HttpError {
    fn from(error: StoreError) -> Self {
        ServiceError::from(error).into()
    }
}

impl From<ExportError> for HttpError {
    fn from(error: ExportError) -> Self {
        match error {
            ExportError::NoDraws(_) => HttpError::new(ErrorKind::Conflict, error.to_string()),
            error => HttpError::internal(&error),
        }
    }
}

impl From<farm::dispatch::Stopped> for HttpError {
    fn from(error: farm::dispatch::Stopped) -> Self {
        ServiceError::from(error).into()
    }
}

/// A JSON body, for which refusals have the form of this interface.
#[derive(FromRequest)]
#[from_request(via(axum::Json), rejection(HttpError))]
pub(super) struct Body<T>(pub(super) T);

impl From<JsonRejection> for HttpError {
    fn from(rejection: JsonRejection) -> Self {
        let kind = match rejection.status() {
            StatusCode::PAYLOAD_TOO_LARGE => ErrorKind::TooLarge,
            _ => ErrorKind::InvalidBody,
        };
        HttpError::new(kind, rejection.body_text())
    }
}

impl From<BytesRejection> for HttpError {
    fn from(rejection: BytesRejection) -> Self {
        let kind = match rejection.status() {
            StatusCode::PAYLOAD_TOO_LARGE => ErrorKind::TooLarge,
            _ => ErrorKind::InvalidBody,
        };
        HttpError::new(kind, rejection.body_text())
    }
}

/// Query parameters, for which refusals have the form of this interface.
#[derive(axum::extract::FromRequestParts)]
#[from_request(via(axum::extract::Query), rejection(HttpError))]
pub(super) struct Query<T>(pub(super) T);

/// The number in a path.
#[derive(axum::extract::FromRequestParts, serde::Deserialize)]
#[from_request(via(axum::extract::Path), rejection(HttpError))]
pub(super) struct Id(pub(super) i64);

/// The name in a path.
#[derive(axum::extract::FromRequestParts, serde::Deserialize)]
#[from_request(via(axum::extract::Path), rejection(HttpError))]
pub(super) struct Name(pub(super) String);

impl From<PathRejection> for HttpError {
    fn from(rejection: PathRejection) -> Self {
        HttpError::new(ErrorKind::NotFound, rejection.body_text())
    }
}

impl From<QueryRejection> for HttpError {
    fn from(rejection: QueryRejection) -> Self {
        HttpError::new(ErrorKind::InvalidBody, rejection.body_text())
    }
}

/// Answers a request to an unknown path.
pub(super) async fn no_route(uri: axum::http::Uri) -> HttpError {
    HttpError::new(
        ErrorKind::NotFound,
        format!("there is no {}; /openapi.json lists all paths", uri.path()),
    )
}

/// Answers a request with a method that its path does not support.
pub(super) async fn no_method(method: axum::http::Method, uri: axum::http::Uri) -> HttpError {
    HttpError::new(
        ErrorKind::NotFound,
        format!(
            "{} does not accept {method}; /openapi.json lists the methods",
            uri.path()
        ),
    )
}
