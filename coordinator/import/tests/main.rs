//! Every kind of file, mistakes, guesses, recordings and raw recordings.

mod cost;
mod files;
mod fixes;
mod guesses;
mod mistakes;
mod properties;
mod raw;
mod recordings;
mod texts;

use import::{Converted, SourceFile, convert};

/// Converts the bytes of a file of the user's own.
fn converted(name: &str, bytes: &[u8], map: &str) -> Converted {
    let source = SourceFile {
        name,
        bytes,
        is_own: true,
    };
    convert(&source, ("map.toml", map), "runs")
}

/// Returns the complaints about a file, as they are printed.
fn complaints(name: &str, bytes: &[u8], map: &str) -> Vec<String> {
    let result = converted(name, bytes, map);
    assert!(
        result.runs.is_none() || result.complaints.is_empty(),
        "{result:?}"
    );
    result.complaints.iter().map(ToString::to_string).collect()
}

/// Returns the text of runs.csv.
#[track_caller]
fn runs(name: &str, bytes: &[u8], map: &str) -> String {
    let result = converted(name, bytes, map);
    let messages: Vec<String> = result.complaints.iter().map(ToString::to_string).collect();
    result.runs.unwrap_or_else(|| panic!("{}", messages.join("\n")))
}
