//! `coordinator run`: a study in one process, resumable from its folder.

use std::path::Path;

use anyhow::{Context, bail};
use shared::api::{NewCalibration, NewExperiment};
use tokio::net::TcpListener;

use super::folder::{Details, Folder};
use super::job_on_disk::{self, JobOnDisk};
use super::output::remark;
use crate::config::RunArguments;
use job::Spec;
use report::model_limits;
use store::IdPage;

pub(super) async fn run(config: RunArguments) -> anyhow::Result<()> {
    let job = job_on_disk::read(&config.file, &[])?;
    for text in std::iter::once(&job.spec)
        .chain(&job.alternatives)
        .flat_map(model_limits)
    {
        remark("note:", &text);
    }
    let out = config
        .out
        .clone()
        .unwrap_or_else(|| Path::new("out").join(&job.name));
    // The address is bound before anything is written, so that a port in use leaves no folder behind.
    let listener = match config.listen {
        Some(address) => Some(
            TcpListener::bind(address)
                .await
                .with_context(|| format!("--listen {address}"))?,
        ),
        None => None,
    };
    std::fs::create_dir_all(&out).with_context(|| format!("--out {}", out.display()))?;
    let folder = Folder::open(
        &out,
        config.local_workers,
        &config.models,
        listener.map(|l| (l, &config.exposure)),
    )
    .await?;
    let service = folder.service.clone();
    let result = async {
        let study = take_up(&job, &folder).await?;
        folder.finish(study, Details::new(config.verbose, None)).await
    };
    let result = result.await;
    service.close().await;
    result
}

/// Returns the study of this folder: the stored one, if it has the same job, or a new one.
async fn take_up(job: &JobOnDisk, folder: &Folder) -> anyhow::Result<i64> {
    let service = &folder.service;
    let rows = service.store().reader().calibrations(IdPage::ALL).await?;
    let mut rows = rows.into_iter().map(|(_, row)| row);
    let Some(first) = rows.next() else {
        for spec in std::iter::once(&job.spec).chain(&job.alternatives) {
            folder.equations_of(spec).await?;
        }
        let experiment = NewExperiment {
            toml: job.experiment.toml.clone(),
            files: job.experiment.files.clone(),
        };
        let experiment = service.add_experiment(experiment).await?;
        let new = NewCalibration {
            experiment,
            toml: job.job.toml.clone(),
            files: job.job.files.clone(),
            name: Some(job.name.clone()),
            webhook: None,
        };
        return Ok(service.add_calibration(new).await?.study);
    };
    // The other members of the study follow from the first one, or were added by a user.
    let first = first?;
    let mut is_same = service.spec_of(&first).await?.same_as(&job.spec);
    for (row, spec) in rows.zip(&job.alternatives) {
        let row = row?;
        is_same = is_same && same_model(service.spec_of(&row).await?, spec);
    }
    if !is_same {
        let differs =
            |(name, text): (&String, &String)| job.job.files.get(name).is_some_and(|now| now != text);
        let changed = first.job.files.iter().find(|&file| differs(file));
        let what = match changed {
            Some((name, _)) => format!("the effect file {name}"),
            None => "the job or its experiment".to_owned(),
        };
        bail!(
            "{} holds the calibration of another job: {what} has changed since; give another --out, or delete the folder",
            folder.out.display()
        );
    }
    folder.go_on(first.study).await?;
    Ok(first.study)
}

/// Returns whether a stored calibration has one of the models that a job compares. Its stored job has this model alone.
fn same_model(mut stored: Spec, of_job: &Spec) -> bool {
    (stored.models, stored.discovery) = (of_job.models, of_job.discovery);
    stored.same_as(of_job)
}
