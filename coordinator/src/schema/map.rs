//! The schema of the map of an import.

use serde_json::{Map, Value, json};

/// Decimal marks.
const MARKS: [&str; 2] = [",", "."];

fn number_or_text() -> Value {
    json!([{ "type": "number" }, { "type": "string" }])
}

/// Returns the schema of the layout of a file.
fn layout() -> Value {
    json!({
        "sheet": {
            "description": "Sheet of a spreadsheet, struct of a MATLAB file, topic of a bag: its name, or the number of a sheet from 1.",
            "anyOf": number_or_text(),
        },
        "encoding": {
            "description": "Encoding of a text, as \"windows-1252\"; detected if it is not stated.", "type": "string",
        },
        "separator": {
            "description": "Separator of the fields of a text.", "type": "string", "enum": [",", ";", "|", "tab", "space"],
        },
        "titles": { "description": "Line of the titles; 0 if there are none.", "type": "integer", "minimum": 0 },
        "units": { "description": "Line of the units; 0 if there is none.", "type": "integer", "minimum": 0 },
        "decimal": { "description": "Decimal mark of numbers that are texts.", "type": "string", "enum": MARKS },
    })
}

/// Returns the schema of a joined file.
fn join(mut properties: Value) -> Value {
    properties["file"] = json!({
        "description": "Name of the file beside the recording, with {places}; {stem} is the recording's name without its ending.",
        "type": "string",
    });
    properties["time"] = json!({ "description": "Column of its time.", "type": "string" });
    properties["time_unit"] = json!({ "description": "Unit of its time.", "type": "string" });
    properties["offset_s"] =
        json!({ "description": "Time that is added to its times [s].", "type": "number" });
    properties["from_start"] = json!({
        "description": "Whether both files begin at the same time.", "type": "boolean",
    });
    json!({
        "description": "A file whose columns join those of a recording on time.",
        "type": "object",
        "properties": properties,
        "required": ["file", "time", "time_unit"],
        "additionalProperties": false,
    })
}

/// Returns the schema of the whole file.
pub(super) fn map() -> Value {
    let number_or_text = number_or_text();
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
                "decimal": { "description": "Decimal mark of this column.", "type": "string", "enum": MARKS },
                "from": { "description": "Name of the joined file that has the column.", "type": "string" },
                "zero_line": {
                    "description": "Line of the reading at rest, which is subtracted from the column.", "type": "integer", "minimum": 0,
                },
                "zero_file": {
                    "description": "File beside the recording, with {places}, whose mean is subtracted from the column.", "type": "string",
                },
                "fill_down": { "description": "Whether a blank cell has the value of the cell above.", "type": "boolean" },
            },
            "additionalProperties": false,
            "oneOf": kinds,
        })
    };
    let layout = layout();
    let columns: Map<String, Value> = import::columns()
        .map(|(name, words)| (name.to_owned(), origin(&words)))
        .collect();
    json!({
        "description": "The origin of each column of runs.csv: one of column, value and formula.",
        "type": "object",
        "properties": {
            "file": {
                "description": "Names of the files that are recordings; {places} are what a name says, for values.", "type": "string",
            },
            "sheet": layout["sheet"],
            "encoding": layout["encoding"],
            "separator": layout["separator"],
            "titles": layout["titles"],
            "units": layout["units"],
            "decimal": layout["decimal"],
            "thousands": { "description": "Mark between thousands.", "type": "string", "enum": MARKS },
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
                    "while": {
                        "description": "Condition that holds during a run, over quantities and mapped columns in SI units.", "type": "string",
                    },
                    "shortest_s": {
                        "description": "Time below which a run is none, and an interruption does not end one [s].",
                        "type": "number", "exclusiveMinimum": 0,
                    },
                    "window_s": {
                        "description": "Interval of each run that is averaged, from its start [s].",
                        "type": "array", "items": { "type": "number", "minimum": 0 }, "minItems": 2, "maxItems": 2, "uniqueItems": true,
                    },
                    "step_s": {
                        "description": "Equal step of the histories [s]; the usual one of a recording with unequal steps if it is not stated.",
                        "type": "number", "exclusiveMinimum": 0,
                    },
                    "histories": { "description": "Whether a history is written for each run.", "type": "boolean" },
                },
                "required": ["time", "time_unit"],
                "additionalProperties": false,
            },
            "join": {
                "description": "Files whose columns join those of a recording on time.", "type": "object",
                "additionalProperties": join(layout),
            },
        },
        "additionalProperties": false,
    })
}
