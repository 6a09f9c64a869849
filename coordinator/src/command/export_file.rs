//! `coordinator export`: writes a calibration as a file for other programs.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, bail};
use export::simulator::LookupTable;
use export::{DrawTable, InferenceData, format, simulator};
use prediction::{Prediction, Sweep};
use serde_json::json;
use shared::api::NewPrediction;
use shared::model::DrawnModel;

use super::place::Place;
use super::predict::stated;
use super::verbs::write;
use crate::config::{ExportArguments, ExportFormat, beside_program};
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
        ExportFormat::Table => write_bytes(output, &table(&place, id, config).await?),
        ExportFormat::Fmu => {
            let library = library()?;
            write_bytes(
                output,
                &simulator::fmu(&model(&place, id, config).await?, &library)?,
            )
        }
        ExportFormat::Chrono => write_folder(output, &simulator::chrono(&model(&place, id, config).await?)?),
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

/// Reads the model with its draws.
async fn model(place: &Place, id: i64, config: &ExportArguments) -> anyhow::Result<DrawnModel> {
    let query: Vec<String> = stated(&config.at)?
        .iter()
        .map(|(name, value)| format!("{name}={}", url_encoded(value)))
        .collect();
    let separator = if query.is_empty() { "" } else { "?" };
    let path = path(id, "drawn-model") + separator + &query.join("&");
    place.get(&path).await
}

/// Returns a text with everything but letters, digits and `-._~` as bytes in hex.
fn url_encoded(text: &str) -> String {
    let byte = |byte: u8| match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' => char::from(byte).to_string(),
        other => format!("%{other:02X}"),
    };
    text.bytes().map(byte).collect()
}

/// Reads the library that is built with the program: beside it, or in `../lib/grouser` where a package puts it.
fn library() -> anyhow::Result<Vec<u8>> {
    let places = beside_program(simulator::LIBRARY)?;
    if let Some(place) = places.iter().find(|place| place.exists()) {
        return std::fs::read(place).with_context(|| place.display().to_string());
    }
    bail!(
        "{} is missing: it computes the model in a simulator, and is built with the program (cargo build --release); a package has it as {}",
        places[0].display(),
        places[1].display()
    )
}

/// Predicts the grid of a table and returns its file, by the suffix of the output's name.
async fn table(place: &Place, id: i64, config: &ExportArguments) -> anyhow::Result<Vec<u8>> {
    if config.grid.is_empty() {
        bail!(
            "--grid is missing: state the values of the table, as in --grid slip=0:0.6:13 --grid wheel_load_n=50:150:5"
        );
    }
    let suffix = needed(config.output.as_deref())?.extension();
    let is_csv = match suffix.and_then(|suffix| suffix.to_str()) {
        Some("csv") => true,
        Some("npz") => false,
        _ => bail!("the name of a table must end with .csv or .npz"),
    };
    let grid: Vec<Sweep> = config
        .grid
        .iter()
        .map(|text| Sweep::read(text))
        .collect::<Result<_, _>>()?;
    let asked = NewPrediction {
        plan: Some(LookupTable::plan(&grid, &stated(&config.at)?)?),
        ..NewPrediction::default()
    };
    let predicted: Prediction = place.post(&path(id, "predict"), &asked).await?;
    let table = LookupTable::new(&grid, &predicted)?;
    Ok(match is_csv {
        true => table.csv().into_bytes(),
        false => table.npz()?,
    })
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
            "{} exists already; a new folder is needed, because what an older one holds would be read too",
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_a_query_are_encoded() {
        assert_eq!(url_encoded("wide wheel&x=1"), "wide%20wheel%26x%3D1");
        assert_eq!(url_encoded("ä-0.5"), "%C3%A4-0.5");
    }
}
