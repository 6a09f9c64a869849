//! The inputs that are read from a row, and the sources of the columns of runs.csv.

use std::collections::BTreeMap;

use formula::expression::Expression;

use crate::field::{Field, Kind, RowUse};
use crate::number::{Decimal, Writing};

/// The origin of a number or a text.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum From<T> {
    Column {
        column: usize,
        fills_down: bool,
        with: T,
    },
    Fixed(String),
}

impl<T> From<T> {
    pub(super) fn column(&self) -> Option<usize> {
        match self {
            From::Column { column, .. } => Some(*column),
            From::Fixed(_) => None,
        }
    }

    /// Returns the text if it is equal in all rows.
    pub(super) fn fixed(&self) -> Option<String> {
        match self {
            From::Column { .. } => None,
            From::Fixed(text) => Some(text.clone()),
        }
    }
}

/// The conversion of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reading {
    pub(super) writing: Option<Writing>,
    pub(super) stated_decimal: Option<Decimal>,
    /// One unit in SI units.
    pub(super) si: f64,
    /// The reading at rest, in the unit of the column.
    pub(super) at_rest: f64,
}

/// A quantity that is read from every row, in SI units.
#[derive(Debug)]
pub(super) struct Input {
    pub(super) name: String,
    pub(super) from: From<Reading>,
    pub(super) fixed: f64,
}

impl Input {
    pub(super) fn column(&self) -> Option<usize> {
        self.from.column()
    }
}

/// The source of a column of runs.csv.
#[derive(Debug)]
pub(super) enum Source {
    Input(usize),
    Formula(Expression),
    Text(From<()>),
}

/// A column of runs.csv.
#[derive(Debug)]
pub(crate) struct Output {
    pub(crate) field: Field,
    pub(super) source: Source,
    /// The meanings of its column's words; empty if the words are those of runs.csv.
    pub(super) words: BTreeMap<String, RowUse>,
}

/// Returns whether a column holds a name or a number without unit.
pub(crate) fn is_text(output: &Output) -> bool {
    !matches!(output.field.kind, Kind::Measured(_))
}
