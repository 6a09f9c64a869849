//! The candidate effects of the library, each as an addition to a job.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use formula::catalogue::{catalogue, find};
use formula::slip::variables;
use formula::{Effect, Hook, Parameter};
use shared::experiment::{Experiment, RunUse, TestRun};
use shared::file::{FileError, FileSet, unknown_word};
use shared::model::effects::parameter_name;
use shared::parameters::WHEEL_RADIUS;

use job::{
    Addition, EffectOnNodes, FreeParameter, Job, ModelChange, ModelSwitch, NamedFile, NamedFiles,
    PlainParameter, Spec, candidate_priors, extended_job,
};
use record::Extension;

/// A candidate effect as an addition to a job.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CandidateEffect {
    /// Its name: that of the effect, `EFFECT.WHEEL` on one wheel of several, `EFFECT_node` with the displacement on the soil,
    /// `pressure_z` of a curve, `pressure_z_power` of a form.
    pub name: String,
    /// The addition to the job.
    pub extension: Extension,
}

/// Why an effect of the library is not a candidate.
#[derive(Debug, thiserror::Error)]
pub enum ExclusionReason {
    /// The model cannot express it in this experiment.
    #[error(transparent)]
    File(#[from] FileError),
    /// Its strength is fixed.
    #[error("no strength is free")]
    NoFreeStrength,
    /// The job infers the radius of the wheel.
    #[error("the radius of the wheel is free in the job")]
    FreeRadius,
    /// It changes nothing at the conditions of the fitted runs.
    #[error("it changes nothing at the slips and slip angles of the fitted runs")]
    AbsentEverywhere,
}

/// Returns the job with further effects, as a text.
///
/// Effects of the catalogue join those under `[model]`, where a setting is turned; a plain parameter of the model gets its prior
/// under `[priors]`; effect files come with the job; and an effect on one wheel is a line under `[priors]` for each of its
/// strengths, with the prior of the effect's file. A prior under `[discovery.priors]` replaces that of the catalogue.
///
/// # Errors
/// [`FileError`] of the job: an effect is unknown, a file or a line exists already, the text is not a job. Whether the model can
/// express the result is checked by [`Spec::new`].
pub fn extended(name: &str, job: &FileSet, extensions: &[&Extension]) -> Result<FileSet, FileError> {
    let stated = candidate_priors(&job.toml);
    let addition = addition(&stated, extensions, &NamedFiles::default());
    extended_job(name, job, &addition.map_err(|e| FileError::whole(name, e))?)
}

/// Returns the job with further effects, as a value.
///
/// # Arguments
/// - `parsed`: effect files that were parsed before.
///
/// # Errors
/// The errors of [`extended`], or the model is not valid with the effects.
pub(crate) fn with_extensions(
    job: &Job,
    extensions: &[&Extension],
    parsed: &NamedFiles,
) -> Result<Job, FileError> {
    let addition = addition(&job.candidate_priors, extensions, parsed);
    job.with(JOB, &addition.map_err(|e| FileError::whole(JOB, e))?)
}

/// Collects the changes of a job by further effects.
///
/// # Arguments
/// - `stated`: the priors that the job states for candidates. `parsed`: effect files that were parsed before.
fn addition(
    stated: &BTreeMap<String, toml::Value>,
    extensions: &[&Extension],
    parsed: &NamedFiles,
) -> Result<Addition, String> {
    let mut addition = Addition::default();
    for extension in extensions {
        match extension {
            Extension::Effect(name) => add_named(&mut addition, stated, name),
            Extension::OnWheel { effect, wheel } => {
                let effect = find(effect).ok_or_else(|| {
                    let names = catalogue().iter().map(|e| e.name.as_str());
                    unknown_word("effect", effect, names)
                })?;
                let strengths = effect.parameters.iter().filter(|p| p.neutral.is_some());
                let prior = |p: &Parameter| {
                    let stated = stated.get(&parameter_name(effect, p, None));
                    stated.unwrap_or(&p.prior).clone()
                };
                let lines = strengths.map(|p| (parameter_name(effect, p, Some(wheel)), prior(p)));
                addition.priors.extend(lines);
            }
            Extension::File { name, text } => {
                let parsed = parsed.get(name).filter(|file| file.text == *text);
                let file = parsed.map_or_else(|| NamedFile::new(text.clone()), Arc::clone);
                addition.files.push((name.clone(), file));
            }
        }
    }
    Ok(addition)
}

/// Adds a plain parameter, a setting of the model, or an effect of the catalogue by its name.
fn add_named(addition: &mut Addition, stated: &BTreeMap<String, toml::Value>, name: &str) {
    if let Some((prior, _)) = PlainParameter::find(name).and_then(PlainParameter::prior) {
        let prior = stated.get(name).unwrap_or(prior).clone();
        addition.changes.push(ModelChange::Free(name.to_owned(), prior));
        return;
    }
    if let Some(switch) = ModelSwitch::find(name) {
        addition.changes.push(ModelChange::Turn(switch));
        return;
    }
    let mut effect = name;
    if let Some(on_nodes) = EffectOnNodes::find(name) {
        addition.changes.push(ModelChange::Turn(on_nodes.setting));
        effect = &on_nodes.effect.name;
    }
    // On the rim and on the nodes together, an effect is on the nodes.
    if addition.effects.iter().any(|added| added == effect) {
        return;
    }
    let is_of_effect = |parameter: &str| parameter.split_once('.').is_some_and(|(name, _)| name == effect);
    let lines = stated.iter().filter(|(parameter, _)| is_of_effect(parameter));
    addition
        .priors
        .extend(lines.map(|(parameter, prior)| (parameter.clone(), prior.clone())));
    addition.effects.push(effect.to_owned());
}

/// A candidate of the library with the free parameters of the model that has it.
pub type LibraryEffect = (CandidateEffect, Vec<FreeParameter>);

/// Lists the candidate effects of the library for an experiment.
///
/// First every effect of the catalogue that the job does not have, in the order of the catalogue; then, where fitted runs have
/// several wheels, each on each of these wheels alone; then those of the shear displacement with that on the nodes of the soil.
/// Checked by `tests::of_several_wheels_each_may_have_an_effect_alone` and
/// `tests::an_effect_of_the_displacement_may_be_on_the_nodes`.
///
/// # Returns
/// The candidates, and the names of the effects that are excluded here with the reason.
pub fn library(
    job: &Job,
    experiment: &Arc<Experiment>,
) -> (Vec<LibraryEffect>, Vec<(String, ExclusionReason)>) {
    let (mut existing, mut on_nodes, mut runs) = (BTreeSet::new(), Vec::new(), [].as_slice());
    let mut infers_radius = false;
    // An invalid job excludes every effect, each with the reason.
    if let Ok(base) = spec(job, experiment) {
        on_nodes.extend(EffectOnNodes::all_of(&base));
        infers_radius = base.parameters.iter().any(|p| p.name.starts_with(WHEEL_RADIUS));
        existing.extend(base.fit_variant.effects.into_iter().map(|e| e.name));
        runs = &experiment.runs;
    }
    let fitted = runs.iter().filter(|run| run.usage == RunUse::Fit);
    let wheels: BTreeSet<&str> = fitted.map(|run| run.wheel.as_str()).collect();
    let missing = || catalogue().iter().filter(|e| !existing.contains(&e.name));
    let everywhere = missing().map(|effect| (effect, None));
    let on_one = missing()
        .flat_map(|effect| wheels.iter().map(move |wheel| (effect, Some(*wheel))))
        .filter(|_| wheels.len() > 1);
    let (mut candidates, mut excluded) = (Vec::new(), Vec::new());
    for (effect, wheel) in everywhere.chain(on_one) {
        let candidate = candidate(effect, wheel);
        // The model may lack the mechanism that the effect changes; then no runs would show the effect.
        let is_mechanism = effect.hooks().next().is_none();
        let checked = match acts(runs, effect, wheel) {
            true if infers_radius && effect.hooks().eq([Hook::Radius]) => Err(ExclusionReason::FreeRadius),
            true => check(job, experiment, &candidate.extension, effect, wheel),
            false if is_mechanism => check(job, experiment, &candidate.extension, effect, wheel)
                .and(Err(ExclusionReason::AbsentEverywhere)),
            false => Err(ExclusionReason::AbsentEverywhere),
        };
        match checked {
            Ok(parameters) => candidates.push((candidate, parameters)),
            Err(reason) => excluded.push((candidate.name, reason)),
        }
    }
    for on_nodes in on_nodes {
        let candidate = named(on_nodes.name());
        // An effect that the model cannot have is excluded above already.
        if let Ok(parameters) = check(job, experiment, &candidate.extension, on_nodes.effect, None) {
            candidates.push((candidate, parameters));
        }
    }
    (candidates, excluded)
}

/// Returns whether an effect changes something in a fitted run, of one wheel if it is named; true if no run is fitted.
pub(super) fn acts(runs: &[TestRun], effect: &Effect, wheel: Option<&str>) -> bool {
    let fitted = || runs.iter().filter(|run| run.usage == RunUse::Fit);
    let mut on_wheel = fitted().filter(|run| wheel.is_none_or(|wheel| run.wheel == wheel));
    fitted().next().is_none()
        || on_wheel.any(|run| !effect.is_absent_at(&variables(run.slip, run.slip_angle_deg.to_radians())))
}

/// Returns the candidate of a name, with its effect; `None` for a name that is not in the catalogue.
pub(super) fn candidate_of(name: &str) -> Option<(&'static Effect, CandidateEffect)> {
    if let Some(on_nodes) = EffectOnNodes::find(name) {
        return Some((on_nodes.effect, named(name.to_owned())));
    }
    let (effect, wheel) = match name.split_once('.') {
        Some((effect, wheel)) => (effect, Some(wheel)),
        None => (name, None),
    };
    let effect = find(effect)?;
    Some((effect, candidate(effect, wheel)))
}

fn candidate(effect: &Effect, wheel: Option<&str>) -> CandidateEffect {
    let effect = effect.name.clone();
    match wheel {
        None => named(effect),
        Some(wheel) => CandidateEffect {
            name: format!("{effect}.{wheel}"),
            extension: Extension::OnWheel {
                effect,
                wheel: wheel.to_owned(),
            },
        },
    }
}

/// Makes the candidate that a job adds by its name.
fn named(name: String) -> CandidateEffect {
    CandidateEffect {
        extension: Extension::Effect(name.clone()),
        name,
    }
}

/// Returns the free parameters of the job's model with an effect.
///
/// # Errors
/// [`ExclusionReason`]: the model cannot have the effect, or none of its strengths is free.
pub(super) fn check(
    job: &Job,
    experiment: &Arc<Experiment>,
    extension: &Extension,
    effect: &Effect,
    wheel: Option<&str>,
) -> Result<Vec<FreeParameter>, ExclusionReason> {
    let with = with_extensions(job, &[extension], &NamedFiles::default())?;
    let parameters = spec(&with, experiment)?.parameters;
    let strengths = effect.parameters.iter().filter(|p| p.neutral.is_some());
    let mut strengths = strengths.map(|p| parameter_name(effect, p, wheel));
    let is_free = |name: String| parameters.iter().any(|p| p.name == name);
    match strengths.any(is_free) {
        true => Ok(parameters),
        false => Err(ExclusionReason::NoFreeStrength),
    }
}

/// Names of job and experiment in messages.
pub(super) const JOB: &str = "job.toml";
pub(super) const EXPERIMENT: &str = "experiment.toml";

/// Returns the specification of a search's job.
pub(super) fn spec(job: &Job, experiment: &Arc<Experiment>) -> Result<Spec, FileError> {
    Spec::from_values(JOB, job.clone(), EXPERIMENT, Arc::clone(experiment))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SearchModels;
    use crate::fixture::{library_of, read, spec_of};

    #[test]
    fn the_library_is_the_catalogue_less_what_the_job_has_and_the_model_cannot_say() {
        let (mut job, files, _) = read("tests/data/shear-mobilisation");
        job.toml = job
            .toml
            .replacen("[model]\n", "[model]\neffects = [\"sled_tare\"]\n", 1);
        let (candidates, excluded) = library_of(&job, &files);
        assert_eq!(candidates.len() + excluded.len(), catalogue().len() - 1);
        let names: Vec<&str> = candidates.iter().map(|e| e.name.as_str()).collect();
        assert!(names.contains(&"janosi_hanamoto") && !names.contains(&"sled_tare"));
        // one wheel: none on a wheel of several
        assert!(names.iter().all(|name| !name.contains('.')), "{names:?}");
        let reason = |name: &str| excluded.iter().find(|(n, _)| n == name).unwrap().1.to_string();
        assert!(
            reason("end_wall").contains("bin_length_m"),
            "{}",
            reason("end_wall")
        );
    }

    #[test]
    fn a_prior_that_the_job_states_for_a_candidate_replaces_the_catalogue_s() {
        let (mut job, files, _) = read("tests/data/shear-mobilisation");
        job.toml += "\n[discovery.priors]\nslip_sinkage.exponent_per_slip = { half_normal = 2.5 }\ncohesion_pa = { half_normal = 90.0 }\n";
        let width = |job: &FileSet, effect: &str, parameter: &str| {
            let added = Extension::Effect(effect.to_owned());
            let with = spec_of(&extended("job.toml", job, &[&added]).unwrap(), &files).unwrap();
            let place = with.parameters.iter().position(|p| p.name == parameter).unwrap();
            with.parameters[place].marginal.quantile(0.5)
        };
        // The median of a half-normal is 0.6745 of its scale.
        let median = |scale: f64| 0.674_489_750_196 * scale;
        for (effect, parameter, scale) in [
            ("slip_sinkage", "slip_sinkage.exponent_per_slip", 2.5),
            ("cohesion_pa", "cohesion_pa", 90.0),
        ] {
            let given = width(&job, effect, parameter);
            assert!((given / median(scale) - 1.0).abs() < 1e-6, "{effect}: {given}");
        }
        // What follows from the job, its search too, keeps them.
        let next = job::continued_job("job.toml", &job).unwrap();
        assert_eq!(candidate_priors(&next.toml), candidate_priors(&job.toml));
    }

    #[test]
    fn of_several_wheels_each_may_have_an_effect_alone() {
        let (job, files, _) = read("examples/cmu-sand");
        let (candidates, excluded) = library_of(&job, &files);
        assert_eq!(candidates.len() + excluded.len(), 3 * catalogue().len());
        let of = |name: &str| candidates.iter().find(|e| e.name == name);
        let digging = of("slip_sinkage.grousered").unwrap();
        let with = extended("job.toml", &job, &[&digging.extension]).unwrap();
        assert!(
            with.toml
                .contains("\"slip_sinkage.exponent_per_slip.grousered\" = { half_normal = 0.5 }\n"),
            "{}",
            with.toml
        );
        let with = spec_of(&with, &files).unwrap();
        assert_eq!(with.effects_on_wheels(), ["slip_sinkage.grousered"]);
        let everywhere = extended("job.toml", &job, &[&of("slip_sinkage").unwrap().extension]).unwrap();
        let everywhere = spec_of(&everywhere, &files).unwrap();
        assert_eq!(everywhere.effects_on_wheels(), ["slip_sinkage"]);
        let names = with.parameters;
        assert!(
            names
                .iter()
                .any(|p| p.name == "slip_sinkage.exponent_per_slip.grousered")
        );
        assert!(
            names
                .iter()
                .all(|p| p.name != "slip_sinkage.exponent_per_slip.smooth")
        );
        let smooth = excluded.iter().find(|(name, _)| name == "lug_thrust.smooth");
        assert!(smooth.is_some_and(|(_, reason)| reason.to_string().contains("needs a wheel with grousers")));
    }

    #[test]
    fn where_grousers_roll_a_springy_soil_or_rim_is_excluded_with_the_reason() {
        let (mut job, files, _) = read("examples/cmu-sand");
        let kind = "kind = \"quasi_static\"\n";
        job.toml = job
            .toml
            .replacen(kind, &format!("{kind}grousers = \"rolled\"\n"), 1);
        let (candidates, excluded) = library_of(&job, &files);
        for effect in ["elastic_rebound", "wheel_flexibility"] {
            let smooth = format!("{effect}.smooth");
            assert!(candidates.iter().any(|c| c.name == smooth), "{smooth}");
            for name in [effect.to_owned(), format!("{effect}.grousered")] {
                let reason = excluded.iter().find(|(n, _)| *n == name).unwrap().1.to_string();
                assert!(
                    reason.contains("grousers = \"rolled\": effect "),
                    "{name}: {reason}"
                );
            }
        }
    }

    #[test]
    fn an_effect_of_the_displacement_may_be_on_the_nodes() {
        let (mut job, files, _) = read("tests/data/shear-mobilisation");
        let on_nodes = |job: &FileSet| -> Vec<CandidateEffect> {
            let (candidates, _) = library_of(job, &files);
            candidates
                .into_iter()
                .filter(|c| c.name.ends_with("_node"))
                .collect()
        };
        // No terrain, no nodes.
        assert!(on_nodes(&job).is_empty());
        job.toml = job.toml.replace("quasi_static", "scm");
        let found = on_nodes(&job);
        let names: Vec<&str> = found.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["janosi_hanamoto_node", "stretched_mobilisation_node"]);
        let with = extended("job.toml", &job, &[&found[0].extension]).unwrap();
        let own = spec_of(&with, &files).unwrap();
        let displacement = own.model.spatial.map(|spatial| spatial.displacement);
        assert_eq!(
            displacement,
            Some(shared::model::spatial::DisplacementFrame::Node)
        );
        assert_eq!(own.freed(), ["displacement_node", "kind_scm"]);
        // Together with the same on the rim it is one effect; a job that has one is asked where it keeps the displacement.
        let rim = Extension::Effect("janosi_hanamoto".into());
        let both = extended("job.toml", &job, &[&rim, &found[0].extension]).unwrap();
        assert_eq!(spec_of(&both, &files).unwrap().fit_variant.effects.len(), 1);
        // The search therefore combines none on the nodes with another effect of the displacement.
        let models = SearchModels::new(&job, &files, 2).unwrap();
        let excluded = |name: &str| -> Vec<String> {
            let library = models.task().library;
            library.into_iter().find(|c| c.name == name).unwrap().excludes
        };
        assert_eq!(
            excluded("janosi_hanamoto_node"),
            [
                "janosi_hanamoto",
                "stretched_mobilisation",
                "stretched_mobilisation_node"
            ]
        );
        assert!(excluded("janosi_hanamoto").is_empty());
        let mobilised = extended("job.toml", &job, &[&rim]).unwrap();
        assert!(on_nodes(&mobilised).is_empty());
    }

    #[test]
    fn what_no_fitted_run_shows_is_no_candidate() {
        let (job, straight, _) = read("examples/cmu-sand");
        let mut at_an_angle = straight.clone();
        let runs = at_an_angle.files.get_mut("runs.csv").unwrap();
        *runs = runs
            .lines()
            .map(|line| match line.starts_with("grousered") {
                true => line.replacen(",0,1,", ",15,1,", 1) + "\n",
                false => line.to_owned() + "\n",
            })
            .collect();
        let names = |files: &FileSet| -> Vec<String> {
            let (candidates, _) = library_of(&job, files);
            candidates.into_iter().map(|c| c.name).collect()
        };
        let of = |names: &[String], effect: &str| -> Vec<String> {
            let own = names.iter().filter(|name| name.split('.').next() == Some(effect));
            own.cloned().collect()
        };
        let (without, with) = (names(&straight), names(&at_an_angle));
        for effect in ["lateral_slip_sinkage", "side_bulldozing", "side_drag"] {
            assert!(of(&without, effect).is_empty(), "{effect}");
            assert_eq!(
                of(&with, effect),
                [effect.to_owned(), format!("{effect}.grousered")]
            );
        }
        // The sand was driven over in skid, too.
        assert_eq!(of(&without, "skid_sinkage").len(), 3);
        let models = SearchModels::new(&job, &straight, 1).unwrap();
        let said: Vec<_> = models.not_tried().filter(|own| own.name == "side_drag").collect();
        assert_eq!(said.len(), 1);
        assert_eq!(said[0].needs, "runs at a slip angle");
        // Runs in drive alone show nothing of a law of skid.
        let mut driven = straight;
        let runs = driven.files.get_mut("runs.csv").unwrap();
        *runs = runs
            .lines()
            .filter(|line| !line.contains(",-"))
            .map(|line| line.to_owned() + "\n")
            .collect();
        let models = SearchModels::new(&job, &driven, 1).unwrap();
        let needs = |name: &str| -> Vec<String> {
            let own = models.not_tried().filter(|own| own.name == name);
            own.map(|own| own.needs.clone()).collect()
        };
        assert_eq!(needs("skid_sinkage"), ["runs in skid"]);
        assert_eq!(needs("lateral_slip_sinkage"), ["runs at a slip angle"]);
    }

    #[test]
    fn a_plain_parameter_is_freed_with_its_prior() {
        let (job, files, _) = read("examples/hidden-effect");
        let free = |name: &str| {
            let with = extended(JOB, &job, &[&Extension::Effect(name.into())]).unwrap();
            spec_of(&with, &files).map(|spec| spec.freed())
        };
        assert_eq!(free("cohesion_pa").unwrap(), ["cohesion_pa", "kind_quasi_static"]);
        // the job holds it under [model]
        assert_eq!(
            free("shear_velocity_m_s").unwrap(),
            ["shear_velocity_m_s", "kind_quasi_static"]
        );
        assert_eq!(free("kind_scm").unwrap(), ["kind_scm"]);
        let message = free("flow_fraction").unwrap_err().to_string();
        assert!(message.contains("quasi_static has no terrain"), "{message}");
    }

    #[test]
    fn settings_of_a_job_s_model_are_candidates_and_the_other_kind_where_it_is_asked_for() {
        let (job, files, _) = read("examples/hidden-effect");
        let switches = |toml: String| -> Vec<String> {
            let job = FileSet { toml, ..job.clone() };
            let models = SearchModels::new(&job, &files, 1).unwrap();
            let candidates = models.task().library.into_iter();
            let switches = candidates.filter(|c| c.parameters.is_empty());
            switches.map(|c| c.name).collect()
        };
        assert_eq!(switches(job.toml.clone()), ["shear_velocity_zero"]);
        let asked = job
            .toml
            .replace("[discovery]\n", "[discovery]\nother_kind = true\n");
        assert_eq!(switches(asked.clone()), ["shear_velocity_zero", "kind_scm"]);
        // A free parameter that the other kind does not have leaves no job of that kind, which is said.
        let bound = asked.replace("quasi_static", "scm").replace(
            "[priors]\n",
            "[priors]\nflow_fraction = { uniform = [0.0, 1.0] }\n",
        );
        let bound = FileSet {
            toml: bound,
            ..job.clone()
        };
        let models = SearchModels::new(&bound, &files, 1).unwrap();
        let other = models
            .not_tried()
            .find(|own| own.name == "kind_quasi_static")
            .unwrap();
        assert!(other.why.contains("flow_fraction"), "{other:?}");
        let spatial = job.toml.replace("quasi_static", "scm");
        let of_scm = ["pressure_direction_vertical", "shear_velocity_zero"];
        assert_eq!(switches(spatial.clone()), of_scm);
        // Without a shear displacement it makes no difference where it is kept.
        let mobilised = spatial.replacen("[model]\n", "[model]\neffects = [\"janosi_hanamoto\"]\n", 1);
        assert_eq!(
            switches(mobilised),
            ["pressure_direction_vertical", "displacement_node", of_scm[1]]
        );
    }

    #[test]
    fn a_velocity_held_above_its_limit_may_be_at_the_limit() {
        let (job, files, _) = read("examples/hidden-effect");
        let held = "shear_velocity_m_s = 0.001 ";
        let is_candidate = |new: &str| -> bool {
            let toml = job.toml.replacen(held, new, 1);
            let models = SearchModels::new(&FileSet { toml, ..job.clone() }, &files, 1).unwrap();
            let mut library = models.task().library.into_iter();
            library.any(|candidate| candidate.name == "shear_velocity_zero")
        };
        assert!(job.toml.contains(held));
        // The default of the model is held as well.
        assert!(is_candidate(held) && is_candidate(""));
        assert!(!is_candidate("shear_velocity_m_s = 0.0 "));
        // Without a reference velocity no factor of it can be inferred.
        assert!(!is_candidate(
            "shear_velocity_m_s = 0.001\neffects = [\"shear_velocity_scale\"] "
        ));
        let toml = job.toml.replacen(held, "", 1);
        let prior = "[priors]\nshear_velocity_m_s = { lognormal = [0.001, 2.0] }\n";
        let free = FileSet {
            toml: toml.replacen("[priors]\n", prior, 1),
            ..job.clone()
        };
        let models = SearchModels::new(&free, &files, 1).unwrap();
        let mut library = models.task().library.into_iter();
        assert!(library.all(|candidate| candidate.name != "shear_velocity_zero"));
        let zero = extended(JOB, &job, &[&Extension::Effect("shear_velocity_zero".into())]).unwrap();
        assert!(
            zero.toml.contains("\nshear_velocity_m_s = 0.0\n"),
            "{}",
            zero.toml
        );
        let freed = spec_of(&zero, &files).unwrap().freed();
        assert_eq!(freed, ["shear_velocity_zero", "kind_quasi_static"]);
    }

    #[test]
    fn several_effects_join_a_job_and_none_twice() {
        let (job, files, _) = read("examples/cmu-sand");
        let file = Extension::File {
            name: "mine.toml".into(),
            text: "name = \"mine\"\nsummary = \"s\"\nsource = \"s\"\nshear = \"tau * (1 + a)\"\n[parameters.a]\n\
                   unit = \"1\"\nneutral = 0.0\nprior = { normal = [0.0, 0.1] }\n"
                .into(),
        };
        let on_wheel = |effect: &str| Extension::OnWheel {
            effect: effect.into(),
            wheel: "smooth".into(),
        };
        let (tare, digging) = (Extension::Effect("sled_tare".into()), on_wheel("slip_sinkage"));
        let with = extended("job.toml", &job, &[&tare, &file, &digging]).unwrap();
        let effects = spec_of(&with, &files).unwrap().fit_variant.effects;
        let names: Vec<&str> = effects.iter().map(|e| e.name.as_str()).collect();
        assert_eq!(names, ["slip_sinkage", "sled_tare", "mine"]);
        let twice = extended("job.toml", &with, &[&file]).unwrap_err();
        assert_eq!(twice.to_string(), "job.toml: file \"mine.toml\" exists already");
        assert!(extended("job.toml", &with, &[&digging]).is_err());
        let unknown = extended("job.toml", &job, &[&on_wheel("slip_sinkage_")]).unwrap_err();
        assert!(unknown.to_string().contains("slip_sinkage"), "{unknown}");
    }
}
