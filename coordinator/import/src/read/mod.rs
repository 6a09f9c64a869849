//! From the bytes of a file to a table of cells.
//!
//! # Layout
//! - `text`: text with separators; `encoding`, `separator`: what of it is found out.
//! - `sheet`: spreadsheets; `archive`: their size before they are unpacked.
//! - `variable`: the variables of a MATLAB file as a table; `mat5`, `mat73`: its two formats.

mod archive;
mod encoding;
mod mat5;
mod mat73;
mod separator;
mod sheet;
mod text;
mod variable;

use crate::complaint::Complaint;
use crate::table::Table;

/// A file as its user sent it.
#[derive(Debug, Clone, Copy)]
pub struct SourceFile<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its content.
    pub bytes: &'a [u8],
    /// Whether whoever sent it runs this program: a reader of old Excel files takes as much memory as a damaged one asks for.
    pub is_own: bool,
}

/// What the map states about the file as a whole.
#[derive(Debug, Clone, Default)]
pub(crate) struct Hints {
    pub(crate) sheet: Option<String>,
    pub(crate) encoding: Option<String>,
    pub(crate) separator: Option<String>,
    /// Takes the sheet with the most rows where none is stated, as for a guess.
    pub(crate) takes_largest: bool,
}

/// Reads a file of any kind, told by its content.
pub(crate) fn read(source: &SourceFile<'_>, hints: &Hints) -> Result<Table, Box<Complaint>> {
    let begins = |magic: &[u8]| source.bytes.starts_with(magic);
    let wrong = |message: String| {
        Box::new(Complaint {
            file: source.name.to_owned(),
            message,
            ..Complaint::default()
        })
    };
    if source.bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(wrong(
            "the file is empty: a table of measurements is expected".into(),
        ));
    }
    if begins(b"PK\x03\x04") {
        sheet::read_zipped(source, hints)
    } else if begins(b"\xd0\xcf\x11\xe0") {
        sheet::read_old(source, hints)
    } else if begins(b"\x89HDF\r\n\x1a\n") || begins(b"MATLAB 7.3 MAT-file") {
        variable::table(source.name, mat73::read(source.bytes), hints)
    } else if begins(b"MATLAB 5.0 MAT-file") {
        variable::table(source.name, mat5::read(source.bytes), hints)
    } else if source.name.to_lowercase().ends_with(".mat") {
        Err(wrong(
            "this is no MATLAB file of version 5, 7 or 7.3: save it again with save('NAME.mat', '-v7')"
                .into(),
        ))
    } else if begins(b"%PDF") {
        Err(wrong("this is a PDF: export its table as .xlsx or .csv".into()))
    } else {
        text::read(source, hints)
    }
}
