//! HTTP client of the coordinator; no other file of the worker uses HTTP.

use std::path::Path;
use std::time::Duration;

use reqwest::header::CONTENT_TYPE;
use reqwest::{Certificate, Client, RequestBuilder, StatusCode};
use shared::api::ErrorBody;
use shared::bearer::BearerToken;
use shared::exchange::{ExchangeRequest, ExchangeResponse, WorkResult};
use shared::model::ModelVariant;
use shared::wire::WireForm;

use crate::pull::exchange::{Coordinator, ExchangeError};

/// An HTTP client of one coordinator.
#[derive(Debug)]
pub struct HttpCoordinator {
    client: Client,
    url: String,
    form: WireForm,
    token: Option<BearerToken>,
}

/// Why an HTTP client cannot be set up.
#[derive(Debug, thiserror::Error)]
pub enum ClientError {
    /// The URL is not usable, for the stated reason.
    #[error("coordinator URL \"{0}\": {1}")]
    Url(String, String),
    /// The certificate of an authority cannot be used.
    #[error("certificate {file}: {message}")]
    Certificate {
        /// Path of the certificate.
        file: String,
        /// Message of the coordinator.
        message: String,
    },
    /// The HTTP client cannot be set up.
    #[error("HTTP client: {0}")]
    Client(reqwest::Error),
}

/// The timeout of a request, longer than the longest poll: a connection that is silent for this time is dead.
const TIMEOUT: Duration = Duration::from_secs(60);

impl HttpCoordinator {
    /// Creates a client of the coordinator at `url`, such as `http://host:7070`, for messages in this form, with a token if
    /// the coordinator requires one.
    ///
    /// An https URL is trusted by the certificates of this machine, or by a PEM file in their place.
    ///
    /// [`ClientError`] names the URL or the file, and the mistake.
    pub fn new(
        url: &str,
        ca_certificate: Option<&Path>,
        form: WireForm,
        token: Option<BearerToken>,
    ) -> Result<Self, ClientError> {
        let owned = || url.to_owned();
        let parsed = reqwest::Url::parse(url).map_err(|e| ClientError::Url(owned(), e.to_string()))?;
        let client = match (parsed.scheme(), ca_certificate) {
            // Without TLS no certificate is read, because a machine may have none.
            ("http", _) => Client::builder().tls_certs_only([]),
            ("https", None) => Client::builder(),
            ("https", Some(file)) => Client::builder().tls_certs_only(authorities(file)?),
            (scheme, _) => {
                let wrong = format!("scheme {scheme} is not http or https");
                return Err(ClientError::Url(owned(), wrong));
            }
        };
        let client = client
            .timeout(TIMEOUT)
            .connect_timeout(Duration::from_secs(5))
            .build()
            .map_err(ClientError::Client)?;
        Ok(HttpCoordinator {
            client,
            url: url.trim_end_matches('/').to_owned(),
            form,
            token,
        })
    }

    async fn post(&self, request: &ExchangeRequest) -> Result<ExchangeResponse, ExchangeError> {
        let url = format!("{}/v1/work/exchange", self.url);
        let body = request
            .to_bytes(self.form)
            .map_err(|e| ExchangeError::Refused(e.to_string()))?;
        let post = self.client.post(url).header(CONTENT_TYPE, self.form.media_type());
        let response = self.send(post.body(body)).await?;
        if response.status() == StatusCode::NOT_FOUND {
            return Err(ExchangeError::Refused(format!(
                "{} is not a Grouser coordinator",
                self.url
            )));
        }
        let body = response
            .bytes()
            .await
            .map_err(|e| ExchangeError::Away(root_cause(&e)))?;
        ExchangeResponse::from_bytes(&body, self.form).map_err(|e| ExchangeError::Away(e.to_string()))
    }

    async fn send(&self, request: RequestBuilder) -> Result<reqwest::Response, ExchangeError> {
        let request = match &self.token {
            Some(token) => request.bearer_auth(token.expose()),
            None => request,
        };
        let response = request
            .send()
            .await
            .map_err(|e| ExchangeError::Away(root_cause(&e)))?;
        let status = response.status();
        if status.is_success() || status == StatusCode::NOT_FOUND {
            return Ok(response);
        }
        let text = response.text().await.unwrap_or_default();
        let message = match serde_json::from_str::<ErrorBody>(&text) {
            Ok(body) => body.error.message,
            Err(_) => format!("status {status}"),
        };
        // only a client error is permanent; a busy or broken coordinator may recover
        if status.is_client_error() && status != StatusCode::TOO_MANY_REQUESTS {
            Err(ExchangeError::Refused(message))
        } else {
            Err(ExchangeError::Away(message))
        }
    }
}

/// Reads the certificates of a PEM file.
fn authorities(file: &Path) -> Result<Vec<Certificate>, ClientError> {
    let failed = |message| ClientError::Certificate {
        file: file.display().to_string(),
        message,
    };
    let pem = std::fs::read(file).map_err(|e| failed(e.to_string()))?;
    let authorities = Certificate::from_pem_bundle(&pem).map_err(|e| failed(root_cause(&e)))?;
    match authorities.is_empty() {
        true => Err(failed("none in PEM form".into())),
        false => Ok(authorities),
    }
}

fn root_cause(error: &dyn std::error::Error) -> String {
    error.source().map_or_else(|| error.to_string(), root_cause)
}

impl Coordinator for HttpCoordinator {
    async fn exchange(
        &self,
        request: ExchangeRequest,
    ) -> Result<ExchangeResponse, (ExchangeError, Vec<WorkResult>)> {
        self.post(&request)
            .await
            .map_err(|error| (error, request.results))
    }

    async fn variant(&self, hash: &str) -> Result<Option<ModelVariant>, ExchangeError> {
        let url = format!("{}/v1/work/variants/{hash}", self.url);
        let response = self.send(self.client.get(url)).await?;
        if response.status() == StatusCode::NOT_FOUND {
            return Ok(None);
        }
        let text = response
            .text()
            .await
            .map_err(|e| ExchangeError::Away(root_cause(&e)))?;
        // a complete answer that cannot be parsed now cannot be parsed on the next attempt either
        serde_json::from_str(&text)
            .map(Some)
            .map_err(|e| ExchangeError::Refused(format!("variant {hash} cannot be read: {e}")))
    }
}
