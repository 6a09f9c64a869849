//! `coordinator export`: writes a calibration as a file for other programs.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, bail};
use export::{DrawTable, InferenceData, format};
use serde_json::json;

use super::place::Place;
use super::verbs::write;
use crate::config::{ExportArguments, ExportFormat};
use report::StudySummary;
use result::{Comparison, PosteriorTable};

pub(super) async fn export(config: &ExportArguments) -> anyhow::Result<()> {
    let output = config.output.as_deref();
    let place = Place::open(&config.target.source).await?;
    let id = place.id(&config.target).await?;
    match config.format {
        ExportFormat::Csv => {
            let posterior: PosteriorTable = place.get(&path(id, "posterior")).await?;
            write(output, &posterior.to_csv(), "posterior.csv")
        }
        ExportFormat::Json => {
            let all = json!({
                "summary": place.get::<StudySummary>(&path(id, "summary")).await?,
                "posterior": place.get::<PosteriorTable>(&path(id, "posterior")).await?,
                "comparison": place.get::<Comparison>(&path(id, "comparison")).await?,
            });
            write(
                output,
                &(serde_json::to_string_pretty(&all)? + "\n"),
                "results.json",
            )
        }
        ExportFormat::Arrow => {
            let file = format::arrow(&DrawTable::from_data(&data(&place, id).await?)?)?;
            write_bytes(output, &file)
        }
        ExportFormat::Parquet => {
            let file = format::parquet(&DrawTable::from_data(&data(&place, id).await?)?)?;
            write_bytes(output, &file)
        }
        ExportFormat::Netcdf => write_bytes(output, &format::netcdf(&data(&place, id).await?)?),
        ExportFormat::Zarr => write_folder(output, &format::zarr(&data(&place, id).await?)?),
    }
}

fn path(id: i64, part: &str) -> String {
    format!("/v1/calibrations/{id}/{part}")
}

/// Reads the inference data of a calibration and checks them, because a service of another version may have sent them.
async fn data(place: &Place, id: i64) -> anyhow::Result<InferenceData> {
    let data: InferenceData = place.get(&path(id, "inference-data")).await?;
    data.check()?;
    Ok(data)
}

fn needed(output: Option<&Path>) -> anyhow::Result<&Path> {
    output.context("--output is missing: only csv and json are written to standard output")
}

fn write_bytes(output: Option<&Path>, bytes: &[u8]) -> anyhow::Result<()> {
    let path = needed(output)?;
    std::fs::write(path, bytes).with_context(|| path.display().to_string())
}

/// Writes files below a new folder.
fn write_folder(output: Option<&Path>, files: &BTreeMap<String, Vec<u8>>) -> anyhow::Result<()> {
    let folder = needed(output)?;
    if folder.exists() {
        bail!(
            "{} exists already; zarr needs a new folder, because what an older one holds would be read too",
            folder.display()
        );
    }
    for (path, bytes) in files {
        let file = folder.join(path);
        let above = file.parent().unwrap_or(folder);
        std::fs::create_dir_all(above).with_context(|| above.display().to_string())?;
        std::fs::write(&file, bytes).with_context(|| file.display().to_string())?;
    }
    Ok(())
}
