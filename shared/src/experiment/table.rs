//! Rows of a CSV file whose columns are known by name.

use std::collections::BTreeMap;

use super::check::{ValueError, not_negative, positive};
use crate::file::{FileError, unknown_word};

/// Most rows of a file of runs or readings: 64 threads post as many results, each with nine values of 9 bytes for every run,
/// in one message of 64 MiB.
pub(super) const MOST_ROWS: usize = 10_000;

/// Which columns a file may and must have.
pub(super) struct Columns<'a> {
    /// Every known name.
    pub(super) known: Vec<&'a str>,
    /// Names that must be there.
    pub(super) required: &'a [&'a str],
    /// Most rows.
    pub(super) most_rows: usize,
}

impl Columns<'_> {
    /// Where each column stands in the header.
    fn find(&self, header: &csv::StringRecord) -> Result<BTreeMap<String, usize>, ValueError> {
        let mut positions = BTreeMap::new();
        for (position, name) in header.iter().enumerate() {
            if !self.known.contains(&name) {
                let known = self.known.iter().copied();
                return Err(ValueError::Unknown(unknown_word("column", name, known)));
            }
            if positions.insert(name.to_owned(), position).is_some() {
                return Err(ValueError::Rule(format!("column \"{name}\" appears twice")));
            }
        }
        match self.required.iter().find(|&&c| !positions.contains_key(c)) {
            Some(missing) => Err(ValueError::Rule(format!("column \"{missing}\" is missing"))),
            None => Ok(positions),
        }
    }
}

/// Reads a file's records.
pub(super) fn reader(text: &str) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .flexible(true)
        .from_reader(text.as_bytes())
}

/// Parses the rows of a file with `row`, which also gets the line, counted from 1.
///
/// # Errors
/// [`FileError`] with the line of the header or of the row.
pub(super) fn rows<T>(
    file: &str,
    text: &str,
    columns: &Columns<'_>,
    mut row: impl FnMut(&Row<'_>, usize) -> Result<T, ValueError>,
) -> Result<Vec<T>, FileError> {
    let mut reader = reader(text);
    let header = reader
        .headers()
        .map_err(|e| FileError::at(file, 1, e.to_string()))?
        .clone();
    let positions = columns
        .find(&header)
        .map_err(|e| FileError::at(file, line_of(text, &header), e.to_string()))?;
    let mut parsed = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| FileError::whole(file, e.to_string()))?;
        let line = line_of(text, &record);
        if record.len() != header.len() {
            let message = format!("{} fields where the header has {}", record.len(), header.len());
            return Err(FileError::at(file, line, message));
        }
        if parsed.len() == columns.most_rows {
            let message = format!("the file must have at most {} rows", columns.most_rows);
            return Err(FileError::at(file, line, message));
        }
        let fields = Row {
            positions: &positions,
            record: &record,
        };
        parsed.push(row(&fields, line).map_err(|e| FileError::at(file, line, e.to_string()))?);
    }
    Ok(parsed)
}

/// The line in which a record stands, counted from 1: its position is that of the comments before it.
pub(super) fn line_of(text: &str, record: &csv::StringRecord) -> usize {
    let Some(position) = record.position() else {
        return 1;
    };
    let [line, byte] = [position.line(), position.byte()].map(|n| usize::try_from(n).unwrap_or(usize::MAX));
    let rest = text.get(byte..).unwrap_or_default();
    line + rest
        .lines()
        .take_while(|l| l.is_empty() || l.starts_with('#'))
        .count()
}

/// One row, by the names of its columns.
pub(super) struct Row<'a> {
    positions: &'a BTreeMap<String, usize>,
    record: &'a csv::StringRecord,
}

impl Row<'_> {
    /// Whether the file has a column.
    pub(super) fn has(&self, column: &str) -> bool {
        self.positions.contains_key(column)
    }

    /// The field of a column; `None` where it is blank or the column absent.
    pub(super) fn text(&self, column: &str) -> Option<&str> {
        self.positions
            .get(column)
            .and_then(|&i| self.record.get(i))
            .filter(|s| !s.is_empty())
    }

    /// The field of a column, which must not be blank.
    pub(super) fn word(&self, column: &str) -> Result<&str, ValueError> {
        self.text(column)
            .ok_or_else(|| ValueError::Blank(column.to_owned()))
    }

    /// A finite number; `None` where the field is blank or the column absent.
    pub(super) fn number(&self, column: &str) -> Result<Option<f64>, ValueError> {
        let Some(text) = self.text(column) else {
            return Ok(None);
        };
        let key = column.to_owned();
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Some(value)),
            Ok(value) => Err(ValueError::NotFinite { key, value }),
            Err(_) => Err(ValueError::NotNumber {
                key,
                text: text.to_owned(),
            }),
        }
    }

    /// A finite number that must be there.
    pub(super) fn required(&self, column: &str) -> Result<f64, ValueError> {
        self.number(column)?
            .ok_or_else(|| ValueError::Blank(column.to_owned()))
    }

    /// A number above 0 that must be there.
    pub(super) fn positive(&self, column: &str, unit: &str) -> Result<f64, ValueError> {
        let value = self.required(column)?;
        positive(column, value, unit)?;
        Ok(value)
    }

    /// A number of at least 0 that must be there.
    pub(super) fn not_negative(&self, column: &str, unit: &str) -> Result<f64, ValueError> {
        let value = self.required(column)?;
        not_negative(column, value, unit)?;
        Ok(value)
    }

    /// A name that must be one of `known`.
    pub(super) fn named<T>(&self, column: &str, known: &BTreeMap<String, T>) -> Result<String, ValueError> {
        let name = self.word(column)?;
        if known.contains_key(name) {
            Ok(name.to_owned())
        } else {
            let known = known.keys().map(String::as_str);
            Err(ValueError::Unknown(unknown_word(column, name, known)))
        }
    }
}
