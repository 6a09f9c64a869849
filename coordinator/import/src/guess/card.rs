//! The columns of a file and of runs.csv, as a proposal shows them.

use serde::Serialize;

use crate::field::RowUse;

/// A column of the file.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ColumnCard {
    /// Letters of the column, for example `A`.
    pub letter: String,
    /// Title of the column.
    pub title: String,
    /// Name of the column in a map: its title, or its letters if another column has the same title.
    pub name: String,
    /// The unit that the file states.
    pub unit: Option<String>,
    /// First cells of the column.
    pub sample: Vec<String>,
    /// Different words of the column, if they are few enough to mark the use of a run.
    pub words: Vec<WordCard>,
}

/// A word of a column.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct WordCard {
    /// Text of the word.
    pub word: String,
    /// Number of rows with this word.
    pub count: usize,
    /// Proposed meaning for the use of a run; null if the file does not tell.
    pub means: Option<RowUse>,
}

/// The proposed source of a column of runs.csv.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FieldGuess {
    /// Name of the column.
    pub name: String,
    /// Description for users.
    pub words: String,
    /// Whether every run needs it.
    pub is_needed: bool,
    /// The units that it can be given in; none for a name.
    pub units: Vec<String>,
    /// The proposed column by its name in a map.
    pub column: Option<String>,
    /// Unit of the proposed column; null if the file does not state it.
    pub unit: Option<String>,
    /// The proposed formula.
    pub formula: Option<String>,
    /// Meanings of the proposed column's words, for `use` only.
    pub meanings: Vec<WordCard>,
    /// Questions that must be answered before the map can be used.
    pub question: Option<String>,
}

/// A quantity that a proposed formula needs.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct QuantityGuess {
    /// Name of the quantity in formulas.
    pub name: String,
    /// Description for users.
    pub words: String,
    /// The units that it can be given in.
    pub units: Vec<String>,
    /// The proposed column; null if a value for all rows is asked for.
    pub column: Option<String>,
    /// Unit of the proposed column; null if the file does not state it.
    pub unit: Option<String>,
    /// Questions that must be answered before the map can be used.
    pub question: Option<String>,
}

/// A proposed map with the data that it was made from.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct Guess {
    /// The text of the map.
    pub map: String,
    /// The sheet that is read; null if the file has none.
    pub sheet: Option<String>,
    /// All sheets of the file.
    pub sheets: Vec<String>,
    /// The line of the titles; 0 if there are none.
    pub title_line: usize,
    /// The line of the units below the titles; null if there is none.
    pub unit_line: Option<usize>,
    /// The columns of the file.
    pub columns: Vec<ColumnCard>,
    /// The columns of runs.csv.
    pub fields: Vec<FieldGuess>,
    /// The quantities of proposed formulas.
    pub quantities: Vec<QuantityGuess>,
    /// Columns that are components of a force or a moment by the letter of an axis alone, and are proposed as nothing.
    pub components: Vec<String>,
    /// The decimal mark of numbers in texts: `.` or `,`; `?` if they can be read in two ways; null if there are none.
    pub decimal: Option<String>,
    /// Remarks on detected properties of the file.
    pub remarks: Vec<String>,
}
