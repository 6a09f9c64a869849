//! The models of a search: its candidates, and the variant of each query, made when it is first needed.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use discovery::{
    Candidate, FormulaRequest, LawCandidate, LawCurve, ProposedRuns, QueriedModel, Query, SearchSettings,
    SearchTask, Smoothness, Starts,
};
use formula::catalogue::{catalogue, find};
use formula::slip::variables;
use formula::{Effect, Variable};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use shared::channel::Channel;
use shared::experiment::Experiment;
use shared::file::{FileError, FileSet};
use shared::model::{EffectSet, ExternalModel, ModelKind, ModelVariant, RunCondition};
use shared::outcome::Observables;

use super::candidate::{EXPERIMENT, ExclusionReason, JOB, LibraryEffect, library, spec, with_extensions};
use super::candidate_file::{candidates_in_files, effects_in_files, unfit_files};
use super::design;
use super::entry::{CandidateEntry, LawEntry, names_taken};
use super::family::set_families;
use super::law::equation::LawEquation;
use super::reduced_model::ReducedModel;
use super::rig_errors::suspects;
use super::untried::{UntriedEffect, untried};
use job::{
    EffectOnNodes, Job, MODEL_SWITCHES, NamedFile, NamedFiles, PLAIN_PARAMETERS, PlainParameter, Spec,
};
use record::{Extension, NotTried};

/// Position of proposed runs in the series of the campaign: its end.
const LAST_IN_SERIES: f64 = 0.5;
/// Starts of the base's fit.
const STARTS: usize = 32;

/// The parts of a query that determine its variant.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct VariantKey {
    model: QueriedModel,
    is_proposed: bool,
    is_low_fidelity: bool,
}

impl VariantKey {
    fn new(query: &Query) -> Self {
        Self {
            model: sorted(&query.model),
            is_proposed: query.is_proposed,
            is_low_fidelity: query.is_low_fidelity,
        }
    }
}

/// The models of a search.
#[derive(Debug)]
pub struct SearchModels {
    pub(super) job: Job,
    /// The experiment with typical values for what it leaves unstated.
    assumed: Arc<Experiment>,
    pub(super) base: Spec,
    pub(super) library: Vec<CandidateEntry>,
    /// Candidates that cannot be searched: another kind of model that the job requests and cannot have, effects that an external
    /// model does not show, and effects that act in no condition of the fitted runs.
    not_tried: Vec<NotTried>,
    pub(super) laws: Vec<LawEntry>,
    /// The formulas of the law that is claimed; `None` before they are wanted.
    pub(super) equation: Option<LawEquation>,
    /// The files of the laws and formulas, each read once.
    law_files: NamedFiles,
    /// The base without each of its effects.
    pub(super) reductions: Vec<ReducedModel>,
    /// Proposed runs.
    pub(super) design: Vec<RunCondition>,
    /// The measured channels with their noise sds.
    channels: Vec<(Channel, f64)>,
    /// Hash and variant of every query so far.
    variants: BTreeMap<VariantKey, (String, ModelVariant)>,
    /// Key of each variant by its hash.
    keys: BTreeMap<String, VariantKey>,
    /// The lists of conditions of these variants, each once.
    conditions: Vec<Arc<[RunCondition]>>,
    max_effects: usize,
}

impl SearchModels {
    /// Reads job and experiment, and lists the candidates.
    ///
    /// # Arguments
    /// - `job`: of the base model, with its effects. `max_effects`: maximum number of effects in a combination, if a job has room
    ///   for them.
    ///
    /// # Errors
    /// [`FileError`] of job or experiment.
    pub fn new(job: &FileSet, files: &FileSet, max_effects: usize) -> Result<Self, FileError> {
        let job = Job::read(JOB, job)?.into_search();
        let experiment = Arc::new(Experiment::parse(EXPERIMENT, files)?);
        let base = spec(&job, &experiment)?;
        let (mut effects, mut excluded) = library(&job, &experiment);
        let (untried, assumed) = untried(&job, &experiment, files, base.model.is_smooth(), &excluded)?;
        let (in_files, unfit) = candidates_in_files(&job, &base);
        effects.extend(in_files);
        excluded.extend(unfit);
        let external = base.model.external.iter();
        let mut not_tried: Vec<NotTried> = external.flat_map(out_of_reach).collect();
        not_tried.extend(absent(&job, &excluded));
        not_tried.extend(unfit_files(&job, &excluded));
        let mut library = library_entries(&job, &base, effects, untried, &mut not_tried);
        exclude_on_nodes(&mut library);
        set_families(&mut library);
        // The number of effects of a job is limited; one place is kept for a law beyond the best combination.
        let room = EffectSet::MAX_EFFECTS.saturating_sub(base.fit_variant.effects.len());
        let laws = match room {
            0 | 1 => Vec::new(),
            _ => LawEntry::all_of(&job, &base)?,
        };
        let prior_means: Vec<f64> = base.parameters.iter().map(|p| p.marginal.quantile(0.5)).collect();
        Ok(Self {
            design: design::proposed(&base),
            channels: design::channels(&base, &prior_means),
            reductions: ReducedModel::all_of(&job, &base, &library),
            job,
            assumed,
            library,
            not_tried,
            law_files: law_files(laws.iter().flat_map(LawEntry::entries)),
            laws,
            equation: None,
            variants: BTreeMap::new(),
            keys: BTreeMap::new(),
            conditions: Vec::new(),
            max_effects: max_effects.min(room.saturating_sub(1)),
            base,
        })
    }

    /// Returns everything that is not tried: effects that need a property which the experiment does not state, and candidates that
    /// cannot be searched.
    pub fn not_tried(&self) -> impl Iterator<Item = &NotTried> {
        let effects = self.library.iter().filter_map(|entry| entry.not_tried.as_ref());
        effects.chain(&self.not_tried)
    }

    /// Returns the task of the search.
    pub fn task(&self) -> SearchTask {
        let base = &self.base;
        let law = |law: &LawEntry| LawCandidate {
            curve: law.curve.candidate.clone(),
            forms: law.forms.iter().map(|(_, form)| form.candidate.clone()).collect(),
            is_description: law.dependence.acts_on.channel().is_some(),
        };
        SearchTask {
            prior: base.prior(),
            likelihood: base.likelihood.clone(),
            library: self.library.iter().map(|entry| entry.candidate.clone()).collect(),
            laws: self.laws.iter().map(law).collect(),
            strengths: self.strengths(),
            reductions: self
                .reductions
                .iter()
                .map(|reduced| reduced.reduction(base))
                .collect(),
            levels: design::levels(base),
            conditions: design::conditions(base),
            proposed: ProposedRuns {
                runs: self.design.len(),
                beyond: design::beyond(base, &self.design),
                channels: self.channels.iter().map(|(channel, _)| channel.index()).collect(),
                noise_sds: self.channels.iter().map(|(_, sd)| *sd).collect(),
            },
            suspected_errors: suspects(base).into_iter().map(|suspect| suspect.error).collect(),
            max_effects: self.max_effects,
            settings: SearchSettings {
                starts: Starts::Even(STARTS),
                seed: base.algorithm.seed(),
                smoothness: match base.model.kind {
                    ModelKind::QuasiStatic | ModelKind::WongReece | ModelKind::Rft => Smoothness::Smooth,
                    // Its evaluations are expensive, however fine its grid is.
                    ModelKind::Scm => Smoothness::Rough,
                    // The search measures whether an external model has numerical noise.
                    ModelKind::Command | ModelKind::Umbridge => Smoothness::Unknown,
                },
                has_numerical_noise: base.model.kind != ModelKind::QuasiStatic,
                has_low_fidelity: base.model.kind == ModelKind::Scm
                    && base.fit_variant.low_fidelity().is_ok(),
            },
        }
    }

    /// Returns the places of the base's parameters that are strengths of its effects, or parameters of the model that a search may free.
    fn strengths(&self) -> Vec<usize> {
        let effects = &self.base.fit_variant.effects;
        let is_strength = |name: &str| {
            let Some((effect, parameter)) = name.split_once('.') else {
                return PlainParameter::find(name).is_some();
            };
            let mut texts = effects.iter().filter(|e| e.name == effect);
            let effect = texts.find_map(|e| Effect::read(&e.text).ok());
            // On one wheel of several, the name of the wheel follows.
            let parameter = parameter.split('.').next().unwrap_or_default();
            let is_neutral = |e: Effect| {
                e.parameters
                    .iter()
                    .any(|p| p.name == parameter && p.neutral.is_some())
            };
            effect.is_some_and(is_neutral)
        };
        let parameters = self.base.parameters.iter().enumerate();
        parameters
            .filter(|(_, p)| is_strength(&p.name))
            .map(|(k, _)| k)
            .collect()
    }

    /// Returns the candidate of an index: the library, then the curve and the forms of each law, then the formulas of one law.
    pub(super) fn entry(&self, index: usize) -> Option<&CandidateEntry> {
        let of_laws = self.laws.iter().flat_map(LawEntry::entries);
        let formulas = self.equation.iter().flat_map(LawEquation::entries);
        self.library.iter().chain(of_laws).chain(formulas).nth(index)
    }

    /// Makes the formulas of a law that a search wants, the most probable by the law's curve; none where the curve determines none.
    pub fn offer(&mut self, request: &FormulaRequest) -> Vec<Candidate> {
        let law = &self.laws[request.law];
        let mut equation = self.equation_of(law, &request.curve);
        let offered = equation.as_mut().map_or(Vec::new(), LawEquation::offer);
        self.law_files = law_files(
            self.laws
                .iter()
                .flat_map(LawEntry::entries)
                .chain(equation.iter().flat_map(LawEquation::entries)),
        );
        self.equation = equation;
        offered
    }

    /// Returns the formulas of the curve of a law; `None` where it determines nothing.
    pub(super) fn equation_of(&self, law: &LawEntry, curve: &LawCurve) -> Option<LawEquation> {
        let taken = names_taken(&self.job, &self.base);
        LawEquation::new(&law.dependence, curve, |name| {
            taken.contains(name) || self.job.files.get(&format!("{name}.toml")).is_some()
        })
    }

    /// Returns the name of a candidate; empty without one.
    pub(super) fn name(&self, index: usize) -> String {
        let entry = self.entry(index);
        entry.map_or(String::new(), |entry| entry.effect.name.clone())
    }

    /// Returns the place of a law that a candidate describes: `shear_z`; `None` for an effect or a formula.
    pub(super) fn place(&self, index: usize) -> Option<String> {
        let mut laws = self.laws.iter().flat_map(|law| law.entries().map(move |_| law));
        let law = laws.nth(index.checked_sub(self.library.len())?)?;
        Some(law.dependence.name())
    }

    /// Makes the variants of queries that were not asked before; hundreds in a round of a search, so on all cores.
    ///
    /// # Errors
    /// [`FileError`] where the effects are incompatible.
    pub fn make<'q>(&mut self, queries: impl Iterator<Item = &'q Query>) -> Result<(), FileError> {
        let keys: BTreeSet<VariantKey> = queries.map(VariantKey::new).collect();
        let unknown = keys.into_iter().filter(|key| !self.variants.contains_key(key));
        let unknown: Vec<VariantKey> = unknown.collect();
        let one = |key: &VariantKey| {
            let mut variant = self.of_fitted_runs(&key.model)?;
            if key.is_proposed {
                variant = self.of_proposed_runs(variant);
            }
            if key.is_low_fidelity {
                let low_fidelity = variant.low_fidelity();
                variant = low_fidelity.map_err(|e| FileError::whole(JOB, e.to_string()))?;
            }
            Ok((variant.hash(), variant))
        };
        let made: Vec<Result<(String, ModelVariant), FileError>> = unknown.par_iter().map(one).collect();
        // The first error in the order of the models is returned, whatever the order of the threads.
        let mut made: Vec<(String, ModelVariant)> = made.into_iter().collect::<Result<_, _>>()?;
        for (_, variant) in &mut made {
            self.share_conditions(variant);
        }
        let keys = made
            .iter()
            .map(|(hash, _)| hash.clone())
            .zip(unknown.iter().cloned());
        self.keys.extend(keys);
        self.variants.extend(unknown.into_iter().zip(made));
        Ok(())
    }

    /// Lets a variant share the conditions of an earlier one: a search makes hundreds of variants, and few lists of conditions.
    fn share_conditions(&mut self, variant: &mut ModelVariant) {
        let mut shared = self.conditions.iter();
        match shared.find(|shared| **shared == variant.conditions) {
            Some(shared) => variant.conditions = Arc::clone(shared),
            None => self.conditions.push(Arc::clone(&variant.conditions)),
        }
    }

    /// Returns the variant of a query, with its hash.
    ///
    /// # Errors
    /// [`FileError`] where the effects are incompatible.
    pub fn variant(&mut self, query: &Query) -> Result<&(String, ModelVariant), FileError> {
        self.make(std::iter::once(query))?;
        Ok(&self.variants[&VariantKey::new(query)])
    }

    /// Returns the variant of a query that was made before, with its hash.
    pub fn made(&self, query: &Query) -> Option<&(String, ModelVariant)> {
        self.variants.get(&VariantKey::new(query))
    }

    /// Returns the variant of a hash that was made before.
    pub fn of_hash(&self, hash: &str) -> Option<&ModelVariant> {
        let key = self.keys.get(hash)?;
        self.variants.get(key).map(|(_, variant)| variant)
    }

    /// Returns the same model on the proposed runs.
    fn of_proposed_runs(&self, mut variant: ModelVariant) -> ModelVariant {
        // Soil density and position in the series are set only if an effect of this variant needs them. Proposed runs follow the
        // end of the series.
        let density_kg_m3 = variant.conditions.first().and_then(|c| c.density_kg_m3);
        let drifts = variant.conditions.iter().any(|c| c.order.is_some());
        let condition = |condition: &RunCondition| RunCondition {
            density_kg_m3,
            order: drifts.then_some(LAST_IN_SERIES),
            ..condition.clone()
        };
        variant.conditions = self.design.iter().map(condition).collect();
        variant.stiffness_sensitivity = false;
        variant.transients.clear();
        variant.plates.clear();
        variant.rings.clear();
        variant
    }

    fn of_fitted_runs(&self, model: &QueriedModel) -> Result<ModelVariant, FileError> {
        let effects = effects_of(model);
        let entries: Vec<&CandidateEntry> = effects.iter().filter_map(|&k| self.entry(k)).collect();
        let extensions: Vec<&Extension> = entries.iter().map(|e| &e.effect.extension).collect();
        let is_assumed = entries.iter().any(|e| e.not_tried.is_some());
        let experiment = match is_assumed {
            true => &self.assumed,
            false => &self.base.experiment,
        };
        let job = match model {
            QueriedModel::With(_) => with_extensions(&self.job, &extensions, &self.law_files),
            QueriedModel::Without(k, _) => self.reductions[*k].with(&extensions, &self.law_files),
        };
        Ok(spec(&job?, experiment)?.fit_variant)
    }

    /// Returns the parameters of a query in the order of its variant.
    pub fn model_theta(&self, query: &Query, variant: &ModelVariant) -> Vec<f64> {
        let mut names: Vec<&str> = match &query.model {
            QueriedModel::With(_) => self.base.parameters.iter().map(|p| p.name.as_str()).collect(),
            QueriedModel::Without(k, _) => self.reductions[*k].names().collect(),
        };
        let entries = effects_of(&query.model).iter().filter_map(|&k| self.entry(k));
        names.extend(entries.flat_map(|entry| entry.names.iter().map(String::as_str)));
        let value = |name: &String| {
            let place = names.iter().position(|candidate| candidate == name);
            place.map_or(f64::NAN, |i| query.theta[i])
        };
        variant.parameters.iter().map(value).collect()
    }

    /// Returns the values that answer a query.
    pub fn values(&self, query: &Query, observables: &Observables) -> Vec<f64> {
        if !query.is_proposed {
            return self.base.predicted_values(observables);
        }
        let channel = |run: usize| {
            let channels = self.channels.iter();
            channels.map(move |(channel, _)| observables.channel(*channel)[run])
        };
        (0..self.design.len()).flat_map(channel).collect()
    }
}

/// Lists the candidates: effects of the library, parameters and settings of the model itself, and effects that are weighed with
/// typical values. Another kind of model that the job requests and cannot have is added to `not_tried`.
fn library_entries(
    job: &Job,
    base: &Spec,
    effects: Vec<LibraryEffect>,
    untried: Vec<UntriedEffect>,
    not_tried: &mut Vec<NotTried>,
) -> Vec<CandidateEntry> {
    let effects = effects.into_iter();
    let mut entries: Vec<CandidateEntry> = effects
        .filter_map(|(effect, parameters)| CandidateEntry::of_library(effect, parameters, base))
        .collect();
    let plain = PLAIN_PARAMETERS.iter();
    entries.extend(plain.filter_map(|plain| CandidateEntry::plain(plain, base)));
    for switch in &MODEL_SWITCHES {
        match CandidateEntry::switch(switch, base, job) {
            Ok(entry) => entries.extend(entry),
            // The job does not request settings, so one that the model cannot have is left out without a record.
            Err(why) => not_tried.extend(switch.is_kind().then_some(why)),
        }
    }
    for untried in untried {
        let needing = Some(untried.record());
        let entry = CandidateEntry::of_library(untried.effect, untried.parameters, base);
        entries.extend(entry.map(|entry| CandidateEntry {
            not_tried: needing,
            ..entry
        }));
    }
    entries
}

/// Parses the files of laws, or of their formulas.
fn law_files<'e>(entries: impl Iterator<Item = &'e CandidateEntry>) -> NamedFiles {
    let mut files = NamedFiles::default();
    for entry in entries {
        if let Extension::File { name, text } = &entry.effect.extension {
            files.insert(name, NamedFile::new(text.clone()));
        }
    }
    files
}

/// Excludes combinations of an effect whose shear displacement is kept on the nodes with other effects of the displacement, which
/// it would move to the nodes, too.
fn exclude_on_nodes(entries: &mut [CandidateEntry]) {
    let uses_displacement = |entry: &&CandidateEntry| {
        let effect = entry.effect.effect();
        effect.is_some_and(|effect| effect.uses().contains(Variable::J))
    };
    let names = entries
        .iter()
        .filter(uses_displacement)
        .map(|entry| entry.effect.name.clone());
    let names: Vec<String> = names.collect();
    for entry in entries {
        if EffectOnNodes::find(&entry.effect.name).is_some() {
            let excluded = names.iter().filter(|name| **name != entry.effect.name);
            entry.candidate.excludes = excluded.cloned().collect();
        }
    }
}

/// Lists the effects that change nothing at the conditions of any fitted run.
fn absent<'a>(
    job: &'a Job,
    excluded: &'a [(String, ExclusionReason)],
) -> impl Iterator<Item = NotTried> + 'a {
    let everywhere = excluded.iter().filter(|(name, reason)| {
        let is_on_one_wheel = name.contains('.');
        matches!(reason, ExclusionReason::AbsentEverywhere) && !is_on_one_wheel
    });
    everywhere.filter_map(|(name, reason)| {
        let effect = find(name).cloned();
        let effect = effect.or_else(|| effects_in_files(job).find(|effect| effect.name == *name))?;
        Some(NotTried {
            name: name.clone(),
            why: reason.to_string(),
            needs: format!("{}{}", NotTried::RUNS, where_it_acts(&effect)),
        })
    })
}

/// Describes the simplest conditions in which an effect changes something.
fn where_it_acts(effect: &Effect) -> String {
    const SLIP: f64 = 0.3;
    const ANGLE_RAD: f64 = 0.26;
    let acts = |slip: f64, angle: f64| !effect.is_absent_at(&variables(slip, angle));
    let straight = [("in drive", SLIP), ("in skid", -SLIP)];
    let mut conditions: Vec<String> = straight
        .into_iter()
        .filter(|(_, slip)| acts(*slip, 0.0))
        .map(|(words, _)| words.to_owned())
        .collect();
    // A slip angle matters if straight runs of the same slip do not show the effect.
    let at_angle: Vec<&str> = straight
        .into_iter()
        .filter(|(_, slip)| acts(*slip, ANGLE_RAD) && !acts(*slip, 0.0))
        .map(|(words, _)| words)
        .collect();
    match at_angle.as_slice() {
        [] => {}
        [one] if conditions.is_empty() => conditions.push(format!("at a slip angle {one}")),
        _ => conditions.push("at a slip angle".to_owned()),
    }
    conditions.join(" or ")
}

/// Lists the effects of the catalogue that cannot act on an external model.
fn out_of_reach(model: &ExternalModel) -> impl Iterator<Item = NotTried> {
    let record = |effect: &Effect| {
        Some(NotTried {
            name: effect.name.clone(),
            why: model.why_not(effect)?,
            needs: NotTried::OUR_MODEL.to_owned(),
        })
    };
    catalogue().iter().filter_map(record)
}

/// Returns the candidates that a model has.
fn effects_of(model: &QueriedModel) -> &[usize] {
    match model {
        QueriedModel::With(effects) | QueriedModel::Without(_, effects) => effects,
    }
}

/// Returns the model with its effects in the order of the candidates.
fn sorted(model: &QueriedModel) -> QueriedModel {
    let mut sorted = model.clone();
    match &mut sorted {
        QueriedModel::With(effects) | QueriedModel::Without(_, effects) => effects.sort_unstable(),
    }
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::read;

    #[test]
    fn the_low_fidelity_model_of_every_candidate_is_a_quasi_static_variant() {
        let (mut job, files, _) = read("examples/cmu-sand");
        let smooth = SearchModels::new(&job, &files, 2).unwrap().task();
        assert!(!smooth.settings.has_low_fidelity);
        job.toml = job.toml.replacen("kind = \"quasi_static\"", "kind = \"scm\"", 1);
        let mut models = SearchModels::new(&job, &files, 2).unwrap();
        let task = models.task();
        assert!(task.settings.has_low_fidelity);
        let candidates = task.candidates();
        for name in [
            "displacement_node",
            "pressure_direction_vertical",
            "flow_fraction",
            "janosi_hanamoto_node",
        ] {
            let named = candidates.iter().filter(|candidate| candidate.name == name);
            assert!(
                named.clone().all(|candidate| !candidate.has_low_fidelity),
                "{name}"
            );
        }
        for (k, candidate) in candidates
            .iter()
            .enumerate()
            .filter(|(_, candidate)| candidate.has_low_fidelity)
        {
            for is_proposed in [false, true] {
                let query = Query {
                    model: QueriedModel::With(vec![k]),
                    is_proposed,
                    is_low_fidelity: true,
                    theta: Vec::new(),
                };
                let variant = models.variant(&query).map(|(_, variant)| variant.kind);
                assert_eq!(variant.unwrap(), ModelKind::QuasiStatic, "{}", candidate.name);
            }
        }
    }

    #[test]
    fn a_search_asks_for_no_more_effects_than_a_job_may_have() {
        let (job, files, _) = read("examples/cmu-sand");
        let task = |count: usize| {
            let effects = [
                "slip_sinkage",
                "skid_sinkage",
                "hard_pan",
                "janosi_hanamoto",
                "adhesion",
                "stick_slip",
                "load_scale",
                "reece_pressure",
                "edge_loss",
                "moisture",
            ];
            let line = format!("kind = \"quasi_static\"\neffects = {:?}\n", &effects[..count]);
            let mut job = job.clone();
            job.toml = job.toml.replacen("kind = \"quasi_static\"\n", &line, 1);
            SearchModels::new(&job, &files, 3).unwrap().task()
        };
        let room = |count: usize| {
            let task = task(count);
            (task.max_effects, task.laws.is_empty())
        };
        assert_eq!(room(0), (3, false));
        assert_eq!(room(7), (2, false), "a law beyond two effects is the tenth");
        assert_eq!(room(9), (0, true));
        assert_eq!(room(10), (0, true));
    }
}
