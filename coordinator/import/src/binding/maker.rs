//! The maker of a binding: it binds the entries of a map to the columns of a table, and collects every mistake.

use formula::expression::Expression;
use formula::unit::Unit as Dimension;

use super::source::{From, Input, Reading};
use crate::complaint::{Complaint, Complaints};
use crate::field::Field;
use crate::map::{Entry, Map, Mark, Origin, QUESTION, quantity_of};
use crate::number::{self, Decimal, Evidence, Writing};
use crate::table::Cell;
use crate::title::{Stated, Title, Titled};
use crate::unit::{self, Quantity, Unit};

/// The input and the progress of a binding.
pub(super) struct Maker<'a> {
    pub(super) map: &'a Map,
    pub(super) map_file: &'a str,
    pub(super) titled: &'a Titled,
    pub(super) fields: &'a [Field],
    pub(super) remarks: &'a mut Vec<String>,
    pub(super) complaints: &'a mut Complaints,
}

/// Returns the dimension that formulas have for a quantity.
pub(super) fn dimension(quantity: Quantity) -> Dimension {
    Dimension::parse(quantity.si()).unwrap_or(Dimension::ONE)
}

impl<'a> Maker<'a> {
    pub(super) fn complain(&mut self, entry: &Entry, message: impl Into<String>) {
        self.complaints.add(Complaint {
            file: self.map_file.to_owned(),
            line: Some(entry.line),
            field: Some(entry.name.clone()),
            message: format!("{}: {}", entry.name, message.into()),
            ..Complaint::default()
        });
    }

    /// Asks for a missing answer of an entry; `plain` is the question for users who see no map.
    fn ask(&mut self, entry: &Entry, message: &str, plain: String) {
        self.complaints.add(Complaint {
            file: self.map_file.to_owned(),
            line: Some(entry.line),
            field: Some(entry.name.clone()),
            message: format!("{}: {message}", entry.name),
            plain: Some(plain),
            ..Complaint::default()
        });
    }

    /// Returns the description of a column of runs.csv for users.
    fn words(&self, entry: &Entry) -> Option<&'a str> {
        let field = self.fields.iter().find(|field| field.name == entry.name);
        field.map(|field| field.words.as_str())
    }

    /// Returns the column of an entry; one whose joined file could not be joined has a complaint already.
    fn column(&mut self, entry: &Entry) -> Option<usize> {
        if entry.from.is_some() {
            return None;
        }
        let result = self.titled.column(entry.column().unwrap_or_default());
        result.map_err(|message| self.complain(entry, message)).ok()
    }

    /// Returns the unit that the map states, otherwise that of the title.
    fn unit(
        &mut self,
        entry: &Entry,
        column: Option<usize>,
        quantity: Option<Quantity>,
    ) -> Option<&'static Unit> {
        let title = column.and_then(|column| self.titled.titles.get(column)).cloned();
        let stated = match title.as_ref().map(|title| title.stated) {
            Some(Stated::Unit(unit)) => Some(unit),
            _ => None,
        };
        if entry.unit.as_deref() == Some(QUESTION) {
            self.ask_unit(entry, title.as_ref(), quantity);
            return None;
        }
        let read = |text: &str| match quantity.or_else(|| quantity_of(text)) {
            Some(quantity) => unit::read(text, quantity),
            None => Err(format!("unknown unit \"{text}\"")),
        };
        let result = match (&entry.unit, stated, &title) {
            (Some(text), _, _) => read(text),
            (None, Some(stated), _) => read(stated.name),
            (None, None, Some(title)) => Err(match &title.unknown {
                Some(unknown) => format!(
                    "the title says \"{unknown}\"; {}; state `unit` in the map",
                    read(unknown).err().unwrap_or_default()
                ),
                None => format!(
                    "the title \"{}\" states no unit: state `unit` in the map, one of {}",
                    title.text,
                    choices(quantity)
                ),
            }),
            (None, None, None) => Err(format!(
                "a value needs its unit: state `unit`, one of {}",
                choices(quantity)
            )),
        };
        match result {
            Ok(result) => {
                if let (Some(stated), Some(title)) = (stated, title)
                    && stated.name != result.name
                {
                    self.remarks.push(format!(
                        "\"{}\" is read in {}, as the map says",
                        title.text, result.name
                    ));
                }
                Some(result)
            }
            Err(message) => {
                self.complain(entry, message);
                None
            }
        }
    }

    fn ask_unit(&mut self, entry: &Entry, title: Option<&Title>, quantity: Option<Quantity>) {
        let message = format!(
            "unit = \"?\" asks for an answer, which the file does not state: one of {}",
            choices(quantity)
        );
        let what = title.map_or_else(|| "it".to_owned(), |title| format!("\"{}\"", title.text));
        self.ask(
            entry,
            &message,
            format!("In which unit is {what}? The file does not state it."),
        );
    }

    /// Returns the column or value of a number, and its unit.
    pub(super) fn input(
        &mut self,
        entry: &Entry,
        quantity: Option<Quantity>,
    ) -> Option<(Input, &'static Unit)> {
        match &entry.origin {
            Origin::Column(_) => {
                let column = self.column(entry)?;
                let unit = self.unit(entry, Some(column), quantity)?;
                let with = Reading {
                    writing: None,
                    stated_decimal: entry.decimal,
                    si: unit.si,
                    at_rest: entry.reading_at_rest,
                };
                let from = From::Column {
                    column,
                    fills_down: entry.fills_down,
                    with,
                };
                let name = entry.name.clone();
                let fixed = 0.0;
                Some((Input { name, from, fixed }, unit))
            }
            Origin::Value(text) if text == QUESTION => {
                let what = self.words(entry).map_or_else(
                    || "How large is it".to_owned(),
                    |words| format!("What is the {words}"),
                );
                self.ask(
                    entry,
                    "value = \"?\" asks for an answer: the value that all rows have, with its unit",
                    format!(
                        "{what}? Choose its column, or give the value that all rows have, with its unit."
                    ),
                );
                None
            }
            Origin::Value(text) => self.fixed(entry, text, quantity),
            Origin::Formula(_) => {
                self.complain(
                    entry,
                    "a quantity must have column or value; formulas stand in [columns]",
                );
                None
            }
        }
    }

    /// Returns a value for all rows, and its unit.
    fn fixed(
        &mut self,
        entry: &Entry,
        text: &str,
        quantity: Option<Quantity>,
    ) -> Option<(Input, &'static Unit)> {
        let unit = self.unit(entry, None, quantity);
        // A value in TOML is a number; one in quotes may be written as in the file.
        let writing = Writing {
            decimal: entry
                .decimal
                .or(self.map.layout.decimal)
                .unwrap_or(Decimal::Point),
            has_thousands: false,
        };
        let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
        let value = match value.map_or_else(|| number::read(text, writing), Ok) {
            Ok(value) => value,
            Err(message) => {
                self.complain(entry, message);
                return None;
            }
        };
        let unit = unit?;
        let input = Input {
            name: entry.name.clone(),
            from: From::Fixed(text.to_owned()),
            fixed: value * unit.si,
        };
        Some((input, unit))
    }

    pub(super) fn quantity(&mut self, entry: &Entry) -> Option<(Input, Dimension)> {
        let is_name = entry.name.chars().next().is_some_and(|c| c.is_ascii_alphabetic())
            && entry.name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !is_name || Expression::read(&entry.name, &[]).is_ok() {
            self.complain(
                entry,
                "the name of a quantity must be of letters, digits and _, and mean nothing else in formulas",
            );
            return None;
        }
        let (input, unit) = self.input(entry, None)?;
        Some((input, dimension(unit.quantity)))
    }

    pub(super) fn text(&mut self, entry: &Entry) -> Option<From<()>> {
        if entry.unit.is_some() {
            self.complain(
                entry,
                "a name or a number without unit has no unit: leave `unit` out",
            );
        }
        if !entry.words.is_empty() && !matches!(entry.origin, Origin::Column(_)) {
            self.complain(
                entry,
                "words are those of a column: state `column`, or leave `words` out",
            );
        }
        match &entry.origin {
            Origin::Value(text) if text == QUESTION => {
                let words = self.words(entry).unwrap_or(&entry.name);
                self.ask(
                    entry,
                    "value = \"?\" asks for an answer: the value that all rows have, as experiment.toml names it",
                    format!("Which {words}? Choose its column, or give one name for all rows."),
                );
                None
            }
            Origin::Value(text) => Some(From::Fixed(text.clone())),
            Origin::Column(_) | Origin::Formula(_) => {
                let column = self.column(entry)?;
                Some(From::Column {
                    column,
                    fills_down: entry.fills_down,
                    with: (),
                })
            }
        }
    }

    pub(super) fn formula(
        &mut self,
        entry: &Entry,
        text: &str,
        quantity: Quantity,
        names: &[(String, Dimension)],
    ) -> Option<Expression> {
        if entry.unit.is_some() {
            self.complain(entry, "a formula gives SI units, angles in rad: leave `unit` out");
        }
        let words: Vec<&str> = text
            .split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
            .collect();
        let entries = self.map.quantities.iter().chain(&self.map.columns);
        let unbound = entries.filter(|entry| {
            words.contains(&entry.name.as_str()) && !names.iter().any(|(bound, _)| *bound == entry.name)
        });
        let unbound: Vec<&Entry> = unbound.collect();
        if let Some(blocking) = unbound
            .iter()
            .find(|entry| matches!(entry.origin, Origin::Formula(_)))
        {
            let message = format!(
                "formula \"{text}\": {} has a formula itself: write it out",
                blocking.name
            );
            self.complain(entry, message);
        }
        if !unbound.is_empty() {
            // Other unbound names have complaints already.
            return None;
        }
        let expected = dimension(quantity);
        match Expression::read(text, names) {
            Err(message) => {
                self.complain(entry, format!("formula \"{text}\": {message}"));
                None
            }
            Ok(expression) if expression.unit().is_some_and(|unit| unit != expected) => {
                let unit = expression.unit().unwrap_or(Dimension::ONE);
                self.complain(
                    entry,
                    format!(
                        "formula \"{text}\" gives {unit}, and {} in {} is expected",
                        quantity.words(),
                        quantity.si()
                    ),
                );
                None
            }
            Ok(expression) => Some(expression),
        }
    }

    /// Returns the condition that holds during a run, as a formula that is 1 where it does.
    pub(super) fn condition(&mut self, names: &[(String, Dimension)]) -> Option<Expression> {
        let recording = self.map.recording.as_ref()?;
        let Mark::Condition { text, .. } = &recording.mark else {
            return None;
        };
        let formula = format!("if({text}, 1, 0)");
        let wrong = |message| Complaint {
            file: self.map_file.to_owned(),
            line: Some(recording.line),
            field: Some("recording".into()),
            message: format!("[recording]: while, as the formula \"{formula}\": {message}"),
            ..Complaint::default()
        };
        let read = Expression::read(&formula, names).map_err(wrong);
        read.map_err(|complaint| self.complaints.add(complaint)).ok()
    }

    /// The notation of numbers: as the map states it, otherwise as the texts of all columns show.
    pub(super) fn settle_decimals(&mut self, inputs: &mut [Input]) {
        let stated = self.map.layout.decimal;
        let columns: Vec<usize> = inputs
            .iter()
            .filter_map(|input| match &input.from {
                From::Column { column, with, .. } if with.stated_decimal.is_none() => Some(*column),
                _ => None,
            })
            .collect();
        let texts = || {
            self.titled
                .data()
                .flat_map(|row| columns.iter().map(move |&column| row.cell(column)))
                .filter_map(|cell| match cell {
                    Cell::Text(text) => Some(text.as_str()),
                    _ => None,
                })
        };
        let result = match stated {
            Some(decimal) => Some(decimal),
            None => match number::decimal_of(texts()) {
                Evidence::Found(decimal) => Some(decimal),
                Evidence::None => Some(Decimal::Point),
                Evidence::Ambiguous => None,
            },
        };
        if result.is_none() {
            let example = texts()
                .find(|text| text.contains([',', '.']))
                .unwrap_or_default()
                .to_owned();
            self.complaints.add(Complaint {
                file: self.map_file.to_owned(),
                message: format!("all numbers are like \"{example}\", which can be read in two ways: state `decimal = \",\"` or `decimal = \".\"` in the map"),
                ..Complaint::default()
            });
        }
        for input in inputs {
            if let From::Column { with, .. } = &mut input.from {
                let has_thousands = self.map.has_thousands && with.stated_decimal.is_none();
                with.writing = with.stated_decimal.or(result).map(|decimal| Writing {
                    decimal,
                    has_thousands,
                });
            }
        }
    }
}

/// Returns the units of a quantity in a sentence.
fn choices(quantity: Option<Quantity>) -> String {
    quantity.map_or_else(
        || "a unit".to_owned(),
        |quantity| quantity.units().collect::<Vec<_>>().join(", "),
    )
}
