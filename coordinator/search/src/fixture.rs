//! Experiments and effect files for tests.

use std::path::Path;

use formula::Effect;
use job::check_own;
use record::Extension;
use shared::experiment::Experiment;
use shared::file::FileSet;
use shared::model::effects::own;

use super::candidate::CandidateEffect;

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

/// The effect file of a candidate, checked as a user's.
pub(super) fn text(candidate: &CandidateEffect) -> (&str, Effect) {
    let Extension::File { name, text } = &candidate.extension else {
        panic!("{candidate:?}")
    };
    let effect = own(name, text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    check_own(name, &effect).unwrap_or_else(|e| panic!("{e}\n{text}"));
    assert_eq!(format!("{}.toml", effect.name), *name);
    (text, effect)
}
