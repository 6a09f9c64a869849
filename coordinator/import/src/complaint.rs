//! A complaint: a mistake in a file or a map with its place, the expectation, and the nearest fix.

use std::collections::BTreeSet;

use serde::Serialize;
use shared::sentence::one_line;

/// Maximum number of complaints about the cells of one column; the rest are counted.
const MAX_OF_A_COLUMN: usize = 10;

/// A change of the map that removes a mistake without a change of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, utoipa::ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Fix {
    /// Leaves out the row of `line`, by `skip` of the map.
    Skip,
    /// Fills a blank cell of `field` from the cell above, by `fill_down` of the map.
    FillDown,
}

/// One mistake of a file or of its map.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct Complaint {
    /// Name of the file as the user wrote it.
    pub file: String,
    /// Name of the sheet, if the file has sheets.
    pub sheet: Option<String>,
    /// The line of a text, or the row of a variable, counted from 1.
    pub line: Option<usize>,
    /// The cell of a sheet: `C7`.
    pub cell: Option<String>,
    /// The title of the column in the file.
    pub column: Option<String>,
    /// The column of runs.csv, or the name of the map's table, that is concerned.
    pub field: Option<String>,
    /// The mistake, the expectation, and the nearest fix.
    pub message: String,
    /// The message for users who see no map, if `message` names keys of it; else null.
    pub plain: Option<String>,
    /// The fix, if one change of the map suffices.
    pub fix: Option<Fix>,
    /// The first cells of the row that the fix leaves out.
    pub row: Vec<String>,
}

impl std::fmt::Display for Complaint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut place = self.file.clone();
        if let Some(sheet) = &self.sheet {
            place += &format!(", sheet \"{sheet}\"");
        }
        match (&self.cell, self.line) {
            (Some(cell), _) => place += &format!(", cell {cell}"),
            (None, Some(line)) => place += &format!(" line {line}"),
            (None, None) => {}
        }
        if let Some(column) = &self.column {
            place += &format!(", column \"{column}\"");
        }
        f.write_str(&one_line(&format!("{place}: {}", self.message)))
    }
}

/// All complaints, those about the cells of one column bounded in number.
#[derive(Debug, Default)]
pub(crate) struct Complaints {
    all: Vec<Complaint>,
    /// The complaints so far. Several files may have the same mistake of the map, which is told once.
    said: BTreeSet<String>,
    /// For each field: number of complaints, and the last complaint shown.
    by_field: Vec<(Option<String>, usize, Complaint)>,
    /// The cells of the last row that has any, by its line and the field.
    last_cells: Vec<(usize, Option<String>)>,
}

impl Complaints {
    /// Adds a complaint, unless the same one is there.
    pub(crate) fn add(&mut self, complaint: Complaint) {
        if self.said.insert(complaint.to_string()) {
            self.all.push(complaint);
        }
    }

    /// Returns the number of complaints.
    pub(crate) fn len(&self) -> usize {
        self.all.len()
    }

    pub(crate) fn add_cell(&mut self, complaint: Complaint) {
        let line = complaint.line.unwrap_or(0);
        self.last_cells.retain(|(last, _)| *last == line);
        self.last_cells.push((line, complaint.field.clone()));
        let key = (&complaint.field, &complaint.column);
        let entry = self
            .by_field
            .iter_mut()
            .find(|(field, _, last)| (field, &last.column) == key);
        let count = match entry {
            Some((_, count, _)) => {
                *count += 1;
                *count
            }
            None => {
                self.by_field
                    .push((complaint.field.clone(), 1, complaint.clone()));
                1
            }
        };
        if count <= MAX_OF_A_COLUMN {
            self.all.push(complaint);
        }
    }

    /// Returns the complaints about the fields of the map that are known to be wrong.
    pub(crate) fn concerns(&self, field: &str) -> bool {
        self.all
            .iter()
            .any(|complaint| complaint.field.as_deref() == Some(field))
    }

    /// Returns whether the last complaints concern a row's cell of a column.
    pub(crate) fn is_said(&self, line: usize, field: &str) -> bool {
        self.last_cells
            .iter()
            .any(|(at, name)| *at == line && name.as_deref() == Some(field))
    }

    /// Returns all complaints, with the number that is left out for each column.
    pub(crate) fn into_all(mut self) -> Vec<Complaint> {
        for (_, count, first) in self.by_field {
            if count > MAX_OF_A_COLUMN {
                let message = format!(
                    "{} more cells of this column have mistakes",
                    count - MAX_OF_A_COLUMN
                );
                self.all.push(Complaint {
                    message,
                    file: first.file,
                    sheet: first.sheet,
                    column: first.column,
                    field: first.field,
                    ..Complaint::default()
                });
            }
        }
        self.all
    }
}
