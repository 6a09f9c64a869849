//! JSON schemas of the files that people write, so that editors complete and check them.
//!
//! The schemas state keys, types, words and bounds of single values. The readers check rules between values and between files.
//! Names, words and defaults come from the code that reads; the tests compare the keys and words with its messages.
//!
//! # Layout
//! - `effect`, `map`: the schemas of an effect and of a map. Jobs and experiments derive theirs from the types that read them.

mod effect;
mod map;
#[cfg(test)]
mod tests;

use clap::ValueEnum;
use job::schema::{from_type, job, model, parameters};
use serde_json::{Value, json};
use shared::experiment::ExperimentKeys;

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub enum FileKind {
    /// A calibration: `job.toml`.
    Job,
    /// Wheels, soils, rig and noise: `experiment.toml`.
    Experiment,
    /// A decision alone, and wheels that the experiment does not have.
    Decision,
    /// An effect.
    Effect,
    /// The map of an import.
    Map,
    /// The model of forward runs.
    Model,
    /// The parameters of forward runs.
    Parameters,
}

/// Returns the schema of a decision: the table of a job, and wheels as in an experiment.
fn decision() -> Value {
    let (mut job, mut experiment) = (job(), from_type::<ExperimentKeys>());
    json!({
        "type": "object",
        "required": ["decision"],
        "additionalProperties": false,
        "properties": {
            "decision": job["properties"]["decision"].take(),
            "wheel": experiment["properties"]["wheel"].take(),
        },
    })
}

impl FileKind {
    /// Returns every kind.
    pub fn all() -> &'static [Self] {
        Self::value_variants()
    }

    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Returns the name of the schema's file.
    pub fn file_name(self) -> String {
        format!("{}.schema.json", self.name())
    }

    /// Returns the patterns of the names of its files, in any folder.
    pub fn usual_files(self) -> &'static [&'static str] {
        match self {
            FileKind::Job => &["**/job.toml", "**/*-job.toml"],
            FileKind::Experiment => &["**/experiment.toml"],
            FileKind::Decision => &["**/decision.toml", "**/*-decision.toml"],
            FileKind::Effect => &["**/effects/*.toml"],
            FileKind::Map => &["**/map.toml", "**/*-map.toml"],
            FileKind::Model => &["**/model.toml"],
            FileKind::Parameters => &["**/theta.toml"],
        }
    }

    /// Returns the schema, in draft 7 of JSON Schema: the one that editors of TOML read.
    pub fn schema(self) -> Value {
        let mut schema = match self {
            FileKind::Job => job(),
            FileKind::Experiment => from_type::<ExperimentKeys>(),
            FileKind::Decision => decision(),
            FileKind::Effect => effect::effect(),
            FileKind::Map => map::map(),
            FileKind::Model => model(),
            FileKind::Parameters => parameters(),
        };
        schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
        schema["title"] = json!(format!("grouser: {}", self.name()));
        schema
    }

    /// Returns the text of the schema's file.
    ///
    /// # Errors
    /// [`serde_json::Error`] if a value is not representable in JSON; no schema has such a value.
    pub fn text(self) -> serde_json::Result<String> {
        Ok(serde_json::to_string_pretty(&self.schema())? + "\n")
    }
}
