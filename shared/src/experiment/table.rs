//! Rows of a CSV file whose columns are known by name.

use std::collections::BTreeMap;

use super::check::{ValueError, not_negative, positive};
use crate::file::{FileError, unknown_word};
use crate::text_file::CONVERT;

/// The maximum number of rows of a file of runs or readings: 64 threads post as many results, each with nine values of 9
/// bytes for every run, in one message of 64 MiB.
pub(super) const MAX_ROWS: usize = 10_000;

/// The columns that a file may and must have.
pub(super) struct Columns<'a> {
    pub(super) allowed: Vec<&'a str>,
    /// Names of the required columns.
    pub(super) required: &'a [&'a str],
    /// The maximum number of rows.
    pub(super) max_rows: usize,
}

impl Columns<'_> {
    /// Finds the position of each column in the header; the error lists everything that is wrong with it.
    fn find(&self, header: &csv::StringRecord) -> Result<BTreeMap<String, usize>, ValueError> {
        let whole = header.iter().collect::<Vec<_>>().join(",");
        for (separator, name) in [(';', "semicolons"), ('\t', "tabs"), ('|', "bars")] {
            let names: Vec<&str> = whole.split(separator).map(str::trim).collect();
            let is_separator = names.len() > 1 && names.iter().all(|name| self.allowed.contains(name));
            if is_separator {
                let message = format!("columns are separated by {name}, commas are expected: {CONVERT}");
                return Err(ValueError::Rule(message));
            }
        }
        let mut positions = BTreeMap::new();
        let mut wrong = Vec::new();
        for (position, name) in header.iter().enumerate() {
            if !self.allowed.contains(&name) {
                wrong.push(unknown_word("column", name, self.allowed.iter().copied()));
            } else if positions.insert(name.to_owned(), position).is_some() {
                wrong.push(format!("column \"{name}\" appears twice"));
            }
        }
        let missing = |column: &&&str| {
            let is_misspelt = || wrong.iter().any(|text| text.ends_with(&format!("\"{column}\"")));
            !positions.contains_key(**column) && !is_misspelt()
        };
        let missing: Vec<&str> = self.required.iter().filter(missing).copied().collect();
        match missing.as_slice() {
            [] => {}
            [column] => wrong.push(format!("column \"{column}\" is missing")),
            columns => wrong.push(format!("columns {} are missing", columns.join(", "))),
        }
        match wrong.is_empty() {
            true => Ok(positions),
            false => Err(ValueError::Rule(wrong.join("; "))),
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

/// Parses the rows of a file with `row`, which also gets the line, counted from 1. The [`FileError`] names the line of the
/// header or of the first bad row, and the faults of the next ones.
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
    let mut wrong: Vec<FileError> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| FileError::whole(file, e.to_string()))?;
        let line = line_of(text, &record);
        if parsed.len() + wrong.len() == columns.max_rows {
            let message = format!("the file must have at most {} rows", columns.max_rows);
            return Err(FileError::at(file, line, message));
        }
        let fields = Row {
            positions: &positions,
            record: &record,
        };
        let read = fields
            .check_length(header.len())
            .and_then(|()| row(&fields, line));
        match read {
            Ok(row) => parsed.push(row),
            Err(_) if parsed.is_empty() && wrong.is_empty() && fields.has_no_number() => {
                let message = "no field is a number: a row of units, or a second title, has no place here";
                wrong.push(FileError::at(file, line, message));
            }
            Err(e) => wrong.push(FileError::at(file, line, e.to_string())),
        }
    }
    match wrong.is_empty() {
        true => Ok(parsed),
        false => Err(all(file, &wrong)),
    }
}

/// The number of bad rows that an error describes.
const MAX_DESCRIBED: usize = 3;

/// Joins bad rows into one error: the first, the next ones, and the number of the rest.
fn all(file: &str, wrong: &[FileError]) -> FileError {
    let line = |error: &FileError| error.line.unwrap_or_default();
    let mut message = wrong[0].message.clone();
    for error in &wrong[1..wrong.len().min(MAX_DESCRIBED)] {
        message += &format!("; line {}: {}", line(error), error.message);
    }
    match wrong.len().saturating_sub(MAX_DESCRIBED) {
        0 => {}
        1 => message += "; and 1 more row is wrong",
        count => message += &format!("; and {count} more rows are wrong"),
    }
    FileError::at(file, line(&wrong[0]), message)
}

/// Returns the line of a record, counted from 1; the position that the reader gives is that of the comments before it.
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

/// Returns the correction for a text that is nearly a number.
fn remedy(text: &str) -> String {
    let pointed = text.replace(',', ".");
    if text.matches(',').count() == 1 && pointed.parse::<f64>().is_ok() {
        return format!(": a number has a point, no comma: write {pointed}");
    }
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c)));
    match end.map(|end| text.split_at(end)) {
        Some((number, unit)) if number.parse::<f64>().is_ok() => {
            format!(
                ": the unit {} stands in the column's name: write {number}",
                unit.trim()
            )
        }
        _ => String::new(),
    }
}

/// One row, by the names of its columns.
pub(super) struct Row<'a> {
    positions: &'a BTreeMap<String, usize>,
    record: &'a csv::StringRecord,
}

impl Row<'_> {
    fn check_length(&self, expected: usize) -> Result<(), ValueError> {
        let field_count = self.record.len();
        if field_count == expected {
            return Ok(());
        }
        let behind = self.record.iter().skip(expected);
        let remedy = match field_count > expected && behind.into_iter().all(str::is_empty) {
            true => ": leave out the commas at its end",
            false => "",
        };
        Err(ValueError::Rule(format!(
            "{field_count} fields where the header has {expected}{remedy}"
        )))
    }

    fn has_no_number(&self) -> bool {
        self.record.iter().all(|field| field.parse::<f64>().is_err())
    }

    /// Returns whether the file has a column.
    pub(super) fn has(&self, column: &str) -> bool {
        self.positions.contains_key(column)
    }

    /// Returns the field of a column; `None` if it is blank or the column absent.
    pub(super) fn text(&self, column: &str) -> Option<&str> {
        self.positions
            .get(column)
            .and_then(|&i| self.record.get(i))
            .filter(|s| !s.is_empty())
    }

    /// Returns the field of a column, which must not be blank.
    pub(super) fn word(&self, column: &str) -> Result<&str, ValueError> {
        self.text(column)
            .ok_or_else(|| ValueError::Blank(column.to_owned()))
    }

    /// Returns a finite number; `None` if the field is blank or the column absent.
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
                remedy: remedy(text),
            }),
        }
    }

    /// Returns a finite number, which is required.
    pub(super) fn required(&self, column: &str) -> Result<f64, ValueError> {
        self.number(column)?
            .ok_or_else(|| ValueError::Blank(column.to_owned()))
    }

    /// Returns a number above 0, which is required.
    pub(super) fn positive(&self, column: &str, unit: &str) -> Result<f64, ValueError> {
        let value = self.required(column)?;
        positive(column, value, unit)?;
        Ok(value)
    }

    /// Returns a number of at least 0, which is required.
    pub(super) fn not_negative(&self, column: &str, unit: &str) -> Result<f64, ValueError> {
        let value = self.required(column)?;
        not_negative(column, value, unit)?;
        Ok(value)
    }

    /// Returns a name that must be a key of `names`.
    pub(super) fn named<T>(&self, column: &str, names: &BTreeMap<String, T>) -> Result<String, ValueError> {
        let name = self.word(column)?;
        if names.contains_key(name) {
            Ok(name.to_owned())
        } else {
            let names = names.keys().map(String::as_str);
            Err(ValueError::Unknown(unknown_word(column, name, names)))
        }
    }
}
