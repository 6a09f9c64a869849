//! The numbers of one column, read before a map is bound.

use std::collections::BTreeSet;

use crate::complaint::Complaint;
use crate::map::Map;
use crate::number::{self, Decimal, Evidence, Writing};
use crate::table::{Cell, Row};
use crate::title::Titled;

/// The reader of a file's columns.
pub(crate) struct Reader<'a> {
    pub(crate) titled: &'a Titled,
    writing: Writing,
    missing: &'a BTreeSet<String>,
    skip: Option<&'a BTreeSet<usize>>,
}

impl<'a> Reader<'a> {
    /// Returns the reader of a file; `is_own` says that the lines that the map skips are those of this file.
    ///
    /// # Errors
    /// All numbers of the file can be read in two ways, and no decimal mark is stated.
    pub(crate) fn new(
        titled: &'a Titled,
        map: &'a Map,
        stated: Option<Decimal>,
        is_own: bool,
    ) -> Result<Self, Box<Complaint>> {
        let texts = titled
            .data()
            .flat_map(|row| &row.cells)
            .filter_map(|cell| match cell {
                Cell::Text(text) => Some(text.as_str()),
                _ => None,
            });
        let decimal = match stated.map_or_else(|| number::decimal_of(texts), Evidence::Found) {
            Evidence::Found(decimal) => decimal,
            Evidence::None => Decimal::Point,
            Evidence::Ambiguous => {
                return Err(titled.table.refusal(
                    "its numbers can be read in two ways: state `decimal = \",\"` or `decimal = \".\"`",
                ));
            }
        };
        Ok(Reader {
            titled,
            writing: Writing {
                decimal,
                has_thousands: map.has_thousands && stated.is_some(),
            },
            missing: &map.missing,
            skip: is_own.then_some(&map.skip),
        })
    }

    /// Returns the numbers of a column in its unit, by row of data; `None` for a blank cell and for a row that is left out.
    ///
    /// # Errors
    /// The first cell that is no number.
    pub(crate) fn numbers(&self, column: usize) -> Result<Vec<Option<f64>>, Box<Complaint>> {
        let number = |row: &Row| match self.is_left_out(row) {
            true => Ok(None),
            false => self.number(row, column),
        };
        self.titled.data().map(number).collect()
    }

    fn is_left_out(&self, row: &Row) -> bool {
        self.skip.is_some_and(|skip| skip.contains(&row.line)) || self.titled.is_comment(row)
    }

    /// Returns the number of a cell in its unit; `None` for a blank cell.
    ///
    /// # Errors
    /// The cell is no number.
    pub(crate) fn number(&self, row: &Row, column: usize) -> Result<Option<f64>, Box<Complaint>> {
        let number = match row.cell(column) {
            Cell::Blank => return Ok(None),
            Cell::Text(text) if self.missing.contains(text) => return Ok(None),
            Cell::Number(value) if value.is_finite() => Ok(*value),
            Cell::Number(value) => Err(format!("{value} is no finite number")),
            Cell::Text(text) => number::read(text, self.writing),
            Cell::NoResult => Err("the formula of this cell has no stored result".into()),
        };
        let wrong = |message| {
            Box::new(Complaint {
                column: self.titled.titles.get(column).map(|title| title.text.clone()),
                ..self.titled.table.complaint_at(row.line, column, message)
            })
        };
        number.map(Some).map_err(wrong)
    }
}
