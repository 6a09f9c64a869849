//! `coordinator import`: converts a user's table of measurements to runs.csv, or proposes a map for it.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use import::{Converted, Files, SourceFile, convert_all, files_of, guess};
use shared::text_file::read_text;

use super::output::{note, say};
use crate::config::ImportArguments;

pub(super) fn import(config: &ImportArguments) -> anyhow::Result<()> {
    let (Some(map), Some(output)) = (&config.map, &config.output) else {
        return propose(config);
    };
    let map_name = map.display().to_string();
    let map_text = read_text(map)?;
    let names = names(&config.files, (&map_name, &map_text))?;
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let files = Files {
        names: &names,
        open: &|name| std::fs::read(name).map(Cow::Owned).map_err(|e| e.to_string()),
        is_own: true,
    };
    let converted = convert_all(files, (&map_name, &map_text), &stem);
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

/// Prints a proposed map for one file.
fn propose(config: &ImportArguments) -> anyhow::Result<()> {
    let [file] = config.files.as_slice() else {
        anyhow::bail!("a map is proposed for one file: name one of these recordings");
    };
    let name = file.display().to_string();
    let bytes = std::fs::read(file).map_err(|e| anyhow::anyhow!("{name}: {e}"))?;
    let source = SourceFile {
        name: &name,
        bytes: &bytes,
        is_own: true,
    };
    let guessed =
        guess(&source, config.sheet.as_deref()).map_err(|complaint| anyhow::anyhow!("{complaint}"))?;
    for remark in &guessed.remarks {
        note(&format!("note: {remark}"));
    }
    Ok(say(&guessed.map)?)
}

/// Returns the names of the files; of a folder, those that the map means by `file`, in alphabetical order.
fn names(stated: &[PathBuf], (map_name, map_text): (&str, &str)) -> anyhow::Result<Vec<String>> {
    let mut names = Vec::new();
    for path in stated {
        if !path.is_dir() {
            names.push(path.display().to_string());
            continue;
        }
        let shown = path.display();
        let wrong = |e: std::io::Error| anyhow::anyhow!("{shown}: {e}");
        let mut within = Vec::new();
        for entry in path.read_dir().map_err(wrong)? {
            let entry = entry.map_err(wrong)?.path();
            if entry.is_file() {
                within.push(entry.display().to_string());
            }
        }
        within.sort();
        let meant = files_of(map_text, &within).ok_or_else(|| {
            anyhow::anyhow!(
                "{shown} is a folder: `file = \"…\"` in {map_name} says which of its files are recordings"
            )
        })?;
        anyhow::ensure!(!meant.is_empty(), "{shown}: no file fits `file` of {map_name}");
        if meant.len() < within.len() {
            note(&format!(
                "note: {} of {} files of {shown} fit `file` of the map",
                meant.len(),
                within.len()
            ));
        }
        names.extend(meant);
    }
    Ok(names)
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
