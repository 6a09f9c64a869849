//! Requests to the service, and the outcome of a study as text.

use serde_json::Value;

use crate::http::{Client, Response};

/// A reason why the user did not get an answer.
#[derive(Debug)]
pub(super) enum Trouble {
    /// No coordinator answers at present.
    Unreachable,
    /// The service fails with a status 5xx, as it does on a full disk.
    Failing(String),
    /// A promise is broken.
    Broken(String),
}

/// Sends a request; returns the answer unless its status is 5xx.
fn send(client: &Client, method: &str, path: &str, body: Option<&Value>) -> Result<Response, Trouble> {
    let body = body.map(Value::to_string);
    let answer = client
        .send(method, path, body.as_deref())
        .map_err(|_| Trouble::Unreachable)?;
    match answer.status {
        500.. => Err(Trouble::Failing(format!(
            "{path}: {} {}",
            answer.status, answer.body
        ))),
        _ => Ok(answer),
    }
}

/// Returns the answer to `GET path`.
pub(super) fn get(client: &Client, path: &str) -> Result<Response, Trouble> {
    send(client, "GET", path, None)
}

/// Sends a request that must not be refused.
pub(super) fn succeed(
    client: &Client,
    method: &str,
    path: &str,
    body: Option<&Value>,
) -> Result<Value, Trouble> {
    let answer = send(client, method, path, body)?;
    match answer.status {
        200 | 201 => Ok(answer.json()),
        status => Err(Trouble::Broken(format!(
            "{method} {path}: {status} {}",
            answer.body
        ))),
    }
}

/// Returns the numbers of the calibrations of a study.
pub(super) fn members(study: &Value) -> Vec<i64> {
    let members = study["calibrations"].as_array().into_iter().flatten();
    members.filter_map(Value::as_i64).collect()
}

/// Returns the results of a finished study without its wall times: summary, stages, populations, draws and the result of a search. Equal
/// texts mean equal bits, because each number has all its digits. `None` before the study is finished.
pub(super) fn outcome(client: &Client, study: &Value) -> Result<Option<String>, Trouble> {
    let ids = members(study);
    let answer = get(client, &format!("/v1/calibrations/{}/summary", ids[0]))?;
    if answer.status != 200 || answer.json()["status"] != "finished" {
        return Ok(None);
    }
    let mut summary = answer.json();
    for part in ["calibrations", "point_estimates"] {
        for calibration in summary[part].as_array_mut().into_iter().flatten() {
            calibration["wall_s"] = Value::Null;
            calibration["calibration"] = Value::Null;
        }
    }
    for round in summary["discovery"]["rounds"]
        .as_array_mut()
        .into_iter()
        .flatten()
    {
        round["calibration"] = Value::Null;
    }
    let mut text = format!("{summary:#}\n");
    for (place, id) in ids.iter().enumerate() {
        let stages = get(client, &format!("/v1/calibrations/{id}/stages"))?;
        let count = stages.json().as_array().map_or(0, Vec::len);
        let samples = (0..count).map(|stage| format!("samples?stage={stage}"));
        let parts = ["stages", "posterior", "discovery"].map(str::to_owned);
        for part in parts.into_iter().chain(samples) {
            let answer = get(client, &format!("/v1/calibrations/{id}/{part}"))?;
            // The message of another status names the calibration, whose number differs.
            let body = match answer.status {
                200 => format!("{:#}", answer.json()),
                status => format!("none ({status})"),
            };
            text += &format!("calibration {} of the study, {part}: {body}\n", place + 1);
        }
    }
    Ok(Some(text))
}
