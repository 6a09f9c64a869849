//! The place of a verb's calibrations, a service or a folder, both of which answer the same requests.

use anyhow::{Context, bail};
use serde::Serialize;
use serde::de::DeserializeOwned;
use shared::api::{CalibrationStatus, ErrorBody};
use shared::bearer::BearerToken;

use crate::config::{ClientArguments, SourceArguments, TargetArguments};
use crate::http::InProcess;
use crate::service::Service;

/// The number of entries of a list that are asked for at a time.
const LIST_PAGE: usize = 1_000;

/// What of a list is wanted.
#[derive(Debug, Clone, Copy)]
pub(super) struct ListPart {
    /// The largest number of entries.
    pub(super) limit: usize,
    /// The number of the entry before the first one.
    pub(super) after: Option<i64>,
}

impl ListPart {
    /// The whole list.
    pub(super) const ALL: ListPart = ListPart {
        limit: usize::MAX,
        after: None,
    };
}

/// A service or a folder.
pub(super) enum Place {
    /// A service, which is reached over HTTP.
    Service(ServiceClient),
    /// The store in the folder of a run, which this program opens.
    Folder {
        routes: InProcess,
        service: Box<Service>,
    },
}

impl Place {
    /// Opens the place that the arguments name. A folder is opened for reading, also beside a program that writes to it.
    pub(super) async fn open(source: &SourceArguments) -> anyhow::Result<Place> {
        match &source.out {
            None => Place::at(&source.url(), &source.client),
            Some(out) => {
                let store = out.join("grouser.db").display().to_string();
                Ok(Place::in_folder(Service::open_read_only(&store).await?))
            }
        }
    }

    pub(super) fn at(url: &str, config: &ClientArguments) -> anyhow::Result<Place> {
        Ok(Place::Service(ServiceClient::new(url, config)?))
    }

    pub(super) fn in_folder(service: Service) -> Place {
        Place::Folder {
            routes: InProcess::new(service.clone()),
            service: Box::new(service),
        }
    }

    async fn answer(&self, method: &str, path: &str, body: Option<String>) -> anyhow::Result<String> {
        match self {
            Place::Service(client) => client.answer(method, path, body).await,
            Place::Folder { routes, .. } => Ok(routes.answer(method, path, body).await?),
        }
    }

    /// Sends a request. Returns the value of the JSON answer.
    async fn value<T: DeserializeOwned>(
        &self,
        method: &str,
        path: &str,
        body: Option<String>,
    ) -> anyhow::Result<T> {
        let text = self.answer(method, path, body).await?;
        serde_json::from_str(&text).with_context(|| match self {
            Place::Service(client) => format!("{} is not a Grouser coordinator of this version", client.url),
            Place::Folder { .. } => path.to_owned(),
        })
    }

    pub(super) async fn text(&self, path: &str) -> anyhow::Result<String> {
        self.answer("GET", path, None).await
    }

    pub(super) async fn get<T: DeserializeOwned>(&self, path: &str) -> anyhow::Result<T> {
        self.value("GET", path, None).await
    }

    /// Requests a list page by page, so that the service never makes the whole of a long one.
    ///
    /// # Arguments
    /// - `path`: with its query. `part`: what of the list is wanted. `id`: the number of an entry.
    pub(super) async fn list<T: DeserializeOwned>(
        &self,
        path: &str,
        part: ListPart,
        id: impl Fn(&T) -> i64,
    ) -> anyhow::Result<Vec<T>> {
        let separator = if path.contains('?') { '&' } else { '?' };
        let mut entries: Vec<T> = Vec::new();
        let mut after = part.after;
        loop {
            let limit = part.limit.saturating_sub(entries.len()).min(LIST_PAGE);
            if limit == 0 {
                return Ok(entries);
            }
            let after_last = after.map_or_else(String::new, |after| format!("&after={after}"));
            let page: Vec<T> = self
                .get(&format!("{path}{separator}limit={limit}{after_last}"))
                .await?;
            let is_last = page.len() < limit;
            after = page.last().map(&id).or(after);
            entries.extend(page);
            if is_last {
                return Ok(entries);
            }
        }
    }

    pub(super) async fn delete<T: DeserializeOwned>(&self, path: &str) -> anyhow::Result<T> {
        self.value("DELETE", path, None).await
    }

    pub(super) async fn post<T: DeserializeOwned>(
        &self,
        path: &str,
        body: &impl Serialize,
    ) -> anyhow::Result<T> {
        self.value("POST", path, Some(serde_json::to_string(body)?)).await
    }

    /// Returns the id of the calibration that a verb is about: the given one, or the first calibration of the only study.
    pub(super) async fn id(&self, target: &TargetArguments) -> anyhow::Result<i64> {
        if let Some(id) = target.id {
            return Ok(id);
        }
        let statuses: Vec<CalibrationStatus> = self
            .list("/v1/calibrations", ListPart::ALL, |status: &CalibrationStatus| {
                status.id
            })
            .await?;
        match statuses.as_slice() {
            [first, rest @ ..] if rest.iter().all(|status| status.study == first.study) => Ok(first.id),
            [] => bail!("there is no calibration"),
            several => bail!("there are {} calibrations: name one by its id", several.len()),
        }
    }

    /// Requests a result of the calibration that a verb is about, by the last word of its path.
    pub(super) async fn part<T: DeserializeOwned>(
        &self,
        target: &TargetArguments,
        part: &str,
    ) -> anyhow::Result<T> {
        let id = self.id(target).await?;
        self.get(&format!("/v1/calibrations/{id}/{part}")).await
    }
}

/// Returns the query of a path with one key.
pub(super) fn query(key: &str, value: &str) -> anyhow::Result<String> {
    // Only the query of this address is used.
    let url = reqwest::Url::parse_with_params("http://localhost", [(key, value)])?;
    Ok(format!("?{}", url.query().unwrap_or_default()))
}

/// The HTTP client of a service.
pub(super) struct ServiceClient {
    client: reqwest::Client,
    url: String,
    token: Option<BearerToken>,
}

impl ServiceClient {
    fn new(url: &str, config: &ClientArguments) -> anyhow::Result<ServiceClient> {
        let parsed = reqwest::Url::parse(url).with_context(|| format!("--url {url}"))?;
        let builder = reqwest::Client::builder();
        let builder = match (parsed.scheme(), &config.ca_certificate) {
            // Without TLS the certificates of the machine are not read, because there may be none.
            ("http", _) => builder.tls_certs_only([]),
            ("https", None) => builder,
            ("https", Some(file)) => {
                let name = || file.display().to_string();
                let pem = std::fs::read(file).with_context(name)?;
                let authorities = reqwest::Certificate::from_pem_bundle(&pem).with_context(name)?;
                if authorities.is_empty() {
                    bail!("{}: no certificate in PEM form", name());
                }
                builder.tls_certs_only(authorities)
            }
            (scheme, _) => bail!("--url {url}: scheme {scheme} is not http or https"),
        };
        Ok(ServiceClient {
            client: builder.build()?,
            url: url.trim_end_matches('/').to_owned(),
            token: config.token()?,
        })
    }

    async fn answer(&self, method: &str, path: &str, body: Option<String>) -> anyhow::Result<String> {
        let method = reqwest::Method::from_bytes(method.as_bytes())?;
        let mut request = self.client.request(method, format!("{}{path}", self.url));
        if let Some(token) = &self.token {
            request = request.bearer_auth(token.expose());
        }
        if let Some(body) = body {
            request = request.header("Content-Type", "application/json").body(body);
        }
        let response = request
            .send()
            .await
            .with_context(|| format!("no answer from {}", self.url))?;
        let status = response.status();
        let text = response.text().await?;
        if status.is_success() {
            return Ok(text);
        }
        match serde_json::from_str::<ErrorBody>(&text) {
            Ok(body) => bail!("{}", body.error.message),
            Err(_) => bail!("{} answered {status}", self.url),
        }
    }
}
