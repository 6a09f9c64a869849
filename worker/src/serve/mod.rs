//! The built-in models by UM-Bridge, protocol 1.0, <https://um-bridge-benchmarks.readthedocs.io>.
//!
//! # Layout
//! - This file: the routes and their errors.
//! - [`model`]: the inputs and outputs of a model.

pub mod model;

use std::future::Future;
use std::sync::Arc;

use axum::Json;
use axum::Router;
use axum::body::Bytes;
use axum::extract::State;
use axum::http::{StatusCode, Uri};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use serde::Deserialize;
use serde_json::{Value, json};
use shared::model::ModelKind;
use tokio::net::TcpListener;
use tokio::sync::Semaphore;

use crate::external::MODEL_VERSION;
use model::{INPUTS, OUTPUTS, PARAMETERS, ServedError, evaluate};

/// The served models.
const MODELS: [ModelKind; 2] = [ModelKind::QuasiStatic, ModelKind::Scm];

/// State that all requests share: the number of models that may run at once.
type Threads = Arc<Semaphore>;

/// The body of every request except that for `/Info`.
#[derive(Debug, Deserialize)]
struct Question {
    name: String,
    #[serde(default)]
    input: Vec<Vec<f64>>,
    #[serde(default)]
    config: toml::Table,
}

/// Why a request has no answer, in the protocol's words.
#[derive(Debug)]
struct ProtocolError {
    status: StatusCode,
    kind: &'static str,
    message: String,
}

impl ProtocolError {
    fn client_error(kind: &'static str, message: String) -> Self {
        ProtocolError {
            status: StatusCode::BAD_REQUEST,
            kind,
            message,
        }
    }
}

impl IntoResponse for ProtocolError {
    fn into_response(self) -> Response {
        let body = json!({ "error": { "type": self.kind, "message": self.message } });
        (self.status, Json(body)).into_response()
    }
}

/// Serves the built-in models on `threads` threads until `shutdown` is ready; an error if the listener fails.
pub async fn serve(
    listener: TcpListener,
    threads: usize,
    shutdown: impl Future<Output = ()> + Send + 'static,
) -> std::io::Result<()> {
    let routes = Router::new()
        .route("/Info", get(info))
        .route("/ModelInfo", post(model_info))
        .route("/InputSizes", post(input_sizes))
        .route("/OutputSizes", post(output_sizes))
        .route("/Evaluate", post(channels))
        .fallback(unsupported)
        .with_state(Threads::new(Semaphore::new(threads)));
    axum::serve(listener, routes)
        .with_graceful_shutdown(shutdown)
        .await
}

/// Answers `/Info`. The version is a header, because the protocol allows no key for it.
async fn info() -> ([(&'static str, &'static str); 1], Json<Value>) {
    let models = json!({ "protocolVersion": 1.0, "models": MODELS.map(ModelKind::name) });
    ([(MODEL_VERSION, crate::model_version())], Json(models))
}

async fn model_info(body: Bytes) -> Result<Json<Value>, ProtocolError> {
    read(&body)?;
    let support =
        json!({ "Evaluate": true, "Gradient": false, "ApplyJacobian": false, "ApplyHessian": false });
    Ok(Json(json!({ "support": support })))
}

async fn input_sizes(body: Bytes) -> Result<Json<Value>, ProtocolError> {
    read(&body)?;
    Ok(Json(json!({ "inputSizes": [INPUTS.len(), PARAMETERS.len()] })))
}

async fn output_sizes(body: Bytes) -> Result<Json<Value>, ProtocolError> {
    read(&body)?;
    Ok(Json(json!({ "outputSizes": [OUTPUTS.len()] })))
}

async fn channels(State(threads): State<Threads>, body: Bytes) -> Result<Json<Value>, ProtocolError> {
    let (kind, question) = read(&body)?;
    let internal = |message: String| ProtocolError {
        status: StatusCode::INTERNAL_SERVER_ERROR,
        kind: "InvalidOutput",
        message,
    };
    let permit = threads.acquire_owned().await;
    let answer = tokio::task::spawn_blocking(move || {
        let answer = evaluate(kind, &question.input, &question.config);
        drop(permit);
        answer
    });
    match answer.await.map_err(|e| internal(e.to_string()))? {
        Ok(channels) => Ok(Json(json!({ "output": [channels] }))),
        Err(ServedError::Input(message)) => Err(ProtocolError::client_error("InvalidInput", message)),
        Err(ServedError::Rejected(message)) => Err(internal(message)),
    }
}

async fn unsupported(uri: Uri) -> ProtocolError {
    let message = format!(
        "{} is not supported: these models have no derivatives",
        uri.path()
    );
    ProtocolError::client_error("UnsupportedFeature", message)
}

/// Reads the model and the question of a body.
fn read(body: &[u8]) -> Result<(ModelKind, Question), ProtocolError> {
    let question: Question = serde_json::from_slice(body)
        .map_err(|e| ProtocolError::client_error("InvalidInput", format!("the body: {e}")))?;
    match MODELS.into_iter().find(|kind| kind.name() == question.name) {
        Some(kind) => Ok((kind, question)),
        None => {
            let names = MODELS.map(ModelKind::name).join(", ");
            let message = format!("model \"{}\" is none of {names}", question.name);
            Err(ProtocolError::client_error("ModelNotFound", message))
        }
    }
}
