//! Questions to the service, and the outcome of a study as text.

use serde_json::Value;

use crate::http::{Client, Response};

/// Why the user got no further.
#[derive(Debug)]
pub(super) enum Trouble {
    /// Nobody answers at present.
    Away,
    /// The service says that it cannot, as on a full disk.
    Failing(String),
    /// A promise is broken.
    Broken(String),
}

/// Sends a request; the answer, unless it is the service's own failure.
pub(super) fn ask(
    client: &Client,
    method: &str,
    path: &str,
    body: Option<&Value>,
) -> Result<Response, Trouble> {
    let body = body.map(Value::to_string);
    let answer = client
        .send(method, path, body.as_deref())
        .map_err(|_| Trouble::Away)?;
    match answer.status {
        500.. => Err(Trouble::Failing(format!(
            "{path}: {} {}",
            answer.status, answer.body
        ))),
        _ => Ok(answer),
    }
}

/// `GET path`.
pub(super) fn get(client: &Client, path: &str) -> Result<Response, Trouble> {
    ask(client, "GET", path, None)
}

/// A request that must not be refused; its answer.
pub(super) fn done(
    client: &Client,
    method: &str,
    path: &str,
    body: Option<&Value>,
) -> Result<Value, Trouble> {
    let answer = ask(client, method, path, body)?;
    match answer.status {
        200 | 201 => Ok(answer.json()),
        status => Err(Trouble::Broken(format!(
            "{method} {path}: {status} {}",
            answer.body
        ))),
    }
}

/// The numbers of the calibrations of a study.
pub(super) fn members(study: &Value) -> Vec<i64> {
    let members = study["calibrations"].as_array().into_iter().flatten();
    members.filter_map(Value::as_i64).collect()
}

/// Everything that a finished study gives but its wall times: summary, stages, populations, draws, the result of a search. Equal texts
/// are equal bits, since a number is written with as many digits as it has. `None` while the study is not finished.
pub(super) fn outcome(client: &Client, study: &Value) -> Result<Option<String>, Trouble> {
    let ids = members(study);
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
        let parts = ["stages", "posterior", "discovery"].map(str::to_owned);
        for part in parts.into_iter().chain(samples) {
            let answer = get(client, &format!("/v1/calibrations/{id}/{part}"))?;
            // The reason why there is none names the number of the calibration.
            let body = match answer.status {
                200 => format!("{:#}", answer.json()),
                status => format!("none ({status})"),
            };
            text += &format!("calibration {} of the study, {part}: {body}\n", place + 1);
        }
    }
    Ok(Some(text))
}
