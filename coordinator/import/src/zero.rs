//! The readings at rest of a file's columns, which are subtracted from all of its readings.

use crate::complaint::Complaint;
use crate::files::Beside;
use crate::map::{Entry, Layout, Map, Zero};
use crate::reading::Reader;
use crate::title::Titled;

/// Returns the reading at rest of an entry's column in its unit: that of a line of its file, or the mean in a taring file.
///
/// `titled` is the file that has the column; a taring file has the same layout. Checked by `tests/raw.rs`.
///
/// # Errors
/// The line is no row of data, the file cannot be read, or there is no number.
pub(crate) fn reading_at_rest(
    titled: &Titled,
    entry: &Entry,
    (map, layout): (&Map, &Layout),
    beside: &mut Beside<'_, '_>,
) -> Result<f64, Box<Complaint>> {
    let decimal = entry.decimal.or(layout.decimal);
    let column = |titled: &Titled| {
        let title = entry.column().unwrap_or_default();
        titled
            .column(title)
            .map_err(|message| titled.table.refusal(message))
    };
    match &entry.zero {
        None => Ok(0.0),
        Some(Zero::Line(line)) => {
            let table = &titled.table;
            let row = titled.data().find(|row| row.line == *line);
            let row = row.ok_or_else(|| {
                table.refusal(format!("{} of zero_line is no row of data", table.place(*line)))
            })?;
            let column = column(titled)?;
            let number = Reader::new(titled, map, decimal, false)?.number(row, column)?;
            number.ok_or_else(|| Box::new(table.complaint_at(*line, column, "the reading at rest is blank")))
        }
        Some(Zero::File(pattern)) => beside.with(pattern, layout, |taring, _| {
            let numbers = Reader::new(taring, map, decimal, false)?.numbers(column(taring)?)?;
            let numbers: Vec<f64> = numbers.into_iter().flatten().collect();
            if numbers.is_empty() {
                return Err(taring.table.refusal("the column of zero_file has no number"));
            }
            Ok(numbers.iter().sum::<f64>() / numbers.len() as f64)
        }),
    }
}

/// Looks up the readings at rest of the columns that the file itself has; returns the mistakes.
pub(crate) fn settle(titled: &Titled, map: &mut Map, beside: &mut Beside<'_, '_>) -> Vec<Complaint> {
    let stated = map.clone();
    let mut complaints = Vec::new();
    let is_own = |entry: &&mut Entry| entry.from.is_none() && entry.zero.is_some();
    for entry in map.entries_mut().filter(is_own) {
        // A column that is not there has a complaint when the map is bound.
        if entry.column().is_none_or(|title| titled.column(title).is_err()) {
            continue;
        }
        match reading_at_rest(titled, entry, (&stated, &stated.layout), beside) {
            Ok(reading) => entry.reading_at_rest = reading,
            Err(complaint) => complaints.push(Complaint {
                field: Some(entry.name.clone()),
                ..*complaint
            }),
        }
    }
    complaints
}
