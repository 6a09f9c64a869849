//! JSON schemas of the files that people write, so that editors complete and check them.
//!
//! They say what a table alone can say: keys, types, words, bounds. What needs two files, or arithmetic, is the reader's. Names, words
//! and defaults come from the code that reads; the tests ask that code for the rest.
//!
//! # Layout
//! - `shape`: numbers, words, lists, tables.
//! - `prior`: parameters with their values and priors.
//! - `model`: the table `[model]`.
//! - `job`, `experiment`, `effect`, `map`: the files.

mod effect;
mod experiment;
mod job;
mod map;
mod model;
mod prior;
mod shape;
#[cfg(test)]
mod tests;

use serde_json::{Value, json};

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum FileKind {
    /// A calibration: `job.toml`.
    Job,
    /// Wheels, soils, rig and noise: `experiment.toml`.
    Experiment,
    /// An effect.
    Effect,
    /// The map of an import.
    Map,
    /// The model of forward runs.
    Model,
    /// The parameters of forward runs.
    Parameters,
}

impl FileKind {
    /// Every kind.
    pub const ALL: [FileKind; 6] = [
        FileKind::Job,
        FileKind::Experiment,
        FileKind::Effect,
        FileKind::Map,
        FileKind::Model,
        FileKind::Parameters,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            FileKind::Job => "job",
            FileKind::Experiment => "experiment",
            FileKind::Effect => "effect",
            FileKind::Map => "map",
            FileKind::Model => "model",
            FileKind::Parameters => "parameters",
        }
    }

    /// Name of the file of its schema.
    pub fn file_name(self) -> String {
        format!("{}.schema.json", self.name())
    }

    /// Files that have it by their names, wherever they lie.
    pub fn usual_files(self) -> &'static [&'static str] {
        match self {
            FileKind::Job => &["**/job.toml", "**/*-job.toml"],
            FileKind::Experiment => &["**/experiment.toml"],
            FileKind::Effect => &["**/effects/*.toml"],
            FileKind::Map => &["**/map.toml", "**/*-map.toml"],
            FileKind::Model => &["**/model.toml"],
            FileKind::Parameters => &["**/theta.toml"],
        }
    }

    /// Its schema, in draft 7 of JSON Schema: the one that editors of TOML read.
    pub fn schema(self) -> Value {
        let mut schema = match self {
            FileKind::Job => job::job(),
            FileKind::Experiment => experiment::experiment(),
            FileKind::Effect => effect::effect(),
            FileKind::Map => map::map(),
            FileKind::Model => model::model(),
            FileKind::Parameters => prior::file_of_values(),
        };
        schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
        schema["title"] = json!(format!("grouser: {}", self.name()));
        schema
    }

    /// The text of its file.
    ///
    /// # Errors
    /// None that is known: a schema has neither maps with other keys than texts nor numbers that JSON lacks.
    pub fn text(self) -> serde_json::Result<String> {
        Ok(serde_json::to_string_pretty(&self.schema())? + "\n")
    }
}
