//! A model of a UM-Bridge server, protocol 1.0, <https://um-bridge-benchmarks.readthedocs.io>.
//!
//! An evaluation is one request for each run: the properties of the run and the parameters, as two vectors or as one, by the
//! server's input sizes; its outputs, in any number of vectors, are the channels.

use std::sync::Mutex;
use std::sync::PoisonError;
use std::time::Duration;

use reqwest::{Client, RequestBuilder, StatusCode};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use shared::model::ExternalModel;
use tokio::runtime::Handle;

use super::answer::{beginning, json, outputs, shortened};
use super::failure::ExternalFailure;
use super::{ExternalRun, MODEL_VERSION};

/// The supported version of the protocol.
const PROTOCOL: f64 = 1.0;

/// A server that the operator allows.
#[derive(Debug)]
pub(super) struct UmbridgeServer {
    url: String,
    client: Client,
    /// The runtime for requests, because the rayon threads that evaluate have none.
    runtime: Handle,
    /// The layouts by model, so that each model is asked for its input sizes once.
    layouts: Mutex<Vec<(String, Layout)>>,
}

/// The layout of a run in the inputs of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Layout {
    /// One vector: properties, then parameters.
    One,
    /// Two output vectors.
    Two,
}

/// Why a server gives no answer.
pub(super) enum CallError {
    /// The request took too long.
    Slow,
    /// The server reports a failure with status 500.
    Failed(String),
    /// Any other failure.
    Other(String),
}

impl UmbridgeServer {
    pub(super) fn new(url: &str, runtime: Handle) -> Result<Self, String> {
        let client = match url.starts_with("https:") {
            true => Client::builder(),
            // Without TLS no certificate is read, because a machine may have none.
            false => Client::builder().tls_certs_only([]),
        };
        Ok(UmbridgeServer {
            url: url.trim_end_matches('/').to_owned(),
            client: client.build().map_err(|e| e.to_string())?,
            runtime,
            layouts: Mutex::default(),
        })
    }

    pub(super) fn url(&self) -> &str {
        &self.url
    }

    pub(super) fn runtime(&self) -> &Handle {
        &self.runtime
    }

    /// Returns the models of the server, each with its identity: a digest of the server's description of itself and of the model.
    pub(super) async fn identities(&self, patience: Duration) -> Result<Vec<(String, String)>, CallError> {
        let info = self.client.get(format!("{}/Info", self.url));
        let (info, version) = call(info, patience).await?;
        if info.get("protocolVersion").and_then(Value::as_f64) != Some(PROTOCOL) {
            return Err(CallError::Other(format!(
                "the protocol must be {PROTOCOL}, and is {}",
                info.get("protocolVersion").unwrap_or(&Value::Null)
            )));
        }
        let names = info.get("models").and_then(Value::as_array).into_iter().flatten();
        let mut models = Vec::new();
        for name in names.filter_map(Value::as_str) {
            let about = self.ask("ModelInfo", &json!({ "name": name }), patience).await?;
            // keys are sorted, so equal answers have equal texts
            let digest = Sha256::digest(format!("{info}\n{name}\n{about}\n{version}"));
            let hex: String = digest[..8].iter().map(|byte| format!("{byte:02x}")).collect();
            models.push((name.to_owned(), format!("umbridge-{hex}")));
        }
        Ok(models)
    }

    /// Evaluates all runs, one after the other.
    pub(super) fn evaluate(
        &self,
        name: &str,
        model: &ExternalModel,
        runs: &[ExternalRun],
    ) -> Result<Vec<Vec<f64>>, ExternalFailure> {
        let layout = self.layout(name, model)?;
        let limit = Duration::from_secs_f64(model.time_s);
        let one = |(run, input): (usize, &ExternalRun)| {
            let input = match layout {
                Layout::Two => json!([input.inputs, input.parameters]),
                Layout::One => {
                    let all = [input.inputs.as_slice(), &input.parameters].concat();
                    json!([all])
                }
            };
            let question = json!({ "name": name, "input": input, "config": {} });
            let answer = self
                .ask_blocking("Evaluate", &question, limit)
                .map_err(|error| match error {
                    CallError::Slow => {
                        let message = format!("{} takes longer than {} s", self.url, model.time_s);
                        ExternalFailure::broke("time_limit", run, message)
                    }
                    CallError::Failed(message) => ExternalFailure::broke("model_error", run, message),
                    CallError::Other(message) => self.machine(&message),
                })?;
            let lists = answer.get("output").and_then(Value::as_array);
            let values: Option<Vec<&Value>> = lists.and_then(|lists| {
                let lists: Option<Vec<&Vec<Value>>> = lists.iter().map(Value::as_array).collect();
                Some(lists?.into_iter().flatten().collect())
            });
            match values.filter(|values| values.len() == model.outputs.len()) {
                Some(values) => outputs(run, &model.outputs, |place, _| values.get(place).copied()),
                None => Err(self.machine(&format!(
                    "model {name} must answer {} outputs, and answers {}",
                    model.outputs.len(),
                    shortened(&answer)
                ))),
            }
        };
        runs.iter().enumerate().map(one).collect()
    }

    /// Finds the layout of a run in the inputs of a model.
    fn layout(&self, name: &str, model: &ExternalModel) -> Result<Layout, ExternalFailure> {
        let (inputs, parameters) = (model.inputs.len(), model.parameters.len());
        let mut layouts = self.layouts.lock().unwrap_or_else(PoisonError::into_inner);
        let key = format!("{name} {inputs} {parameters}");
        if let Some((_, layout)) = layouts.iter().find(|(candidate, _)| *candidate == key) {
            return Ok(*layout);
        }
        let question = json!({ "name": name, "config": {} });
        let answer = self.ask_blocking("InputSizes", &question, Duration::from_secs_f64(model.time_s));
        let answer = answer.map_err(|e| self.machine(&e.words(&self.url)))?;
        let sizes = answer.get("inputSizes").unwrap_or(&Value::Null);
        let layout = if *sizes == json!([inputs, parameters]) {
            Layout::Two
        } else if *sizes == json!([inputs + parameters]) {
            Layout::One
        } else {
            return Err(self.machine(&format!(
                "model {name} takes inputs of the sizes {sizes}; the job has {inputs} inputs and {parameters} parameters: [{inputs}, {parameters}] or [{}]",
                inputs + parameters
            )));
        };
        layouts.push((key, layout));
        Ok(layout)
    }

    fn machine(&self, message: &str) -> ExternalFailure {
        match message.starts_with(&self.url) {
            true => ExternalFailure::Machine(message.to_owned()),
            false => ExternalFailure::Machine(format!("{}: {message}", self.url)),
        }
    }

    fn ask_blocking(&self, route: &str, question: &Value, limit: Duration) -> Result<Value, CallError> {
        self.runtime.block_on(self.ask(route, question, limit))
    }

    async fn ask(&self, route: &str, question: &Value, limit: Duration) -> Result<Value, CallError> {
        let post = self.client.post(format!("{}/{route}", self.url));
        call(post.json(question), limit).await.map(|(answer, _)| answer)
    }
}

/// Returns the answer to a request, and the version of the server's models if it states one.
async fn call(request: RequestBuilder, limit: Duration) -> Result<(Value, String), CallError> {
    let away = |error: reqwest::Error| match error.is_timeout() {
        true => CallError::Slow,
        false => CallError::Other(root_cause(&error)),
    };
    let response = request.timeout(limit).send().await.map_err(away)?;
    let status = response.status();
    let version = response.headers().get(MODEL_VERSION);
    let version = version
        .and_then(|version| version.to_str().ok())
        .unwrap_or_default()
        .to_owned();
    let text = response.text().await.map_err(away)?;
    if status == StatusCode::INTERNAL_SERVER_ERROR {
        return Err(CallError::Failed(reason(&text)));
    }
    if !status.is_success() {
        return Err(CallError::Other(format!("status {status}: {}", reason(&text))));
    }
    match json(&text) {
        Ok(answer) => Ok((answer, version)),
        Err(e) => {
            let start = beginning(&text);
            Err(CallError::Other(format!(
                "the answer is not JSON: {e}: \"{start}\""
            )))
        }
    }
}

impl CallError {
    pub(super) fn words(self, url: &str) -> String {
        match self {
            CallError::Slow => format!("{url} does not answer"),
            CallError::Failed(message) | CallError::Other(message) => format!("{url}: {message}"),
        }
    }
}

/// Returns the message in the body of an error.
fn reason(text: &str) -> String {
    let body: Option<Value> = json(text).ok();
    let message = body
        .as_ref()
        .and_then(|body| body.get("error")?.get("message")?.as_str());
    message.map_or_else(|| beginning(text), beginning)
}

fn root_cause(error: &dyn std::error::Error) -> String {
    error.source().map_or_else(|| error.to_string(), root_cause)
}
