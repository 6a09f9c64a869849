//! Text files on disk; the error for a file that is no text names its format.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::file::{FileError, unknown_word};

/// The advice for a table in another format.
pub(crate) const CONVERT: &str = "coordinator import converts it";

/// Reads a text file whole. The error names the path with the actual format, the nearest existing file, or the operating
/// system's reason.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    let fail = |message: String| FileError::whole(&path.display().to_string(), message);
    let bytes = std::fs::read(path).map_err(|e| match e.kind() {
        std::io::ErrorKind::NotFound => fail(absent(path)),
        _ => fail(e.to_string()),
    })?;
    let is_table = path.extension().is_some_and(|extension| extension == "csv");
    if let Some(form) = form(&bytes) {
        let remedy = if is_table {
            format!(": {CONVERT}")
        } else {
            String::new()
        };
        return Err(fail(format!(
            "the file is {form}, text in UTF-8 is expected{remedy}"
        )));
    }
    String::from_utf8(bytes).map_err(|e| {
        let start = e.utf8_error().valid_up_to();
        let line = e.as_bytes()[..start].iter().filter(|&&b| b == b'\n').count() + 1;
        let byte = e.as_bytes()[start];
        let message = format!(
            "byte {byte:#04x} is no UTF-8: the file was probably saved as Latin-1 or Windows-1252; save it as UTF-8"
        );
        FileError::at(&path.display().to_string(), line, message)
    })
}

/// Resolves a name written in the file `beside`, relative to that file's folder.
pub fn sibling(beside: &Path, name: &str) -> PathBuf {
    beside.parent().unwrap_or(Path::new("")).join(name)
}

/// Reads the files that the file `beside` names, by their names in it. The error names the path and the operating system's reason.
pub fn read_beside(beside: &Path, names: &[String]) -> Result<BTreeMap<String, String>, FileError> {
    let read = |name: &String| Ok((name.clone(), read_text(&sibling(beside, name))?));
    names.iter().map(read).collect()
}

/// Returns the format of a file by its first bytes, if it is known and not text.
fn form(bytes: &[u8]) -> Option<&'static str> {
    let forms: [(&[u8], &str); 7] = [
        (b"PK\x03\x04", "a workbook (.xlsx, .ods) or another ZIP archive"),
        (b"\xd0\xcf\x11\xe0", "a workbook of an old Excel (.xls)"),
        (b"MATLAB 5.0 MAT-file", "a MATLAB file"),
        (b"MATLAB 7.3 MAT-file", "a MATLAB file"),
        (b"\x89HDF\r\n\x1a\n", "an HDF5 file, as MATLAB 7.3 writes"),
        (b"\xff\xfe", "text in UTF-16"),
        (b"\xfe\xff", "text in UTF-16"),
    ];
    forms
        .iter()
        .find(|(start, _)| bytes.starts_with(start))
        .map(|(_, form)| *form)
}

/// Returns the message about a missing file: the nearest name in its folder.
fn absent(path: &Path) -> String {
    let stem = |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let entries = std::fs::read_dir(folder.unwrap_or(Path::new(".")))
        .into_iter()
        .flatten();
    let beside = entries.flatten().map(|entry| entry.path());
    let alike = beside.filter(|other| other.is_file() && other.extension() == path.extension());
    let mut stems: Vec<String> = alike.filter_map(|other| stem(&other)).collect();
    stems.sort();
    let missing = stem(path).unwrap_or_default();
    let nearest = unknown_word("file", &missing, stems.iter().map(String::as_str));
    let nearest = nearest
        .split_once("; the nearest known is \"")
        .map(|(_, nearest)| nearest.trim_end_matches('"'));
    let end = path.extension().map(|end| format!(".{}", end.to_string_lossy()));
    match nearest {
        Some(stem) => format!(
            "there is no such file; the nearest in its folder is \"{stem}{}\"",
            end.unwrap_or_default()
        ),
        None => "there is no such file".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_no_text_is_named_by_its_format() {
        let folder = tempfile::tempdir().unwrap();
        let message = |content: &[u8]| {
            let path = folder.path().join("runs.csv");
            std::fs::write(&path, content).unwrap();
            let error = read_text(&path).unwrap_err().to_string();
            error.replace(&format!("{}/", folder.path().display()), "")
        };
        for (content, expected) in [
            (&b"PK\x03\x04..."[..], ": the file is a workbook (.xlsx, .ods)"),
            (b"MATLAB 5.0 MAT-file, Platform", ": the file is a MATLAB file,"),
            (b"\xff\xfer\0u\0n\0", ": the file is text in UTF-16,"),
            (b"run\nschl\xe4mm\n", " line 2: byte 0xe4 is no UTF-8"),
        ] {
            let message = message(content);
            assert!(message.starts_with(&format!("runs.csv{expected}")), "{message}");
        }
    }

    #[test]
    fn a_missing_file_is_named_with_the_nearest_existing_one() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("experiment.toml"), "").unwrap();
        let message = |name: &str| read_text(&folder.path().join(name)).unwrap_err().message;
        let nearest = "there is no such file; the nearest in its folder is \"experiment.toml\"";
        assert_eq!(message("experimnt.toml"), nearest);
        assert_eq!(message("runs.csv"), "there is no such file");
    }
}
