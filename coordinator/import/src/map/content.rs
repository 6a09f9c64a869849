//! The content of a map.

use std::collections::{BTreeMap, BTreeSet};

use crate::field::RowUse;
use crate::number::Decimal;
use crate::pattern::Pattern;
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

/// The origin of the reading that a column has at rest, which is subtracted.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Zero {
    /// A line of the same file.
    Line(usize),
    /// The mean of the column in another file, by its name with places.
    File(Pattern),
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
    /// Name of the joined file that has the column; `None` for the file itself.
    pub(crate) from: Option<String>,
    pub(crate) zero: Option<Zero>,
    /// The reading at rest, in the unit of the column, after it has been looked up.
    pub(crate) reading_at_rest: f64,
    /// Meanings of the column's words, for `use` only; the blank word is that of a blank cell.
    pub(crate) words: BTreeMap<String, RowUse>,
}

/// What a run of a recording is told by.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Mark {
    /// The whole file is a run.
    File,
    /// A column that changes from run to run, and its values between runs.
    Column { name: String, between: BTreeSet<String> },
    /// A condition that holds during a run; what is shorter than this time neither is a run nor interrupts one `[s]`.
    Condition { text: String, shortest_s: f64 },
}

/// A recording of one run or of several, one after the other.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Recording {
    pub(crate) line: usize,
    /// Column and unit of the time.
    pub(crate) time: String,
    pub(crate) time_unit: String,
    /// What a run is told by.
    pub(crate) mark: Mark,
    /// Interval that is averaged, from the beginning of each run `[s]`.
    pub(crate) window_s: Option<(f64, f64)>,
    /// Equal step of the histories `[s]`; `None` keeps the steps of the recording if they are equal.
    pub(crate) step_s: Option<f64>,
    /// Whether the channels are written as histories, not as averages.
    pub(crate) histories: bool,
}

/// The map's statements about the layout of a file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Layout {
    pub(crate) hints: Hints,
    pub(crate) titles: Option<usize>,
    pub(crate) units: Option<usize>,
    pub(crate) decimal: Option<Decimal>,
}

/// A file whose columns join those of a recording by their times.
#[derive(Debug, Clone)]
pub(crate) struct Join {
    pub(crate) name: String,
    /// Name of the file, with places.
    pub(crate) file: Pattern,
    pub(crate) layout: Layout,
    /// Column and unit of its time.
    pub(crate) time: String,
    pub(crate) time_unit: String,
    /// Time that is added to its times `[s]`.
    pub(crate) offset_s: f64,
    /// Whether times count from the first row of each of the two files.
    pub(crate) is_from_start: bool,
}

/// A map without its mistaken parts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Map {
    /// Names of the files that are recordings, with places.
    pub(crate) file: Option<Pattern>,
    pub(crate) layout: Layout,
    pub(crate) has_thousands: bool,
    pub(crate) skip: BTreeSet<usize>,
    pub(crate) missing: BTreeSet<String>,
    pub(crate) columns: Vec<Entry>,
    pub(crate) quantities: Vec<Entry>,
    pub(crate) recording: Option<Recording>,
    pub(crate) joins: Vec<Join>,
}

impl Entry {
    /// Returns the column that it names.
    pub(crate) fn column(&self) -> Option<&str> {
        match &self.origin {
            Origin::Column(name) => Some(name),
            Origin::Value(_) | Origin::Formula(_) => None,
        }
    }
}

impl Map {
    /// Returns the entries of columns and quantities.
    pub(crate) fn entries(&self) -> impl Iterator<Item = &Entry> {
        self.columns.iter().chain(&self.quantities)
    }

    pub(crate) fn entries_mut(&mut self) -> impl Iterator<Item = &mut Entry> {
        self.columns.iter_mut().chain(&mut self.quantities)
    }
}

/// Returns the admissible units of a quantity for formulas.
pub(crate) fn quantity_of(unit: &str) -> Option<Quantity> {
    crate::unit::find(unit).map(|unit| unit.quantity)
}
