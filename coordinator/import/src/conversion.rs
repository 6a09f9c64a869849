//! The conversion of a file by its map to runs.csv, with every mistake at once.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use crate::binding::Binding;
use crate::complaint::{Complaint, Complaints};
use crate::field::{Field, fields};
use crate::map::{self, Map};
use crate::read::{self, SourceFile};
use crate::recording::Knife;
use crate::rows;
use crate::run::{Run, noted, notes_csv, runs_csv};
use crate::summary;
use crate::table::{Cell, Form, Row};
use crate::title::{self, Titled};

const MAX_RUNS: usize = 10_000;

/// The result of an import.
#[derive(Debug, Clone, Default, PartialEq, Serialize, utoipa::ToSchema)]
pub struct Converted {
    /// The text of runs.csv; null where there are complaints.
    pub runs: Option<String>,
    /// The columns of the file that runs.csv does not have, by run, as CSV; null without any.
    pub notes: Option<String>,
    /// The texts of the histories by their names in runs.csv.
    pub histories: BTreeMap<String, String>,
    /// Number of runs.
    pub run_count: usize,
    /// Remarks for the user: detected properties of the file, omissions, and readings that differ from the file.
    pub remarks: Vec<String>,
    /// All mistakes.
    pub complaints: Vec<Complaint>,
}

/// Converts a file by a map.
///
/// `map` is the name and the text of the map; `stem` is the prefix of the names of histories, equal to that of runs.csv. Nothing is written
/// if there is a mistake. Mistakes of the map do not hide those of cells that can be judged without it. Checked by `tests/mistakes.rs`.
pub fn convert(source: &SourceFile<'_>, map: (&str, &str), stem: &str) -> Converted {
    let mut complaints = Complaints::default();
    let mut converted = Converted::default();
    let fields = fields();
    let (map_file, map_text) = map;
    let map = map::read(map_file, map_text, &fields, &mut complaints);
    let titled =
        read::read(source, &map.hints).and_then(|table| title::find(table, (map.titles, map.units), &fields));
    match titled {
        Ok(titled) => judge(
            &titled,
            (map_file, &map),
            &fields,
            stem,
            &mut converted,
            &mut complaints,
        ),
        Err(complaint) => complaints.add(*complaint),
    }
    converted.complaints = complaints.into_all();
    if !converted.complaints.is_empty() {
        (converted.runs, converted.notes) = (None, None);
        converted.histories.clear();
    }
    converted
}

fn judge(
    titled: &Titled,
    (map_file, map): (&str, &Map),
    fields: &[Field],
    stem: &str,
    converted: &mut Converted,
    complaints: &mut Complaints,
) {
    converted.remarks.clone_from(&titled.table.remarks);
    complain_of_missing(titled, (map_file, map), fields, complaints);
    let rows = chosen(titled, (map_file, map), converted, complaints);
    let binding = Binding::new(
        (map_file, map),
        titled,
        fields,
        &mut converted.remarks,
        complaints,
    );
    let (mut rows, left_out) = binding.chosen(rows);
    if !left_out.is_empty() {
        converted.remarks.push(format!(
            "left out, because a word of theirs means skip: {}",
            lines(left_out.into_iter())
        ));
    }
    if map.recording.is_none() {
        rows = summary::without(titled, rows, &binding, &mut converted.remarks, complaints);
    }
    check_width(titled, &rows, complaints);
    let order = || fields.iter().map(|field| field.name.clone());
    let runs = match &map.recording {
        Some(recording) => {
            let knife = Knife {
                titled,
                binding: &binding,
                recording,
                map_file,
                decimal: map.decimal,
                stem,
            };
            let (runs, histories) = knife.cut(&rows, &mut converted.remarks, complaints);
            converted.histories = histories;
            runs
        }
        None => rows::runs(titled, &rows, &binding, complaints),
    };
    check_count(runs.len(), titled, complaints);
    converted.run_count = runs.len();
    converted.runs = Some(runs_csv(&runs, order()));
    keep_notes(titled, map, &binding, &runs, converted);
    if map.recording.is_none() && !map.columns.iter().any(|entry| entry.name == "run") {
        converted
            .remarks
            .push("the runs are numbered, r1 and so on: the map has no [columns.run]".into());
    }
}

fn check_count(runs: usize, titled: &Titled, complaints: &mut Complaints) {
    if runs == 0 {
        complaints.add(titled.table.complaint("there is no row of data below the titles"));
    }
    if runs > MAX_RUNS {
        complaints.add(titled.table.complaint(format!(
            "{runs} runs must be at most {MAX_RUNS}; for a recording of several runs the map needs [recording]"
        )));
    }
}

/// Keeps the columns that runs.csv does not have as notes; those of a recording are only remarked.
fn keep_notes(titled: &Titled, map: &Map, binding: &Binding, runs: &[Run], converted: &mut Converted) {
    let kept = noted(titled, &binding.mapped);
    if kept.is_empty() {
        return;
    }
    let titles: Vec<String> = kept
        .iter()
        .map(|&column| titled.titles[column].text.clone())
        .collect();
    let listed = titles.join(", ");
    converted.remarks.push(if map.recording.is_none() {
        converted.notes = Some(notes_csv(runs, titles));
        format!("kept as notes, no columns of runs.csv: {listed}")
    } else {
        format!("columns of the recording that runs.csv does not take as they are: {listed}")
    });
}

/// Returns the rows of runs or samples: not skipped, no comments.
fn chosen<'a>(
    titled: &'a Titled,
    (map_file, map): (&str, &Map),
    converted: &mut Converted,
    complaints: &mut Complaints,
) -> Vec<&'a Row> {
    let data_lines: BTreeSet<usize> = titled.data().map(|row| row.line).collect();
    for line in &map.skip {
        if !data_lines.contains(line) {
            let message = format!(
                "skip has {line}, and {} is no row of data",
                titled.table.place(*line)
            );
            complaints.add(Complaint {
                file: map_file.to_owned(),
                message,
                ..Complaint::default()
            });
        }
    }
    let is_comment = |row: &Row| {
        titled.table.form == Form::Lines && matches!(row.cell(0), Cell::Text(text) if text.starts_with('#'))
    };
    let (kept, comments): (Vec<&Row>, Vec<&Row>) = titled
        .data()
        .filter(|row| !map.skip.contains(&row.line))
        .partition(|row| !is_comment(row));
    if !comments.is_empty() {
        converted.remarks.push(format!(
            "comments, left out: lines {}",
            lines(comments.iter().map(|row| row.line))
        ));
    }
    if !map.skip.is_empty() {
        converted.remarks.push(format!(
            "left out, as the map says: {}",
            lines(map.skip.iter().copied())
        ));
    }
    kept
}

/// Returns the numbers of lines in a sentence.
fn lines(numbers: impl Iterator<Item = usize>) -> String {
    numbers
        .map(|line| line.to_string())
        .collect::<Vec<_>>()
        .join(", ")
}

/// The rows of a text with more or fewer fields than titles.
fn check_width(titled: &Titled, rows: &[&Row], complaints: &mut Complaints) {
    if titled.table.form != Form::Lines || titled.title_line == 0 {
        return;
    }
    let title_row = titled.table.rows.iter().find(|row| row.line == titled.title_line);
    let width = title_row.map_or(0, |row| row.cells.len());
    for row in rows {
        let filled = row
            .cells
            .iter()
            .rposition(|cell| !cell.is_blank())
            .map_or(0, |k| k + 1);
        if filled > width || row.cells.len() < width {
            let message = format!(
                "{} fields where the titles have {width}: is a decimal comma taken for a separator? Put such fields in quotes, or state `separator` in the map",
                row.cells.len()
            );
            complaints.add_cell(Complaint {
                line: Some(row.line),
                ..titled.table.complaint(message)
            });
        }
    }
}

/// The columns that runs.csv needs and the map lacks.
fn complain_of_missing(
    titled: &Titled,
    (map_file, map): (&str, &Map),
    fields: &[Field],
    complaints: &mut Complaints,
) {
    let has = |name: &str| map.columns.iter().any(|entry| entry.name == name);
    for field in fields
        .iter()
        .filter(|field| field.is_needed && !has(&field.name) && !complaints.concerns(&field.name))
        .collect::<Vec<_>>()
    {
        let near = titled
            .titles
            .iter()
            .find(|title| field.titles.iter().any(|name| *name == title.name.to_lowercase()));
        let fix = near.map_or_else(
            || format!("add `[columns.{}]` with column, value or formula", field.name),
            |near| {
                format!(
                    "did you mean `[columns.{}]` with `column = \"{}\"`",
                    field.name, near.text
                )
            },
        );
        complaints.add(Complaint {
            file: map_file.to_owned(),
            field: Some(field.name.clone()),
            message: format!("the map has no {}, which every run needs: {fix}", field.words),
            ..Complaint::default()
        });
    }
    let channels = shared::channel::Channel::ALL.map(|channel| channel.column());
    if !channels.iter().any(|name| has(name) || complaints.concerns(name)) {
        complaints.add(Complaint {
            file: map_file.to_owned(),
            message: format!(
                "the map has no measured channel: at least one of {} is needed",
                channels.join(", ")
            ),
            ..Complaint::default()
        });
    }
}
