//! JSON schemas of jobs, models and parameters, so that editors complete and check these files.
//!
//! # Layout
//! - `model`: the table `[model]`. `prior`: parameters with their values and priors. `sampler`: the table `[sampler]`.

mod model;
mod prior;
mod sampler;

pub use model::model;
pub use prior::{parameters, prior};

use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use schemars::{JsonSchema, Schema};
use serde_json::{Value, json};

use crate::job::RawJob;

/// Returns the schema of the type that reads a file or a table, in draft 7 of JSON Schema: the one that editors of TOML read.
pub fn from_type<T: JsonSchema>() -> Value {
    let mut settings = SchemaSettings::draft07().with_transform(RecursiveTransform(simplify));
    settings.inline_subschemas = true;
    settings.into_generator().into_root_schema_for::<T>().to_value()
}

/// Returns the schema of `job.toml`.
pub fn job() -> Value {
    let mut compared = model();
    let priors = json!([{ "$ref": "#/definitions/priors" }]);
    compared["properties"]["priors"] =
        json!({ "description": "Priors of this model alone.", "allOf": priors });
    compared["else"] = json!({ "propertyNames": prior::names_of(&compared) });
    let mut job = from_type::<RawJob>();
    let tables = &mut job["properties"];
    tables["model"] = json!({ "$ref": "#/definitions/model" });
    tables["models"]["items"] = compared;
    tables["priors"] = json!({ "$ref": "#/definitions/priors" });
    tables["sampler"] = sampler::sampler();
    tables["discovery"]["properties"]["priors"] = prior::candidate_priors();
    let external = model::is_external();
    job["if"] = json!({ "anyOf": [
        { "properties": { "model": external }, "required": ["model"] },
        { "properties": { "models": { "contains": external } }, "required": ["models"] },
    ] });
    let priors = prior::priors();
    job["else"] = json!({ "properties": { "priors": { "propertyNames": prior::names_of(&priors) } } });
    job["definitions"] = json!({ "model": model(), "priors": priors, "prior": prior() });
    job
}

/// Removes the null that TOML does not have and defaults that are tables, and lists the words of an enumeration under `enum`.
fn simplify(schema: &mut Schema) {
    let Some(schema) = schema.as_object_mut() else {
        return;
    };
    for key in ["anyOf", "oneOf"] {
        let Some(Value::Array(mut shapes)) = schema.remove(key) else {
            continue;
        };
        shapes.retain(|shape| shape["type"] != "null");
        let words: Option<Vec<&Value>> = shapes.iter().map(|shape| shape.get("const")).collect();
        if let Some(words) = words {
            let words = json!(words);
            schema.extend([("type".to_owned(), json!("string")), ("enum".to_owned(), words)]);
        } else if let [Value::Object(only)] = &mut shapes[..] {
            only.append(schema);
            schema.append(only);
        } else {
            schema.insert(key.to_owned(), shapes.into());
        }
    }
    for key in ["type", "enum"] {
        if let Some(Value::Array(alternatives)) = schema.get_mut(key) {
            alternatives.retain(|value| value != "null" && !value.is_null());
            if let ("type", [only]) = (key, &alternatives[..]) {
                schema[key] = only.clone();
            }
        }
    }
    schema.retain(|key, value| key != "default" || !(value.is_null() || value.is_object()));
}
