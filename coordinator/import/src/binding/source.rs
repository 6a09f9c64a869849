//! What is read from a row, and what a column of runs.csv is made of.

use formula::expression::Expression;

use crate::field::{Field, Kind};
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
}

/// Whether a column holds a name or a number without unit.
pub(crate) fn is_text(output: &Output) -> bool {
    !matches!(output.field.kind, Kind::Measured(_))
}
