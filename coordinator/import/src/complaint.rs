//! What is wrong with a file or a map: where, what was expected, and the nearest fix.

use serde::Serialize;
use shared::sentence::one_line;

/// Most complaints about the cells of one column; the rest are counted.
const MOST_OF_A_COLUMN: usize = 10;

/// What removes a mistake without a look into the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, utoipa::ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Fix {
    /// The row of `line` is left out, by `skip` of the map.
    Skip,
    /// A blank cell of `field` has the value of the cell above, by `fill_down` of the map.
    FillDown,
}

/// One mistake of a file or of its map.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, utoipa::ToSchema)]
pub struct Complaint {
    /// The file, as the user wrote it.
    pub file: String,
    /// The sheet, of a file with sheets.
    pub sheet: Option<String>,
    /// The line of a text, or the row of a variable, counted from 1.
    pub line: Option<usize>,
    /// The cell of a sheet: `C7`.
    pub cell: Option<String>,
    /// The title of the column in the file.
    pub column: Option<String>,
    /// The column of runs.csv, or the name of the map's table, that is concerned.
    pub field: Option<String>,
    /// What is wrong, what was expected, and the nearest fix.
    pub message: String,
    /// The same for people who see no map, where `message` names its keys; else null.
    pub plain: Option<String>,
    /// What removes the mistake, where one change of the map does.
    pub fix: Option<Fix>,
    /// The cells of the row that the fix leaves out, the first of them.
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
    /// By field: how many cells, and where the last one that is shown stands.
    of_cells: Vec<(Option<String>, usize, Complaint)>,
    /// The cells of the last row that has any, by its line and the field.
    last_cells: Vec<(usize, Option<String>)>,
}

impl Complaints {
    pub(crate) fn add(&mut self, complaint: Complaint) {
        self.all.push(complaint);
    }

    /// Adds a complaint about a cell.
    pub(crate) fn add_cell(&mut self, complaint: Complaint) {
        let line = complaint.line.unwrap_or(0);
        self.last_cells.retain(|(last, _)| *last == line);
        self.last_cells.push((line, complaint.field.clone()));
        let key = (&complaint.field, &complaint.column);
        let known = self
            .of_cells
            .iter_mut()
            .find(|(field, _, last)| (field, &last.column) == key);
        let count = match known {
            Some((_, count, _)) => {
                *count += 1;
                *count
            }
            None => {
                self.of_cells
                    .push((complaint.field.clone(), 1, complaint.clone()));
                1
            }
        };
        if count <= MOST_OF_A_COLUMN {
            self.all.push(complaint);
        }
    }

    /// Those about the fields of the map that are known to be wrong.
    pub(crate) fn concerns(&self, field: &str) -> bool {
        self.all
            .iter()
            .any(|complaint| complaint.field.as_deref() == Some(field))
    }

    /// Whether the last complaints are about a row's cell of a column.
    pub(crate) fn is_said(&self, line: usize, field: &str) -> bool {
        self.last_cells
            .iter()
            .any(|(at, name)| *at == line && name.as_deref() == Some(field))
    }

    /// All of them, and how many more there are of a column.
    pub(crate) fn into_all(mut self) -> Vec<Complaint> {
        for (_, count, first) in self.of_cells {
            if count > MOST_OF_A_COLUMN {
                let message = format!(
                    "{} more cells of this column have mistakes",
                    count - MOST_OF_A_COLUMN
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
