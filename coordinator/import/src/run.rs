//! The runs of an import, and the files that are written from them.

use std::collections::{BTreeMap, BTreeSet};

use crate::complaint::Complaint;
use crate::table::Row;
use crate::title::Titled;

/// Significant digits of a converted number: the product with a factor may be wrong in the sixteenth.
const DIGITS: usize = 12;

/// One row of runs.csv.
#[derive(Debug, Clone, Default)]
pub(crate) struct Run {
    /// The row of the file that contains the run, or with which the run begins.
    pub(crate) line: usize,
    pub(crate) name: String,
    /// Values by column of runs.csv; a blank one is absent.
    pub(crate) cells: BTreeMap<String, String>,
    /// Cells of the columns that runs.csv does not have, in the order of the file.
    pub(crate) notes: Vec<String>,
}

pub(crate) fn shown(value: f64) -> String {
    let rounded = format!("{value:.*e}", DIGITS - 1).parse::<f64>().unwrap_or(value);
    rounded.to_string()
}

/// Returns the columns of the file that runs.csv does not have and that are not blank.
pub(crate) fn noted(titled: &Titled, mapped: &BTreeSet<usize>) -> Vec<usize> {
    let is_filled = |column: &usize| titled.data().any(|row| !row.cell(*column).is_blank());
    (0..titled.titles.len())
        .filter(|column| !mapped.contains(column))
        .filter(is_filled)
        .collect()
}

pub(crate) fn notes_of(row: &Row, columns: &[usize]) -> Vec<String> {
    columns.iter().map(|&column| row.cell(column).shown()).collect()
}

/// Returns complaints about runs of the same name.
pub(crate) fn repeated(titled: &Titled, runs: &[Run]) -> Vec<Complaint> {
    let mut first: BTreeMap<&str, usize> = BTreeMap::new();
    let mut complaints = Vec::new();
    for run in runs {
        if let Some(line) = first.get(run.name.as_str()) {
            let message = format!(
                "run \"{}\" is named in {} too: give each run a name of its own, or leave [columns.run] out to have them numbered",
                run.name,
                titled.table.place(*line)
            );
            complaints.push(Complaint {
                line: Some(run.line),
                field: Some("run".into()),
                ..titled.table.complaint(message)
            });
        } else {
            first.insert(&run.name, run.line);
        }
    }
    complaints
}

/// Returns a field of CSV; a field that would look like a comment is quoted.
fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r', '#']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

pub(crate) fn csv(rows: impl Iterator<Item = Vec<String>>) -> String {
    let line = |row: Vec<String>| row.iter().map(|text| field(text)).collect::<Vec<_>>().join(",") + "\n";
    rows.map(line).collect()
}

/// Returns the text of runs.csv, with the columns of `order` that any run has.
pub(crate) fn runs_csv(runs: &[Run], order: impl Iterator<Item = String>) -> String {
    let columns: Vec<String> = order
        .filter(|name| name == "run" || runs.iter().any(|run| run.cells.contains_key(name)))
        .collect();
    let cell = |run: &Run, name: &String| {
        if name == "run" {
            run.name.clone()
        } else {
            run.cells.get(name).cloned().unwrap_or_default()
        }
    };
    let rows = runs
        .iter()
        .map(|run| columns.iter().map(|name| cell(run, name)).collect());
    csv(std::iter::once(columns.clone()).chain(rows))
}

/// Returns the text of the notes: the name of each run, and the columns of its row that runs.csv does not have.
pub(crate) fn notes_csv(runs: &[Run], titles: Vec<String>) -> String {
    let header = std::iter::once("run".to_owned()).chain(titles).collect();
    let rows = runs.iter().map(|run| {
        std::iter::once(run.name.clone())
            .chain(run.notes.iter().cloned())
            .collect()
    });
    csv(std::iter::once(header).chain(rows))
}
