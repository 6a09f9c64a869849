//! Keys of a table of a map, read with all their mistakes.

use std::collections::BTreeMap;

use shared::file::unknown_word;
use toml_edit::{Item, TableLike};

use super::content::QUESTION;
use crate::complaint::{Complaint, Complaints};
use crate::field::RowUse;
use crate::table::spaced;

/// The text of a map, for lines.
pub(super) struct Source<'a> {
    pub(super) file: &'a str,
    pub(super) text: &'a str,
}

impl Source<'_> {
    pub(super) fn line(&self, byte: usize) -> usize {
        self.text.bytes().take(byte).filter(|&b| b == b'\n').count() + 1
    }

    pub(super) fn complaint(
        &self,
        byte: Option<usize>,
        field: Option<&str>,
        message: impl Into<String>,
    ) -> Complaint {
        Complaint {
            file: self.file.to_owned(),
            line: byte.map(|byte| self.line(byte)),
            field: field.map(str::to_owned),
            message: message.into(),
            ..Complaint::default()
        }
    }
}

/// A table of a map; it remembers the keys that were asked for.
pub(super) struct Keys<'a> {
    source: &'a Source<'a>,
    table: &'a dyn TableLike,
    /// Place of the table, for example `[columns.slip]`; blank for the map itself.
    name: String,
    field: Option<String>,
    asked: Vec<&'static str>,
    pub(super) is_right: bool,
}

impl<'a> Keys<'a> {
    pub(super) fn new(
        source: &'a Source<'a>,
        table: &'a dyn TableLike,
        name: &str,
        field: Option<&str>,
    ) -> Self {
        Keys {
            source,
            table,
            name: name.to_owned(),
            field: field.map(str::to_owned),
            asked: Vec::new(),
            is_right: true,
        }
    }

    fn place(&self) -> String {
        if self.name.is_empty() {
            String::new()
        } else {
            format!("{}: ", self.name)
        }
    }

    fn wrong(&mut self, complaints: &mut Complaints, item: Option<&Item>, message: String) {
        let place = self.place();
        let byte = item.and_then(Item::span).map(|span| span.start);
        self.is_right = false;
        complaints.add(
            self.source
                .complaint(byte, self.field.as_deref(), place + &message),
        );
    }

    fn item(&mut self, key: &'static str) -> Option<&'a Item> {
        self.asked.push(key);
        self.table.get(key)
    }

    pub(super) fn text(&mut self, complaints: &mut Complaints, key: &'static str) -> Option<String> {
        let item = self.item(key)?;
        let value = item.as_str();
        if value.is_none() {
            self.wrong(complaints, Some(item), format!("{key} must be a text in quotes"));
        }
        value.map(str::to_owned)
    }

    /// Returns a text, a number or a whole number, as a text.
    pub(super) fn scalar(&mut self, complaints: &mut Complaints, key: &'static str) -> Option<String> {
        let item = self.item(key)?;
        let value = scalar(item);
        if value.is_none() {
            self.wrong(
                complaints,
                Some(item),
                format!("{key} must be a number or a text in quotes"),
            );
        }
        value
    }

    pub(super) fn flag(&mut self, complaints: &mut Complaints, key: &'static str) -> bool {
        let Some(item) = self.item(key) else {
            return false;
        };
        let value = item.as_bool();
        if value.is_none() {
            self.wrong(complaints, Some(item), format!("{key} must be true or false"));
        }
        value.unwrap_or(false)
    }

    pub(super) fn line_number(&mut self, complaints: &mut Complaints, key: &'static str) -> Option<usize> {
        let item = self.item(key)?;
        let value = item.as_integer().and_then(|number| usize::try_from(number).ok());
        if value.is_none() {
            self.wrong(
                complaints,
                Some(item),
                format!("{key} must be the number of a line, 0 where there is none"),
            );
        }
        value
    }

    /// Returns a finite number.
    pub(super) fn number(&mut self, complaints: &mut Complaints, key: &'static str) -> Option<f64> {
        let item = self.item(key)?;
        let integer = || item.as_integer().map(|number| number as f64);
        let value = item
            .as_float()
            .or_else(integer)
            .filter(|number| number.is_finite());
        if value.is_none() {
            self.wrong(complaints, Some(item), format!("{key} must be a number in s"));
        }
        value
    }

    /// Returns a number above 0.
    pub(super) fn positive(&mut self, complaints: &mut Complaints, key: &'static str) -> Option<f64> {
        let value = self.number(complaints, key)?;
        if value <= 0.0 {
            self.complain(complaints, key, format!("{key} {value} s must be > 0"));
        }
        (value > 0.0).then_some(value)
    }

    /// Returns a list of numbers or texts, as texts.
    pub(super) fn list(&mut self, complaints: &mut Complaints, key: &'static str) -> Vec<String> {
        let Some(item) = self.item(key) else {
            return Vec::new();
        };
        let value: Option<Vec<String>> = item.as_array().and_then(|list| {
            list.iter()
                .map(|value| scalar(&Item::Value(value.clone())))
                .collect()
        });
        if value.is_none() {
            self.wrong(
                complaints,
                Some(item),
                format!("{key} must be a list of numbers or texts"),
            );
        }
        value.unwrap_or_default()
    }

    /// Returns a table of words and their meanings, each a [`RowUse`].
    pub(super) fn words(
        &mut self,
        complaints: &mut Complaints,
        key: &'static str,
    ) -> BTreeMap<String, RowUse> {
        let mut words = BTreeMap::new();
        let Some(table) = self.table(complaints, key) else {
            return words;
        };
        for (word, item) in table.iter() {
            let stated = item.as_str().unwrap_or_default();
            if let Ok(row_use) = stated.parse() {
                words.insert(spaced(word), row_use);
                continue;
            }
            let is_open = stated == QUESTION;
            let what = if is_open {
                " = \"?\" asks for an answer:"
            } else {
                " must be"
            };
            let message =
                format!("{key}: \"{word}\"{what} \"fit\", \"holdout\" (never fitted) or \"skip\" (no run)");
            let plain = format!("What does \"{word}\" mean: is the run fitted, held out, or no run?");
            self.is_right = false;
            complaints.add(Complaint {
                plain: is_open.then_some(plain),
                ..self.source.complaint(
                    item.span().map(|span| span.start),
                    self.field.as_deref(),
                    self.place() + &message,
                )
            });
        }
        words
    }

    /// Returns a table within this one, with the byte at which it begins.
    pub(super) fn table(
        &mut self,
        complaints: &mut Complaints,
        key: &'static str,
    ) -> Option<&'a dyn TableLike> {
        let item = self.item(key)?;
        let value = item.as_table_like();
        if value.is_none() {
            self.wrong(complaints, Some(item), format!("{key} must be a table"));
        }
        value
    }

    /// A complaint about a key that is there, or about the table.
    pub(super) fn complain(&mut self, complaints: &mut Complaints, key: &str, message: impl Into<String>) {
        let item = self.table.get(key);
        self.wrong(complaints, item, message.into());
    }

    /// Asks for the missing answer to a key of the map; `plain` is the question for users who see no map.
    pub(super) fn ask(&mut self, complaints: &mut Complaints, key: &str, message: &str, plain: &str) {
        let byte = self.table.get(key).and_then(Item::span).map(|span| span.start);
        self.is_right = false;
        complaints.add(Complaint {
            plain: Some(plain.to_owned()),
            ..self
                .source
                .complaint(byte, self.field.as_deref(), self.place() + message)
        });
    }

    /// Complains about all keys that are not asked for.
    pub(super) fn end(&mut self, complaints: &mut Complaints) {
        for (key, item) in self.table.iter() {
            if !self.asked.contains(&key) {
                self.wrong(
                    complaints,
                    Some(item),
                    unknown_word("key", key, self.asked.clone()),
                );
            }
        }
    }
}

/// Returns a number or a text as a text.
fn scalar(item: &Item) -> Option<String> {
    let number = || item.as_float().map(|value| value.to_string());
    item.as_str()
        .map(str::to_owned)
        .or_else(|| item.as_integer().map(|value| value.to_string()))
        .or_else(number)
}
