//! A table of cells with their places, from a file of any format.

use crate::complaint::Complaint;

/// Maximum number of columns of a table: a rig has some dozens, and each is compared with every column of runs.csv.
pub(crate) const MAX_COLUMNS: usize = 20_000;
/// Number of cells of a row that are shown to identify it.
const SHOWN_CELLS: usize = 12;

/// Returns the message that refuses a table with this many columns.
pub(crate) fn too_wide(columns: usize) -> String {
    format!(
        "{columns} columns must be at most {MAX_COLUMNS}: a table has a column for each quantity, and a row for each run"
    )
}

/// Returns a text with every run of spaces and line breaks reduced to one space.
pub(crate) fn spaced(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The content of a cell.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Cell {
    Blank,
    Number(f64),
    Text(String),
    /// A formula without a stored result.
    NoResult,
}

impl Cell {
    /// Returns a cell of a text without the spaces around it.
    pub(crate) fn from_text(text: &str) -> Cell {
        match text.trim() {
            "" => Cell::Blank,
            text => Cell::Text(text.to_owned()),
        }
    }

    pub(crate) fn is_blank(&self) -> bool {
        *self == Cell::Blank
    }

    /// Returns the text that users read in it.
    pub(crate) fn shown(&self) -> String {
        match self {
            Cell::Blank => String::new(),
            Cell::Number(value) => value.to_string(),
            Cell::Text(text) => text.clone(),
            Cell::NoResult => "=…".into(),
        }
    }
}

/// The naming of places in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    /// Lines of a text.
    Lines,
    /// Cells of a sheet: `C7`.
    Cells,
    /// Rows of variables, whose names are the titles.
    Variables,
}

/// One row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    /// Line of the text or row of the sheet, counted from 1; in variables, row 0 has their names.
    pub(crate) line: usize,
    pub(crate) cells: Vec<Cell>,
}

impl Row {
    pub(crate) fn cell(&self, column: usize) -> &Cell {
        self.cells.get(column).unwrap_or(&Cell::Blank)
    }

    pub(crate) fn is_blank(&self) -> bool {
        self.cells.iter().all(Cell::is_blank)
    }

    /// Returns the first cells, as users read them.
    pub(crate) fn beginning(&self) -> Vec<String> {
        self.cells.iter().take(SHOWN_CELLS).map(Cell::shown).collect()
    }
}

/// A table of a file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Table {
    pub(crate) file: String,
    pub(crate) sheet: Option<String>,
    /// The names of all sheets, or of all groups of variables.
    pub(crate) sheets: Vec<String>,
    pub(crate) form: Form,
    pub(crate) rows: Vec<Row>,
    /// Detected properties of the file, in words.
    pub(crate) remarks: Vec<String>,
}

impl Table {
    /// Returns a complaint about the whole table.
    pub(crate) fn complaint(&self, message: impl Into<String>) -> Complaint {
        Complaint {
            file: self.file.clone(),
            sheet: self.sheet.clone(),
            message: message.into(),
            ..Complaint::default()
        }
    }

    /// Returns a complaint that refuses the whole table.
    pub(crate) fn refusal(&self, message: impl Into<String>) -> Box<Complaint> {
        Box::new(self.complaint(message))
    }

    pub(crate) fn complaint_at(&self, line: usize, column: usize, message: impl Into<String>) -> Complaint {
        let cell = (self.form == Form::Cells).then(|| format!("{}{line}", letter(column)));
        Complaint {
            line: Some(line),
            cell,
            ..self.complaint(message)
        }
    }

    /// Returns the place of a row, in words.
    pub(crate) fn place(&self, line: usize) -> String {
        match self.form {
            Form::Lines => format!("line {line}"),
            Form::Cells | Form::Variables => format!("row {line}"),
        }
    }
}

/// Returns the letters of a column in a spreadsheet: `A`, `Z`, `AA`.
pub(crate) fn letter(column: usize) -> String {
    let (rest, last) = (column / 26, (column % 26) as u8);
    let before = if rest == 0 {
        String::new()
    } else {
        letter(rest - 1)
    };
    format!("{before}{}", char::from(b'A' + last))
}

/// Returns the column with these letters; `None` if they are no letters of a column.
pub(crate) fn column_of(letters: &str) -> Option<usize> {
    if letters.is_empty() || letters.len() > 3 || !letters.bytes().all(|b| b.is_ascii_uppercase()) {
        return None;
    }
    let number = letters
        .bytes()
        .fold(0, |number, b| number * 26 + usize::from(b - b'A') + 1);
    Some(number - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_name_columns_and_back() {
        for (column, letters) in [(0, "A"), (25, "Z"), (26, "AA"), (51, "AZ"), (702, "AAA")] {
            assert_eq!(letter(column), letters);
            assert_eq!(column_of(letters), Some(column));
        }
        assert_eq!(column_of("Slip"), None);
        assert_eq!(column_of("ABCD"), None);
    }
}
