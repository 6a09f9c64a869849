//! What is read from a row, and what a column of runs.csv is made of.

use std::collections::BTreeMap;

use formula::expression::Expression;

use crate::field::{Field, Kind, RowUse};
use crate::number::{Decimal, Writing};

/// Where a number or a text is read.
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
    /// The column that it is read from.
    pub(super) fn column(&self) -> Option<usize> {
        match self {
            From::Column { column, .. } => Some(*column),
            From::Fixed(_) => None,
        }
    }

    /// The text that all rows have.
    pub(super) fn fixed(&self) -> Option<String> {
        match self {
            From::Column { .. } => None,
            From::Fixed(text) => Some(text.clone()),
        }
    }
}

/// How a number is read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reading {
    pub(super) writing: Option<Writing>,
    pub(super) stated_decimal: Option<Decimal>,
    /// One of the unit in SI units.
    pub(super) si: f64,
}

/// A quantity that is read from every row, in SI units.
#[derive(Debug)]
pub(super) struct Input {
    pub(super) name: String,
    pub(super) from: From<Reading>,
    pub(super) fixed: f64,
}

impl Input {
    /// The column that it is read from.
    pub(super) fn column(&self) -> Option<usize> {
        self.from.column()
    }
}

/// What a column of runs.csv is made of.
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
    /// What the words of its column mean; empty where they mean themselves.
    pub(super) words: BTreeMap<String, RowUse>,
}

/// Whether a column holds a name or a number without unit.
pub(crate) fn is_text(output: &Output) -> bool {
    !matches!(output.field.kind, Kind::Measured(_))
}
