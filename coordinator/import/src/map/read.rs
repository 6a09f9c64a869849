//! The reader of a map: it parses the map's text.

use std::collections::BTreeMap;

use formula::nesting::too_deep;
use shared::file::unknown_word;
use toml_edit::{Document, TableLike};

use super::content::{Entry, Join, Map, Origin, Zero};
use super::entry::{Keys, Source};
use super::{join, recording};
use crate::complaint::{Complaint, Complaints};
use crate::field::Field;
use crate::number::Decimal;

/// Maximum nesting of brackets; a map needs three.
const DEEPEST: usize = 16;
/// Maximum number of columns or quantities in a map. A runs.csv has about two dozen, and each is compared with all titles.
const MAX_ENTRIES: usize = 200;
/// Maximum number of joined files.
const MAX_JOINS: usize = 8;
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
    map.file = join::pattern(&mut keys, "file", complaints);
    map.layout = join::layout(&mut keys, complaints);
    map.has_thousands = thousands(&mut keys, complaints, map.layout.decimal);
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
    if let Some(table) = keys.table(complaints, "recording") {
        map.recording = recording::read(&source, table, complaints);
    }
    if let Some(table) = keys.table(complaints, "join") {
        map.joins = joins(&source, table, complaints);
    }
    keys.end(complaints);
    for entry in map.entries() {
        let is_known = |from: &String| map.joins.iter().any(|join| join.name == *from);
        if let Some(from) = entry.from.as_ref().filter(|from| !is_known(from)) {
            let names = map.joins.iter().map(|join| join.name.as_str());
            let message = format!("{}: {}", entry.name, unknown_word("joined file", from, names));
            complaints.add(Complaint {
                line: Some(entry.line),
                ..source.complaint(None, Some(&entry.name), message)
            });
        }
    }
    map
}

/// Reads the tables of joined files; mistaken ones are left out.
fn joins(source: &Source<'_>, tables: &dyn TableLike, complaints: &mut Complaints) -> Vec<Join> {
    let mut joins = Vec::new();
    if tables.len() > MAX_JOINS {
        let message = format!("[join]: {} tables must be at most {MAX_JOINS}", tables.len());
        complaints.add(source.complaint(None, None, message));
        return joins;
    }
    for (name, item) in tables.iter() {
        let byte = item.span().map(|span| span.start);
        match item.as_table_like() {
            Some(table) => joins.extend(join::read(source, name, table, complaints)),
            None => {
                let message = format!("[join.{name}] must be a table, as {{ file = \"{{stem}}.bag\", … }}");
                complaints.add(source.complaint(byte, None, message));
            }
        }
    }
    joins
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
    let decimal = join::decimal(&mut keys, complaints);
    let fills_down = keys.flag(complaints, "fill_down");
    let from = keys.text(complaints, "from");
    let zero = zero(&mut keys, complaints);
    if column.is_none() && (from.is_some() || zero.is_some()) {
        let message = "from, zero_line and zero_file belong to a column: state `column`, or leave them out";
        keys.complain(complaints, "", message);
    }
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
            from,
            zero,
            reading_at_rest: 0.0,
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

/// Returns what is subtracted from the readings of a column.
fn zero(keys: &mut Keys<'_>, complaints: &mut Complaints) -> Option<Zero> {
    let line = keys.line_number(complaints, "zero_line").map(Zero::Line);
    let file = join::pattern(keys, "zero_file", complaints).map(Zero::File);
    if line.is_some() && file.is_some() {
        let message = "the reading at rest stands in zero_line or in zero_file: leave one of them out";
        keys.complain(complaints, "zero_file", message);
    }
    line.or(file)
}
