//! What a map states, as written.

use std::collections::{BTreeMap, BTreeSet};

use crate::field::RowUse;
use crate::number::Decimal;
use crate::read::Hints;
use crate::unit::Quantity;

/// The mark of a question in a map.
pub(crate) const QUESTION: &str = "?";

/// Where a column comes from, as written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Origin {
    /// A column by its title or letter.
    Column(String),
    /// The same in all rows.
    Value(String),
    /// A formula over `[quantities]` and other columns.
    Formula(String),
}

/// A column of runs.csv, or a quantity for formulas, as written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    /// `slip`, or the name of the quantity.
    pub(crate) name: String,
    /// The line of its table.
    pub(crate) line: usize,
    pub(crate) origin: Origin,
    pub(crate) unit: Option<String>,
    pub(crate) decimal: Option<Decimal>,
    /// Whether a blank cell has the value of the cell above.
    pub(crate) fills_down: bool,
    /// What the words of the column mean, of `use` alone; the blank word is that of a blank cell.
    pub(crate) words: BTreeMap<String, RowUse>,
}

/// A recording of several runs one after the other.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Recording {
    pub(crate) line: usize,
    /// The column of the time, and its unit.
    pub(crate) time: String,
    pub(crate) time_unit: String,
    /// The column that changes from run to run.
    pub(crate) marker: String,
    /// What it holds between runs.
    pub(crate) between: BTreeSet<String>,
    /// What is averaged, from the beginning of each run `[s]`.
    pub(crate) window_s: Option<(f64, f64)>,
    /// Whether the channels are written as histories, not as averages.
    pub(crate) histories: bool,
}

/// A map without what is wrong with it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Map {
    pub(crate) hints: Hints,
    pub(crate) titles: Option<usize>,
    pub(crate) units: Option<usize>,
    pub(crate) decimal: Option<Decimal>,
    pub(crate) has_thousands: bool,
    pub(crate) skip: BTreeSet<usize>,
    pub(crate) missing: BTreeSet<String>,
    pub(crate) columns: Vec<Entry>,
    pub(crate) quantities: Vec<Entry>,
    pub(crate) recording: Option<Recording>,
}

/// What a quantity for formulas may be: told by its unit.
pub(crate) fn quantity_of(unit: &str) -> Option<Quantity> {
    crate::unit::find(unit).map(|unit| unit.quantity)
}
