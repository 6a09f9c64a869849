//! The base of a search without one of its effects, and the candidates that may take the effect's place.

use std::collections::BTreeSet;

use discovery::Reduction;
use job::{Job, NamedFiles, Spec};
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use record::Extension;
use shared::file::FileError;

use super::candidate::{JOB, spec, with_extensions};
use super::entry::CandidateEntry;

/// The base without one of its effects.
#[derive(Debug)]
pub(super) struct ReducedModel {
    /// Name of the effect that is left out.
    pub(super) effect: String,
    job: Job,
    /// Names of the parameters that remain.
    names: Vec<String>,
    /// Indices of the effects of the library that the model may have in the effect's place.
    substitutes: Vec<usize>,
}

impl ReducedModel {
    /// Lists the base's effects without which the job is valid.
    pub(super) fn all_of(job: &Job, base: &Spec, library: &[CandidateEntry]) -> Vec<Self> {
        let effects = base.fit_variant.effects.iter();
        let reduced = effects.filter_map(|effect| Self::new(job, base, &effect.name, library));
        reduced.collect()
    }

    fn new(job: &Job, base: &Spec, effect: &str, library: &[CandidateEntry]) -> Option<Self> {
        let job = job.without(JOB, &[effect.to_owned()]).ok()?;
        let parameters = spec(&job, &base.experiment).ok()?.parameters;
        let mut reduced = Self {
            effect: effect.to_owned(),
            job,
            names: parameters.into_iter().map(|p| p.name).collect(),
            substitutes: Vec::new(),
        };
        let candidates = library.par_iter().enumerate();
        let substitutes = candidates.filter(|(_, entry)| reduced.takes(base, entry));
        reduced.substitutes = substitutes.map(|(k, _)| k).collect();
        Some(reduced)
    }

    /// Returns whether the model may have a candidate, with the parameters that it adds to the base.
    fn takes(&self, base: &Spec, entry: &CandidateEntry) -> bool {
        let with = self.with(&[&entry.effect.extension], &NamedFiles::default());
        let with = with.and_then(|with| spec(&with, &base.experiment));
        let names = self.names.iter().chain(&entry.names).map(String::as_str);
        let expected: BTreeSet<&str> = names.collect();
        with.is_ok_and(|with| {
            let names = with.parameters.iter().map(|p| p.name.as_str());
            entry.not_tried.is_none() && names.collect::<BTreeSet<&str>>() == expected
        })
    }

    /// Returns the job with candidates in the place of the effect.
    ///
    /// # Errors
    /// [`FileError`] where the model is not valid with them.
    pub(super) fn with(&self, extensions: &[&Extension], parsed: &NamedFiles) -> Result<Job, FileError> {
        with_extensions(&self.job, extensions, parsed)
    }

    /// Returns the names of the parameters that remain.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(String::as_str)
    }

    /// Returns the reduction of the search's task.
    pub(super) fn reduction(&self, base: &Spec) -> Reduction {
        let place = |name: &String| base.parameters.iter().position(|p| p.name == *name);
        Reduction {
            parameters: self.names.iter().filter_map(place).collect(),
            substitutes: self.substitutes.clone(),
        }
    }
}
