//! Text with separators.

use super::encoding::decode;
use super::separator::Separator;
use super::source_file::{Hints, SourceFile};
use crate::complaint::Complaint;
use crate::table::{Cell, Form, Row, Table};

pub(super) fn read(source: &SourceFile<'_>, hints: &Hints) -> Result<Table, Box<Complaint>> {
    let mut table = Table {
        file: source.name.to_owned(),
        sheet: None,
        sheets: Vec::new(),
        form: Form::Lines,
        rows: Vec::new(),
        remarks: Vec::new(),
    };
    let (text, remark) = decode(source.bytes, hints.encoding.as_deref()).map_err(|e| table.complaint(e))?;
    table.remarks.extend(remark);
    let stated = hints.separator.as_deref().map(Separator::named).transpose();
    let separator = match stated.map_err(|e| table.complaint(e))? {
        Some(separator) => separator,
        None => Separator::detect(&text).ok_or_else(|| {
            table.complaint("no line has two fields or more: a table with , ; | tab or spaces between its columns is expected")
        })?,
    };
    table.rows = separator.rows(&text).map_err(|(line, message)| Complaint {
        line: Some(line),
        ..table.complaint(message)
    })?;
    // Excel writes the separator into the first line, which is no row.
    let is_statement = |row: &Row| {
        row.line == 1 && matches!(row.cell(0), Cell::Text(text) if text.to_lowercase().starts_with("sep="))
    };
    table.rows.retain(|row| !is_statement(row));
    Ok(table)
}
