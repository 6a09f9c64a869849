//! The map of an import.

use serde_json::{Value, json};

use super::shape::{either, flag, list, named, needing, one_of, said, table, text, whole};

/// The whole file.
pub(super) fn map() -> Value {
    let columns = import::columns();
    let columns = columns.map(|(name, words)| (name, said(origin(), &words)));
    let marks = [",", "."];
    table(
        "where each column of runs.csv comes from",
        [
            (
                "sheet",
                number_or_text(
                    "sheet of a spreadsheet, or struct of a MATLAB file: its name, or its number from 1",
                ),
            ),
            (
                "encoding",
                text("encoding of a text, as \"windows-1252\"; found where nothing is said"),
            ),
            (
                "separator",
                one_of("between the fields of a text", [",", ";", "|", "tab", "space"]),
            ),
            (
                "titles",
                whole("line of the titles; 0 where there are none", 0, None),
            ),
            (
                "units",
                whole("line of the units; 0 where there is none", 0, None),
            ),
            (
                "decimal",
                one_of("mark before the decimals of numbers that are texts", marks),
            ),
            ("thousands", one_of("mark between thousands", marks)),
            (
                "skip",
                list("lines that are no runs, as means", whole("a line", 1, None)),
            ),
            (
                "missing",
                list(
                    "what stands for a value that was not measured",
                    number_or_text("a word"),
                ),
            ),
            ("columns", table("the columns of runs.csv", columns)),
            ("quantities", named("names for formulas", origin())),
            ("recording", recording()),
        ],
    )
}

/// A table of `[columns]` or `[quantities]`.
fn origin() -> Value {
    let mut origin = table(
        "one of column, value and formula",
        [
            ("column", text("title of the column, or its letters")),
            ("value", number_or_text("the same in all rows")),
            (
                "formula",
                text("SI units, angles in rad; names are quantities and other columns"),
            ),
            ("unit", text("unit of the column or value")),
            ("decimal", one_of("mark of this column", [",", "."])),
            (
                "fill_down",
                flag("whether a blank cell has the value of the cell above"),
            ),
        ],
    );
    let one = ["column", "value", "formula"].map(|key| json!({ "required": [key] }));
    origin["oneOf"] = json!(one);
    origin
}

fn recording() -> Value {
    let mut window = list(
        "part of each run that counts, from its start [s]",
        json!({ "type": "number", "minimum": 0 }),
    );
    window["minItems"] = json!(2);
    window["maxItems"] = json!(2);
    let recording = table(
        "cuts runs from one recording",
        [
            ("time", text("column of the time")),
            ("time_unit", text("unit of the time")),
            ("marker", text("column that changes from run to run")),
            (
                "between",
                list("values of the marker between the runs", number_or_text("a value")),
            ),
            ("window_s", window),
            ("histories", flag("whether a history is written for each run")),
        ],
    );
    needing(recording, &["time", "time_unit", "marker"])
}

fn number_or_text(words: &str) -> Value {
    let types = ["number", "string"].map(|kind| json!({ "type": kind }));
    either(words, types.into())
}
