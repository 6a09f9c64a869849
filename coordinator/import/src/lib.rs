//! The import: from users' tables of measurements to `runs.csv`.
//!
//! # Layout
//! - `read`: the bytes of a file (text, spreadsheet, MATLAB) to a `table` of cells with their places.
//! - `title`: the titles of a table, and the units that they state.
//! - `files`: the files of an import; `pattern`: what their names say, and the names of files beside them; `join`: their join on time.
//! - `map`: the statements of a map; `binding`: a map bound to a table.
//! - `summary`: rows of means and totals, which are no runs.
//! - `reading`: the numbers of a column before a map is bound; `zero`: readings at rest; `series`: means of samples over time.
//! - `rows`: a run from every row; `recording`: runs cut from one long recording; `run`: the files that are written.
//! - `number`, `unit`: numbers and units in common notations; `field`, `rule`: the columns of runs.csv and their valid values.
//! - `guess`: a map proposed from the titles, and from the words of columns.
//! - `conversion`: the whole import, with every mistake at once. [`Complaint`]: a mistake and its place.
//!
//! The crate is pure: bytes and a map are the input, texts and complaints the output. No input makes it panic.

mod binding;
mod complaint;
mod conversion;
mod field;
mod files;
mod guess;
mod join;
mod map;
mod number;
mod pattern;
mod read;
mod reading;
mod recording;
mod rows;
mod rule;
mod run;
mod series;
mod summary;
mod table;
mod title;
mod unit;
mod zero;

pub use complaint::{Complaint, Fix};
pub use conversion::{Converted, convert, convert_all, files_of};
pub use field::{RowUse, columns};
pub use files::Files;
pub use guess::{ColumnCard, FieldGuess, Guess, QuantityGuess, WordCard, guess};
pub use read::SourceFile;
