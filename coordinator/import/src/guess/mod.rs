//! The guess of a map: it is proposed from the titles of a file, and missing statements become questions.
//!
//! # Layout
//! - this file: the column of each field.
//! - `card`: the contents of a proposal. `word`: the words of columns, and those that mark held-out runs.
//! - `proposal`: the text of a proposed map.

mod card;
mod proposal;
mod word;

pub use card::{ColumnCard, FieldGuess, Guess, QuantityGuess, WordCard};

use crate::complaint::Complaint;
use crate::field::{Field, Kind, fields};
use crate::number::{self, Decimal, Evidence};
use crate::read::{self, Hints, SourceFile};
use crate::table::{Cell, letter};
use crate::title::{self, Stated, Title, Titled};
use crate::unit::Quantity;

/// Number of cells of a column that are shown.
const SAMPLE: usize = 5;

/// Proposes a map for a file. If `sheet` names none of several sheets, the one with the most cells is taken.
///
/// # Errors
/// The complaint about a file that cannot be read. Checked by `tests/guesses.rs`.
pub fn guess(source: &SourceFile<'_>, sheet: Option<&str>) -> Result<Guess, Box<Complaint>> {
    let all = fields();
    let hints = Hints {
        sheet: sheet.map(str::to_owned),
        takes_largest: true,
        ..Hints::default()
    };
    let titled = title::find(read::read(source, &hints)?, (None, None), &all)?;
    let decimal = decimal(&titled);
    let columns = cards(&titled);
    let mut used = vec![false; titled.titles.len()];
    let mut fields = vec![None; all.len()];
    let names: Vec<String> = titled.titles.iter().map(|title| plain(&title.name)).collect();
    // Names of runs.csv come first, because no other title is as certain.
    for is_exact in [true, false] {
        for (field, place) in all.iter().zip(&mut fields) {
            if place.is_none() {
                let column = column_for(field, (&titled.titles, &names), &used, is_exact);
                if let Some(column) = column {
                    used[column] = true;
                    *place = Some(column);
                }
            }
        }
    }
    let mut guessed: Vec<FieldGuess> = all
        .iter()
        .zip(fields)
        .map(|(field, column)| field_guess(field, column, &titled, &columns))
        .collect();
    let components = names.iter().zip(&columns).zip(&used);
    let components = components.filter(|((name, _), is_used)| !**is_used && word::is_component(name));
    let components = components.map(|((_, card), _)| card.name.clone()).collect();
    let quantities = from_rotation(&mut guessed, &titled, &columns, &mut used);
    from_words(&mut guessed, &columns, &mut used);
    let mut proposal = Guess {
        map: String::new(),
        sheet: titled.table.sheet.clone(),
        sheets: titled.table.sheets.clone(),
        title_line: titled.title_line,
        unit_line: titled.unit_line,
        columns,
        fields: guessed,
        quantities,
        components,
        decimal,
        remarks: titled.table.remarks.clone(),
    };
    proposal.map = proposal::text(source.name, &proposal, titled.table.form, titled.data().count());
    Ok(proposal)
}

fn decimal(titled: &Titled) -> Option<String> {
    // Dates and numbers of tests look like numbers, so a column counts only if most of its cells are.
    let is_number = |text: &&str| number::is_number(text);
    let column_texts = |column: usize| {
        let texts: Vec<&str> = titled
            .data()
            .filter_map(|row| match row.cell(column) {
                Cell::Text(text) => Some(text.as_str()),
                _ => None,
            })
            .collect();
        let numbers = texts.iter().filter(|text| is_number(text)).count();
        if numbers * 2 > texts.len() {
            texts
        } else {
            Vec::new()
        }
    };
    match number::decimal_of((0..titled.titles.len()).flat_map(column_texts)) {
        Evidence::Found(Decimal::Comma) => Some(",".into()),
        Evidence::Found(Decimal::Point) => Some(".".into()),
        Evidence::Ambiguous => Some("?".into()),
        Evidence::None => None,
    }
}

fn cards(titled: &Titled) -> Vec<ColumnCard> {
    let card = |(column, title): (usize, &Title)| ColumnCard {
        letter: letter(column),
        title: title.text.clone(),
        name: match titled.column(&title.text) {
            Ok(number) if number == column => title.text.clone(),
            _ => letter(column),
        },
        unit: match title.stated {
            Stated::Unit(unit) => Some(unit.name.to_owned()),
            Stated::Nothing => title.unknown.clone(),
        },
        sample: titled
            .data()
            .map(|row| row.cell(column).shown())
            .take(SAMPLE)
            .collect(),
        words: word::words(titled.data(), column),
    };
    titled.titles.iter().enumerate().map(card).collect()
}

/// Returns a title in lower case, without umlauts, as separate words.
fn plain(text: &str) -> String {
    let text = text
        .to_lowercase()
        .replace('ä', "ae")
        .replace('ö', "oe")
        .replace('ü', "ue")
        .replace('ß', "ss");
    let words = text
        .split(|c: char| !c.is_alphanumeric())
        .filter(|word| !word.is_empty());
    words
        .filter(|word| !["mean", "avg", "average", "mittel", "mittlere", "mittlerer"].contains(word))
        .collect::<Vec<_>>()
        .join(" ")
}

/// Returns the quality of a title's fit: 3 for the same name, 2 for the same words first or last, 1 for a part of a compound.
fn fit(field: &Field, name: &str) -> usize {
    let is_certain = matches!(field.kind, Kind::Measured(_));
    let fit = |title: &String| {
        let is_first = || {
            name.strip_prefix(title.as_str())
                .is_some_and(|rest| rest.starts_with(' '))
        };
        let is_last = || {
            name.strip_suffix(title.as_str())
                .is_some_and(|rest| rest.ends_with(' '))
        };
        if name == title {
            3
        } else if is_certain && (is_first() || is_last()) {
            2
        } else {
            usize::from(is_certain && title.chars().count() > 5 && name.contains(title.as_str()))
        }
    };
    field.titles.iter().map(fit).max().unwrap_or(0)
}

/// Returns the column whose title fits a field best; a column whose unit measures another quantity does not fit.
fn column_for(
    field: &Field,
    (titles, names): (&[Title], &[String]),
    used: &[bool],
    is_exact: bool,
) -> Option<usize> {
    let fits = |column: &usize| {
        let title = &titles[*column];
        if is_exact {
            return usize::from(title.text == field.name);
        }
        match (title.stated, field.quantity()) {
            (Stated::Unit(unit), Some(quantity)) if unit.quantity != quantity => 0,
            (Stated::Unit(_), None) => 0,
            // The letter of an axis says neither which force it is on the rig nor its sign.
            (_, Some(Quantity::Force | Quantity::Torque)) if word::is_component(&names[*column]) => 0,
            _ => fit(field, &names[*column]),
        }
    };
    let free = (0..titles.len()).filter(|&column| !used[column]).rev();
    free.max_by_key(fits).filter(|column| fits(column) > 0)
}

fn field_guess(field: &Field, column: Option<usize>, titled: &Titled, columns: &[ColumnCard]) -> FieldGuess {
    let units: Vec<String> = field
        .quantity()
        .map(|quantity| quantity.units().map(str::to_owned).collect())
        .unwrap_or_default();
    let stated = column.and_then(|column| match titled.titles[column].stated {
        Stated::Unit(unit) => Some(unit.name.to_owned()),
        Stated::Nothing => None,
    });
    let title = column.map(|column| columns[column].title.as_str());
    let meanings = match column {
        Some(column) if field.kind == Kind::Use => word::meanings(&columns[column]),
        _ => Vec::new(),
    };
    let question = match (title, &stated) {
        (Some(title), None) if !units.is_empty() => Some(format!(
            "in which unit is \"{title}\"? The file does not state it"
        )),
        (Some(title), _) if meanings.iter().any(|card| card.means.is_none()) => Some(format!(
            "what do the words of \"{title}\" mean: is the run fitted, held out, or no run"
        )),
        (None, _) if field.is_needed && field.name != "run" => Some(format!(
            "which column has the {}, or which value have all rows",
            field.words
        )),
        _ => None,
    };
    FieldGuess {
        name: field.name.clone(),
        words: field.words.clone(),
        is_needed: field.is_needed,
        units,
        column: column.map(|column| columns[column].name.clone()),
        unit: stated,
        formula: None,
        meanings,
        question,
    }
}

/// If only one of slip and sled speed has a column and another column has the wheel's rotation, the other follows from it.
fn from_rotation(
    fields: &mut [FieldGuess],
    titled: &Titled,
    columns: &[ColumnCard],
    used: &mut [bool],
) -> Vec<QuantityGuess> {
    let has = |fields: &[FieldGuess], name: &str| {
        fields
            .iter()
            .any(|field| field.name == name && field.column.is_some())
    };
    let (name, formula) = match (has(fields, "slip"), has(fields, "sled_speed_m_s")) {
        (false, true) => (
            "slip",
            "(omega * r - sled_speed_m_s) / max(omega * r, sled_speed_m_s)",
        ),
        (true, false) => (
            "sled_speed_m_s",
            "if(slip >= 0, omega * r * (1 - slip), omega * r / (1 + slip))",
        ),
        _ => return Vec::new(),
    };
    let turning = (0..columns.len()).find(|&column| {
        let title = &titled.titles[column];
        !used[column] && matches!(title.stated, Stated::Unit(unit) if unit.quantity == Quantity::AngularSpeed)
    });
    let derived = fields.iter_mut().find(|field| field.name == name);
    let (Some(derived), Some(turning)) = (derived, turning) else {
        return Vec::new();
    };
    used[turning] = true;
    derived.formula = Some(formula.into());
    derived.question = None;
    let radius = (0..columns.len())
        .find(|&column| !used[column] && plain(&titled.titles[column].name).contains("radius"));
    let column = |column: usize| (&titled.titles[column], &columns[column]);
    vec![
        quantity_guess(
            "omega",
            "rotational speed of the wheel",
            Quantity::AngularSpeed,
            Some(column(turning)),
        ),
        quantity_guess(
            "r",
            "radius with which the rig converts slip to rim speed",
            Quantity::Length,
            radius.map(column),
        ),
    ]
}

fn quantity_guess(
    name: &str,
    words: &str,
    quantity: Quantity,
    column: Option<(&Title, &ColumnCard)>,
) -> QuantityGuess {
    let unit = column.and_then(|(title, _)| match title.stated {
        Stated::Unit(unit) if unit.quantity == quantity => Some(unit.name.to_owned()),
        _ => None,
    });
    QuantityGuess {
        name: name.into(),
        words: words.into(),
        units: quantity.units().map(str::to_owned).collect(),
        column: column.map(|(_, card)| card.name.clone()),
        question: unit
            .is_none()
            .then(|| format!("what is the {words}, and in which unit")),
        unit,
    }
}

/// If no title says which runs are held out, the words of a column may.
fn from_words(fields: &mut [FieldGuess], columns: &[ColumnCard], used: &mut [bool]) {
    let marking = (0..columns.len()).find(|&column| !used[column] && word::marks_held_out(&columns[column]));
    let open = fields
        .iter_mut()
        .find(|field| field.name == "use" && field.column.is_none());
    if let (Some(field), Some(column)) = (open, marking) {
        used[column] = true;
        field.column = Some(columns[column].name.clone());
        field.meanings = word::meanings(&columns[column]);
    }
}
