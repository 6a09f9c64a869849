//! The key `grousers` under `[model]`: whether the quasi-static model rolls the grousers that wheels have.

use super::error::ModelError;
use super::kind::ModelKind;

/// The key.
pub const KEY: &str = "grousers";
/// Its values: a smooth rim, whatever grousers are declared, or a rim with them.
pub const WORDS: [&str; 2] = ["ignored", "rolled"];

/// Whether a model of a kind rolls its wheels' grousers by the value of the key.
///
/// # Errors
/// [`ModelError::Invalid`]: another word, or another kind.
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
