//! `/v1/work`: the exchange of workers with the farm; `/v1/workers`: the list of workers.

use std::collections::BTreeMap;

use axum::Json;
use axum::body::Bytes;
use axum::extract::{FromRequest, Request, State};
use axum::http::header::{ACCEPT, CONTENT_TYPE, HeaderMap, HeaderValue};
use axum::response::IntoResponse;
use shared::api::{ErrorBody, ErrorKind, WorkDemand};
use shared::exchange::{ExchangeRequest, ExchangeResponse, PROTOCOL_VERSION};
use shared::model::ModelVariant;
use shared::outcome::Outcome;
use shared::wire::WireForm;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::access::Caller;
use super::error::{HttpError, Name, Query};
use super::list_page::NamesPage;
use crate::service::Service;
use farm::WorkerRecord;

/// The longest duration of a poll `[ms]`.
const LONGEST_WAIT_MS: u64 = 30_000;
/// The largest number of leases in one answer.
const MAX_WANTED: u32 = 10_000;
/// The longest name of a worker, or of the version of its equations `[bytes]`.
pub(super) const LONGEST_NAME: usize = 200;
/// The longest name of an external model, which may contain a URL `[bytes]`.
const LONGEST_MODEL: usize = 400;
/// The largest number of external models of a worker.
const MAX_MODELS: usize = 100;
/// The longest mean time of a worker's evaluations, twelve days `[s]`.
const LONGEST_EVALUATION_S: f64 = 1e6;
/// The longest message of an outcome `[bytes]`.
const LONGEST_MESSAGE: usize = 10_000;

pub(super) fn routes() -> OpenApiRouter<Service> {
    OpenApiRouter::new()
        .routes(routes!(exchange))
        .routes(routes!(variant))
        .routes(routes!(demand))
        .routes(routes!(workers))
}

/// Takes results and gives leases.
///
/// Waits for work up to `wait_ms`. The answer means: results are durable. It has the form that `Accept` names, else
/// that of the request.
#[utoipa::path(post, path = "/work/exchange", operation_id = "exchange_work", tag = "work",
    request_body(content(
    (ExchangeRequest = "application/json"), (ExchangeRequest = "application/vnd.msgpack"))), responses(
    (status = 200, description = "results are durable; new leases", content(
        (ExchangeResponse = "application/json"), (ExchangeResponse = "application/vnd.msgpack"))),
    (status = 400, body = ErrorBody, description = "the body is no such message"),
    (status = 413, body = ErrorBody, description = "the body is too large"),
    (status = 415, body = ErrorBody, description = "the body is neither JSON nor MessagePack"),
    (status = 426, body = ErrorBody, description = "another version of the protocol"),
    (status = 429, body = ErrorBody, description = "more results wait than the store takes, or more bodies are on their way than there is memory for; try again"),
))]
async fn exchange(
    State(service): State<Service>,
    caller: Caller,
    Exchange { mut request, answer }: Exchange,
) -> Result<impl IntoResponse, HttpError> {
    if request.protocol != PROTOCOL_VERSION {
        let message = format!(
            "worker {} speaks protocol {}, this coordinator {PROTOCOL_VERSION}",
            request.worker, request.protocol
        );
        return Err(HttpError::new(ErrorKind::ProtocolMismatch, message));
    }
    check_texts(&request)?;
    check_time(&request)?;
    request.worker = caller.worker(request.worker)?;
    request.wait_ms = request.wait_ms.min(LONGEST_WAIT_MS);
    request.want = request.want.min(MAX_WANTED);
    let response = tokio::select! {
        response = service.exchange(request) => response?.to_bytes(answer),
        // Leases of this exchange go to other workers, because nobody receives them.
        refusal = caller.shut_out() => return Err(refusal),
    };
    let body = response.map_err(|e| HttpError::new(ErrorKind::Internal, e.to_string()))?;
    Ok(([(CONTENT_TYPE, answer.media_type())], body))
}

/// Refuses texts of a worker that are too long for lists, logs and the store.
fn check_texts(request: &ExchangeRequest) -> Result<(), HttpError> {
    let check = |what: &str, text: &str, longest: usize| {
        if text.len() <= longest {
            return Ok(());
        }
        let message = format!("{what}: {} bytes must be at most {longest} bytes", text.len());
        Err(HttpError::new(ErrorKind::InvalidBody, message))
    };
    check("worker", &request.worker, LONGEST_NAME)?;
    check("model_version", &request.model_version, LONGEST_NAME)?;
    check(
        "queue_job",
        request.queue_job.as_deref().unwrap_or_default(),
        LONGEST_NAME,
    )?;
    if request.models.len() > MAX_MODELS {
        let message = format!("models: {} must be at most {MAX_MODELS}", request.models.len());
        return Err(HttpError::new(ErrorKind::InvalidBody, message));
    }
    for (name, version) in &request.models {
        check("models: name", name, LONGEST_MODEL)?;
        check("models: version", version, LONGEST_NAME)?;
    }
    for result in &request.results {
        match &result.outcome {
            Outcome::Rejected(rejection) => {
                check("kind", &rejection.kind, LONGEST_NAME)?;
                check("message", &rejection.message, LONGEST_MESSAGE)?;
            }
            Outcome::Fault(fault) => check("message", &fault.message, LONGEST_MESSAGE)?,
            Outcome::Evaluated(_) => {}
        }
    }
    Ok(())
}

/// Refuses an impossible time, because programs that start workers multiply it by the number of remaining evaluations.
fn check_time(request: &ExchangeRequest) -> Result<(), HttpError> {
    match request.evaluation_s {
        Some(evaluation_s) if !(0.0..=LONGEST_EVALUATION_S).contains(&evaluation_s) => {
            let message =
                format!("evaluation_s: {evaluation_s:?} s must lie in [0, {LONGEST_EVALUATION_S}] s");
            Err(HttpError::new(ErrorKind::InvalidBody, message))
        }
        _ => Ok(()),
    }
}

/// A request in either form, and the form of its answer.
struct Exchange {
    request: ExchangeRequest,
    answer: WireForm,
}

impl<S: Send + Sync> FromRequest<S> for Exchange {
    type Rejection = HttpError;

    async fn from_request(request: Request, state: &S) -> Result<Self, HttpError> {
        let (form, answer) = forms(request.headers())?;
        let body = Bytes::from_request(request, state).await?;
        let request = ExchangeRequest::from_bytes(&body, form).map_err(|error| {
            // for JSON, axum's message names the key
            let named = Json::<ExchangeRequest>::from_bytes(&body).err();
            let named = named.filter(|_| form == WireForm::Json).map(HttpError::from);
            named.unwrap_or_else(|| HttpError::new(ErrorKind::InvalidBody, error.to_string()))
        })?;
        Ok(Exchange { request, answer })
    }
}

/// Returns the form of a request, and the form of its answer.
fn forms(headers: &HeaderMap) -> Result<(WireForm, WireForm), HttpError> {
    let header = |name| {
        headers
            .get(name)
            .and_then(|value: &HeaderValue| value.to_str().ok())
    };
    let stated = header(CONTENT_TYPE).unwrap_or_default();
    let Some(form) = WireForm::from_media_type(stated) else {
        let forms = WireForm::ALL.map(WireForm::media_type).join(" or ");
        let message = format!("Content-Type \"{stated}\" must be {forms}");
        return Err(HttpError::new(ErrorKind::UnsupportedMediaType, message));
    };
    let mut accepted = header(ACCEPT).unwrap_or_default().split(',');
    let answer = accepted.find_map(WireForm::from_media_type).unwrap_or(form);
    Ok((form, answer))
}

/// The variant of a hash.
///
/// Everything that maps a parameter vector to observables, for a worker to keep.
#[utoipa::path(get, path = "/work/variants/{hash}", operation_id = "get_variant", tag = "work",
    params(("hash" = String, Path, description = "hash of the variant, as a lease names it")), responses(
    (status = 200, description = "the variant", body = ModelVariant), (status = 404, body = ErrorBody)))]
async fn variant(State(service): State<Service>, Name(hash): Name) -> Result<Json<ModelVariant>, HttpError> {
    let variant = service.dispatcher().variant(hash.clone()).await?;
    variant.map(Json).ok_or_else(|| {
        HttpError::new(
            ErrorKind::NotFound,
            format!("no calibration in progress uses variant {hash}"),
        )
    })
}

/// The amount of work.
///
/// Evaluations, workers, and the mean time of an evaluation, for programs that start workers.
#[utoipa::path(get, path = "/work/demand", operation_id = "get_work_demand", tag = "work",
    responses((status = 200, description = "work and workers", body = WorkDemand)))]
async fn demand(State(service): State<Service>) -> Result<Json<WorkDemand>, HttpError> {
    Ok(Json(service.dispatcher().demand().await?))
}

/// Lists the workers.
///
/// Those heard of lately, by name; of one that computes wrongly, why it is quarantined.
#[utoipa::path(get, path = "/workers", operation_id = "list_workers", tag = "work",
    params(
        ("limit" = Option<u32>, Query, minimum = 1, maximum = 10000, description = "the largest number of entries; without it, all"),
        ("after" = Option<String>, Query, description = "the name of the last entry of the page before")),
    responses((status = 200, description = "workers by name", body = BTreeMap<String, WorkerRecord>)))]
async fn workers(
    State(service): State<Service>,
    Query(which): Query<NamesPage>,
) -> Result<Json<BTreeMap<String, WorkerRecord>>, HttpError> {
    let workers = service.dispatcher().workers().await?;
    Ok(Json(which.cut_sorted(workers)?))
}
