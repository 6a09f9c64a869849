//! The sheets of a spreadsheet: .xlsx, .ods and .xls.

use std::collections::BTreeMap;
use std::io::Cursor;

use calamine::{Data, DataRef, Dimensions, Ods, Range, Reader, Xls, Xlsx};

use super::archive;
use super::source_file::{Hints, SourceFile};
use crate::complaint::Complaint;
use crate::table::{Cell, Form, Row, Table};

/// Maximum number of columns of a table.
const MAX_COLUMNS: u32 = 1000;
/// Maximum number of cells of a sheet.
const MAX_CELLS: usize = 5_000_000;

/// The cells of a sheet by row and column, counted from 0.
type Cells = BTreeMap<u32, BTreeMap<u32, Cell>>;
type Bytes<'a> = Cursor<&'a [u8]>;

pub(super) fn read_zipped(source: &SourceFile<'_>, hints: &Hints) -> Result<Table, Box<Complaint>> {
    let table = empty(source);
    archive::check(source.bytes).map_err(|e| table.complaint(e))?;
    if let Ok(mut book) = Xlsx::new(Cursor::new(source.bytes)) {
        return choose(table, book.sheet_names(), hints, |name| {
            cells_of_xlsx(&mut book, name)
        });
    }
    let mut book: Ods<Bytes<'_>> = Ods::new(Cursor::new(source.bytes)).map_err(|_| {
        table.complaint("this is no .xlsx and no .ods file: save the table as one of these, or as .csv")
    })?;
    choose(table, book.sheet_names(), hints, |name| cells_of(&mut book, name))
}

pub(super) fn read_old(source: &SourceFile<'_>, hints: &Hints) -> Result<Table, Box<Complaint>> {
    let table = empty(source);
    if !source.is_own {
        return Err(table.refusal("a service does not read .xls files, or locked ones: save it as .xlsx without a password, or use `coordinator import`"));
    }
    let damaged = |e: calamine::XlsError| {
        table.complaint(format!(
            "the file cannot be read ({e}): save it as .xlsx without a password"
        ))
    };
    let mut book: Xls<Bytes<'_>> = Xls::new(Cursor::new(source.bytes)).map_err(damaged)?;
    choose(table, book.sheet_names(), hints, |name| {
        let mut cells = cells_of(&mut book, name)?;
        fill(
            &mut cells,
            book.merge_cells_by_sheet_name(name).unwrap_or_default(),
        );
        Ok(cells)
    })
}

fn empty(source: &SourceFile<'_>) -> Table {
    Table {
        file: source.name.to_owned(),
        sheet: None,
        sheets: Vec::new(),
        form: Form::Cells,
        rows: Vec::new(),
        remarks: Vec::new(),
    }
}

/// Returns the stated sheet; otherwise the only one with cells, or on request the one with the most.
fn choose(
    mut table: Table,
    names: Vec<String>,
    hints: &Hints,
    mut read: impl FnMut(&str) -> Result<Cells, String>,
) -> Result<Table, Box<Complaint>> {
    table.sheets.clone_from(&names);
    let mut cells_of = |name: &str| {
        read(name).map_err(|e| {
            Box::new(Complaint {
                sheet: Some(name.to_owned()),
                ..table.complaint(e)
            })
        })
    };
    let (name, cells) = if let Some(stated) = &hints.sheet {
        let by_number = || {
            stated
                .parse::<usize>()
                .ok()
                .and_then(|number| names.get(number.checked_sub(1)?))
        };
        let Some(name) = names.iter().find(|name| *name == stated).or_else(by_number) else {
            let names = names.iter().map(String::as_str);
            return Err(table.refusal(shared::file::unknown_word("sheet", stated, names)));
        };
        (name.clone(), cells_of(name)?)
    } else {
        let mut filled = Vec::new();
        for name in &names {
            let cells = cells_of(name)?;
            if !cells.is_empty() {
                filled.push((name.clone(), cells));
            }
        }
        if filled.len() > 1 && !hints.takes_largest {
            let listed: Vec<String> = filled.iter().map(|(name, _)| format!("\"{name}\"")).collect();
            return Err(table.refusal(format!(
                "several sheets have cells: state `sheet = ` in the map, one of {}",
                listed.join(", ")
            )));
        }
        let largest = filled
            .into_iter()
            .rev()
            .max_by_key(|(_, cells)| cells.values().map(BTreeMap::len).sum::<usize>());
        largest.ok_or_else(|| table.complaint("no sheet of the file has a cell"))?
    };
    table.sheet = Some(name);
    table.rows = rows(cells);
    Ok(table)
}

fn rows(cells: Cells) -> Vec<Row> {
    let row = |(row, cells): (u32, BTreeMap<u32, Cell>)| {
        let last = cells.keys().next_back().copied().unwrap_or(0) as usize;
        let mut list = vec![Cell::Blank; last + 1];
        for (column, cell) in cells {
            list[column as usize] = cell;
        }
        Row {
            line: row as usize + 1,
            cells: list,
        }
    };
    cells.into_iter().map(row).collect()
}

/// Adds a cell; an error if the sheet is too large.
fn put(cells: &mut Cells, count: &mut usize, (row, column): (u32, u32), cell: Cell) -> Result<(), String> {
    if cell.is_blank() {
        return Ok(());
    }
    *count += 1;
    if column >= MAX_COLUMNS || *count > MAX_CELLS {
        return Err(format!(
            "the sheet has cells beyond column {MAX_COLUMNS} or more than {MAX_CELLS}: copy the table into a sheet of its own"
        ));
    }
    cells.entry(row).or_default().insert(column, cell);
    Ok(())
}

/// Returns the cells of an .xlsx sheet in sequence: a single cell far away costs nothing.
fn cells_of_xlsx(book: &mut Xlsx<Bytes<'_>>, name: &str) -> Result<Cells, String> {
    let damaged = |e: calamine::XlsxError| format!("the sheet cannot be read: {e}");
    let (mut cells, mut count) = (Cells::new(), 0);
    let mut reader = book.worksheet_cells_reader(name).map_err(damaged)?;
    while let Some(next) = reader.next_cell_with_formula().map_err(damaged)? {
        let cell = match (next.value, next.formula) {
            (DataRef::Empty, Some(_)) => Cell::NoResult,
            (value, _) => cell(&Data::from(value)),
        };
        put(&mut cells, &mut count, next.pos, cell)?;
    }
    drop(reader);
    fill(&mut cells, book.merge_cells_by_sheet_name(name).map_err(damaged)?);
    Ok(cells)
}

/// Returns the cells of a sheet of another format.
fn cells_of<'a, B: Reader<Bytes<'a>>>(book: &mut B, name: &str) -> Result<Cells, String>
where
    B::Error: std::fmt::Display,
{
    let damaged = |e: B::Error| format!("the sheet cannot be read: {e}");
    let range: Range<Data> = book.worksheet_range(name).map_err(damaged)?;
    let (row, column) = range.start().unwrap_or((0, 0));
    let (mut cells, mut count) = (Cells::new(), 0);
    for (r, c, value) in range.used_cells() {
        put(
            &mut cells,
            &mut count,
            (row + r as u32, column + c as u32),
            cell(value),
        )?;
    }
    // A sheet whose formulas cannot be listed still has values.
    if let Ok(formulas) = book.worksheet_formula(name) {
        let (row, column) = formulas.start().unwrap_or((0, 0));
        for (r, c, formula) in formulas.used_cells() {
            let place = (row + r as u32, column + c as u32);
            let has_result = cells.get(&place.0).is_some_and(|row| row.contains_key(&place.1));
            if !formula.is_empty() && !has_result {
                put(&mut cells, &mut count, place, Cell::NoResult)?;
            }
        }
    }
    Ok(cells)
}

/// A merged cell counts for its whole area.
fn fill(cells: &mut Cells, merged: Vec<Dimensions>) {
    for area in merged {
        let first = cells.get(&area.start.0).and_then(|row| row.get(&area.start.1));
        let (Some(first), true) = (first.cloned(), area.len() <= u64::from(MAX_COLUMNS) * 100) else {
            continue;
        };
        for row in area.start.0..=area.end.0 {
            for column in area.start.1..=area.end.1.min(MAX_COLUMNS - 1) {
                cells
                    .entry(row)
                    .or_default()
                    .entry(column)
                    .or_insert_with(|| first.clone());
            }
        }
    }
}

fn cell(value: &Data) -> Cell {
    match value {
        Data::Empty => Cell::Blank,
        Data::Float(value) => Cell::Number(*value),
        Data::Int(value) => Cell::Number(*value as f64),
        Data::Bool(value) => Cell::Text(value.to_string()),
        Data::String(text) | Data::DateTimeIso(text) | Data::DurationIso(text) => Cell::from_text(text),
        Data::Error(error) => Cell::Text(error.to_string()),
        Data::DateTime(time) if time.is_duration() => Cell::Text(format!("{} d", time.as_f64())),
        Data::DateTime(time) => {
            let (year, month, day, hour, minute, second, _) = time.to_ymd_hms_milli();
            Cell::Text(format!(
                "{year:04}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:02}"
            ))
        }
    }
}
