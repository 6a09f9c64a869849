//! The reader's messages for files with one mistake each: `gallery/NAME.toml` with `NAME.txt`.
//!
//! `UPDATE_GALLERY=1` rewrites the messages; read them before committing them.

use std::path::{Path, PathBuf};

use formula::Effect;

/// Returns the files of the gallery with an ending, sorted by name.
fn files(ending: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/gallery");
    let entries = folder.read_dir().unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries
        .filter(|path| path.extension().is_some_and(|e| e == ending))
        .collect();
    files.sort();
    files
}

#[test]
fn every_message_is_as_written() {
    let update = std::env::var_os("UPDATE_GALLERY").is_some();
    let mut wrong = String::new();
    for file in files("toml") {
        let text = String::from_utf8_lossy(&std::fs::read(&file).unwrap()).into_owned();
        let actual = match Effect::read(&text) {
            Ok(_) => "read without an error\n".to_owned(),
            Err(error) => format!("{error}\n"),
        };
        let snapshot = file.with_extension("txt");
        if update {
            std::fs::write(&snapshot, &actual).unwrap();
        }
        let expected = std::fs::read_to_string(&snapshot).unwrap_or_default();
        if actual != expected.replace("\r\n", "\n") {
            wrong += &format!("{}\n  expected {expected}  found    {actual}", file.display());
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

#[test]
fn every_message_has_its_file_and_form() {
    assert!(files("toml").len() >= 20);
    for snapshot in files("txt") {
        assert!(snapshot.with_extension("toml").exists(), "{}", snapshot.display());
        let message = std::fs::read_to_string(&snapshot).unwrap();
        let first = message.chars().next().unwrap();
        assert!(!first.is_uppercase(), "{message}");
        assert!(message.lines().count() == 1 && message.len() < 700, "{message}");
        assert!(!message.trim_end().ends_with('.'), "{message}");
    }
}
