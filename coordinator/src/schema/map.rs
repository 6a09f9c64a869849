//! The schema of the map of an import.

use serde_json::{Map, Value, json};

/// Returns the schema of the whole file.
pub(super) fn map() -> Value {
    let number_or_text = json!([{ "type": "number" }, { "type": "string" }]);
    let marks = [",", "."];
    let kinds = ["column", "value", "formula"].map(|key| json!({ "required": [key] }));
    let origin = |words: &str| {
        json!({
            "description": words,
            "type": "object",
            "properties": {
                "column": { "description": "Title of the column, or its letters.", "type": "string" },
                "value": { "description": "Value of all rows.", "anyOf": number_or_text },
                "formula": {
                    "description": "Formula in SI units, angles in rad; its names are quantities and other columns.", "type": "string",
                },
                "unit": { "description": "Unit of the column or value.", "type": "string" },
                "decimal": { "description": "Decimal mark of this column.", "type": "string", "enum": marks },
                "fill_down": { "description": "Whether a blank cell has the value of the cell above.", "type": "boolean" },
            },
            "additionalProperties": false,
            "oneOf": kinds,
        })
    };
    let columns: Map<String, Value> = import::columns()
        .map(|(name, words)| (name.to_owned(), origin(&words)))
        .collect();
    json!({
        "description": "The origin of each column of runs.csv: one of column, value and formula.",
        "type": "object",
        "properties": {
            "sheet": {
                "description": "Sheet of a spreadsheet, or struct of a MATLAB file: its name, or its number from 1.",
                "anyOf": number_or_text,
            },
            "encoding": {
                "description": "Encoding of a text, as \"windows-1252\"; detected if it is not stated.", "type": "string",
            },
            "separator": {
                "description": "Separator of the fields of a text.", "type": "string", "enum": [",", ";", "|", "tab", "space"],
            },
            "titles": { "description": "Line of the titles; 0 if there are none.", "type": "integer", "minimum": 0 },
            "units": { "description": "Line of the units; 0 if there is none.", "type": "integer", "minimum": 0 },
            "decimal": { "description": "Decimal mark of numbers that are texts.", "type": "string", "enum": marks },
            "thousands": { "description": "Mark between thousands.", "type": "string", "enum": marks },
            "skip": {
                "description": "Lines that are no runs, as means.",
                "type": "array", "items": { "type": "integer", "minimum": 1 }, "uniqueItems": true,
            },
            "missing": {
                "description": "Entries that stand for a value that was not measured.",
                "type": "array", "items": { "anyOf": number_or_text }, "uniqueItems": true,
            },
            "columns": {
                "description": "The columns of runs.csv.", "type": "object", "properties": columns, "additionalProperties": false,
            },
            "quantities": {
                "description": "Names for formulas.", "type": "object",
                "additionalProperties": origin("One of column, value and formula."),
            },
            "recording": {
                "description": "Cuts runs from one recording.",
                "type": "object",
                "properties": {
                    "time": { "description": "Column of the time.", "type": "string" },
                    "time_unit": { "description": "Unit of the time.", "type": "string" },
                    "marker": { "description": "Column that changes from run to run.", "type": "string" },
                    "between": {
                        "description": "Values of the marker between the runs.",
                        "type": "array", "items": { "anyOf": number_or_text }, "uniqueItems": true,
                    },
                    "window_s": {
                        "description": "Interval of each run that is averaged, from its start [s].",
                        "type": "array", "items": { "type": "number", "minimum": 0 }, "minItems": 2, "maxItems": 2, "uniqueItems": true,
                    },
                    "histories": { "description": "Whether a history is written for each run.", "type": "boolean" },
                },
                "required": ["time", "time_unit", "marker"],
                "additionalProperties": false,
            },
        },
        "additionalProperties": false,
    })
}
