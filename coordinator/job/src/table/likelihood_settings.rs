//! The table `[likelihood]`: how measurements scatter around the model.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde_json::{Map, Value, json};
use shared::channel::Channel;
use shared::file::{number, unknown_word};
use statistics::likelihood::{DISCREPANCY_LEVELS, MAX_DISCREPANCY, MIN_DISCREPANCY};
use statistics::{Discrepancy, ErrorLaw};

use super::error::TableError;

/// The error laws by their names in files.
const LAWS: [&str; 2] = ["gaussian", "student_t"];
/// Default degrees of freedom of Student's t.
const DEFAULT_FREEDOM: f64 = 5.0;

/// The scatter of measurements around the model, as a job states it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LikelihoodSettings {
    /// The law of the errors.
    pub law: ErrorLaw,
    /// The discrepancy of the model in a condition, in noise sds, in the order of [`Channel::ALL`].
    pub discrepancies: [Discrepancy; 4],
    /// Whether the recorded sinkages before the steady state are fitted, too.
    pub histories: bool,
}

impl LikelihoodSettings {
    /// Returns whether any channel has a discrepancy.
    pub fn has_discrepancy(&self) -> bool {
        self.discrepancies.iter().any(|d| *d != Discrepancy::None)
    }

    /// Returns a sentence for each property that differs from independent normal errors.
    pub fn words(&self) -> Vec<String> {
        let mut words = Vec::new();
        if let ErrorLaw::StudentT { degrees_of_freedom } = self.law {
            words.push(format!(
                "errors follow Student's t with {degrees_of_freedom} degrees of freedom, scaled by the noise sd"
            ));
        }
        let off = |m: &str| {
            format!(
                "the model may be off by {m} noise sds in each condition and channel, common to all repeats"
            )
        };
        let inferred = format!(
            "m of each channel is marginalised over {DISCREPANCY_LEVELS} values from {MIN_DISCREPANCY} to {MAX_DISCREPANCY}, uniform in log m"
        );
        let first = self.discrepancies[0];
        if self.discrepancies.iter().all(|discrepancy| *discrepancy == first) {
            match first {
                Discrepancy::None => {}
                Discrepancy::Known(m) => words.push(off(&m.to_string())),
                Discrepancy::Unknown => words.push(format!("{}; {inferred}", off("m"))),
            }
        } else {
            let channels = Channel::ALL.iter().zip(self.discrepancies);
            let words_of = channels.map(|(channel, discrepancy)| {
                let m = match discrepancy {
                    Discrepancy::None => "0".to_owned(),
                    Discrepancy::Known(m) => m.to_string(),
                    Discrepancy::Unknown => "m".to_owned(),
                };
                format!("{m} ({})", channel.words())
            });
            let by_channel: Vec<String> = words_of.collect();
            words.push(format!("{}; {inferred}", off(&by_channel.join(", "))));
        }
        words
    }
}

/// The scatter of measurements around the model.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct RawLikelihood {
    /// Law of the errors.
    #[schemars(extend("enum" = LAWS))]
    kind: String,
    /// Degrees of freedom of `student_t`; 5 if they are not stated.
    #[schemars(range(min = 1))]
    degrees_of_freedom: Option<f64>,
    #[schemars(schema_with = "discrepancy_schema")]
    discrepancy: toml::Value,
    #[serde(rename = "discrepancy.drawbar_pull")]
    #[schemars(schema_with = "channel_schema")]
    drawbar_pull: Option<toml::Value>,
    #[serde(rename = "discrepancy.torque")]
    #[schemars(schema_with = "channel_schema")]
    torque: Option<toml::Value>,
    #[serde(rename = "discrepancy.sinkage")]
    #[schemars(schema_with = "channel_schema")]
    sinkage: Option<toml::Value>,
    #[serde(rename = "discrepancy.lateral_force")]
    #[schemars(schema_with = "channel_schema")]
    lateral_force: Option<toml::Value>,
    /// Whether the recorded sinkages before the steady state are fitted beside the averages.
    histories: bool,
}

/// Returns the schema of the discrepancy of one channel.
fn channel_schema(_: &mut SchemaGenerator) -> Schema {
    json_schema!({
        "description": "Model inadequacy per condition, in noise standard deviations.",
        "anyOf": [{ "type": "number", "minimum": 0 }, { "type": "string", "enum": ["unknown"] }],
    })
}

/// Returns the schema of `discrepancy`: a value for all channels, or a table by channel.
fn discrepancy_schema(generator: &mut SchemaGenerator) -> Schema {
    let mut schema = channel_schema(generator);
    let by_channel: Map<String, Value> = Channel::ALL
        .map(|channel| (channel.name().to_owned(), json!(schema)))
        .into_iter()
        .collect();
    let table = json!({ "type": "object", "properties": by_channel, "additionalProperties": false });
    let shapes = schema.get_mut("anyOf").and_then(Value::as_array_mut);
    shapes.into_iter().for_each(|shapes| shapes.push(table.clone()));
    schema
}

impl Default for RawLikelihood {
    fn default() -> Self {
        RawLikelihood {
            kind: "gaussian".into(),
            degrees_of_freedom: None,
            discrepancy: toml::Value::Float(0.0),
            drawbar_pull: None,
            torque: None,
            sinkage: None,
            lateral_force: None,
            histories: false,
        }
    }
}

impl RawLikelihood {
    pub(crate) fn settings(&self) -> Result<LikelihoodSettings, TableError> {
        let law = match (self.kind.as_str(), self.degrees_of_freedom) {
            ("gaussian", None) => ErrorLaw::Gaussian,
            ("gaussian", Some(_)) => return Err(TableError::DegreesOfFreedom),
            ("student_t", given) => {
                let degrees_of_freedom = given.unwrap_or(DEFAULT_FREEDOM);
                if !(degrees_of_freedom.is_finite() && degrees_of_freedom >= 1.0) {
                    let rule = "must be a finite number >= 1";
                    return Err(TableError::value("degrees_of_freedom", degrees_of_freedom, rule));
                }
                ErrorLaw::StudentT { degrees_of_freedom }
            }
            (other, _) => {
                let unknown = unknown_word("kind", other, LAWS);
                return Err(TableError::Unknown(unknown));
            }
        };
        // TOML reads discrepancy.torque = 0.5 as a table; channels that are not in the table are inferred.
        let mut discrepancies = match &self.discrepancy {
            toml::Value::Table(_) => [Discrepancy::Unknown; 4],
            value => [discrepancy("discrepancy", value)?; 4],
        };
        if let toml::Value::Table(table) = &self.discrepancy {
            for (name, value) in table {
                let channel = Channel::ALL.into_iter().find(|channel| channel.name() == name);
                let channel = channel.ok_or_else(|| {
                    let known = Channel::ALL.map(Channel::name);
                    TableError::Unknown(unknown_word("channel of discrepancy", name, known))
                })?;
                discrepancies[channel.index()] = discrepancy(KEYS[channel.index()], value)?;
            }
        }
        let stated = [
            &self.drawbar_pull,
            &self.torque,
            &self.sinkage,
            &self.lateral_force,
        ];
        for (i, value) in stated.into_iter().enumerate() {
            if let Some(value) = value {
                discrepancies[i] = discrepancy(KEYS[i], value)?;
            }
        }
        Ok(LikelihoodSettings {
            law,
            discrepancies,
            histories: self.histories,
        })
    }
}

/// The keys of the channels, in the order of [`Channel::ALL`].
const KEYS: [&str; 4] = [
    "discrepancy.drawbar_pull",
    "discrepancy.torque",
    "discrepancy.sinkage",
    "discrepancy.lateral_force",
];

fn discrepancy(key: &'static str, value: &toml::Value) -> Result<Discrepancy, TableError> {
    match (number(value), value.as_str()) {
        (_, Some("unknown")) => Ok(Discrepancy::Unknown),
        (Some(m), _) if m.abs() == 0.0 => Ok(Discrepancy::None),
        (Some(m), _) if m.is_finite() && m > 0.0 => Ok(Discrepancy::Known(m)),
        _ => {
            let rule = "must be a number >= 0, in noise sds, or \"unknown\"";
            Err(TableError::value(key, value, rule))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<[Discrepancy; 4], String> {
        let raw: RawLikelihood = toml::from_str(text).map_err(|e| e.to_string())?;
        let settings = raw.settings().map_err(|e| e.to_string())?;
        Ok(settings.discrepancies)
    }

    #[test]
    fn a_discrepancy_is_one_of_all_channels_or_one_of_each() {
        use Discrepancy::{Known, None, Unknown};
        assert_eq!(read(""), Ok([None; 4]));
        assert_eq!(read("discrepancy = 2"), Ok([Known(2.0); 4]));
        assert_eq!(read("discrepancy = \"unknown\""), Ok([Unknown; 4]));
        let torque = Ok([Unknown, Known(0.5), Unknown, Unknown]);
        assert_eq!(read("discrepancy.torque = 0.5"), torque);
        assert_eq!(
            read("discrepancy = \"unknown\"\n\"discrepancy.torque\" = 0.5"),
            torque
        );
        assert_eq!(
            read("discrepancy = 1.0\n\"discrepancy.sinkage\" = 0"),
            Ok([Known(1.0), Known(1.0), None, Known(1.0)])
        );
        assert_eq!(
            read("discrepancy.torqe = 0.5").unwrap_err(),
            "unknown channel of discrepancy \"torqe\"; the nearest known is \"torque\""
        );
        assert_eq!(
            read("discrepancy.torque = -1.0").unwrap_err(),
            "discrepancy.torque = -1.0 must be a number >= 0, in noise sds, or \"unknown\""
        );
    }
}
