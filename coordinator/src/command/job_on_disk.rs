//! A job on disk with its files and the effects that the command line adds.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use shared::experiment::Experiment;
use shared::file::{FileError, FileSet};
use shared::text_file::{read_beside, read_text, sibling};

use crate::config::JobArguments;
use job::{
    Addition, Job, NamedFile, ServiceEffect, Spec, accepting_job, check_accepted, extended_job,
    with_service_effects, without_service_effects,
};

/// A job with all its files, read and validated.
pub(super) struct JobOnDisk {
    /// Name for lists and folders.
    pub(super) name: String,
    /// The job with its effect files and the effects of the command line.
    pub(super) job: FileSet,
    /// Experiment of the job.
    pub(super) experiment: FileSet,
    /// The specification; with the first model where the job compares several.
    pub(super) spec: Spec,
    /// The specifications with each of the other models.
    pub(super) alternatives: Vec<Spec>,
}

/// Reads and validates a job and its experiment. Of the effects that it lists, `service_effects` are in the catalogue of a service.
pub(super) fn read(file: &JobArguments, service_effects: &[ServiceEffect]) -> Result<JobOnDisk, FileError> {
    let path = &file.job;
    let job_name = path.display().to_string();
    let written = read_text(path)?;
    let mut models = Job::parse_models(
        &job_name,
        &without_service_effects(&job_name, &written, service_effects)?,
    )?;
    for name in &file.accept {
        models.accept(name).map_err(|e| FileError::whole(&job_name, e))?;
    }
    let job = &mut models.first;
    if job.models > 1 && !(file.effect.is_empty() && file.effect_file.is_empty()) {
        let message = "--effect adds to one model: write effects under the [[models]] that is to have them";
        return Err(FileError::whole(&job_name, message));
    }
    let named = job.experiment.as_deref();
    let named =
        named.ok_or_else(|| FileError::whole(&job_name, "experiment = \"experiment.toml\" is missing"))?;
    let experiment_path = sibling(path, named);
    let experiment_name = experiment_path.display().to_string();
    let experiment = Experiment::read_files(&experiment_path)?;
    let files = read_beside(path, &job.named_files())?;
    let added = added_files(&file.effect_file)?;
    let names: Vec<String> = added.keys().cloned().collect();
    let service_files: Vec<String> = service_effects.iter().map(|effect| effect.file.clone()).collect();
    for (effects, files) in [(&file.effect[..], &names), (&[], &service_files)] {
        let added = job.list_effects(effects, files);
        added.map_err(|e| FileError::whole(&job_name, e))?;
    }
    // Messages name the lines of the user's file; the stored job has the additions.
    let toml = accepting_job(&job_name, &written, &file.accept)?;
    let addition = Addition {
        effects: file.effect.clone(),
        files: added
            .into_iter()
            .map(|(name, text)| (name, NamedFile::new(text)))
            .collect(),
        ..Addition::default()
    };
    let kept = extended_job(&job_name, &FileSet { toml, files }, &addition)?;
    let kept = with_service_effects(&job_name, kept, service_effects)?;
    let mut specs = Spec::of_models(&job_name, models, &kept.files, &experiment_name, &experiment)?;
    for spec in &specs {
        check_accepted(spec).map_err(|e| FileError::whole(&job_name, e.to_string()))?;
    }
    let alternatives = specs.split_off(1);
    let spec = specs.remove(0);
    let effects = file.effect.iter().map(String::as_str);
    let additions = effects.chain(names.iter().map(|name| stem(name)));
    Ok(JobOnDisk {
        // An extension has another folder than its base.
        name: additions.fold(name(path), |name, addition| format!("{name}+{addition}")),
        job: kept,
        experiment,
        spec,
        alternatives,
    })
}

/// Reads the effect files of the command line, each by its name without folders.
fn added_files(paths: &[PathBuf]) -> Result<BTreeMap<String, String>, FileError> {
    let mut files = BTreeMap::new();
    for path in paths {
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if files.insert(name.clone(), read_text(path)?).is_some() {
            return Err(FileError::whole(
                &name,
                "two files of --effect-file have this name",
            ));
        }
    }
    Ok(files)
}

/// Returns the job's name: the name of its file, or of its folder where the file is `job.toml`.
fn name(path: &Path) -> String {
    let text = |s: Option<&std::ffi::OsStr>| s.map(|s| s.to_string_lossy().into_owned());
    let stem = text(path.file_stem()).unwrap_or_else(|| "job".into());
    if stem != "job" {
        return stem;
    }
    let absolute: PathBuf = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    text(absolute.parent().and_then(Path::file_name)).unwrap_or(stem)
}

/// Returns the name of a file without its ending.
fn stem(file: &str) -> &str {
    file.strip_suffix(".toml").unwrap_or(file)
}
