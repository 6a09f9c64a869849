//! The schema of the table `[model]`, and of each of `[[models]]`.

use formula::catalogue::catalogue;
use serde_json::{Value, json};
use shared::channel::Channel;
use shared::model::{ModelKind, RunInput, SpatialSettings, grouser_key};

use crate::derived_schema::from_type;

use super::prior::{DOTTED, JobParameter, names_of};

/// Returns the schema of `[model]`: the keys of all kinds of models in one table, and parameters with fixed values.
pub fn model() -> Value {
    let list = |words: &str, items: Value| json!({ "description": words, "type": "array", "items": items, "uniqueItems": true });
    let one_of = |words: &[&str]| json!({ "type": "string", "enum": words });
    let text = || json!({ "type": "string" });
    let kinds: Vec<&str> = ModelKind::ALL.iter().map(|kind| kind.name()).collect();
    let inputs: Vec<&str> = RunInput::ALL.iter().map(|input| input.name()).collect();
    let effects: Vec<&str> = catalogue().iter().map(|effect| effect.name.as_str()).collect();
    let mut properties = json!({
        "kind": { "description": "Forward model.", "type": "string", "enum": kinds },
        "effects": list("Effects of the catalogue.", one_of(&effects)),
        "effect_files": list("Files of further effects.", text()),
        grouser_key::KEY: {
            "description": "quasi_static: whether the grousers that wheels have are ignored (a smooth rim) or rolled.",
            "type": "string", "enum": grouser_key::WORDS, "default": grouser_key::WORDS[0],
        },
        "program": { "description": "command: name of the program's file; the worker's operator states its folder.", "type": "string" },
        "url": { "description": "umbridge: URL of the server.", "type": "string" },
        "model": { "description": "umbridge: name of the model on the server.", "type": "string" },
        "version": {
            "description": "command, umbridge: version of the model; letters, digits, \".\", \"_\" and \"-\".", "type": "string",
        },
        "inputs": list("command, umbridge: properties of a run, in the order of the model's inputs.", one_of(&inputs)),
        "parameters": list("command, umbridge: parameters in the order of the model's inputs, \"name [unit]\".", text()),
        "outputs": list("command, umbridge: channels in the order of the model's outputs.", one_of(&Channel::ALL.map(Channel::column))),
        "time_s": {
            "description": "command, umbridge: longest time of one run [s].", "type": "number", "exclusiveMinimum": 0, "default": 60.0,
        },
        "memory_mb": {
            "description": "command: address space of the program [MB].", "type": "integer", "minimum": 1, "default": 4096,
        },
    });
    let spatial = from_type::<SpatialSettings>();
    for (key, shape) in spatial["properties"].as_object().into_iter().flatten() {
        properties[key] = shape.clone();
        properties[key]["description"] =
            format!("scm: {}", shape["description"].as_str().unwrap_or_default()).into();
    }
    for parameter in JobParameter::all() {
        properties[&parameter.name] = parameter.value();
    }
    let mut model = json!({
        "description": "The forward model, with parameters that are fixed.",
        "type": "object",
        "properties": properties,
        "required": ["kind"],
        "patternProperties": { DOTTED: { "type": "number" } },
        // The names of an external model's parameters are stated by the job.
        "additionalProperties": { "type": "number" },
        "if": is_external(),
    });
    model["else"] = json!({ "propertyNames": names_of(&model) });
    model
}

/// Returns the schema that a table `[model]` of an external model satisfies.
pub(super) fn is_external() -> Value {
    let external = ModelKind::ALL.iter().filter(|kind| kind.is_external());
    let names: Vec<&str> = external.map(|kind| kind.name()).collect();
    json!({ "properties": { "kind": { "enum": names } }, "required": ["kind"] })
}
