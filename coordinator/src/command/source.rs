//! Access to stored calibrations: through a service or in a folder.

use anyhow::{Context, bail};
use export::InferenceData;
use serde::de::DeserializeOwned;
use shared::api::{CalibrationStatus, ErrorBody};
use shared::bearer::BearerToken;

use crate::config::{ClientArguments, SourceArguments, TargetArguments};
use crate::service::{
    calibration_row, diagnostics, finished_calibration, leave_out_archived, stored_status, study_file,
};
use report::{StudyFile, StudySummary};
use result::{Comparison, Diagnostics, FinishedCalibration, PosteriorTable};
use store::Reader;

/// A service or a folder.
pub(super) enum CalibrationSource {
    Service(ServiceClient),
    Folder(Reader),
}

impl CalibrationSource {
    pub(super) async fn open(source: &SourceArguments) -> anyhow::Result<CalibrationSource> {
        match &source.out {
            Some(out) => {
                let file = out.join("grouser.db");
                Ok(CalibrationSource::Folder(
                    Reader::open(&file.display().to_string()).await?,
                ))
            }
            None => Ok(CalibrationSource::Service(ServiceClient::new(
                &source.url(),
                &source.client,
            )?)),
        }
    }

    pub(super) async fn list(&self, with_archived: bool) -> anyhow::Result<Vec<CalibrationStatus>> {
        match self {
            CalibrationSource::Service(client) if with_archived => {
                client.get("/v1/calibrations?archived=true").await
            }
            CalibrationSource::Service(client) => client.get("/v1/calibrations").await,
            CalibrationSource::Folder(reader) => {
                let rows = reader.calibrations().await?;
                let mut statuses = rows.iter().map(|(id, row)| stored_status(*id, row)).collect();
                if !with_archived {
                    leave_out_archived(reader, &mut statuses).await?;
                }
                Ok(statuses)
            }
        }
    }

    /// The calibration that is meant: the one named, or the first of the only study.
    pub(super) async fn id(&self, target: &TargetArguments) -> anyhow::Result<i64> {
        if let Some(id) = target.id {
            return Ok(id);
        }
        match self.list(false).await?.as_slice() {
            [first, others @ ..] if others.iter().all(|o| o.study == first.study) => Ok(first.id),
            [] => bail!("there is no calibration"),
            several => bail!("there are {} calibrations: name one by its id", several.len()),
        }
    }

    pub(super) async fn status(&self, id: i64) -> anyhow::Result<CalibrationStatus> {
        match self {
            CalibrationSource::Service(client) => client.get(&format!("/v1/calibrations/{id}")).await,
            CalibrationSource::Folder(reader) => {
                Ok(stored_status(id, &Ok(calibration_row(reader, id).await?)))
            }
        }
    }

    pub(super) async fn comparison(&self, id: i64) -> anyhow::Result<Comparison> {
        match self {
            CalibrationSource::Service(client) => {
                client.get(&format!("/v1/calibrations/{id}/comparison")).await
            }
            CalibrationSource::Folder(reader) => Ok(outcome(reader, id).await?.comparison().clone()),
        }
    }

    pub(super) async fn diagnostics(&self, id: i64) -> anyhow::Result<Diagnostics> {
        match self {
            CalibrationSource::Service(client) => {
                client.get(&format!("/v1/calibrations/{id}/diagnostics")).await
            }
            CalibrationSource::Folder(reader) => {
                Ok(diagnostics(reader, &calibration_row(reader, id).await?).await?)
            }
        }
    }

    pub(super) async fn posterior(&self, id: i64) -> anyhow::Result<PosteriorTable> {
        match self {
            CalibrationSource::Service(client) => {
                client.get(&format!("/v1/calibrations/{id}/posterior")).await
            }
            CalibrationSource::Folder(reader) => Ok(outcome(reader, id).await?.posterior_table()),
        }
    }

    pub(super) async fn inference_data(&self, id: i64) -> anyhow::Result<InferenceData> {
        match self {
            CalibrationSource::Service(client) => {
                client.get(&format!("/v1/calibrations/{id}/inference-data")).await
            }
            CalibrationSource::Folder(reader) => Ok(export::inference_data(&outcome(reader, id).await?)?),
        }
    }

    pub(super) async fn summary(&self, id: i64) -> anyhow::Result<StudySummary> {
        match self {
            CalibrationSource::Service(client) => client.get(&format!("/v1/calibrations/{id}/summary")).await,
            CalibrationSource::Folder(reader) => Ok(serde_json::from_str(
                &file(reader, id, StudyFile::Summary).await?,
            )?),
        }
    }

    pub(super) async fn report(&self, id: i64) -> anyhow::Result<String> {
        match self {
            CalibrationSource::Service(client) => client.text(&format!("/v1/calibrations/{id}/report")).await,
            CalibrationSource::Folder(reader) => file(reader, id, StudyFile::Report).await,
        }
    }
}

/// A finished calibration in a folder.
pub(super) async fn outcome(reader: &Reader, id: i64) -> anyhow::Result<FinishedCalibration> {
    Ok(finished_calibration(reader, &calibration_row(reader, id).await?).await?)
}

async fn file(reader: &Reader, id: i64, file: StudyFile) -> anyhow::Result<String> {
    Ok(study_file(reader, None, &calibration_row(reader, id).await?, file).await?)
}

/// A service over HTTP.
pub(super) struct ServiceClient {
    client: reqwest::Client,
    url: String,
    token: Option<BearerToken>,
}

impl ServiceClient {
    pub(super) fn new(url: &str, config: &ClientArguments) -> anyhow::Result<ServiceClient> {
        let parsed = reqwest::Url::parse(url).with_context(|| format!("--url {url}"))?;
        let builder = reqwest::Client::builder();
        let builder = match (parsed.scheme(), &config.ca_certificate) {
            // Without TLS no certificate is read: a machine may have none.
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

    async fn answer(&self, request: reqwest::RequestBuilder) -> anyhow::Result<String> {
        let request = match &self.token {
            Some(token) => request.bearer_auth(token.expose()),
            None => request,
        };
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

    async fn text(&self, path: &str) -> anyhow::Result<String> {
        self.answer(self.client.get(format!("{}{path}", self.url))).await
    }

    pub(super) async fn get<T: DeserializeOwned>(&self, path: &str) -> anyhow::Result<T> {
        let text = self.text(path).await?;
        serde_json::from_str(&text)
            .with_context(|| format!("{} is not a Grouser coordinator of this version", self.url))
    }

    pub(super) async fn delete<T: DeserializeOwned>(&self, path: &str) -> anyhow::Result<T> {
        let text = self
            .answer(self.client.delete(format!("{}{path}", self.url)))
            .await?;
        serde_json::from_str(&text)
            .with_context(|| format!("{} is not a Grouser coordinator of this version", self.url))
    }

    pub(super) async fn post<T: DeserializeOwned>(
        &self,
        path: &str,
        body: &impl serde::Serialize,
    ) -> anyhow::Result<T> {
        let text = self
            .answer(self.client.post(format!("{}{path}", self.url)).json(body))
            .await?;
        serde_json::from_str(&text)
            .with_context(|| format!("{} is not a Grouser coordinator of this version", self.url))
    }
}
