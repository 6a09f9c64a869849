//! The schema of an effect's file.

use formula::Hook;
use formula::effect::Mechanism;
use serde_json::{Value, json};

/// Returns the schema of the whole file.
pub(super) fn effect() -> Value {
    let mechanisms: Vec<&str> = Mechanism::ALL.iter().map(|mechanism| mechanism.name()).collect();
    let formula = json!({ "description": "A formula.", "type": "string" });
    let parameter = json!({
        "description": "A parameter of the formulas.",
        "type": "object",
        "properties": {
            "unit": { "description": "SI unit, as \"m/s\"; \"1\" for a pure number.", "type": "string" },
            "neutral": { "description": "Value at which the effect is absent; it marks a strength.", "type": "number" },
            "typical": { "description": "Value at which tables show the effect.", "type": "number" },
            "prior": {
                "description": "Value or prior if the job does not state the parameter.",
                "allOf": [{ "$ref": "#/definitions/prior" }],
            },
        },
        "required": ["unit", "prior"],
        "additionalProperties": false,
    });
    let mut effect = json!({
        "description": "An effect.",
        "type": "object",
        "properties": {
            "name": {
                "description": "Name in jobs and results: lower-case letters, digits and _, a letter first.", "type": "string",
            },
            "summary": { "description": "The effect in one line.", "type": "string" },
            "source": { "description": "Publication or data that the effect comes from.", "type": "string" },
            "mechanism": {
                "description": "In the catalogue alone.", "type": "string", "enum": mechanisms,
            },
            "definitions": { "description": "Named parts of formulas.", "type": "object", "additionalProperties": formula },
            "parameters": {
                "description": "Parameters of the formulas.", "type": "object", "additionalProperties": parameter,
            },
        },
        "required": ["name", "summary", "source"],
        "additionalProperties": false,
        "definitions": { "prior": job::schema::prior() },
    });
    for hook in Hook::ALL {
        let words = format!(
            "Formula of {} in {}, {}.",
            hook.name(),
            hook.target().unit_name(),
            hook.bound()
        );
        effect["properties"][hook.name()] = json!({ "description": words, "type": "string" });
    }
    effect
}
