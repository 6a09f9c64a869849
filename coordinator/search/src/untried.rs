//! Effects that the experiment leaves no way to try as it is: weighed with typical values, never named.

use std::collections::BTreeMap;

use formula::{Effect, Variable};
use shared::file::{FileError, FileSet};

use super::candidate::{CandidateEffect, EXPERIMENT, ExclusionReason, candidate_of, check, library};
use job::{AssumedExperiment, SiteProperty, UnsaidProperty};
use record::NotTried;

/// An effect that needs what the experiment does not state.
#[derive(Debug, Clone)]
pub struct UntriedEffect {
    /// The effect as an addition to the job.
    pub(super) effect: CandidateEffect,
    /// What is not stated.
    unsaid: Vec<UnsaidProperty>,
}

impl UntriedEffect {
    /// Its record: what is not stated, and the lines that would state it.
    pub fn record(&self) -> NotTried {
        let join = |of: fn(&UnsaidProperty) -> &str, with: &str| {
            let parts: Vec<&str> = self.unsaid.iter().map(of).collect();
            parts.join(with)
        };
        NotTried {
            name: self.effect.name.clone(),
            why: join(|u| &u.why, "; "),
            needs: join(|u| &u.needs, ", "),
        }
    }
}

/// Those of the excluded effects that the model could have if the experiment stated more, and the experiment in which typical
/// values stand for that.
///
/// # Arguments
/// - `is_smooth`: whether the model rolls smooth rims, whatever grousers are declared.
/// - `excluded`: names as [`library`] gives them.
///
/// # Errors
/// [`FileError`] of the experiment.
pub fn untried(
    job: &FileSet,
    experiment: &FileSet,
    is_smooth: bool,
    excluded: &[(String, ExclusionReason)],
) -> Result<(Vec<UntriedEffect>, FileSet), FileError> {
    let assumed = AssumedExperiment::new(EXPERIMENT, experiment, is_smooth)?;
    let of = |name: &str| {
        let (effect, candidate) = candidate_of(name)?;
        let needed = needed(effect);
        let unsaid = assumed.unsaid.iter().filter(|u| needed.contains(&u.property));
        let unsaid: Vec<UnsaidProperty> = unsaid.cloned().collect();
        let wheel = name.split_once('.').map(|(_, wheel)| wheel);
        let can_be =
            !unsaid.is_empty() && check(job, &assumed.files, &candidate.extension, effect, wheel).is_ok();
        can_be.then_some(UntriedEffect {
            effect: candidate,
            unsaid,
        })
    };
    // What no fitted run shows, no further line of the experiment would show.
    let stated = excluded
        .iter()
        .filter(|(_, reason)| !matches!(reason, ExclusionReason::AbsentEverywhere));
    let untried = stated.filter_map(|(name, _)| of(name)).collect();
    Ok((untried, assumed.files))
}

/// What further lines of the experiment would add to the candidates of a search, a sentence for each.
///
/// # Errors
/// [`FileError`] of the experiment.
pub fn additions(job: &FileSet, experiment: &FileSet, is_smooth: bool) -> Result<Vec<String>, FileError> {
    let (_, excluded) = library(job, experiment);
    let (untried, _) = untried(job, experiment, is_smooth, &excluded)?;
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

/// The properties of the site that an effect uses.
fn needed(effect: &Effect) -> Vec<SiteProperty> {
    let uses = effect.uses();
    let of = [
        (SiteProperty::Density, [Variable::Density].as_slice()),
        (
            SiteProperty::Grousers,
            &[Variable::GrouserCount, Variable::GrouserHeight],
        ),
        (SiteProperty::BinLength, &[Variable::BinLength]),
    ];
    let used = of
        .into_iter()
        .filter(|(_, variables)| variables.iter().any(|v| uses.contains(*v)));
    used.map(|(property, _)| property).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::read;

    #[test]
    fn what_the_experiment_does_not_state_is_said_with_the_line_that_would() {
        let (job, mut files, _) = read("examples/hidden-effect");
        files.toml = files
            .toml
            .lines()
            .filter(|line| !line.starts_with("grouser_count"))
            .map(|line| format!("{line}\n"))
            .collect();
        let (candidates, excluded) = library(&job, &files);
        let (untried, assumed) = untried(&job, &files, true, &excluded).unwrap();
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
        assert!(of("janosi_hanamoto").is_none() && candidates.iter().any(|c| c.name == "janosi_hanamoto"));
        let lines = additions(&job, &files, true).unwrap();
        assert!(
            lines
                .iter()
                .any(|line| line.starts_with("density_kg_m3 under [soil.") && line.contains("bulldozing")),
            "{lines:?}"
        );
        // with the values that are assumed, nothing is excluded any more for want of them
        let (more, _) = library(&job, &assumed);
        assert_eq!(more.len(), candidates.len() + untried.len());
    }

    #[test]
    fn a_rim_that_is_stated_to_be_smooth_has_no_grousers_to_try() {
        let (job, files, _) = read("examples/hidden-effect");
        let (_, excluded) = library(&job, &files);
        let (untried, _) = untried(&job, &files, true, &excluded).unwrap();
        assert!(untried.iter().all(|u| u.effect.name != "lug_thrust"));
    }
}
