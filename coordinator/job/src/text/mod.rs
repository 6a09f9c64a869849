//! Edits of the text of a job, for users to read: comments, and everything that a change does not concern, stay as written.
//!
//! No other file edits the text of a job. Jobs that only the program reads are changes of the value ([`Job::with`](crate::Job::with)).

#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};

use shared::file::{FileError, FileSet};
use shared::model::ModelKind;
use toml_edit::{Array, DocumentMut, Item, Table, TableLike, value};

use crate::addition::{Addition, ModelChange, keys_of_kinds};
use crate::facts::effect_name;
use crate::model_switch::{ModelSwitch, SettingValue};
use crate::service_effect::ServiceEffect;
use crate::table::algorithm_settings::{AlgorithmName, AlgorithmSettings};
use crate::table::model_entry::is_shared_by;
use crate::table::sampler::METAMODEL_MOVES;

/// Returns a job with an addition; everything else stays as it is written.
///
/// # Errors
/// [`FileError`] if the text is no job with a table `[model]`, or if a line of `[priors]` or a file exists already.
pub fn extended_job(name: &str, job: &FileSet, addition: &Addition) -> Result<FileSet, FileError> {
    if addition.is_empty() {
        return Ok(job.clone());
    }
    let mut text = JobText::parse(name, &job.toml)?;
    let mut files = job.files.clone();
    text.keep_model(0)?;
    for change in &addition.changes {
        match change {
            ModelChange::Free(parameter, prior) => {
                text.release(parameter);
                text.add_prior(parameter, prior)?;
            }
            ModelChange::Turn(switch) => text.turn(switch)?,
        }
    }
    let candidates = text.candidate_files();
    for (file, added) in &addition.files {
        let before = files.insert(file.clone(), added.text.clone());
        // A candidate's file is there before the model has its effect.
        let is_candidate = candidates.contains(file) && before.as_ref() == Some(&added.text);
        if before.is_some() && !is_candidate {
            return Err(text.error(format!("file \"{file}\" exists already")));
        }
    }
    text.list("effects", addition.effects.iter())?;
    text.list("effect_files", addition.files.iter().map(|(file, _)| file))?;
    for (parameter, prior) in &addition.priors {
        text.add_prior(parameter, prior)?;
    }
    Ok(text.beside(&files))
}

/// Returns a job without some of its effects: their names, their files and every line about their parameters are removed.
///
/// # Errors
/// [`FileError`] if the text is no job.
pub fn without_effects(name: &str, job: &FileSet, effects: &[String]) -> Result<FileSet, FileError> {
    let is_named = |effect: &str| effects.iter().any(|dropped| dropped == effect);
    let is_dropped = |file: &str| {
        let effect = job.files.get(file).and_then(|text| effect_name(text));
        effect.is_some_and(|effect| is_named(&effect))
    };
    let mut text = JobText::parse(name, &job.toml)?;
    text.keep_model(0)?;
    text.unlist("effects", is_named);
    text.unlist("effect_files", is_dropped);
    // A dotted key without quotes is a table under the effect's name.
    let is_about = |key: &str| is_named(key.split_once('.').map_or(key, |(effect, _)| effect));
    for table in ["model", "priors"] {
        text.remove(table, is_about);
    }
    let candidates = text.candidate_files();
    let mut files = job.files.clone();
    files.retain(|file, _| candidates.contains(file) || !is_dropped(file));
    Ok(text.beside(&files))
}

/// Returns a job whose search tries further effects, each with its file. What the job has already stays as it is: a file of that name,
/// and a candidate that is the same effect.
///
/// # Errors
/// [`FileError`] if the text is no job, or `candidate_files` no list.
pub fn with_candidates(
    name: &str,
    job: &FileSet,
    candidates: &[(String, String)],
) -> Result<FileSet, FileError> {
    let mut text = JobText::parse(name, &job.toml)?;
    let mut files = job.files.clone();
    let named = text.candidate_files();
    let named = named.iter().filter_map(|file| effect_name(job.files.get(file)?));
    let mut named: BTreeSet<String> = named.collect();
    for (file, effect) in candidates {
        let is_new = effect_name(effect).is_none_or(|name| named.insert(name));
        if is_new && !files.contains_key(file) {
            files.insert(file.clone(), effect.clone());
            text.add_candidate(file)?;
        }
    }
    Ok(text.beside(&files))
}

/// Returns a job with further names under `accept`, each name once.
///
/// # Errors
/// [`FileError`] if the text is no TOML, or `accept` no list.
pub fn accepting_job(name: &str, toml: &str, accepted: &[String]) -> Result<String, FileError> {
    if accepted.is_empty() {
        return Ok(toml.to_owned());
    }
    let mut text = JobText::parse(name, toml)?;
    let list = text.document.entry("accept").or_insert(value(Array::new()));
    let Some(list) = list.as_array_mut() else {
        return Err(text.error("accept must be a list of names in quotes".into()));
    };
    for name in accepted {
        if !list.iter().any(|there| there.as_str() == Some(name)) {
            list.push(name);
        }
    }
    Ok(text.document.to_string())
}

/// Returns a job whose study searches for a missing effect, by `[discovery] apply = "ask"` if it states no search.
///
/// # Errors
/// [`FileError`] if the text is no job.
pub fn searched_job(name: &str, job: &FileSet) -> Result<FileSet, FileError> {
    let mut text = JobText::parse(name, &job.toml)?;
    let discovery = text.table_or_new("discovery")?;
    let apply = discovery.get("apply");
    if apply.is_none_or(|apply| apply.as_str() == Some("off")) {
        discovery.insert("apply", value("ask"));
    }
    Ok(text.beside(&job.files))
}

/// Returns the job of a study's next calibration: without point estimates, and without a search.
///
/// # Errors
/// [`FileError`] if the text is no job.
pub fn continued_job(name: &str, job: &FileSet) -> Result<FileSet, FileError> {
    let mut text = JobText::parse(name, &job.toml)?;
    text.keep_model(0)?;
    text.remove("sampler", |key| key == "point_estimates");
    text.keep_candidates();
    Ok(text.beside(&job.files))
}

/// Returns the job of one of the models that a job compares: its table becomes `[model]`, and `[priors]` holds the lines of all models that
/// concern it, then the lines of its table.
///
/// # Arguments
/// - `number`: of the model, from 0, in the order of the job.
///
/// # Errors
/// [`FileError`] if the text is no job, or has fewer models.
pub fn model_job(name: &str, job: &FileSet, number: usize) -> Result<FileSet, FileError> {
    let mut text = JobText::parse(name, &job.toml)?;
    text.keep_model(number)?;
    text.keep_candidates();
    Ok(text.beside(&job.files))
}

/// Returns a job with a fit or a search in place of its sampler; the seed and everything else stay as written. A point estimate is
/// therefore stored, resumed and shown like any other calibration.
///
/// # Errors
/// [`FileError`] if the text is no job.
pub fn point_job(name: &str, job: &FileSet, algorithm: &AlgorithmSettings) -> Result<FileSet, FileError> {
    let mut text = JobText::parse(name, &job.toml)?;
    text.set_algorithm(algorithm.name())?;
    if let AlgorithmSettings::Fit(_) = algorithm {
        // The sample makes draws of the normal approximation superfluous.
        text.table_or_new("sampler")?.insert("particles", value(0));
    }
    Ok(text.beside(&job.files))
}

/// Returns the job that predicts a left-out level: without point estimates and search, by `lm` with its default settings or by the
/// job's algorithm.
///
/// # Errors
/// [`FileError`] if the text is no job.
pub fn validation_job(name: &str, job: &FileSet, by_own_algorithm: bool) -> Result<FileSet, FileError> {
    let continued = continued_job(name, job)?;
    if by_own_algorithm {
        return Ok(continued);
    }
    let mut text = JobText::parse(name, &continued.toml)?;
    text.set_algorithm(AlgorithmName::Lm.name())?;
    Ok(text.beside(&continued.files))
}

/// Returns a job without the effects of a service's catalogue; lines keep their numbers.
///
/// # Errors
/// [`FileError`] if the text is no TOML.
pub fn without_service_effects(
    name: &str,
    toml: &str,
    effects: &[ServiceEffect],
) -> Result<String, FileError> {
    if effects.is_empty() {
        return Ok(toml.to_owned());
    }
    let mut text = JobText::parse(name, toml)?;
    text.unlist("effects", |listed| {
        effects.iter().any(|effect| effect.listed_as == listed)
    });
    Ok(text.document.to_string())
}

/// Returns the job with effects of a service's catalogue as its files, so that later versions of the catalogue do not change it.
///
/// # Errors
/// [`FileError`] if the job has another file of that name.
pub fn with_service_effects(
    name: &str,
    job: FileSet,
    effects: &[ServiceEffect],
) -> Result<FileSet, FileError> {
    let toml = without_service_effects(name, &job.toml, effects)?;
    let files = effects.iter().map(ServiceEffect::named_file).collect();
    let addition = Addition {
        files,
        ..Addition::default()
    };
    extended_job(name, &FileSet { toml, ..job }, &addition)
}

/// Returns the job by which versions before migration 20 searched the model of a job.
///
/// # Errors
/// [`FileError`] if the text is no job.
pub fn earlier_search(name: &str, job: &FileSet) -> Result<FileSet, FileError> {
    let mut text = JobText::parse(name, &job.toml)?;
    text.keep_model(0)?;
    text.set_algorithm(AlgorithmName::Discovery.name())?;
    Ok(text.beside(&job.files))
}

/// Returns the job whose model an earlier search searched, from the job of that search: the model with the default algorithm.
///
/// # Errors
/// [`FileError`] if the text is no job.
pub fn searched_model(name: &str, search: &FileSet) -> Result<FileSet, FileError> {
    let mut text = JobText::parse(name, &search.toml)?;
    text.remove("sampler", |key| key == "algorithm");
    Ok(text.beside(&search.files))
}

/// Returns the text of a job with `stages = "moves"` in place of `metamodel_moves`, a key of versions before migration 23.
///
/// A sampler with a metamodel moved its particles, so its results are read as those of moves.
///
/// # Errors
/// [`FileError`] if the text names the key and is no TOML.
pub fn without_metamodel(name: &str, toml: &str) -> Result<String, FileError> {
    // Every stored job is read through here, and hardly one has the key.
    if !toml.contains(METAMODEL_MOVES) {
        return Ok(toml.to_owned());
    }
    let mut text = JobText::parse(name, toml)?;
    if let Some(sampler) = text.table("sampler") {
        let moves = sampler.remove(METAMODEL_MOVES);
        if moves.and_then(|moves| moves.as_integer()) > Some(0) {
            sampler.insert("stages", value("moves"));
        }
    }
    Ok(text.document.to_string())
}

/// A job's text that is being changed.
struct JobText<'n> {
    /// Name of the job in messages.
    name: &'n str,
    document: DocumentMut,
}

impl<'n> JobText<'n> {
    fn parse(name: &'n str, toml: &str) -> Result<Self, FileError> {
        let document = toml.parse();
        let document = document.map_err(|e: toml_edit::TomlError| FileError::whole(name, e.to_string()))?;
        Ok(JobText { name, document })
    }

    fn error(&self, message: String) -> FileError {
        FileError::whole(self.name, message)
    }

    /// Returns the text, with files beside it.
    fn beside(self, files: &BTreeMap<String, String>) -> FileSet {
        FileSet {
            toml: self.document.to_string(),
            files: files.clone(),
        }
    }

    fn table(&mut self, name: &str) -> Option<&mut dyn TableLike> {
        self.document.get_mut(name).and_then(Item::as_table_like_mut)
    }

    fn table_or_new(&mut self, name: &str) -> Result<&mut dyn TableLike, FileError> {
        let not_a_table = FileError::whole(self.name, format!("[{name}] must be a table"));
        let item = self.document.entry(name).or_insert(toml_edit::table());
        item.as_table_like_mut().ok_or(not_a_table)
    }

    fn model(&mut self) -> Result<&mut dyn TableLike, FileError> {
        let missing = self.error("[model] is missing".into());
        self.table("model").ok_or(missing)
    }

    /// Replaces all compared models by one; a job with a table `[model]` stays as it is.
    fn keep_model(&mut self, number: usize) -> Result<(), FileError> {
        let Some(models) = self.document.remove("models") else {
            return Ok(());
        };
        let model = models
            .into_array_of_tables()
            .map_err(|_| self.error("[[models]] is not a list of tables".into()))?
            .get(number)
            .cloned();
        let mut model: Table = model.ok_or_else(|| self.error("[[models]] has fewer models".into()))?;
        let kind = model.get("kind").and_then(Item::as_str).and_then(ModelKind::find);
        let kind = kind.ok_or_else(|| self.error("[[models]] has a model of no known kind".into()))?;
        let stated = model.remove("priors");
        let stated = stated.as_ref().and_then(Item::as_table_like);
        let shared = self.document.remove("priors");
        let shared = shared.as_ref().and_then(Item::as_table_like);
        let is_inherited = |key: &str| {
            let is_stated = stated.is_some_and(|stated| stated.contains_key(key));
            is_shared_by(kind, key) && !is_stated && !model.contains_key(key)
        };
        let shared = shared.into_iter().flat_map(|table| table.iter());
        let inherited = shared.filter(|(key, _)| is_inherited(key));
        let mut priors = Table::new();
        for (key, item) in inherited.chain(stated.into_iter().flat_map(|table| table.iter())) {
            priors.insert(key, item.clone());
        }
        model.set_position(None);
        self.document.insert("model", Item::Table(model));
        if !priors.is_empty() {
            self.document.insert("priors", Item::Table(priors));
        }
        Ok(())
    }

    /// Removes `[discovery]` except the keys that define the candidates, because a derived job starts no search itself.
    fn keep_candidates(&mut self) {
        let stays = ["priors", "other_kind", "candidate_files"];
        self.remove("discovery", |key| !stays.contains(&key));
        if self
            .table("discovery")
            .is_some_and(|discovery| discovery.is_empty())
        {
            self.document.remove("discovery");
        }
    }

    /// Replaces the job's algorithm by another with its default settings; the seed and the keys of `[discovery]` that define the
    /// candidates stay.
    fn set_algorithm(&mut self, algorithm: &str) -> Result<(), FileError> {
        self.table_or_new("sampler")?;
        self.remove("sampler", |key| key != "seed");
        self.table_or_new("sampler")?
            .insert("algorithm", value(algorithm));
        self.keep_candidates();
        Ok(())
    }

    /// Removes the keys of a table that satisfy a condition.
    fn remove(&mut self, table: &str, condition: impl Fn(&str) -> bool) {
        if let Some(table) = self.table(table) {
            let keys: Vec<String> = table.iter().map(|(key, _)| key.to_owned()).collect();
            for key in keys.iter().filter(|key| condition(key)) {
                table.remove(key);
            }
        }
    }

    /// Removes the number at which the job holds a parameter.
    fn release(&mut self, parameter: &str) {
        for table in ["model", "priors"] {
            let Some(table) = self.table(table) else { continue };
            let held = table.get(parameter);
            if held.is_some_and(|held| held.is_float() || held.is_integer()) {
                table.remove(parameter);
            }
        }
    }

    /// Gives a setting of the model another value.
    fn turn(&mut self, switch: &ModelSwitch) -> Result<(), FileError> {
        self.release(switch.key);
        let model = self.model()?;
        if switch.is_kind() {
            for key in keys_of_kinds() {
                model.remove(key);
            }
        }
        let setting = match switch.value {
            SettingValue::Word(word) => value(word),
            SettingValue::Limit(number) => value(number),
        };
        model.insert(switch.key, setting);
        Ok(())
    }

    /// Adds names to a list under `[model]`.
    fn list<'a>(&mut self, key: &str, names: impl Iterator<Item = &'a String>) -> Result<(), FileError> {
        let not_a_list = self.error(format!("{key} must be a list"));
        let model = self.model()?;
        let mut names = names.map(String::as_str).peekable();
        if names.peek().is_some() {
            let list = model.entry(key).or_insert(value(Array::new()));
            list.as_array_mut().ok_or(not_a_list)?.extend(names);
        }
        Ok(())
    }

    /// Lists the files of candidates.
    fn candidate_files(&self) -> Vec<String> {
        let list = self
            .document
            .get("discovery")
            .and_then(|table| table.get("candidate_files"));
        let files = list.and_then(Item::as_array).into_iter().flatten();
        files
            .filter_map(|file| file.as_str().map(str::to_owned))
            .collect()
    }

    /// Adds a file of a candidate.
    fn add_candidate(&mut self, file: &str) -> Result<(), FileError> {
        let not_a_list = self.error("[discovery] candidate_files must be a list".into());
        let discovery = self.table_or_new("discovery")?;
        let list = discovery.entry("candidate_files").or_insert(value(Array::new()));
        list.as_array_mut().ok_or(not_a_list)?.push(file);
        Ok(())
    }

    /// Removes names from a list under `[model]`.
    fn unlist(&mut self, key: &str, condition: impl Fn(&str) -> bool) {
        let list = self.table("model").and_then(|model| model.get_mut(key));
        if let Some(list) = list.and_then(Item::as_array_mut) {
            list.retain(|name| !name.as_str().is_some_and(&condition));
        }
    }

    /// Adds a line under `[priors]`.
    fn add_prior(&mut self, parameter: &str, prior: &toml::Value) -> Result<(), FileError> {
        // Jobs state a prior as an inline table on one line.
        let line = prior.to_string().parse();
        let line: toml_edit::Value =
            line.map_err(|e: toml_edit::TomlError| self.error(format!("{parameter}: {e}")))?;
        let there = self.error(format!("{parameter} is already under [priors]"));
        match self.table_or_new("priors")?.insert(parameter, value(line)) {
            None => Ok(()),
            Some(_) => Err(there),
        }
    }
}
