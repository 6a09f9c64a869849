//! JSON schemas of jobs, models and parameters, so that editors complete and check these files.
//!
//! # Layout
//! - `model`: the table `[model]`. `prior`: parameters with their values and priors. `sampler`: the table `[sampler]`.

mod model;
mod prior;
mod sampler;

pub use crate::derived_schema::from_type;
pub use model::model;
pub use prior::{parameters, prior};

use serde_json::{Value, json};

use crate::job::RawJob;

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
