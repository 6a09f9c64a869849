//! The content of a map.

use std::collections::{BTreeMap, BTreeSet};

use crate::field::RowUse;
use crate::number::Decimal;
use crate::read::Hints;
use crate::unit::Quantity;

/// The mark of an open question in a map.
pub(crate) const QUESTION: &str = "?";

/// The stated origin of a column.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Origin {
    /// A column by its title or letter.
    Column(String),
    /// A value for all rows.
    Value(String),
    /// A formula over `[quantities]` and other columns.
    Formula(String),
}

/// The entry of a column of runs.csv, or of a quantity for formulas.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    /// Name of the column, for example `slip`, or of the quantity.
    pub(crate) name: String,
    pub(crate) line: usize,
    pub(crate) origin: Origin,
    pub(crate) unit: Option<String>,
    pub(crate) decimal: Option<Decimal>,
    /// Whether a blank cell has the value of the cell above.
    pub(crate) fills_down: bool,
    /// Meanings of the column's words, for `use` only; the blank word is that of a blank cell.
    pub(crate) words: BTreeMap<String, RowUse>,
}

/// A recording of several runs one after the other.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Recording {
    pub(crate) line: usize,
    /// Column and unit of the time.
    pub(crate) time: String,
    pub(crate) time_unit: String,
    /// Column that changes from run to run.
    pub(crate) marker: String,
    /// Values of the marker column between runs.
    pub(crate) between: BTreeSet<String>,
    /// Interval that is averaged, from the beginning of each run `[s]`.
    pub(crate) window_s: Option<(f64, f64)>,
    /// Whether the channels are written as histories, not as averages.
    pub(crate) histories: bool,
}

/// A map without its mistaken parts.
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

/// Returns the admissible units of a quantity for formulas.
pub(crate) fn quantity_of(unit: &str) -> Option<Quantity> {
    crate::unit::find(unit).map(|unit| unit.quantity)
}
