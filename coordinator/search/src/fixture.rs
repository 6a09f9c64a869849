//! Experiments and effect files for tests.

use std::path::Path;
use std::sync::Arc;

use formula::Effect;
use job::{Job, Spec, check_effect};
use record::Extension;
use shared::experiment::Experiment;
use shared::file::{FileError, FileSet};
use shared::model::effects::read_user_effect;

use super::candidate::{CandidateEffect, EXPERIMENT, ExclusionReason, JOB, library, spec};

/// An experiment of the repository, with the job beside it.
pub(super) fn read(folder: &str) -> (FileSet, FileSet, Experiment) {
    let file = |name: &str| Path::new("../..").join(folder).join(name);
    let job = FileSet {
        toml: std::fs::read_to_string(file("job.toml")).unwrap(),
        ..FileSet::default()
    };
    let files = Experiment::read_files(&file("experiment.toml")).unwrap();
    let experiment = Experiment::parse("experiment.toml", &files).unwrap();
    (job, files, experiment)
}

/// The job of a search and its experiment as values.
pub(super) fn values(job: &FileSet, files: &FileSet) -> (Job, Arc<Experiment>) {
    let experiment = Experiment::parse(EXPERIMENT, files).unwrap();
    (Job::read(JOB, job).unwrap().into_search(), Arc::new(experiment))
}

/// The specification of the search of a job.
pub(super) fn spec_of(job: &FileSet, files: &FileSet) -> Result<Spec, FileError> {
    let (job, experiment) = values(job, files);
    spec(&job, &experiment)
}

/// The library of a job: the candidates, and the names of the effects that are excluded with the reason.
pub(super) fn library_of(
    job: &FileSet,
    files: &FileSet,
) -> (Vec<CandidateEffect>, Vec<(String, ExclusionReason)>) {
    let (job, experiment) = values(job, files);
    let (candidates, excluded) = library(&job, &experiment);
    let candidates = candidates.into_iter().map(|(candidate, _)| candidate);
    (candidates.collect(), excluded)
}

/// The effect file of a candidate, checked as a user's.
pub(super) fn text(candidate: &CandidateEffect) -> (&str, Effect) {
    let Extension::File { name, text } = &candidate.extension else {
        panic!("{candidate:?}")
    };
    let effect = read_user_effect(name, text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    check_effect(name, &effect).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!(format!("{}.toml", effect.name), *name);
    (text, effect)
}
