//! The outcome of a study as text: equal texts are equal bits, since a number is written with as many digits as it has.

use serde_json::Value;

use super::trouble::{Trouble, get};
use crate::http::Client;

/// Everything that a finished study gives but its wall times: summary, stages, populations, draws, what was found; `None` while it
/// is not finished.
pub(super) fn outcome(client: &Client, study: &Value) -> Result<Option<String>, Trouble> {
    let ids: Vec<i64> = study["calibrations"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(Value::as_i64)
        .collect();
    let answer = get(client, &format!("/v1/calibrations/{}/summary", ids[0]))?;
    if answer.status != 200 {
        return Ok(None);
    }
    let mut summary = answer.json();
    if summary["status"] != "finished" {
        return Ok(None);
    }
    for part in ["calibrations", "point_estimates"] {
        for calibration in summary[part].as_array_mut().into_iter().flatten() {
            calibration["wall_s"] = Value::Null;
            calibration["calibration"] = Value::Null;
        }
    }
    let mut text = format!("{summary:#}\n");
    for (place, id) in ids.iter().enumerate() {
        let stages = get(client, &format!("/v1/calibrations/{id}/stages"))?;
        let count = stages.json().as_array().map_or(0, Vec::len);
        let samples = (0..count).map(|stage| format!("samples?stage={stage}"));
        for part in ["stages", "posterior", "discovery"]
            .map(str::to_owned)
            .into_iter()
            .chain(samples)
        {
            let answer = get(client, &format!("/v1/calibrations/{id}/{part}"))?;
            // Why there is none names the number of the calibration.
            let body = match answer.status {
                200 => format!("{:#}", answer.json()),
                status => format!("none ({status})"),
            };
            text += &format!("calibration {} of the study, {part}: {body}\n", place + 1);
        }
    }
    Ok(Some(text))
}

/// Where a text first differs from another.
pub(super) fn difference(got: &str, expected: &str) -> Option<String> {
    let mut pairs = got.lines().zip(expected.lines()).enumerate();
    let unequal = pairs.find(|(_, (got, expected))| got != expected);
    match unequal {
        Some((number, (got, expected))) => {
            Some(format!("line {}: {got:?}, expected {expected:?}", number + 1))
        }
        None if got.len() != expected.len() => {
            Some(format!("{} bytes, expected {}", got.len(), expected.len()))
        }
        None => None,
    }
}
