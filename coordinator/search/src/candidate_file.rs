//! Candidates that come with the job as effect files: `[discovery] candidate_files`.

use formula::{Effect, Hook};
use shared::parameters::WHEEL_RADIUS;

use job::{Job, Spec};
use record::{Extension, NotTried};

use super::candidate::{CandidateEffect, ExclusionReason, LibraryEffect, acts, check};

/// Lists the effects of the job's candidate files.
pub(super) fn effects_in_files(job: &Job) -> impl Iterator<Item = Effect> {
    let files = job.candidate_files.iter();
    files.filter_map(|file| job.files.effect(file)?.ok())
}

/// Lists the candidates in files, except those that the model has.
///
/// Checked by `library::a_job_names_candidates_by_their_files` of the tests of the farm.
///
/// # Returns
/// The candidates, and the names of those that are excluded with the reason.
pub(super) fn candidates_in_files(
    job: &Job,
    base: &Spec,
) -> (Vec<LibraryEffect>, Vec<(String, ExclusionReason)>) {
    let infers_radius = base.parameters.iter().any(|p| p.name.starts_with(WHEEL_RADIUS));
    let (mut candidates, mut excluded) = (Vec::new(), Vec::new());
    for file in &job.candidate_files {
        let Some(Ok(effect)) = job.files.effect(file) else {
            continue;
        };
        if base
            .fit_variant
            .effects
            .iter()
            .any(|existing| existing.name == effect.name)
        {
            continue;
        }
        let candidate = CandidateEffect {
            name: effect.name.clone(),
            extension: Extension::File {
                name: file.clone(),
                text: effect.text.clone(),
            },
        };
        let checked = match acts(&base.experiment.runs, &effect, None) {
            false => Err(ExclusionReason::AbsentEverywhere),
            true if infers_radius && effect.hooks().eq([Hook::Radius]) => Err(ExclusionReason::FreeRadius),
            true => check(job, &base.experiment, &candidate.extension, &effect, None),
        };
        match checked {
            Ok(parameters) => candidates.push((candidate, parameters)),
            Err(reason) => excluded.push((candidate.name, reason)),
        }
    }
    (candidates, excluded)
}

/// Lists the effects of candidate files that the model cannot have, with what they would need.
pub(super) fn unfit_files(job: &Job, excluded: &[(String, ExclusionReason)]) -> Vec<NotTried> {
    let unfit = |effect: Effect| {
        let (name, reason) = excluded.iter().find(|(name, _)| *name == effect.name)?;
        let external = job.model.external.as_ref();
        let needs = match reason {
            ExclusionReason::AbsentEverywhere => return None,
            _ if external.is_some_and(|model| model.why_not(&effect).is_some()) => NotTried::OUR_MODEL,
            _ => "a model and an experiment that have what the formulas of its file use",
        };
        Some(NotTried {
            name: name.clone(),
            why: reason.to_string(),
            needs: needs.to_owned(),
        })
    };
    effects_in_files(job).filter_map(unfit).collect()
}
