//! `coordinator predict` and `coordinator decide`: conditions of one's own, and options.

use anyhow::{Context, bail};
use prediction::{DecisionAnswer, Prediction};
use serde::Serialize;
use shared::api::{CalibrationStatus, NewDecision, NewPrediction};
use shared::text_file::read_text;

use super::output::say;
use super::place::Place;
use super::verbs::{current, write};
use crate::config::{DecideArguments, PredictArguments, PredictionFormat};
use report::terminal;

pub(super) async fn predict(config: &PredictArguments) -> anyhow::Result<()> {
    let place = Place::open(&config.target.source).await?;
    let id = target(&place, config.target.id).await?;
    let plan = match &config.plan {
        Some(path) => Some(read_text(path)?),
        None => row(&config.at)?,
    };
    let asked = NewPrediction {
        plan,
        sweep: config.sweep.clone(),
        wheels: config.wheels.as_deref().map(read_text).transpose()?,
        statements: config.probability.clone(),
        draws: config.draws,
    };
    let predicted: Prediction = place
        .post(&format!("/v1/calibrations/{id}/predict"), &asked)
        .await?;
    Ok(say(&match config.format {
        PredictionFormat::Text => terminal::prediction(&predicted),
        PredictionFormat::Json => json(&predicted)?,
        PredictionFormat::Csv => terminal::prediction_csv(&predicted),
    })?)
}

pub(super) async fn decide(config: &DecideArguments) -> anyhow::Result<()> {
    if config.format == PredictionFormat::Csv {
        bail!("--format csv is of predictions and recordings: a decision is printed as text or json");
    }
    let place = Place::open(&config.source).await?;
    let id = target(&place, config.id).await?;
    let asked = NewDecision {
        file: Some(read_text(&config.file)?),
        draws: config.draws,
    };
    let answer: DecisionAnswer = place
        .post(&format!("/v1/calibrations/{id}/decide"), &asked)
        .await?;
    say(&match config.format {
        PredictionFormat::Json => json(&answer)?,
        PredictionFormat::Text | PredictionFormat::Csv => terminal::decision(&answer),
    })?;
    if let Some(path) = &config.report {
        let report = place.text(&format!("/v1/calibrations/{id}/report")).await?;
        write(Some(path), &report, "report.html")?;
    }
    Ok(())
}

fn json(value: &impl Serialize) -> anyhow::Result<String> {
    Ok(serde_json::to_string_pretty(value)? + "\n")
}

/// Returns the calibration that is meant: the given one, or that of the current model of the only study.
pub(super) async fn target(place: &Place, id: Option<i64>) -> anyhow::Result<i64> {
    if let Some(id) = id {
        return Ok(id);
    }
    let statuses: Vec<CalibrationStatus> = place.get("/v1/calibrations").await?;
    match statuses.as_slice() {
        [first, rest @ ..] if rest.iter().all(|status| status.study == first.study) => {
            current(place, first.id).await
        }
        [] => bail!("there is no calibration"),
        several => bail!("there are {} calibrations: name one by its id", several.len()),
    }
}

/// Returns the names and values of arguments of the form NAME=VALUE.
pub(super) fn stated(values: &[String]) -> anyhow::Result<Vec<(&str, &str)>> {
    let parts = values.iter().map(|value| {
        let parts = value.split_once('=');
        parts.with_context(|| format!("--at {value} must have the form NAME=VALUE"))
    });
    parts.collect()
}

/// Returns a plan with one row of these values; `None` without values.
fn row(values: &[String]) -> anyhow::Result<Option<String>> {
    let parts = stated(values)?;
    let line = |part: fn(&(&str, &str)) -> String| parts.iter().map(part).collect::<Vec<_>>().join(",");
    let (names, values) = (line(|part| part.0.to_owned()), line(|part| part.1.to_owned()));
    Ok((!parts.is_empty()).then(|| format!("{names}\n{values}\n")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_on_the_command_line_are_a_plan_with_one_row() {
        let values = |values: &[&str]| row(&values.iter().map(|&v| v.to_owned()).collect::<Vec<_>>());
        assert_eq!(values(&[]).unwrap(), None);
        let plan = values(&["slip=0.2", "wheel=w"]).unwrap();
        assert_eq!(plan.as_deref(), Some("slip,wheel\n0.2,w\n"));
        assert!(values(&["slip"]).is_err());
    }
}
