//! The titles of a table: their line, and the units that they state.

use std::collections::BTreeMap;

use crate::complaint::Complaint;
use crate::field::Field;
use crate::number;
use crate::table::{Cell, Form, MAX_COLUMNS, Row, Table, column_of, letter, spaced, too_wide};
use crate::unit::{self, Unit};

/// Maximum number of names in a sentence.
const LISTED: usize = 40;
/// Maximum length of a title that is compared with a similar one: the comparison costs the product of both lengths.
const NEAR_BYTES: usize = 200;

/// The unit that a title, or the row of units, states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Stated {
    Nothing,
    Unit(&'static Unit),
}

/// The title of a column.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Title {
    /// The title in the file; without a title, the letters of the column.
    pub(crate) text: String,
    /// The name without its unit.
    pub(crate) name: String,
    pub(crate) stated: Stated,
    /// A text in brackets or in the row of units that is no known unit.
    pub(crate) unknown: Option<String>,
}

/// A table with its titles and its rows of data.
#[derive(Debug)]
pub(crate) struct Titled {
    pub(crate) table: Table,
    pub(crate) titles: Vec<Title>,
    /// The line of the titles; 0 where there are none.
    pub(crate) title_line: usize,
    pub(crate) unit_line: Option<usize>,
    by_text: BTreeMap<String, Vec<usize>>,
    /// Lines of a text with more or fewer fields than titles, with their number of fields.
    pub(crate) misfits: BTreeMap<usize, usize>,
    /// Indices of the rows of data: those below the titles that are not blank.
    data: Vec<usize>,
}

impl Titled {
    /// Returns the rows below the titles, blank ones left out.
    pub(crate) fn data(&self) -> impl Iterator<Item = &Row> {
        self.data.iter().map(|&position| &self.table.rows[position])
    }

    /// Adds a column with a cell for each row of data.
    pub(crate) fn add_column(&mut self, title: Title, cells: impl Iterator<Item = Cell>) {
        let column = self.titles.len();
        self.by_text.entry(title.text.clone()).or_default().push(column);
        self.titles.push(title);
        for (&position, cell) in self.data.iter().zip(cells) {
            let row = &mut self.table.rows[position].cells;
            row.resize(column, Cell::Blank);
            row.push(cell);
        }
    }

    /// Returns whether a row of a text is a comment.
    pub(crate) fn is_comment(&self, row: &Row) -> bool {
        self.table.form == Form::Lines && matches!(row.cell(0), Cell::Text(text) if text.starts_with('#'))
    }

    /// Returns the column that a map names, by its title or else by its letters.
    pub(crate) fn column(&self, meant: &str) -> Result<usize, String> {
        let columns = self.by_text.get(&spaced(meant)).map_or(&[][..], Vec::as_slice);
        match columns[..] {
            [one] => Ok(one),
            [] => match column_of(meant).filter(|&column| column < self.titles.len()) {
                Some(column) => Ok(column),
                None => Err(self.unknown_column(meant)),
            },
            _ => {
                let letters = columns.iter().map(|&k| letter(k));
                Err(format!(
                    "several columns have the title \"{meant}\": name the one that is meant by its letter, {}",
                    listed(letters, " or ")
                ))
            }
        }
    }

    fn unknown_column(&self, meant: &str) -> String {
        let sought = meant.to_lowercase();
        let is_short = |text: &str| text.len() <= NEAR_BYTES;
        let is_near = |title: &&Title| {
            let (text, name) = (title.text.to_lowercase(), title.name.to_lowercase());
            if text == sought || name == sought {
                return true;
            }
            if name.is_empty() || !is_short(&text) || !is_short(&sought) {
                return false;
            }
            let distance =
                strsim::damerau_levenshtein(&name, &sought).min(strsim::damerau_levenshtein(&text, &sought));
            distance <= sought.chars().count().max(name.chars().count()) / 3
        };
        let begins =
            |title: &&Title| sought.chars().count() > 2 && title.text.to_lowercase().starts_with(&sought);
        let near = self
            .titles
            .iter()
            .find(is_near)
            .or_else(|| self.titles.iter().find(begins));
        let titles = || listed(self.titles.iter().map(|title| title.text.clone()), ", ");
        match near {
            Some(near) => format!(
                "no column has the title \"{meant}\"; did you mean \"{}\"",
                near.text
            ),
            None => format!("no column has the title \"{meant}\"; the titles are {}", titles()),
        }
    }
}

/// Returns names in a sentence; only the first of many.
fn listed(names: impl ExactSizeIterator<Item = String>, between: &str) -> String {
    let omitted = names.len().saturating_sub(LISTED);
    let shown = names.take(LISTED).collect::<Vec<_>>().join(between);
    if omitted == 0 {
        shown
    } else {
        format!("{shown} and {omitted} more")
    }
}

/// Parses the row of titles and the row of units.
fn titles_of(titles: Option<&Row>, units: Option<&Row>, width: usize, fields: &[Field]) -> Vec<Title> {
    // `slip` is also a unit's word, but only beside names of runs.csv with that unit.
    let is_runs_csv = titles.is_some_and(|row| row.cells.iter().any(|cell| cell.shown() == "wheel_load_n"));
    let fields: Vec<&Field> = fields
        .iter()
        .filter(|field| is_runs_csv || field.name != "slip")
        .collect();
    let parsed = |column: usize| {
        let text = titles.map(|row| spaced(&row.cell(column).shown()));
        let text = text.unwrap_or_default();
        let text = if column == 0 {
            text.trim_start_matches('#').trim_start()
        } else {
            &text
        };
        let below = units
            .map(|row| row.cell(column).shown())
            .filter(|text| !text.is_empty());
        title(text, column, below, &fields)
    };
    (0..width).map(parsed).collect()
}

/// Finds the titles; `stated` are the lines of titles and units in the map, 0 for none.
pub(crate) fn find(
    table: Table,
    stated: (Option<usize>, Option<usize>),
    fields: &[Field],
) -> Result<Titled, Box<Complaint>> {
    let (titles_at, units_at) = stated;
    let position = |line: usize| {
        let at = table
            .rows
            .iter()
            .position(|row| row.line == line && !row.is_blank());
        at.ok_or_else(|| {
            table.refusal(format!(
                "{} of the map's titles or units is blank or not there",
                table.place(line)
            ))
        })
    };
    let at = match (titles_at, table.form) {
        (_, Form::Variables) => Some(0),
        (Some(0), _) => None,
        (Some(line), _) => Some(position(line)?),
        (None, _) => guessed(&table)?,
    };
    let units = match (units_at, at) {
        (Some(0), _) | (None, None) => None,
        (Some(line), _) => Some(position(line)?),
        (None, Some(at)) => table.rows[at + 1..]
            .iter()
            .position(|row| !row.is_blank())
            .map(|k| at + 1 + k)
            .filter(|&k| is_units(&table.rows[k])),
    };
    let first = at.max(units).map_or(0, |k| k + 1);
    let width = table.rows[first..]
        .iter()
        .chain(at.map(|k| &table.rows[k]))
        .map(|row| row.cells.len())
        .max()
        .unwrap_or(0);
    if width > MAX_COLUMNS {
        return Err(table.refusal(too_wide(width)));
    }
    let titles = at.map(|k| &table.rows[k]);
    let titles = titles_of(titles, units.map(|k| &table.rows[k]), width, fields);
    let mut by_text: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (column, title) in titles.iter().enumerate() {
        by_text.entry(title.text.clone()).or_default().push(column);
    }
    let is_filled = |&position: &usize| !table.rows[position].is_blank();
    let misfits = match at {
        Some(at) if table.form == Form::Lines => misfits(&table.rows[first..], table.rows[at].cells.len()),
        _ => BTreeMap::new(),
    };
    Ok(Titled {
        misfits,
        data: (first..table.rows.len()).filter(is_filled).collect(),
        by_text,
        title_line: at.map_or(0, |k| table.rows[k].line),
        unit_line: units.map(|k| table.rows[k].line),
        titles,
        table,
    })
}

/// Returns the lines whose number of fields is not that of the titles, blank ones at the end not counted.
fn misfits(rows: &[Row], width: usize) -> BTreeMap<usize, usize> {
    let is_misfit = |row: &&Row| {
        let filled = row.cells.iter().rposition(|cell| !cell.is_blank());
        filled.is_some_and(|last| last >= width) || row.cells.len() < width
    };
    let misfits = rows.iter().filter(is_misfit);
    misfits.map(|row| (row.line, row.cells.len())).collect()
}

fn is_number(cell: &Cell) -> bool {
    match cell {
        Cell::Number(_) => true,
        Cell::Text(text) => number::is_number(text),
        Cell::Blank | Cell::NoResult => false,
    }
}

/// Returns whether the row below the titles has their units.
fn is_units(row: &Row) -> bool {
    let mut cells = row.cells.iter().filter(|cell| !cell.is_blank());
    let is_like = |cell: &Cell| matches!(cell, Cell::Text(text) if unit::is_like_a_unit(text));
    cells.clone().any(is_like) && cells.all(is_like)
}

/// Returns the index of the titles: the last row with words above the first row with about as many numbers as any row has.
fn guessed(table: &Table) -> Result<Option<usize>, Box<Complaint>> {
    let numbers = |row: &Row| row.cells.iter().filter(|cell| is_number(cell)).count();
    let max_numbers = table.rows.iter().map(numbers).max().unwrap_or(0);
    if max_numbers == 0 {
        return Err(table
            .refusal("no row has a number: a table with a row of titles and rows of numbers is expected"));
    }
    let Some(data) = table
        .rows
        .iter()
        .position(|row| numbers(row) * 10 >= max_numbers * 6)
    else {
        return Ok(None);
    };
    let above = table.rows[..data]
        .iter()
        .rposition(|row| !row.is_blank() && !is_units(row));
    Ok(above.filter(|&at| {
        let row = &table.rows[at];
        let words = row
            .cells
            .iter()
            .filter(|cell| !cell.is_blank() && !is_number(cell))
            .count();
        words * 2 > row.cells.iter().filter(|cell| !cell.is_blank()).count()
    }))
}

/// Parses a title; `below` is the cell of the row of units.
fn title(text: &str, column: usize, below: Option<String>, fields: &[&Field]) -> Title {
    let shown = if text.is_empty() {
        letter(column)
    } else {
        text.to_owned()
    };
    let (name, unit_text) = apart(text);
    // Names of runs.csv imply their units.
    let quantity = fields
        .iter()
        .find(|field| field.name == text)
        .and_then(|field| field.quantity());
    let implied = quantity.and_then(|quantity| {
        unit::find(if quantity.si() == "rad" {
            "deg"
        } else {
            quantity.si()
        })
    });
    let below = below.map(|text| text.trim_matches(['[', ']', '(', ')']).trim().to_owned());
    let (stated, unknown) = match (below, implied, unit_text) {
        (Some(below), _, _) => (unit::find(&below), Some(below)),
        (None, Some(implied), _) => (Some(implied), None),
        (None, None, Some(text)) => (unit::find(&text), Some(text)),
        (None, None, None) => (None, None),
    };
    Title {
        text: shown,
        name,
        stated: stated.map_or(Stated::Nothing, Stated::Unit),
        unknown: unknown.filter(|_| stated.is_none()),
    }
}

/// Units that may follow a title without brackets: none is a word of a language, a sign of a mean, or a number.
const BARE: [&str; 26] = [
    "N", "kN", "mm", "cm", "%", "rpm", "deg", "°", "ms", "kgf", "lbf", "Nm", "Ncm", "Nmm", "mm/s", "cm/s",
    "m/s", "km/h", "m/h", "rad/s", "deg/s", "U/min", "1/min", "mm/min", "kp", "daN",
];

/// Returns the name and the unit of a title: `load [kN]`, `load (kN)`, `load / kN`, `load in kN`, `load_kN`, `load kN`.
fn apart(text: &str) -> (String, Option<String>) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, rest)) = text.rsplit_once(open)
            && let Some((inside, after)) = rest.split_once(close)
            && after.trim().is_empty()
            && !inside.trim().is_empty()
        {
            return (name.trim().to_owned(), Some(inside.trim().to_owned()));
        }
    }
    for between in [" / ", " in ", "/ "] {
        if let Some((name, unit)) = text.rsplit_once(between)
            && unit::find(unit).is_some()
        {
            return (name.trim().to_owned(), Some(unit.trim().to_owned()));
        }
    }
    if let Some((name, unit)) = text.rsplit_once([' ', '_'])
        && BARE.contains(&unit)
    {
        return (name.trim().to_owned(), Some(unit.to_owned()));
    }
    (text.to_owned(), None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::fields;

    #[test]
    fn a_title_states_its_unit_in_many_ways() {
        let fields = fields();
        let all_fields: Vec<&Field> = fields.iter().collect();
        for (text, name, unit) in [
            ("Radlast [kN]", "Radlast", Some("kN")),
            ("load (kgf)", "load", Some("kgf")),
            ("pull / N", "pull", Some("N")),
            ("Zugkraft in daN", "Zugkraft", Some("daN")),
            ("sinkage_mm", "sinkage", Some("mm")),
            ("Schlupf %", "Schlupf", Some("%")),
            ("Drehzahl [U/min]", "Drehzahl", Some("rpm")),
            ("slip [-]", "slip", Some("1")),
            ("slip_m", "slip_m", None),
            ("pull_min", "pull_min", None),
            ("slip ratio", "slip ratio", None),
            ("load [kg]", "load", None),
            ("sinkage_m", "sinkage_m", Some("m")),
            ("wheel_load_n", "wheel_load_n", Some("N")),
        ] {
            let title = title(text, 0, None, &all_fields);
            let stated = match title.stated {
                Stated::Unit(unit) => Some(unit.name),
                Stated::Nothing => None,
            };
            assert_eq!((title.name.as_str(), stated), (name, unit), "{text}");
        }
        assert_eq!(
            title("load [kg]", 0, None, &all_fields).unknown.as_deref(),
            Some("kg")
        );
        assert_eq!(
            title("load", 0, Some("(N)".into()), &all_fields).stated,
            Stated::Unit(unit::find("N").unwrap())
        );
    }
}
