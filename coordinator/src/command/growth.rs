//! The commands that extend a study: discover, extend, add-runs.

use std::path::Path;
use std::time::Duration;

use anyhow::Context;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::json;
use shared::api::{
    CalibrationCreated, CalibrationState, CalibrationStatus, NamedText, NewExtension, NewRuns, RunsAdded,
};
use shared::text_file::read_text;

use super::folder::{Details, Folder};
use super::output::{note, say};
use super::place::Place;
use crate::config::{AddRunsArguments, DiscoverArguments, ExtendArguments, GrowthArguments, SourceArguments};
use record::Discovery;
use report::terminal::discovery;
use result::discovery::effect_files;

/// Interval between two requests for the state of a search at a service.
const LOOK: Duration = Duration::from_millis(500);

pub(super) async fn discover(config: &DiscoverArguments) -> anyhow::Result<()> {
    let source = &config.target.source;
    let place = Place::open(source).await?;
    let id = place.id(&config.target).await?;
    let path = format!("/v1/calibrations/{id}/discovery");
    let addition = Addition {
        source,
        growth: &config.growth,
        calibration: id,
    };
    let search = addition.make(&place, &path, &json!({}), |_| {}).await?;
    let Some(search): Option<CalibrationCreated> = search else {
        return Ok(());
    };
    loop {
        let status: CalibrationStatus = place.get(&format!("/v1/calibrations/{}", search.id)).await?;
        if status.state == CalibrationState::Paused || status.state.is_final() {
            break;
        }
        tokio::time::sleep(LOOK).await;
    }
    let record: Discovery = place.get(&path).await?;
    for (name, text) in effect_files(&record) {
        std::fs::write(&name, text).context(name)?;
    }
    let url = format!("--url {}", source.url());
    Ok(say(&discovery::text(&record, id, &url, Path::new("")))?)
}

pub(super) async fn extend(config: &ExtendArguments) -> anyhow::Result<()> {
    let source = &config.target.source;
    let place = Place::open(source).await?;
    let id = place.id(&config.target).await?;
    let new = NewExtension {
        effect: config.effect.clone(),
        wheel: config.wheel.clone(),
        effect_file: config.effect_file.as_deref().map(named_text).transpose()?,
    };
    let calibrations: Vec<CalibrationStatus> = match place {
        Place::Folder { .. } => place.get("/v1/calibrations?archived=true").await?,
        Place::Service(_) => Vec::new(),
    };
    let tell_of_known = |created: &CalibrationCreated| {
        if calibrations.iter().any(|status| status.id == created.id) {
            note(&format!("calibration {} has it already", created.id));
        }
    };
    let addition = Addition {
        source,
        growth: &config.growth,
        calibration: id,
    };
    let path = format!("/v1/calibrations/{id}/extend");
    if let Some(created) = addition.make(&place, &path, &new, tell_of_known).await? {
        say(&format!(
            "calibration {} of study {}\n",
            created.id, created.study
        ))?;
    }
    Ok(())
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
    let new = NewRuns {
        runs: read_text(&config.runs)?,
        calibration: Some(*id),
    };
    let place = Place::open(source).await?;
    let status: CalibrationStatus = place.get(&format!("/v1/calibrations/{id}")).await?;
    let addition = Addition {
        source,
        growth: &config.growth,
        calibration: *id,
    };
    let path = format!("/v1/studies/{}/runs", status.study);
    let added = addition.make(&place, &path, &new, |_| {}).await?;
    let Some(added): Option<RunsAdded> = added else {
        return Ok(());
    };
    Ok(say(&format!(
        "calibration {} of study {} on experiment {}\n",
        added.id, added.study, added.experiment
    ))?)
}

/// An addition to a study, with the settings of its computation in a folder.
struct Addition<'a> {
    source: &'a SourceArguments,
    growth: &'a GrowthArguments,
    /// A calibration of the study.
    calibration: i64,
}

impl Addition<'_> {
    /// Makes the addition by a request. A service answers with the addition. In a folder, the study is brought to its
    /// end here and its results are printed; then there is no answer.
    ///
    /// # Arguments
    /// - `added`: called with the addition before a folder computes it.
    async fn make<T: DeserializeOwned>(
        &self,
        place: &Place,
        path: &str,
        body: &impl Serialize,
        added: impl FnOnce(&T),
    ) -> anyhow::Result<Option<T>> {
        let Some(out) = &self.source.out else {
            return Ok(Some(place.post(path, body).await?));
        };
        let GrowthArguments {
            local_workers,
            models,
            verbose,
        } = self.growth;
        let folder = Folder::open(out, *local_workers, models, None).await?;
        let service = folder.service.clone();
        let result = async {
            let study = service.calibration_row(self.calibration).await?.study;
            folder.go_on(study).await?;
            added(&Place::in_folder(service.clone()).post(path, body).await?);
            let details = Details::new(*verbose, Some(self.calibration));
            folder.finish(study, details).await
        };
        let result = result.await;
        service.close().await;
        result.map(|()| None)
    }
}
