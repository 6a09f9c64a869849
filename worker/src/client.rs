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

/// A coordinator at a URL.
#[derive(Debug)]
pub struct HttpCoordinator {
    client: Client,
    url: String,
    form: WireForm,
    token: Option<BearerToken>,
}

/// Why a coordinator cannot be reached at all.
#[derive(Debug, thiserror::Error)]
pub enum ClientError {
    /// The URL, and what is wrong with it.
    #[error("coordinator URL \"{0}\": {1}")]
    Url(String, String),
    /// The certificate of an authority cannot be used.
    #[error("certificate {file}: {message}")]
    Certificate {
        /// Its file.
        file: String,
        /// What is wrong with it.
        message: String,
    },
    /// The HTTP client cannot be set up.
    #[error("HTTP client: {0}")]
    Client(reqwest::Error),
}

/// Longer than the longest poll; a connection that is silent for so long is dead.
const TIMEOUT: Duration = Duration::from_secs(60);

impl HttpCoordinator {
    /// A client of the coordinator at `url`, as in `http://host:7070`, that exchanges messages in this form, with the token
    /// that the coordinator asks for, if it does. An https URL is trusted by the certificates of this machine, or by those of a
    /// PEM file in their place.
    ///
    /// # Errors
    /// [`ClientError`] names the URL or the file and what is wrong with it.
    pub fn new(
        url: &str,
        ca_certificate: Option<&Path>,
        form: WireForm,
        token: Option<BearerToken>,
    ) -> Result<Self, ClientError> {
        let owned = || url.to_owned();
        let parsed = reqwest::Url::parse(url).map_err(|e| ClientError::Url(owned(), e.to_string()))?;
        let client = match (parsed.scheme(), ca_certificate) {
            // Without TLS no certificate is read: a machine may have none.
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
        // only a client's error is permanent; a busy or broken coordinator may recover
        if status.is_client_error() && status != StatusCode::TOO_MANY_REQUESTS {
            Err(ExchangeError::Refused(message))
        } else {
            Err(ExchangeError::Away(message))
        }
    }
}

/// The certificates of a PEM file.
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
        // a complete answer that cannot be read will not be readable the next time either
        serde_json::from_str(&text)
            .map(Some)
            .map_err(|e| ExchangeError::Refused(format!("variant {hash} cannot be read: {e}")))
    }
}
