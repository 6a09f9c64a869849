//! The reader of a map: it parses the map's text.

use std::collections::BTreeMap;

use formula::nesting::too_deep;
use shared::file::unknown_word;
use toml_edit::{Document, TableLike};

use super::content::{Entry, Map, Origin, QUESTION, Recording};
use super::entry::{Keys, Source};
use crate::complaint::Complaints;
use crate::field::Field;
use crate::number::Decimal;
use crate::read::Hints;

/// Maximum nesting of brackets; a map needs three.
const DEEPEST: usize = 16;
/// Maximum number of columns or quantities in a map. A runs.csv has about two dozen, and each is compared with all titles.
const MAX_ENTRIES: usize = 200;
/// Maximum size of a map `[bytes]`.
const LARGEST: usize = 1 << 20;

/// Parses a map, with all its mistakes; mistaken parts are left out.
pub(crate) fn read(file: &str, text: &str, fields: &[Field], complaints: &mut Complaints) -> Map {
    let source = Source { file, text };
    let mut map = Map::default();
    if text.len() > LARGEST || too_deep(text, DEEPEST).is_some() {
        let message =
            format!("a map must have at most {LARGEST} bytes, and brackets nested at most {DEEPEST} deep");
        complaints.add(source.complaint(None, None, message));
        return map;
    }
    let document = match Document::parse(text) {
        Ok(document) => document,
        Err(error) => {
            let byte = error.span().map(|span| span.start);
            complaints.add(source.complaint(byte, None, error.message().trim_end().replace('\n', " ")));
            return map;
        }
    };
    let mut keys = Keys::new(&source, document.as_table(), "", None);
    map.hints = Hints {
        sheet: keys.scalar(complaints, "sheet"),
        encoding: keys.text(complaints, "encoding"),
        separator: keys.text(complaints, "separator"),
        takes_largest: false,
    };
    map.titles = keys.line_number(complaints, "titles");
    map.units = keys.line_number(complaints, "units");
    map.decimal = decimal(&mut keys, complaints);
    map.has_thousands = thousands(&mut keys, complaints, map.decimal);
    for line in keys.list(complaints, "skip") {
        match line.parse() {
            Ok(line) => {
                map.skip.insert(line);
            }
            Err(_) => keys.complain(
                complaints,
                "skip",
                format!("skip has \"{line}\", and numbers of lines are expected"),
            ),
        }
    }
    map.missing = keys.list(complaints, "missing").into_iter().collect();
    if let Some(columns) = keys.table(complaints, "columns") {
        map.columns = entries(&source, columns, "columns", complaints, Some(fields));
    }
    if let Some(quantities) = keys.table(complaints, "quantities") {
        map.quantities = entries(&source, quantities, "quantities", complaints, None);
    }
    if let Some(recording) = keys.table(complaints, "recording") {
        map.recording = read_recording(&source, recording, complaints);
    }
    keys.end(complaints);
    map
}

fn decimal(keys: &mut Keys<'_>, complaints: &mut Complaints) -> Option<Decimal> {
    let mark = keys.text(complaints, "decimal")?;
    let decimal = Decimal::from_mark(&mark);
    if mark == QUESTION {
        keys.ask(complaints, "decimal", "decimal = \"?\" asks for an answer: write \",\" where 1,234 is a little more than one, \".\" where it is more than a thousand", "Is 1,234 a little more than one, or more than a thousand?");
    } else if decimal.is_none() {
        keys.complain(
            complaints,
            "decimal",
            format!("decimal \"{mark}\" must be \".\" or \",\""),
        );
    }
    decimal
}

fn thousands(keys: &mut Keys<'_>, complaints: &mut Complaints, decimal: Option<Decimal>) -> bool {
    let Some(mark) = keys.text(complaints, "thousands") else {
        return false;
    };
    let expected = match decimal.unwrap_or(Decimal::Point) {
        Decimal::Point => ",",
        Decimal::Comma => ".",
    };
    if mark != expected {
        keys.complain(complaints, "thousands", format!("thousands \"{mark}\" must be \"{expected}\", the mark that is not the decimals'; spaces and apostrophes need no statement"));
    }
    mark == expected
}

/// Returns the tables of `[columns]` or `[quantities]`.
fn entries(
    source: &Source<'_>,
    tables: &dyn TableLike,
    kind: &str,
    complaints: &mut Complaints,
    fields: Option<&[Field]>,
) -> Vec<Entry> {
    let mut entries = Vec::new();
    if tables.len() > MAX_ENTRIES {
        let message = format!("[{kind}]: {} tables must be at most {MAX_ENTRIES}", tables.len());
        complaints.add(source.complaint(None, None, message));
        return entries;
    }
    for (name, item) in tables.iter() {
        let byte = item.span().map(|span| span.start);
        let place = format!("[{kind}.{name}]");
        if let Some(fields) = fields
            && !fields.iter().any(|field| field.name == name)
        {
            let names = fields.iter().map(|field| field.name.as_str());
            complaints.add(source.complaint(
                byte,
                None,
                format!("{place}: {}", unknown_word("column of runs.csv", name, names)),
            ));
            continue;
        }
        let Some(table) = item.as_table_like() else {
            complaints.add(source.complaint(
                byte,
                Some(name),
                format!("{place} must be a table, as {{ column = \"slip [%]\", unit = \"%\" }}"),
            ));
            continue;
        };
        let has_words = name == "use" && fields.is_some();
        entries.extend(entry(source, (name, byte), table, &place, has_words, complaints));
    }
    entries
}

/// Returns an entry at a byte of the map; `None` if it has a mistake.
fn entry(
    source: &Source<'_>,
    (name, byte): (&str, Option<usize>),
    table: &dyn TableLike,
    place: &str,
    has_words: bool,
    complaints: &mut Complaints,
) -> Option<Entry> {
    let mut keys = Keys::new(source, table, place, Some(name));
    let column = keys.text(complaints, "column").map(Origin::Column);
    let value = keys.scalar(complaints, "value").map(Origin::Value);
    let formula = keys.text(complaints, "formula").map(Origin::Formula);
    let unit = keys.text(complaints, "unit");
    let decimal = decimal(&mut keys, complaints);
    let fills_down = keys.flag(complaints, "fill_down");
    let words = if has_words {
        keys.words(complaints, "words")
    } else {
        BTreeMap::new()
    };
    keys.end(complaints);
    let mut origins = [column, value, formula].into_iter().flatten();
    match (origins.next(), origins.next()) {
        (Some(origin), None) if keys.is_right => Some(Entry {
            name: name.to_owned(),
            line: byte.map_or(1, |byte| source.line(byte)),
            origin,
            unit,
            decimal,
            fills_down,
            words,
        }),
        (Some(_), None) => None,
        (None, _) if !keys.is_right => None,
        _ => {
            complaints.add(source.complaint(
                byte,
                Some(name),
                format!("{place} must have one of column, value and formula"),
            ));
            None
        }
    }
}

fn read_recording(
    source: &Source<'_>,
    table: &dyn TableLike,
    complaints: &mut Complaints,
) -> Option<Recording> {
    let mut keys = Keys::new(source, table, "[recording]", Some("recording"));
    let time = keys.text(complaints, "time");
    let time_unit = keys.text(complaints, "time_unit");
    let marker = keys.text(complaints, "marker");
    let between = keys.list(complaints, "between").into_iter().collect();
    let window = keys.list(complaints, "window_s");
    let histories = keys.flag(complaints, "histories");
    keys.end(complaints);
    let window_s = match window.as_slice() {
        [] => None,
        [from, to] => match (from.parse(), to.parse()) {
            (Ok(from), Ok(to)) if 0.0 <= from && from < to => Some((from, to)),
            _ => {
                keys.complain(
                    complaints,
                    "window_s",
                    format!("[{from}, {to}] must be two times in s, the second after the first"),
                );
                None
            }
        },
        _ => {
            keys.complain(
                complaints,
                "window_s",
                "window_s must be two times in s, as [20, 60]",
            );
            None
        }
    };
    let (Some(time), Some(time_unit), Some(marker)) = (time, time_unit, marker) else {
        let message = "a recording needs time (a column), time_unit and marker (the column that changes from run to run)";
        keys.complain(complaints, "", message);
        return None;
    };
    let line = table
        .iter()
        .next()
        .and_then(|(_, item)| item.span())
        .map_or(1, |span| source.line(span.start));
    keys.is_right.then_some(Recording {
        line,
        time,
        time_unit,
        marker,
        between,
        window_s,
        histories,
    })
}
