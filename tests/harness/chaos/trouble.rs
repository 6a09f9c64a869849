//! Why a question to the service has no answer.

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

impl From<std::io::Error> for Trouble {
    fn from(_: std::io::Error) -> Trouble {
        Trouble::Away
    }
}

/// An answer that is not the service's own failure.
pub(super) fn answered(what: &str, answer: Response) -> Result<Response, Trouble> {
    match answer.status {
        500.. => Err(Trouble::Failing(format!(
            "{what}: {} {}",
            answer.status, answer.body
        ))),
        _ => Ok(answer),
    }
}

/// `GET path`.
pub(super) fn get(client: &Client, path: &str) -> Result<Response, Trouble> {
    answered(path, client.try_get(path)?)
}

/// `POST path`, which must not be refused.
pub(super) fn post(client: &Client, path: &str, body: &Value) -> Result<Response, Trouble> {
    let answer = answered(path, client.send("POST", path, Some(&body.to_string()))?)?;
    match answer.status {
        200 | 201 => Ok(answer),
        status => Err(Trouble::Broken(format!("{path}: {status} {}", answer.body))),
    }
}
