//! What a proposal shows: the columns of a file and of runs.csv.

use serde::Serialize;

use crate::field::RowUse;

/// A column of the file.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ColumnCard {
    /// Its letters: `A`.
    pub letter: String,
    /// Its title.
    pub title: String,
    /// How a map names it: by its title, or by its letters where the title is another column's too.
    pub name: String,
    /// The unit that the file states.
    pub unit: Option<String>,
    /// Its first cells.
    pub sample: Vec<String>,
    /// Its different words, where they are few enough to say what each means for the use of a run.
    pub words: Vec<WordCard>,
}

/// A word of a column.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct WordCard {
    /// The word.
    pub word: String,
    /// The number of rows that have this word.
    pub count: usize,
    /// What it means for the use of a run, as proposed; null where the file does not tell.
    pub means: Option<RowUse>,
}

/// Where a column of runs.csv comes from, as proposed.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FieldGuess {
    /// The column of runs.csv.
    pub name: String,
    /// Words for people.
    pub words: String,
    /// Whether every run needs it.
    pub is_needed: bool,
    /// The units that it can be given in; none of a name.
    pub units: Vec<String>,
    /// The proposed column, as a map names it.
    pub column: Option<String>,
    /// Its unit; null where the file does not state it.
    pub unit: Option<String>,
    /// The proposed formula.
    pub formula: Option<String>,
    /// What the words of the proposed column mean, of `use` alone.
    pub meanings: Vec<WordCard>,
    /// What must be answered before the map can be used.
    pub question: Option<String>,
}

/// A quantity that a proposed formula needs.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct QuantityGuess {
    /// Its name in formulas.
    pub name: String,
    /// Words for people.
    pub words: String,
    /// The units that it can be given in.
    pub units: Vec<String>,
    /// The proposed column; null where a value for all rows is asked for.
    pub column: Option<String>,
    /// Its unit; null where the file does not state it.
    pub unit: Option<String>,
    /// What must be answered before the map can be used.
    pub question: Option<String>,
}

/// A proposed map, and what it is made from.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct Guess {
    /// The text of the map.
    pub map: String,
    /// The sheet that is read; null where the file has none.
    pub sheet: Option<String>,
    /// All sheets of the file.
    pub sheets: Vec<String>,
    /// The line of the titles; 0 where there are none.
    pub title_line: usize,
    /// The line of the units below them; null where there is none.
    pub unit_line: Option<usize>,
    /// The columns of the file.
    pub columns: Vec<ColumnCard>,
    /// The columns of runs.csv.
    pub fields: Vec<FieldGuess>,
    /// The quantities of proposed formulas.
    pub quantities: Vec<QuantityGuess>,
    /// The decimal mark of numbers that are texts: `.` or `,`; `?` where they can be read in two ways; null where there are none.
    pub decimal: Option<String>,
    /// Remarks on what the reader found out about the file.
    pub remarks: Vec<String>,
}
