//! The short commands: submit, list, status, cancel, pause, resume, archive, delete, compare, diagnose, report.

use std::io::IsTerminal;
use std::path::Path;

use anyhow::{Context, bail};
use serde::Deserialize;
use serde_json::json;
use shared::api::{
    CalibrationCreated, CalibrationStatus, ExperimentCreated, NewCalibration, NewExperiment, StudyArchived,
    StudyDeleted,
};
use shared::text_file::read_text;

use super::job_on_disk;
use super::output::say;
use super::place::{self, ListPart, Place};
use crate::config::{
    ListArguments, ReportArguments, ResumeArguments, StudyArguments, SubmitArguments, TargetArguments,
};
use crate::effect::EffectCard;
use job::{ServiceEffect, foreign_effects};
use report::{StudyListItem, StudyOverview, terminal};
use result::{Comparison, Diagnostics};

pub(super) async fn submit(config: &SubmitArguments) -> anyhow::Result<()> {
    let service = Place::at(&config.url, &config.client)?;
    let added = added_effects(config, &service).await?;
    let job = job_on_disk::read(&config.file, &added)?;
    let experiment = NewExperiment {
        toml: job.experiment.toml,
        files: job.experiment.files,
    };
    let experiment: ExperimentCreated = service.post("/v1/experiments", &experiment).await?;
    let new = NewCalibration {
        experiment: experiment.id,
        toml: job.job.toml,
        files: job.job.files,
        name: Some(job.name),
        webhook: config.webhook.clone(),
    };
    let created: CalibrationCreated = service.post("/v1/calibrations", &new).await?;
    let mut text = format!("calibration {} of study {}\n", created.id, created.study);
    for id in created.point_estimates {
        text += &format!("calibration {id} beside it\n");
    }
    Ok(say(&text)?)
}

/// Reads those effects of a job that are in the catalogue of the service and not in the library.
async fn added_effects(config: &SubmitArguments, service: &Place) -> anyhow::Result<Vec<ServiceEffect>> {
    /// The needed part of the answer to `GET /v1/effects/NAME`.
    #[derive(Deserialize)]
    struct Page {
        effect: EffectCard,
        text: String,
    }
    let toml = read_text(&config.file.job)?;
    let mut added = Vec::new();
    for named in foreign_effects(&toml) {
        let is_name = |c: char| c.is_ascii_alphanumeric() || "_@".contains(c);
        if !named.chars().all(is_name) {
            // The reader of the job refuses this name.
            continue;
        }
        let page: Page = service
            .get(&format!("/v1/effects/{named}"))
            .await
            .with_context(|| format!("{}: [model] effects", config.file.job.display()))?;
        let version = page.effect.version.unwrap_or_default();
        added.push(ServiceEffect::new(named, &page.effect.name, version, page.text));
    }
    Ok(added)
}

pub(super) async fn list(config: &ListArguments) -> anyhow::Result<()> {
    let place = Place::open(&config.source).await?;
    let which = if config.archived { "?archived=true" } else { "" };
    let part = ListPart {
        limit: config.limit.unwrap_or(usize::MAX),
        after: config.after,
    };
    let path = format!("/v1/calibrations{which}");
    let statuses: Vec<CalibrationStatus> = place
        .list(&path, part, |status: &CalibrationStatus| status.id)
        .await?;
    // Studies have the order of their first calibrations.
    let shown = statuses
        .iter()
        .map(|status| status.study)
        .filter(|&study| study > 0);
    let part = match (shown.clone().min(), shown.max()) {
        (Some(first), Some(last)) => ListPart {
            limit: usize::try_from(last - first + 1)?,
            after: Some(first - 1),
        },
        _ => ListPart {
            limit: 0,
            after: None,
        },
    };
    let path = format!("/v1/studies{which}");
    let studies: Vec<StudyListItem> = place.list(&path, part, |study: &StudyListItem| study.id).await?;
    Ok(say(&terminal::list(&statuses, &studies))?)
}

pub(super) async fn status(target: &TargetArguments) -> anyhow::Result<()> {
    let place = Place::open(&target.source).await?;
    let id = place.id(target).await?;
    let status: CalibrationStatus = place.get(&format!("/v1/calibrations/{id}")).await?;
    Ok(say(&terminal::status_table(&[status]))?)
}

/// Sends a command on a calibration, with the query of its path.
pub(super) async fn control(target: &TargetArguments, verb: &str, query: &str) -> anyhow::Result<()> {
    let place = Place::open(&target.source).await?;
    if let Place::Folder { .. } = place {
        bail!(
            "{verb} needs a service (--url): a run in a folder is stopped by ^C and resumed by running it again"
        );
    }
    let id = place.id(target).await?;
    let answer: serde_json::Value = place
        .post(&format!("/v1/calibrations/{id}/{verb}{query}"), &json!({}))
        .await?;
    let state = answer["state"].as_str().unwrap_or("in an unknown state");
    Ok(say(&format!("calibration {id} is {state}\n"))?)
}

pub(super) async fn resume(config: &ResumeArguments) -> anyhow::Result<()> {
    let query = match &config.version {
        Some(version) => place::query("version", version)?,
        None if config.skip_faults => "?skip_faults=true".to_owned(),
        None => String::new(),
    };
    control(&config.target, "resume", &query).await
}

/// Archives or restores a study.
pub(super) async fn archive(config: &StudyArguments, verb: &str) -> anyhow::Result<()> {
    let service = Place::at(&config.url, &config.client)?;
    let path = format!("/v1/studies/{}/{verb}", config.study);
    let study: StudyArchived = service.post(&path, &json!({})).await?;
    let now = if study.archived {
        "archived"
    } else {
        "in the lists again"
    };
    Ok(say(&format!("study {} is {now}\n", study.id))?)
}

pub(super) async fn delete(config: &StudyArguments) -> anyhow::Result<()> {
    let service = Place::at(&config.url, &config.client)?;
    let study: StudyDeleted = service.delete(&format!("/v1/studies/{}", config.study)).await?;
    let calibrations: Vec<String> = study.calibrations.iter().map(i64::to_string).collect();
    let text = format!(
        "study {} is deleted, with its calibrations: {}\n",
        study.id,
        calibrations.join(", ")
    );
    Ok(say(&text)?)
}

pub(super) async fn compare(target: &TargetArguments) -> anyhow::Result<()> {
    let place = Place::open(&target.source).await?;
    let comparison: Comparison = place.part(target, "comparison").await?;
    Ok(say(
        &(terminal::comparison(&comparison) + &terminal::groups(&comparison))
    )?)
}

pub(super) async fn diagnose(target: &TargetArguments) -> anyhow::Result<()> {
    let place = Place::open(&target.source).await?;
    let diagnostics: Diagnostics = place.part(target, "diagnostics").await?;
    Ok(say(&terminal::diagnostics(&diagnostics))?)
}

pub(super) async fn report(config: &ReportArguments) -> anyhow::Result<()> {
    let place = Place::open(&config.target.source).await?;
    let id = match config.target.id {
        Some(id) => id,
        None => current(&place, place.id(&config.target).await?).await?,
    };
    let report = place.text(&format!("/v1/calibrations/{id}/report")).await?;
    write(config.output.as_deref(), &report, "report.html")
}

/// Returns the calibration of the current model of a study, or the given calibration if the study has no current model.
pub(super) async fn current(place: &Place, calibration: i64) -> anyhow::Result<i64> {
    let status: CalibrationStatus = place.get(&format!("/v1/calibrations/{calibration}")).await?;
    let study: StudyOverview = place.get(&format!("/v1/studies/{}", status.study)).await?;
    Ok(study.current.unwrap_or(calibration))
}

/// Writes a text to a file, or to standard output. A terminal gets the size of the text instead, and how to write it to a file.
///
/// # Arguments
/// - `name`: the proposed name of the file.
pub(super) fn write(path: Option<&Path>, text: &str, name: &str) -> anyhow::Result<()> {
    match path {
        Some(path) => std::fs::write(path, text).with_context(|| path.display().to_string()),
        None if std::io::stdout().is_terminal() => Ok(say(&in_place_of(text, name))?),
        None => Ok(say(text)?),
    }
}

/// Returns the message for a terminal in place of a long text.
fn in_place_of(text: &str, name: &str) -> String {
    let mut message = format!("{} lines, {} kB", text.lines().count(), text.len().div_ceil(1000));
    if name.ends_with(".csv")
        && let Some(head) = text.lines().next()
    {
        message += &format!("; columns {}", head.replace(',', ", "));
    }
    message
        + &format!("\nwrite them to a file with --output {name}, or hand them to another program with |\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_is_told_the_size_and_the_columns_of_a_table_and_what_to_give() {
        let table = format!("log_prior,n\n{}", "-1.5,1.1\n".repeat(1000));
        assert_eq!(
            in_place_of(&table, "posterior.csv"),
            "1001 lines, 10 kB; columns log_prior, n\nwrite them to a file with --output posterior.csv, or hand them to another program with |\n"
        );
        assert!(!in_place_of("<html>", "report.html").contains("columns"));
    }
}
