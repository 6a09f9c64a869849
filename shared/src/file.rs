//! Text files by name, and errors that name file, line and the nearest known word.

use std::collections::BTreeMap;
use std::ops::Range;

use serde::de::DeserializeOwned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

pub use formula::word::unknown_word;

use crate::sentence::one_line;
use crate::toml_message::plain;

/// A TOML file and the files it names, as text. The same value comes from disk and over REST.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FileSet {
    /// Text of the TOML file itself.
    pub toml: String,
    /// Texts of the files that the TOML file names, by the names used there.
    pub files: BTreeMap<String, String>,
}

impl FileSet {
    /// Returns the text of a file that is named in the file `by`; a [`FileError`] of `by` if the file is not in the set.
    pub fn named(&self, by: &str, file: &str) -> Result<&str, FileError> {
        let text = self.files.get(file).map(String::as_str);
        text.ok_or_else(|| FileError::whole(by, format!("file \"{file}\" is named but was not sent")))
    }
}

/// Why a file cannot be used: file, line and mistake.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", one_line(&format!("{file}{}: {message}", place(*line, *column))))]
pub struct FileError {
    /// Name of the file as the user wrote it.
    pub file: String,
    /// Line, counted from 1; `None` if the whole file is to blame.
    pub line: Option<usize>,
    /// Column, counted from 1; `None` if no column is to blame.
    pub column: Option<usize>,
    /// The mistake: quantity, value, unit, bound.
    pub message: String,
}

fn place(line: Option<usize>, column: Option<usize>) -> String {
    match (line, column) {
        (Some(line), Some(column)) => format!(" line {line}, column {column}"),
        (Some(line), None) => format!(" line {line}"),
        _ => String::new(),
    }
}

impl FileError {
    /// Returns an error of a whole file.
    pub fn whole(file: &str, message: impl Into<String>) -> Self {
        FileError {
            file: file.to_owned(),
            line: None,
            column: None,
            message: message.into(),
        }
    }

    /// Returns an error of one line, counted from 1.
    pub fn at(file: &str, line: usize, message: impl Into<String>) -> Self {
        FileError {
            file: file.to_owned(),
            line: Some(line),
            column: None,
            message: message.into(),
        }
    }
}

/// The maximum nesting of brackets; a job needs three.
const DEEPEST: usize = 16;
/// The maximum size of a TOML file `[bytes]`: the parser takes 80 ns per byte.
const LARGEST_TOML: usize = 1 << 20;

/// A TOML file that is parsed and keeps the place of every value, so that its tables can be read one by one.
#[derive(Debug)]
pub struct TomlFile<'t> {
    name: &'t str,
    text: &'t str,
    root: toml::Spanned<DeTable<'t>>,
}

impl<'t> TomlFile<'t> {
    /// Parses a file; `name` is how messages call it. A [`FileError`] names the line where the parser stopped.
    pub fn parse(name: &'t str, text: &'t str) -> Result<Self, FileError> {
        if text.len() > LARGEST_TOML {
            let message = format!("{} bytes must be at most {LARGEST_TOML} bytes", text.len());
            return Err(FileError::whole(name, message));
        }
        if let Some(byte) = formula::nesting::too_deep(text, DEEPEST) {
            let message = format!("brackets must be nested at most {DEEPEST} deep");
            return Err(FileError::at(name, line_of(text, byte), message));
        }
        let root = DeTable::parse(text).map_err(|e| toml_error(name, text, &e))?;
        Ok(TomlFile { name, text, root })
    }

    /// Returns the value of a key of the file's root.
    pub fn get(&self, key: &str) -> Option<&toml::Spanned<DeValue<'t>>> {
        self.root.get_ref().get(key)
    }

    /// Reads one value of the file. A [`FileError`] names the line of a value that does not fit `T`.
    pub fn read<T: DeserializeOwned>(&self, value: toml::Spanned<DeValue<'t>>) -> Result<T, FileError> {
        T::deserialize(ValueDeserializer::from(value)).map_err(|e| toml_error(self.name, self.text, &e))
    }

    /// Reads the whole file. A [`FileError`] names the line of a value that does not fit `T`.
    pub fn read_all<T: DeserializeOwned>(self) -> Result<T, FileError> {
        T::deserialize(toml::Deserializer::from(self.root)).map_err(|e| toml_error(self.name, self.text, &e))
    }

    /// Returns an error in the line of a place of the file.
    pub fn error_at(&self, place: &Range<usize>, message: impl Into<String>) -> FileError {
        FileError::at(self.name, line_of(self.text, place.start), message)
    }

    /// Returns an error of the file as a whole.
    pub fn error(&self, message: impl Into<String>) -> FileError {
        FileError::whole(self.name, message)
    }
}

/// Parses TOML into `T`; an unknown key is an error that names its line and the nearest known key. A [`FileError`] names the
/// line where the parser stopped.
pub fn parse_toml<T: DeserializeOwned>(file: &str, text: &str) -> Result<T, FileError> {
    TomlFile::parse(file, text)?.read_all()
}

fn toml_error(file: &str, text: &str, error: &toml::de::Error) -> FileError {
    FileError {
        file: file.to_owned(),
        line: error.span().map(|span| line_of(text, span.start)),
        column: None,
        message: plain(text, error.span(), error.message()),
    }
}

/// Returns the line, counted from 1, of the byte at `offset`.
fn line_of(text: &str, offset: usize) -> usize {
    text.bytes().take(offset).filter(|&b| b == b'\n').count() + 1
}

/// Returns a value as a number; an integer counts as a number.
pub fn number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|i| i as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, serde::Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Toy {
        #[expect(dead_code, reason = "only its name matters here")]
        radius_m: f64,
    }

    #[test]
    fn an_unknown_key_names_its_line_and_the_nearest_known() {
        let error = parse_toml::<Toy>("toy.toml", "# a comment\nradus_m = 1.0\n").unwrap_err();
        let message = "toy.toml line 2: unknown key \"radus_m\"; the nearest known is \"radius_m\"";
        assert_eq!(error.to_string(), message);
    }

    #[test]
    fn a_word_without_a_near_one_lists_the_known_ones() {
        let message = unknown_word("column", "zzzzzz", ["run", "slip"]);
        assert_eq!(message, "unknown column \"zzzzzz\"; known are run, slip");
    }

    #[test]
    fn a_place_is_a_line_and_perhaps_a_column() {
        let mut error = FileError::at("mine.toml", 4, "wrong");
        error.column = Some(17);
        assert_eq!(error.to_string(), "mine.toml line 4, column 17: wrong");
    }

    #[test]
    fn a_file_made_to_exhaust_the_stack_is_refused() {
        // 79 inline tables of 79 dotted names each
        let names = ["a"; 79].join(".");
        let text = format!("x = {}1{}", format!("{{ {names} = ").repeat(79), " }".repeat(79));
        let error = parse_toml::<toml::Table>("job.toml", &text).unwrap_err();
        let message = "job.toml line 1: brackets must be nested at most 16 deep";
        assert_eq!(error.to_string(), message);
    }
}
