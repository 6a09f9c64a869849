//! The forward models of a job: its table `[model]`, or each of `[[models]]` that it compares.

use std::collections::BTreeMap;

use serde::Deserialize;
use shared::file::{FileError, parse_toml};
use shared::model::{ModelKind, ModelSettings};
use shared::parameters::model_parameters;

use super::prior_entry::PriorEntry;

/// The numbers of models that a job can compare.
pub(crate) const COMPARED: std::ops::RangeInclusive<usize> = 2..=8;

/// The values of a table with their places in the text.
type Spanned = BTreeMap<String, toml::Spanned<toml::Value>>;

/// A forward model as a job writes it.
#[derive(Debug)]
pub(crate) struct ModelEntry {
    /// Line of its `[[models]]`; `None` for a table `[model]`.
    pub(crate) line: Option<usize>,
    /// The table without its priors.
    pub(crate) table: toml::Table,
    pub(crate) settings: ModelSettings,
    /// The lines of the common `[priors]` that concern the model, then the lines of the model's table.
    pub(crate) priors: Vec<PriorEntry>,
}

/// The part of a job that is parsed again for line numbers.
#[derive(Deserialize)]
struct Lines {
    #[serde(default)]
    models: Vec<toml::Spanned<PriorLines>>,
}

#[derive(Deserialize)]
struct PriorLines {
    #[serde(default)]
    priors: Spanned,
}

/// Returns the models of a job, at least one.
///
/// # Arguments
/// - `shared`: the table `[priors]`, which holds for every model that has the parameter; a model's own line comes before it.
///
/// # Errors
/// [`FileError`] with the line of the model or of the prior.
pub(crate) fn model_entries(
    name: &str,
    toml: &str,
    model: Option<toml::Table>,
    models: Vec<toml::Table>,
    shared: Spanned,
) -> Result<(ModelEntry, Vec<ModelEntry>), FileError> {
    let shared = entries(toml, shared);
    let whole = |message: &str| FileError::whole(name, message);
    match model {
        None if models.is_empty() => Err(whole("[model] is missing, or [[models]] for several to compare")),
        None => compared_entries(name, toml, models, &shared),
        Some(_) if !models.is_empty() => Err(whole(
            "[model] and [[models]] exclude each other: a model to compare is one of [[models]]",
        )),
        Some(table) => {
            let settings = ModelSettings::from_table(&table);
            let entry = ModelEntry {
                line: None,
                settings: settings.map_err(|e| whole(&format!("[model] {e}")))?,
                table,
                priors: shared,
            };
            Ok((entry, Vec::new()))
        }
    }
}

/// Returns the entries of `[[models]]`.
fn compared_entries(
    name: &str,
    toml: &str,
    models: Vec<toml::Table>,
    shared: &[PriorEntry],
) -> Result<(ModelEntry, Vec<ModelEntry>), FileError> {
    if !COMPARED.contains(&models.len()) {
        let (count, least, most) = (models.len(), COMPARED.start(), COMPARED.end());
        let message =
            format!("[[models]] has {count}; a comparison takes {least} to {most}, a single one is [model]");
        return Err(FileError::whole(name, message));
    }
    let lines: Lines = parse_toml(name, toml)?;
    let mut read = Vec::new();
    for (mut table, spanned) in models.into_iter().zip(lines.models) {
        let line = line_at(toml, spanned.span().start);
        table.remove("priors");
        let settings = ModelSettings::from_table(&table)
            .map_err(|e| FileError::at(name, line, format!("[[models]] {e}")))?;
        let stated = entries(toml, spanned.into_inner().priors);
        let inherited = shared
            .iter()
            .filter(|entry| is_shared_by(settings.kind, &entry.name))
            .filter(|entry| stated.iter().all(|stated| stated.name != entry.name))
            .filter(|entry| !settings.fixed.contains_key(&entry.name));
        let priors = inherited.chain(&stated).cloned().collect();
        read.push(ModelEntry {
            line: Some(line),
            priors,
            settings,
            table,
        });
    }
    let is_idle = |entry: &&PriorEntry| read.iter().all(|m| !is_shared_by(m.settings.kind, &entry.name));
    if let Some(entry) = shared.iter().find(is_idle) {
        let kinds: Vec<&str> = read.iter().map(|m| m.settings.kind.name()).collect();
        let message = format!("{} is a parameter of none of {}", entry.name, kinds.join(", "));
        return Err(entry.error(name, message));
    }
    let first = read.remove(0);
    Ok((first, read))
}

/// Returns the entries of a table of priors, in the order of the file.
fn entries(toml: &str, table: Spanned) -> Vec<PriorEntry> {
    let mut table: Vec<_> = table.into_iter().collect();
    table.sort_by_key(|(_, value)| value.span().start);
    let entry = |(name, value): (String, toml::Spanned<toml::Value>)| PriorEntry {
        name,
        line: Some(line_at(toml, value.span().start)),
        has_header: value.get_ref().is_table() && toml[value.span().start..].starts_with('['),
        value: value.into_inner(),
    };
    table.into_iter().map(entry).collect()
}

/// Returns the line, counted from 1, of a byte of a text.
fn line_at(text: &str, byte: usize) -> usize {
    text[..byte].matches('\n').count() + 1
}

/// Returns whether a line of `[priors]` concerns a model among several: for a base parameter, if the model has it.
pub(crate) fn is_shared_by(kind: ModelKind, name: &str) -> bool {
    let stem = name.split_once('.').map_or(name, |(stem, _)| stem);
    model_parameters().all(|p| p.name != stem) || kind.parameters().any(|p| p.name == stem)
}
