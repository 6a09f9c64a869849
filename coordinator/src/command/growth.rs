//! The commands that extend a study: discover, extend, add-runs.

use std::path::Path;
use std::time::Duration;

use anyhow::{Context, bail};
use serde_json::json;
use shared::api::{
    CalibrationCreated, CalibrationState, CalibrationStatus, NamedText, NewExtension, NewRuns, RunsAdded,
};
use shared::text_file::read_text;

use super::folder::{Details, Folder};
use super::output::{note, say};
use super::source::{CalibrationSource, ServiceClient};
use crate::config::{AddRunsArguments, DiscoverArguments, ExtendArguments, ModelArguments};
use crate::service::{Service, ServiceError};
use record::{Discovery, Extension};
use report::terminal::discovery;
use result::discovery::effect_file;

/// How often a service is asked whether a search is over.
const LOOK: Duration = Duration::from_millis(500);

pub(super) async fn discover(config: &DiscoverArguments) -> anyhow::Result<()> {
    let place = CalibrationSource::open(&config.target.source).await?;
    let id = place.id(&config.target).await?;
    let client = match (&config.target.source.out, place) {
        (Some(out), _) => {
            let details = Details::new(config.verbose, Some(id));
            return grow(
                out,
                id,
                (config.local_workers, &config.models),
                details,
                async |service| service.discover(id).await.map(drop),
            )
            .await;
        }
        (None, CalibrationSource::Service(client)) => client,
        (None, CalibrationSource::Folder(_)) => bail!("--url or --out"),
    };
    let path = format!("/v1/calibrations/{id}/discovery");
    let search: CalibrationCreated = client.post(&path, &json!({})).await?;
    loop {
        let status: CalibrationStatus = client.get(&format!("/v1/calibrations/{}", search.id)).await?;
        if status.state == CalibrationState::Paused || status.state.is_final() {
            break;
        }
        tokio::time::sleep(LOOK).await;
    }
    let record: Discovery = client.get(&path).await?;
    let url = format!("--url {}", config.target.source.url());
    write_file(&record)?;
    Ok(say(&discovery::text(&record, id, &url, Path::new("")))?)
}

/// Writes the effect file that a search found into the present folder.
fn write_file(record: &Discovery) -> anyhow::Result<()> {
    match effect_file(record) {
        Some((name, text)) => std::fs::write(&name, text).context(name),
        None => Ok(()),
    }
}

pub(super) async fn extend(config: &ExtendArguments) -> anyhow::Result<()> {
    let source = &config.target.source;
    let place = CalibrationSource::open(source).await?;
    let id = place.id(&config.target).await?;
    let file = config.effect_file.as_deref().map(named_text).transpose()?;
    if let Some(out) = &source.out {
        let extension = match (&config.effect, &config.wheel, file) {
            (Some(effect), Some(wheel), _) => Extension::OnWheel {
                effect: effect.clone(),
                wheel: wheel.clone(),
            },
            (Some(effect), None, _) => Extension::Effect(effect.clone()),
            (None, _, Some(NamedText { name, text })) => Extension::File { name, text },
            (None, _, None) => bail!("--effect or --effect-file is missing"),
        };
        let details = Details::new(config.verbose, Some(id));
        return grow(
            out,
            id,
            (config.local_workers, &config.models),
            details,
            async |service| {
                let before = service.store().reader().calibrations().await?.len();
                let created = service.extend(id, extension.clone()).await?;
                if service.store().reader().calibrations().await?.len() == before {
                    note(&format!("calibration {} has it already", created.id));
                }
                Ok(())
            },
        )
        .await;
    }
    let new = NewExtension {
        effect: config.effect.clone(),
        wheel: config.wheel.clone(),
        effect_file: file,
    };
    let created: CalibrationCreated = ServiceClient::new(&source.url(), &source.client)?
        .post(&format!("/v1/calibrations/{id}/extend"), &new)
        .await?;
    Ok(say(&format!(
        "calibration {} of study {}\n",
        created.id, created.study
    ))?)
}

fn named_text(path: &Path) -> anyhow::Result<NamedText> {
    let name = path.file_name().unwrap_or_default();
    Ok(NamedText {
        name: name.to_string_lossy().into_owned(),
        text: read_text(path)?,
    })
}

pub(super) async fn add_runs(config: &AddRunsArguments) -> anyhow::Result<()> {
    let AddRunsArguments { id, source, .. } = config;
    let runs = read_text(&config.runs)?;
    let study = CalibrationSource::open(source).await?.status(*id).await?.study;
    if let Some(out) = &source.out {
        let details = Details::new(config.verbose, Some(*id));
        return grow(
            out,
            *id,
            (config.local_workers, &config.models),
            details,
            async |service| {
                let last = Some(*id);
                service.add_runs(study, runs.clone(), last).await.map(drop)
            },
        )
        .await;
    }
    let added: RunsAdded = ServiceClient::new(&source.url(), &source.client)?
        .post(
            &format!("/v1/studies/{study}/runs"),
            &NewRuns {
                runs,
                calibration: Some(*id),
            },
        )
        .await?;
    Ok(say(&format!(
        "calibration {} of study {} on experiment {}\n",
        added.id, added.study, added.experiment
    ))?)
}

/// Adds to the study of a calibration in a folder, and brings the study to its end there.
async fn grow(
    out: &Path,
    id: i64,
    (local_workers, models): (Option<usize>, &ModelArguments),
    details: Details,
    add: impl AsyncFn(&Service) -> Result<(), ServiceError>,
) -> anyhow::Result<()> {
    let folder = Folder::open(out, local_workers, models, None).await?;
    let service = folder.service.clone();
    let result = async {
        let study = folder.service.calibration_row(id).await?.study;
        folder.go_on(study).await?;
        add(&folder.service).await?;
        folder.finish(study, details).await
    };
    let result = result.await;
    service.close().await;
    result
}
