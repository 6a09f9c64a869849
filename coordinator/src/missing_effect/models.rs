//! Every model that a search asks: the base, with candidates, without one of its effects, on runs not made yet.

use std::collections::BTreeMap;

use discovery::inquiry::{Asked, Model, Pair, Proposed, Reduction, Task};
use discovery::{Candidate, Settings, Starts};
use formula::Effect;
use shared::channel::Channel;
use shared::file::{FileError, FileSet};
use shared::model::{ModelKind, ModelVariant, RunCondition};
use shared::outcome::Observables;

use super::candidate::{Explanation, extended, library};
use super::form::Form;
use super::{design, scan};
use job::{FreeParameter, Spec, free_parameters, without_effects};
use record::Extension;

const JOB: &str = "job.toml";
const EXPERIMENT: &str = "experiment.toml";
/// The three-dimensional model is rough on its grid: over shorter differences than this share of a prior's sd it shows no slope.
const ROUGH: f64 = 0.15;
/// Starts of the base's fit.
const STARTS: usize = 32;

/// A candidate with what a job adds for it.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    pub(super) explanation: Explanation,
    pub(super) candidate: Candidate,
    /// Full names of its free parameters, in the candidate's order.
    pub(super) names: Vec<String>,
}

/// A quantity and a variable with what tells the dependence.
#[derive(Debug, Clone)]
pub(super) struct Law {
    pub(super) pair: scan::Pair,
    pub(super) curve: Entry,
    pub(super) forms: Vec<(Form, Entry)>,
}

/// The models of a search, made as they are asked for.
#[derive(Debug)]
pub struct Models {
    job: FileSet,
    experiment: FileSet,
    pub(super) base: Spec,
    pub(super) library: Vec<Entry>,
    pub(super) laws: Vec<Law>,
    /// Effects that the model cannot express in this experiment, with the reason.
    pub left_out: Vec<(String, String)>,
    /// The base's own effects, each with the names of the parameters that are left without it.
    pub(super) reductions: Vec<(String, Vec<String>)>,
    pub(super) design: Vec<RunCondition>,
    pub(super) channels: Vec<(Channel, f64)>,
    variants: BTreeMap<(Model, bool), (String, ModelVariant)>,
    max_effects: usize,
}

fn spec(job: &FileSet, experiment: &FileSet) -> Result<Spec, FileError> {
    Spec::new(JOB, job, EXPERIMENT, experiment)
}

impl Models {
    /// # Arguments
    /// - `job`: of the model that is searched, with its effects. `max_effects`: most that are looked for together.
    ///
    /// # Errors
    /// [`FileError`] of job or experiment.
    pub fn new(job: &FileSet, experiment: &FileSet, max_effects: usize) -> Result<Self, FileError> {
        let base = spec(job, experiment)?;
        let fail = |message: String| FileError::whole(JOB, message);
        let (explanations, mut left_out) = library(job, experiment);
        let known = |name: &str| base.parameters.iter().any(|p| p.name == name);
        let mut entries = Vec::new();
        for explanation in explanations {
            let with = spec(&extended(JOB, job, &[&explanation.extension])?, experiment)?;
            let free: Vec<FreeParameter> = with.parameters.into_iter().filter(|p| !known(&p.name)).collect();
            let effect = explanation.name.split('.').next().unwrap_or_default();
            let effect = formula::catalogue::find(effect);
            match effect.and_then(|effect| candidate(&explanation.name, effect, &free, false)) {
                Some(candidate) => entries.push(Entry {
                    candidate,
                    names: free.into_iter().map(|p| p.name).collect(),
                    explanation,
                }),
                None => left_out.push((explanation.name, "no strength is free".to_owned())),
            }
        }
        let of_file = |explanation: Explanation| -> Result<Entry, FileError> {
            let Extension::File { text, .. } = &explanation.extension else {
                return Err(fail(format!("{} is no effect file", explanation.name)));
            };
            let effect = Effect::read(text).map_err(|e| fail(format!("{}: {e}", explanation.name)))?;
            let free = free_parameters(&effect).map_err(fail)?;
            let candidate = candidate(&explanation.name, &effect, &free, true)
                .ok_or_else(|| fail(format!("{} has no strength", explanation.name)))?;
            Ok(Entry {
                candidate,
                names: free.into_iter().map(|p| p.name).collect(),
                explanation,
            })
        };
        let mut laws = Vec::new();
        for pair in scan::pairs(&base.experiment) {
            let forms = Form::ALL
                .iter()
                .map(|form| Ok((*form, of_file(form.of(&pair))?)))
                .collect::<Result<_, FileError>>()?;
            laws.push(Law {
                curve: of_file(pair.curve())?,
                forms,
                pair,
            });
        }
        let own: Vec<String> = base.fit_variant.effects.iter().map(|e| e.name.clone()).collect();
        let mut reductions = Vec::new();
        for effect in own {
            // An effect that the others, or the data, need in order to mean anything stays.
            if let Ok(without) = spec(
                &without_effects(JOB, job, std::slice::from_ref(&effect))?,
                experiment,
            ) {
                let names = without.parameters.into_iter().map(|p| p.name).collect();
                reductions.push((effect, names));
            }
        }
        let prior_means: Vec<f64> = base.parameters.iter().map(|p| p.marginal.quantile(0.5)).collect();
        Ok(Self {
            design: design::proposed(&base),
            channels: design::channels(&base, &prior_means),
            job: job.clone(),
            experiment: experiment.clone(),
            library: entries,
            laws,
            left_out,
            reductions,
            variants: BTreeMap::new(),
            max_effects,
            base,
        })
    }

    /// What the pure search is given.
    pub fn task(&self) -> Task {
        let base = &self.base;
        let place = |name: &String| base.parameters.iter().position(|p| p.name == *name);
        let reduction = |(_, names): &(String, Vec<String>)| Reduction {
            parameters: names.iter().filter_map(place).collect(),
        };
        let law = |law: &Law| Pair {
            curve: law.curve.candidate.clone(),
            forms: law.forms.iter().map(|(_, form)| form.candidate.clone()).collect(),
            is_description: law.pair.acts_on.channel().is_some(),
        };
        Task {
            prior: base.parameters.iter().map(|p| p.marginal.clone()).collect(),
            likelihood: base.likelihood.clone(),
            library: self.library.iter().map(|entry| entry.candidate.clone()).collect(),
            pairs: self.laws.iter().map(law).collect(),
            reductions: self.reductions.iter().map(reduction).collect(),
            levels: design::levels(base),
            proposed: Proposed {
                runs: self.design.len(),
                groups: self.slips(),
                noise_sds: self.channels.iter().map(|(_, sd)| *sd).collect(),
            },
            max_effects: self.max_effects,
            settings: Settings {
                starts: Starts::Even(STARTS),
                seed: base.method.seed(),
                least_difference: match base.model.kind {
                    ModelKind::QuasiStatic => Settings::default().least_difference,
                    ModelKind::Scm => ROUGH,
                },
            },
        }
    }

    /// The slip of each proposed run, numbered: of runs that differ in load and speed alone one is proposed.
    fn slips(&self) -> Vec<usize> {
        let same = |slip: f64| self.design.iter().position(|c| (c.slip - slip).abs() < 1e-9);
        self.design.iter().filter_map(|c| same(c.slip)).collect()
    }

    /// The candidate of a position: the library, then for each law its curve and its forms.
    pub(super) fn entry(&self, position: usize) -> Option<&Entry> {
        let of_laws = self.laws.iter().flat_map(|law| {
            let forms = law.forms.iter().map(|(_, entry)| entry);
            std::iter::once(&law.curve).chain(forms)
        });
        self.library.iter().chain(of_laws).nth(position)
    }

    /// The variant that a question is asked of, with its hash.
    ///
    /// # Errors
    /// [`FileError`] where the effects do not go together.
    pub fn variant(&mut self, asked: &Asked) -> Result<&(String, ModelVariant), FileError> {
        let key = (canonical(&asked.model), asked.is_proposed);
        if !self.variants.contains_key(&key) {
            let mut variant = self.made(&key.0)?;
            if asked.is_proposed {
                // The soil's density is there only if an effect of this variant asks for it.
                let density_kg_m3 = variant.conditions.first().and_then(|c| c.density_kg_m3);
                variant.conditions.clone_from(&self.design);
                for condition in &mut variant.conditions {
                    condition.density_kg_m3 = density_kg_m3;
                }
                variant.stiffness_sensitivity = false;
                variant.plates.clear();
                variant.rings.clear();
            }
            self.variants.insert(key.clone(), (variant.hash(), variant));
        }
        Ok(&self.variants[&key])
    }

    /// The variant of a hash that was asked for before.
    pub fn of_hash(&self, hash: &str) -> Option<&ModelVariant> {
        let mut made = self.variants.values();
        made.find(|(own, _)| own == hash).map(|(_, variant)| variant)
    }

    fn made(&self, model: &Model) -> Result<ModelVariant, FileError> {
        let job = match model {
            Model::With(effects) => {
                let entries = effects.iter().filter_map(|&k| self.entry(k));
                let extensions: Vec<&Extension> = entries.map(|e| &e.explanation.extension).collect();
                extended(JOB, &self.job, &extensions)?
            }
            Model::Without(k) => {
                without_effects(JOB, &self.job, std::slice::from_ref(&self.reductions[*k].0))?
            }
        };
        Ok(spec(&job, &self.experiment)?.fit_variant)
    }

    /// The parameters of a question in the order of its variant.
    pub fn model_theta(&self, asked: &Asked, variant: &ModelVariant) -> Vec<f64> {
        let names: Vec<&str> = match &asked.model {
            Model::With(effects) => {
                let base = self.base.parameters.iter().map(|p| p.name.as_str());
                let own = effects.iter().filter_map(|&k| self.entry(k));
                base.chain(own.flat_map(|entry| entry.names.iter().map(String::as_str)))
                    .collect()
            }
            Model::Without(k) => self.reductions[*k].1.iter().map(String::as_str).collect(),
        };
        let value = |name: &String| {
            let place = names.iter().position(|own| own == name);
            place.map_or(f64::NAN, |i| asked.theta[i])
        };
        variant.parameters.iter().map(value).collect()
    }

    /// The values that answer a question.
    pub fn values(&self, asked: &Asked, observables: &Observables) -> Vec<f64> {
        if !asked.is_proposed {
            return self.base.predicted_values(observables);
        }
        let channel = |run: usize| {
            let channels = self.channels.iter();
            channels.map(move |(channel, _)| observables.channel(*channel)[run])
        };
        (0..self.design.len()).flat_map(channel).collect()
    }
}

/// The same model whatever the order in which its effects were found.
fn canonical(model: &Model) -> Model {
    match model {
        Model::With(effects) => {
            let mut effects = effects.clone();
            effects.sort_unstable();
            Model::With(effects)
        }
        without @ Model::Without(_) => without.clone(),
    }
}

/// A candidate of the free parameters that an effect brings; `None` without a free strength. Every strength of a curve is one, of an
/// effect of the library the first is and the others shape it.
fn candidate(name: &str, effect: &Effect, free: &[FreeParameter], is_curve: bool) -> Option<Candidate> {
    let strengths = free.iter().enumerate().filter_map(|(k, parameter)| {
        let own = parameter.name.split('.').nth(1)?;
        let neutral = effect.parameters.iter().find(|p| p.name == own)?.neutral?;
        Some((k, neutral))
    });
    let mut strengths: Vec<(usize, f64)> = strengths.collect();
    if !is_curve {
        strengths.truncate(1);
    }
    let &(_, neutral) = strengths.first()?;
    Some(Candidate {
        name: name.to_owned(),
        parameters: free.iter().map(|p| p.marginal.clone()).collect(),
        strengths: strengths.into_iter().map(|(k, _)| k).collect(),
        neutral,
    })
}
