//! A map proposed from the titles; what they do not state is asked.

use serde::Serialize;

use crate::complaint::Complaint;
use crate::field::{Field, Kind, fields};
use crate::number::{self, Decimal, Evidence};
use crate::read::{self, Hints, SourceFile};
use crate::table::{Cell, Form, letter};
use crate::title::{self, Stated, Title, Titled};
use crate::unit::Quantity;

/// Cells of a column that are shown.
const SAMPLE: usize = 5;

/// A column of the file.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct ColumnCard {
    /// Its letters: `A`.
    pub letter: String,
    /// Its title.
    pub title: String,
    /// How a map names it: by its title, or by its letters where the title is another column's too.
    pub name: String,
    /// The unit that the file states.
    pub unit: Option<String>,
    /// Its first cells.
    pub sample: Vec<String>,
}

/// Where a column of runs.csv comes from, as proposed.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct FieldGuess {
    /// The column of runs.csv.
    pub name: String,
    /// Words for people.
    pub words: String,
    /// Whether every run needs it.
    pub is_needed: bool,
    /// The units that it can be given in; none of a name.
    pub units: Vec<String>,
    /// The proposed column, as a map names it.
    pub column: Option<String>,
    /// Its unit; null where the file does not state it.
    pub unit: Option<String>,
    /// The proposed formula.
    pub formula: Option<String>,
    /// What must be answered before the map can be used.
    pub question: Option<String>,
}

/// A quantity that a proposed formula needs.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct QuantityGuess {
    /// Its name in formulas.
    pub name: String,
    /// Words for people.
    pub words: String,
    /// The units that it can be given in.
    pub units: Vec<String>,
    /// The proposed column; null where a value for all rows is asked for.
    pub column: Option<String>,
    /// Its unit; null where the file does not state it.
    pub unit: Option<String>,
    /// What must be answered before the map can be used.
    pub question: Option<String>,
}

/// A proposed map, and what it is made from.
#[derive(Debug, Clone, PartialEq, Serialize, utoipa::ToSchema)]
pub struct Guess {
    /// The text of the map.
    pub map: String,
    /// The sheet that is read; null where the file has none.
    pub sheet: Option<String>,
    /// All sheets of the file.
    pub sheets: Vec<String>,
    /// The line of the titles; 0 where there are none.
    pub title_line: usize,
    /// The line of the units below them; null where there is none.
    pub unit_line: Option<usize>,
    /// The columns of the file.
    pub columns: Vec<ColumnCard>,
    /// The columns of runs.csv.
    pub fields: Vec<FieldGuess>,
    /// The quantities of proposed formulas.
    pub quantities: Vec<QuantityGuess>,
    /// The decimal mark of numbers that are texts: `.` or `,`; `?` where they can be read in two ways; null where there are none.
    pub decimal: Option<String>,
    /// What was found out about the file.
    pub remarks: Vec<String>,
}

/// Proposes a map for a file. Of several sheets, that with the most cells is taken where `sheet` names none.
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
    let mut taken = vec![false; titled.titles.len()];
    let mut fields = vec![None; all.len()];
    // The names of runs.csv first: no other title is as certain.
    for is_exact in [true, false] {
        for (field, place) in all.iter().zip(&mut fields) {
            if place.is_none() {
                let found = column_for(field, &titled.titles, &taken, is_exact);
                if let Some(column) = found {
                    taken[column] = true;
                    *place = Some(column);
                }
            }
        }
    }
    let mut guessed: Vec<FieldGuess> = all
        .iter()
        .zip(fields)
        .map(|(field, column)| of_field(field, column, &titled, &columns))
        .collect();
    let quantities = from_rotation(&mut guessed, &titled, &columns, &mut taken);
    let mut found = Guess {
        map: String::new(),
        sheet: titled.table.sheet.clone(),
        sheets: titled.table.sheets.clone(),
        title_line: titled.title_line,
        unit_line: titled.unit_line,
        columns,
        fields: guessed,
        quantities,
        decimal,
        remarks: titled.table.remarks.clone(),
    };
    found.map = text(source.name, &found, titled.table.form);
    Ok(found)
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
            Ok(found) if found == column => title.text.clone(),
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
    };
    titled.titles.iter().enumerate().map(card).collect()
}

/// A title in lower case, without umlauts, each word by itself.
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

/// How well a title fits: 3 the same, 2 the same words first or last, 1 within a compound.
fn fit(field: &Field, title: &Title) -> usize {
    let own = plain(&title.name);
    let is_certain = matches!(field.kind, Kind::Measured(_));
    let of = |known: &String| {
        if own == *known {
            3
        } else if is_certain && (own.starts_with(&format!("{known} ")) || own.ends_with(&format!(" {known}")))
        {
            2
        } else {
            usize::from(is_certain && known.chars().count() > 5 && own.contains(known.as_str()))
        }
    };
    field.titles.iter().map(of).max().unwrap_or(0)
}

/// The column whose title fits a field best; one that states a unit of another quantity does not.
fn column_for(field: &Field, titles: &[Title], taken: &[bool], is_exact: bool) -> Option<usize> {
    let fits = |column: &usize| {
        let title = &titles[*column];
        if is_exact {
            return usize::from(title.text == field.name);
        }
        match (title.stated, field.quantity()) {
            (Stated::Unit(unit), Some(quantity)) if unit.quantity != quantity => 0,
            (Stated::Unit(_), None) => 0,
            _ => fit(field, title),
        }
    };
    let free = (0..titles.len()).filter(|&column| !taken[column]).rev();
    free.max_by_key(fits).filter(|column| fits(column) > 0)
}

fn of_field(field: &Field, column: Option<usize>, titled: &Titled, columns: &[ColumnCard]) -> FieldGuess {
    let units: Vec<String> = field
        .quantity()
        .map(|quantity| quantity.units().map(str::to_owned).collect())
        .unwrap_or_default();
    let stated = column.and_then(|column| match titled.titles[column].stated {
        Stated::Unit(unit) => Some(unit.name.to_owned()),
        Stated::Nothing => None,
    });
    let title = column.map(|column| columns[column].title.as_str());
    let question = match (title, &stated) {
        (Some(title), None) if !units.is_empty() => Some(format!(
            "in which unit is \"{title}\"? The file does not state it"
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
        question,
    }
}

/// Where one of slip and sled speed has no column and another column has the wheel's rotation: the one from the other.
fn from_rotation(
    fields: &mut [FieldGuess],
    titled: &Titled,
    columns: &[ColumnCard],
    taken: &mut [bool],
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
        !taken[column]
            && matches!(title.stated, Stated::Unit(unit) if unit.quantity == Quantity::AngularSpeed)
    });
    let derived = fields.iter_mut().find(|field| field.name == name);
    let (Some(derived), Some(turning)) = (derived, turning) else {
        return Vec::new();
    };
    taken[turning] = true;
    derived.formula = Some(formula.into());
    derived.question = None;
    let radius = (0..columns.len())
        .find(|&column| !taken[column] && plain(&titled.titles[column].name).contains("radius"));
    let quantity = |name: &str, words: &str, quantity: Quantity, column: Option<usize>| {
        let unit = column.and_then(|column| match titled.titles[column].stated {
            Stated::Unit(unit) if unit.quantity == quantity => Some(unit.name.to_owned()),
            _ => None,
        });
        QuantityGuess {
            name: name.into(),
            words: words.into(),
            units: quantity.units().map(str::to_owned).collect(),
            column: column.map(|column| columns[column].name.clone()),
            question: unit
                .is_none()
                .then(|| format!("what is the {words}, and in which unit")),
            unit,
        }
    };
    vec![
        quantity(
            "omega",
            "rotational speed of the wheel",
            Quantity::AngularSpeed,
            Some(turning),
        ),
        quantity(
            "r",
            "radius with which the rig converts slip to rim speed",
            Quantity::Length,
            radius,
        ),
    ]
}

/// A text of TOML in quotes.
fn quoted(text: &str) -> String {
    let escaped = text.chars().map(|c| match c {
        '"' | '\\' => format!("\\{c}"),
        c if c.is_control() => format!("\\u{:04X}", u32::from(c)),
        c => c.to_string(),
    });
    format!("\"{}\"", escaped.collect::<String>())
}

/// The text of a proposed map.
fn text(file: &str, guess: &Guess, form: Form) -> String {
    let name: String = file.chars().filter(|c| !c.is_control()).collect();
    let mut text = format!("# How {name} becomes runs.csv. What is marked with \"?\" must be answered.\n");
    if let Some(sheet) = &guess.sheet {
        text += &format!("sheet = {}\n", quoted(sheet));
    }
    if form != Form::Variables {
        text += &format!(
            "titles = {}                    # line of the titles\n",
            guess.title_line
        );
    }
    if let Some(line) = guess.unit_line {
        text += &format!("units = {line}                     # line of their units\n");
    }
    match guess.decimal.as_deref() {
        Some("?") => {
            text += "decimal = \"?\"                 # \",\" or \".\": is 1,234 a little more than one, or more than a thousand?\n"
        }
        Some(mark) => text += &format!("decimal = \"{mark}\"\n"),
        None => {}
    }
    for field in &guess.fields {
        let origin = match (&field.column, &field.formula) {
            (Some(column), _) => format!("column = {}\n", quoted(column)),
            (None, Some(formula)) => format!("formula = {}\n", quoted(formula)),
            (None, None) if field.is_needed => format!(
                "value = \"?\"                   # the same in all rows; or column = \"…\": {}\n",
                field.words
            ),
            (None, None) => continue,
        };
        text += &format!("\n[columns.{}]\n{origin}", field.name);
        if field.formula.is_none() && !field.units.is_empty() {
            text += &unit_line(field.unit.as_deref(), &field.units);
        }
    }
    for quantity in &guess.quantities {
        let origin = match &quantity.column {
            Some(column) => format!("column = {}\n", quoted(column)),
            None => format!("value = \"?\"                   # {}\n", quantity.words),
        };
        text += &format!(
            "\n[quantities.{}]\n{origin}{}",
            quantity.name,
            unit_line(quantity.unit.as_deref(), &quantity.units)
        );
    }
    let mapped = |column: &&ColumnCard| {
        let name = Some(&column.name);
        guess.fields.iter().any(|field| field.column.as_ref() == name)
            || guess
                .quantities
                .iter()
                .any(|quantity| quantity.column.as_ref() == name)
    };
    let rest: Vec<String> = guess
        .columns
        .iter()
        .filter(|column| !mapped(column))
        .map(|column| quoted(&column.title))
        .collect();
    if !rest.is_empty() {
        text += &format!("\n# Kept as notes: {}\n", rest.join(", "));
    }
    text
}

fn unit_line(unit: Option<&str>, units: &[String]) -> String {
    match unit {
        Some(unit) => format!("unit = {}\n", quoted(unit)),
        None => format!(
            "unit = \"?\"                    # the file does not state it: {}\n",
            units.join(", ")
        ),
    }
}
