//! The table `[likelihood]`: how measurements scatter around the model.

use serde::Deserialize;
use shared::file::unknown_word;
use statistics::likelihood::{DISCREPANCY_LEVELS, GREATEST_DISCREPANCY, LEAST_DISCREPANCY};
use statistics::{Discrepancy, ErrorLaw};

use super::error::TableError;

/// Degrees of freedom of Student's t where a job says nothing.
const USUAL_FREEDOM: f64 = 5.0;

/// How measurements scatter around the model: what a job says of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LikelihoodSettings {
    /// The law of the errors.
    pub law: ErrorLaw,
    /// How far off the model may be in a condition, in noise sds.
    pub discrepancy: Discrepancy,
}

impl LikelihoodSettings {
    /// What is unusual about it, a sentence each; none of independent normal errors.
    pub fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        if let ErrorLaw::StudentT { degrees_of_freedom } = self.law {
            words.push(format!(
                "errors follow Student's t with {degrees_of_freedom} degrees of freedom, scaled by the noise sd"
            ));
        }
        match self.discrepancy {
            Discrepancy::None => {}
            Discrepancy::Known(m) => words.push(format!(
                "the model may be off by {m} noise sds in each condition and channel, common to all repeats"
            )),
            Discrepancy::Unknown => words.push(format!(
                "the model may be off by m noise sds in each condition and channel, common to all repeats; m is marginalised over {DISCREPANCY_LEVELS} values from {LEAST_DISCREPANCY} to {GREATEST_DISCREPANCY}, uniform in log m: {}",
                levels(self.discrepancy)
            )),
        }
        words
    }
}

fn levels(discrepancy: Discrepancy) -> String {
    let levels = discrepancy.levels();
    let words: Vec<String> = levels.iter().map(|m| format!("{m:.2}")).collect();
    words.join(", ")
}

/// The table as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct RawLikelihood {
    kind: String,
    degrees_of_freedom: Option<f64>,
    discrepancy: toml::Value,
}

impl Default for RawLikelihood {
    fn default() -> Self {
        RawLikelihood {
            kind: "gaussian".into(),
            degrees_of_freedom: None,
            discrepancy: toml::Value::Float(0.0),
        }
    }
}

impl RawLikelihood {
    pub(crate) fn settings(&self) -> Result<LikelihoodSettings, TableError> {
        let law = match (self.kind.as_str(), self.degrees_of_freedom) {
            ("gaussian", None) => ErrorLaw::Gaussian,
            ("gaussian", Some(_)) => return Err(TableError::DegreesOfFreedom),
            ("student_t", given) => {
                let degrees_of_freedom = given.unwrap_or(USUAL_FREEDOM);
                if !(degrees_of_freedom.is_finite() && degrees_of_freedom >= 1.0) {
                    let rule = "must be a finite number >= 1";
                    return Err(TableError::value("degrees_of_freedom", degrees_of_freedom, rule));
                }
                ErrorLaw::StudentT { degrees_of_freedom }
            }
            (other, _) => {
                let unknown = unknown_word("kind", other, ["gaussian", "student_t"]);
                return Err(TableError::Unknown(unknown));
            }
        };
        let value = &self.discrepancy;
        let number = shared::file::number(value);
        let discrepancy = match (number, value.as_str()) {
            (_, Some("unknown")) => Discrepancy::Unknown,
            (Some(m), _) if m.abs() == 0.0 => Discrepancy::None,
            (Some(m), _) if m.is_finite() && m > 0.0 => Discrepancy::Known(m),
            _ => {
                let rule = "must be a number >= 0, in noise sds, or \"unknown\"";
                return Err(TableError::value("discrepancy", value, rule));
            }
        };
        Ok(LikelihoodSettings { law, discrepancy })
    }
}
