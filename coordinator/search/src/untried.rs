//! Untried effects: they need a property that the experiment does not state, so they are weighed with a typical value and never
//! named.

use std::collections::BTreeMap;
use std::sync::Arc;

use formula::{Effect, Variable};
use shared::experiment::Experiment;
use shared::file::{FileError, FileSet};

use super::candidate::{CandidateEffect, EXPERIMENT, ExclusionReason, JOB, candidate_of, check, library};
use job::{AssumedExperiment, FreeParameter, Job, SiteProperty, UnstatedProperty};
use record::NotTried;

/// An effect that needs what the experiment does not state.
#[derive(Debug, Clone)]
pub struct UntriedEffect {
    /// The effect as an addition to the job.
    pub(super) effect: CandidateEffect,
    /// The free parameters of the model that has it, with typical values for what is not stated.
    pub(super) parameters: Vec<FreeParameter>,
    /// The properties that are not stated.
    unstated: Vec<UnstatedProperty>,
}

impl UntriedEffect {
    /// Makes its record: the unstated properties, and the lines that would state them.
    pub fn record(&self) -> NotTried {
        let join = |part: fn(&UnstatedProperty) -> &str, separator: &str| {
            let parts: Vec<&str> = self.unstated.iter().map(part).collect();
            parts.join(separator)
        };
        NotTried {
            name: self.effect.name.clone(),
            why: join(|u| &u.why, "; "),
            needs: join(|u| &u.needs, ", "),
        }
    }
}

/// Lists the excluded effects that the model could have if the experiment stated more properties, and returns the experiment with
/// typical values of these.
///
/// # Arguments
/// - `files`: the texts of the experiment, which tell a stated value from a default.
/// - `is_smooth`: whether the model rolls smooth rims, whatever grousers are declared.
/// - `excluded`: names as [`library`] gives them.
///
/// # Errors
/// [`FileError`] of the experiment.
pub fn untried(
    job: &Job,
    experiment: &Experiment,
    files: &FileSet,
    is_smooth: bool,
    excluded: &[(String, ExclusionReason)],
) -> Result<(Vec<UntriedEffect>, Arc<Experiment>), FileError> {
    let assumed = AssumedExperiment::new(EXPERIMENT, files, experiment, is_smooth)?;
    let with_values = Arc::new(assumed.experiment);
    let effect = |name: &str| {
        let (effect, candidate) = candidate_of(name)?;
        let needed = needed(effect);
        let unstated = assumed.unstated.iter().filter(|u| needed.contains(&u.property));
        let unstated: Vec<UnstatedProperty> = unstated.cloned().collect();
        if unstated.is_empty() {
            return None;
        }
        let wheel = name.split_once('.').map(|(_, wheel)| wheel);
        let parameters = check(job, &with_values, &candidate.extension, effect, wheel).ok()?;
        Some(UntriedEffect {
            effect: candidate,
            parameters,
            unstated,
        })
    };
    // No statement about the experiment makes an effect visible that acts in no fitted run.
    let possible = excluded
        .iter()
        .filter(|(_, reason)| !matches!(reason, ExclusionReason::AbsentEverywhere));
    let untried = possible.filter_map(|(name, _)| effect(name)).collect();
    Ok((untried, with_values))
}

/// Describes which candidates of a search further lines of the experiment would add, a sentence for each line.
///
/// # Errors
/// [`FileError`] of job and experiment.
pub fn additions(job: &FileSet, files: &FileSet, is_smooth: bool) -> Result<Vec<String>, FileError> {
    let job = Job::read(JOB, job)?.into_search();
    let experiment = Arc::new(Experiment::parse(EXPERIMENT, files)?);
    let (_, excluded) = library(&job, &experiment);
    let (untried, _) = untried(&job, &experiment, files, is_smooth, &excluded)?;
    let mut of_lines: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for effect in &untried {
        let NotTried { name, needs, .. } = effect.record();
        of_lines.entry(needs).or_default().push(name);
    }
    let sentences = of_lines.into_iter().map(|(needs, names)| {
        format!(
            "{needs} would add to the candidates of a search: {}",
            names.join(", ")
        )
    });
    Ok(sentences.collect())
}

/// Lists the properties of the site that an effect uses.
fn needed(effect: &Effect) -> Vec<SiteProperty> {
    let uses = effect.uses();
    let variables = [
        (SiteProperty::Density, [Variable::Density].as_slice()),
        (
            SiteProperty::Grousers,
            &[Variable::GrouserCount, Variable::GrouserHeight],
        ),
        (SiteProperty::BinLength, &[Variable::BinLength]),
    ];
    let used = variables
        .into_iter()
        .filter(|(_, variables)| variables.iter().any(|v| uses.contains(*v)));
    used.map(|(property, _)| property).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{read, values};

    #[test]
    fn what_the_experiment_does_not_state_is_said_with_the_line_that_would() {
        let (job, mut files, _) = read("examples/hidden-effect");
        files.toml = files
            .toml
            .lines()
            .filter(|line| !line.starts_with("grouser_count"))
            .map(|line| format!("{line}\n"))
            .collect();
        let (value, experiment) = values(&job, &files);
        let (candidates, excluded) = library(&value, &experiment);
        let (untried, assumed) = untried(&value, &experiment, &files, true, &excluded).unwrap();
        let records: Vec<NotTried> = untried.iter().map(UntriedEffect::record).collect();
        let of = |name: &str| records.iter().find(|r| r.name == name);
        let bulldozing = of("bulldozing").unwrap();
        assert!(
            bulldozing.needs.starts_with("density_kg_m3 under [soil."),
            "{bulldozing:?}"
        );
        let lugs = of("lug_thrust").unwrap();
        assert!(
            lugs.needs.contains("density_kg_m3") && lugs.needs.contains("grouser_count"),
            "{lugs:?}"
        );
        assert!(
            of("janosi_hanamoto").is_none() && candidates.iter().any(|(c, _)| c.name == "janosi_hanamoto")
        );
        let lines = additions(&job, &files, true).unwrap();
        assert!(
            lines
                .iter()
                .any(|line| line.starts_with("density_kg_m3 under [soil.") && line.contains("bulldozing")),
            "{lines:?}"
        );
        // with the values that are assumed, nothing is excluded any more for want of them
        let (more, _) = library(&value, &assumed);
        assert_eq!(more.len(), candidates.len() + untried.len());
    }

    #[test]
    fn a_rim_that_is_stated_to_be_smooth_has_no_grousers_to_try() {
        let (job, files, _) = read("examples/hidden-effect");
        let (job, experiment) = values(&job, &files);
        let (_, excluded) = library(&job, &experiment);
        let (untried, _) = untried(&job, &experiment, &files, true, &excluded).unwrap();
        assert!(untried.iter().all(|u| u.effect.name != "lug_thrust"));
    }
}
