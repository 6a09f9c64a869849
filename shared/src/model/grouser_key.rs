//! The key `grousers` under `[model]`: it decides whether the quasi-static model rolls grousers.

use super::error::ModelError;
use super::kind::ModelKind;

/// The name of the key.
pub const KEY: &str = "grousers";
/// The values of the key: a smooth rim, whatever grousers are declared, or a rim with them.
pub const WORDS: [&str; 2] = ["ignored", "rolled"];

/// Returns whether the key makes a model of this kind roll its wheels' grousers; [`ModelError::Invalid`] for another word or kind.
pub(super) fn read(kind: ModelKind, value: &toml::Value) -> Result<bool, ModelError> {
    let [ignored, rolled] = WORDS;
    let rolls = match value.as_str() {
        Some(word) if word == ignored => false,
        Some(word) if word == rolled => true,
        _ => {
            return Err(ModelError::Invalid(format!(
                "{KEY} = {value} must be \"{ignored}\" or \"{rolled}\""
            )));
        }
    };
    let why = match kind {
        ModelKind::QuasiStatic => return Ok(rolls),
        ModelKind::WongReece => "rolls a smooth rim",
        _ => "rolls grousers as they are declared",
    };
    Err(ModelError::Invalid(format!(
        "{KEY}: {} {why}; the key is for kind = \"quasi_static\"",
        kind.name()
    )))
}
