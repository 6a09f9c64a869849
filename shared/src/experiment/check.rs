//! Checks of single values, and their errors.

use schemars::JsonSchema;
use serde::Deserialize;

use super::mesh::MeshError;
use crate::limit;

/// A standard deviation of a channel: a number, pooled from the repeats of a condition, or inferred.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(super) enum RawSd {
    #[schemars(extend("exclusiveMinimum" = 0))]
    Number(f64),
    #[schemars(extend("enum" = ["replicates", "unknown"]))]
    Word(String),
}

/// A relative standard deviation: a number, or inferred.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(super) enum RawScatter {
    #[schemars(extend("minimum" = 0, "maximum" = 1))]
    Number(f64),
    #[schemars(extend("enum" = ["unknown"]))]
    Word(String),
}

/// A standard deviation of errors that runs share: a number in its unit, or inferred.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
pub(super) enum RawSharedSd {
    #[schemars(extend("minimum" = 0))]
    Number(f64),
    #[schemars(extend("enum" = ["unknown"]))]
    Word(String),
}

/// An error of a key or a field.
#[derive(Debug, thiserror::Error)]
pub(super) enum ValueError {
    #[error("{0} is blank")]
    Blank(String),
    #[error("{key} \"{text}\" is not a number{remedy}")]
    NotNumber {
        key: String,
        text: String,
        /// The correction to suggest, or an empty text.
        remedy: String,
    },
    #[error("{key} {value} is not a finite number")]
    NotFinite { key: String, value: f64 },
    /// The value breaks `bound`, such as `> 0`, `>= 0` or `< 90`.
    #[error("{key} {value} {unit} must be {bound} {unit}")]
    Bound {
        key: String,
        value: f64,
        unit: String,
        bound: String,
    },
    #[error("{key} {value} m must be <= {largest} m: metres are expected, were these millimetres?")]
    Millimetres { key: String, value: f64, largest: f64 },
    /// An unknown word, with the nearest known one.
    #[error("{0}")]
    Unknown(String),
    /// Any other rule, as a sentence.
    #[error("{0}")]
    Rule(String),
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Requires a finite number above 0 within the physical limits of the quantity.
pub(super) fn positive(key: &str, value: f64, unit: &str) -> Result<(), ValueError> {
    require(value.is_finite() && value > 0.0, key, value, unit, "> 0")?;
    possible(key, value)
}

/// Requires a finite number of at least 0 within the physical limits of the quantity.
pub(super) fn not_negative(key: &str, value: f64, unit: &str) -> Result<(), ValueError> {
    require(value.is_finite() && value >= 0.0, key, value, unit, ">= 0")?;
    possible(key, value)
}

/// Requires a value within the physical limits of the quantity.
pub(super) fn possible(key: &str, value: f64) -> Result<(), ValueError> {
    match limit::impossible(key, value) {
        None => Ok(()),
        Some(why) => Err(ValueError::Rule(format!("{key} {why}"))),
    }
}

/// Returns an error with the requirement `bound` in words unless `holds`.
pub(super) fn require(holds: bool, key: &str, value: f64, unit: &str, bound: &str) -> Result<(), ValueError> {
    if holds {
        return Ok(());
    }
    Err(ValueError::Bound {
        key: key.to_owned(),
        value,
        unit: unit.to_owned(),
        bound: bound.to_owned(),
    })
}
