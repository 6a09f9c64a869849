//! `coordinator import`: converts a user's table of measurements to runs.csv, or proposes a map for it.

use std::path::Path;

use import::{Converted, SourceFile, convert, guess};
use shared::text_file::read_text;

use super::output::{note, say};
use crate::config::ImportArguments;

pub(super) fn import(config: &ImportArguments) -> anyhow::Result<()> {
    let name = config.file.display().to_string();
    let bytes = std::fs::read(&config.file).map_err(|e| anyhow::anyhow!("{name}: {e}"))?;
    let source = SourceFile {
        name: &name,
        bytes: &bytes,
        is_own: true,
    };
    let (Some(map), Some(output)) = (&config.map, &config.output) else {
        let guessed =
            guess(&source, config.sheet.as_deref()).map_err(|complaint| anyhow::anyhow!("{complaint}"))?;
        for remark in &guessed.remarks {
            note(&format!("note: {remark}"));
        }
        return Ok(say(&guessed.map)?);
    };
    let map_name = map.display().to_string();
    let map_text = read_text(map)?;
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let converted = convert(&source, (&map_name, &map_text), &stem);
    for complaint in &converted.complaints {
        note(&complaint.to_string());
    }
    match converted.complaints.len() {
        0 => {}
        1 => anyhow::bail!("1 mistake; {} is not written", output.display()),
        count => anyhow::bail!("{count} mistakes; {} is not written", output.display()),
    }
    write(&converted, output, &stem)
}

/// Writes runs.csv, and beside it the notes and the histories.
fn write(converted: &Converted, output: &Path, stem: &str) -> anyhow::Result<()> {
    let put = |path: &Path, text: &str| {
        std::fs::write(path, text).map_err(|e| anyhow::anyhow!("{}: {e}", path.display()))
    };
    let mut text = String::new();
    for remark in &converted.remarks {
        text += &format!("note: {remark}\n");
    }
    // runs.csv is written last, so that the files that it names exist.
    for (name, text) in &converted.histories {
        put(&output.with_file_name(name), text)?;
    }
    if !converted.histories.is_empty() {
        text += &format!("{} histories beside it\n", converted.histories.len());
    }
    if let Some(notes) = &converted.notes {
        let path = output.with_file_name(format!("{stem}-notes.csv"));
        put(&path, notes)?;
        text += &format!("{}: what runs.csv does not have, by run\n", path.display());
    }
    put(output, converted.runs.as_deref().unwrap_or_default())?;
    text += &format!("{}: {} runs\n", output.display(), converted.run_count);
    Ok(say(&text)?)
}
