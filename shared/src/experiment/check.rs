//! Numbers of `experiment.toml` before and while they are checked.

use serde::Deserialize;

/// A standard deviation as the file states it.
#[derive(Deserialize)]
#[serde(untagged)]
pub(super) enum RawSd {
    Number(f64),
    Word(String),
}

/// Requires a finite number above 0.
pub(super) fn positive(key: &str, value: f64, unit: &str) -> Result<(), String> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(format!("{key} {value} {unit} must be > 0 {unit}"))
    }
}

/// Requires a finite number of at least 0.
pub(super) fn not_negative(key: &str, value: f64, unit: &str) -> Result<(), String> {
    if value.is_finite() && value >= 0.0 {
        Ok(())
    } else {
        Err(format!("{key} {value} {unit} must be >= 0 {unit}"))
    }
}
