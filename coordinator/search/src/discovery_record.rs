//! The record of a search: its conclusion in names, as it is stored.

use std::collections::{BTreeMap, BTreeSet};

use discovery::{
    Conclusion, DETECTED, EvidenceMethod, FitChiSquare, NAMED, OutsideLaw, RankedEffect, Replacement,
    SearchVerdict, WeighedForm, WeighedSet,
};
use job::PlainParameter;
use record::{
    ChiSquare, Discovery, Extension, FittedForm, ImplausibleParameter, JudgedEffect, JudgedReplacement,
    JudgedSet, LawFormulas, LawPlace, NONE, NOT_IN_LIBRARY, NextRun, Outside, RunInformation, Verdict,
};
use shared::channel::Channel;

use super::bench_measurement;
use super::candidate::CandidateEffect;
use super::curves::curves;
use super::entry::{CandidateEntry, LawEntry};
use super::law::curve;
use super::law::file::free_name;
use super::law::formula::formula;
use super::models::SearchModels;
use super::narrative::{parameter_name, sentence};
use super::remaining_misfit::remaining_misfit;
use super::rig_errors::rig_errors;

/// A law outside the library with more probability is in the credible set.
const MIN_CREDIBLE: f64 = 0.05;

/// A strength farther out in its prior is no basis of predictions \[sds\].
const MAX_PRIOR_SDS: f64 = 5.0;

/// Makes the record of a conclusion.
pub(super) fn discovery_record(
    models: &SearchModels,
    conclusion: &Conclusion,
    evaluations: usize,
) -> Discovery {
    let names = |indices: &[usize]| -> Vec<String> { indices.iter().map(|&k| models.name(k)).collect() };
    let effects = effects(models, conclusion);
    let (outside, law) = match &conclusion.outside {
        Some(law) => outside(models, law).unzip(),
        None => (None, None),
    };
    let (verdict, extension) = match conclusion.verdict {
        SearchVerdict::NothingDetectable => (Verdict::NothingDetectable, None),
        SearchVerdict::Named(k) => match models.entry(k) {
            // The effect cannot be added before the experiment states the property that it needs.
            Some(entry) if entry.not_tried.is_some() => (Verdict::Undecided, None),
            entry => (Verdict::Named, entry.map(|entry| entry.effect.extension.clone())),
        },
        SearchVerdict::Class(_) => (Verdict::Class, None),
        SearchVerdict::NotInLibrary => (Verdict::NotInLibrary, law),
        SearchVerdict::Undecided => {
            let entry = conclusion
                .agreed
                .and_then(|k| models.entry(k))
                .filter(|entry| entry.not_tried.is_none());
            (
                Verdict::Undecided,
                entry.map(|entry| entry.effect.extension.clone()),
            )
        }
    };
    let open: Vec<&str> = effects
        .iter()
        .filter(|e| e.in_credible_set && e.name != NONE && e.name != NOT_IN_LIBRARY)
        .map(|e| e.name.as_str())
        .collect();
    let separated = conclusion.next_runs.iter().flat_map(|run| &run.separates);
    let laws: BTreeSet<&Vec<usize>> = separated
        .filter(|effects| matches!(effects.as_slice(), [k] if *k >= models.library.len()))
        .collect();
    // Several laws differ in their places.
    let laws = laws.len();
    let next_runs = conclusion.next_runs.iter().filter_map(|run| {
        let condition = models.design.get(run.run)?;
        let words = |effects: &Vec<usize>| match effects.as_slice() {
            [] => NONE.to_owned(),
            [k] if *k >= models.library.len() => match models.place(*k).filter(|_| laws > 1) {
                Some(place) => place,
                None => NOT_IN_LIBRARY.to_owned(),
            },
            effects => names(effects).join(" + "),
        };
        Some(NextRun {
            slip: condition.slip,
            wheel_load_n: condition.wheel_load_n,
            sled_speed_m_s: condition.sled_speed_m_s,
            separates: run.separates.iter().map(words).collect(),
            information_nats: run.information_nats,
            settles: Some(run.settles),
        })
    });
    let information = conclusion.information.iter().filter_map(|&(run, nats)| {
        let condition = models.design.get(run)?;
        Some(RunInformation {
            slip: condition.slip,
            wheel_load_n: condition.wheel_load_n,
            sled_speed_m_s: condition.sled_speed_m_s,
            nats,
        })
    });
    let given = models.base.fit_variant.effects.iter();
    let mut record = Discovery {
        given: given.map(|effect| effect.name.clone()).collect(),
        verdict,
        text: String::new(),
        implausible: conclusion
            .implausible
            .or(conclusion.held_back)
            .and_then(|(k, prior_sds)| {
                let name = parameter_name(models, conclusion, k)?;
                Some(ImplausibleParameter { name, prior_sds })
            }),
        unsupported_noise: unsupported_noise(models, conclusion),
        leading: leading(models, conclusion).filter(|_| extension.is_none()),
        extension,
        // Evidences are unreliable where a prior is contradicted.
        drop: conclusion
            .redundant()
            .filter(|_| conclusion.implausible.is_none())
            .map(|k| models.reductions[k].effect.clone())
            .collect(),
        replacements: replacements(models, conclusion),
        other_tests: bench_measurement::deciding(&open, verdict),
        effects,
        sets: sets(models, conclusion),
        misfit: conclusion.misfit,
        complete: conclusion.complete,
        explained: conclusion.explained,
        outside,
        cannot_exclude: names(&conclusion.ranking.cannot_exclude),
        refused: names(&conclusion.ranking.refused),
        not_tried: models.not_tried().cloned().collect(),
        next_runs: next_runs.collect(),
        information: information.collect(),
        curves: curves(models, conclusion),
        remaining: remaining_misfit(models, &conclusion.remaining),
        rig: rig_errors(&models.base, &conclusion.shared_errors),
        numerical_noise: numerical_noise(&conclusion.numerical_noise_sds),
        chi2: chi_square(conclusion.chi_square, models),
        chi2_best: chi_square(conclusion.chi_square_best, models),
        // This counts queries, of which some may have asked for the same evaluation.
        evaluations_to_name: conclusion.ranking.evaluations.to_name().min(evaluations) as u64,
        evaluations: evaluations as u64,
    };
    record.text = sentence(models, conclusion, &record);
    record
}

/// Returns the most probable effect of an open verdict, for the sake of predictions: it is in the 95 % set, is more probable than that
/// nothing is missing, and is in a set that is a detection. Neither its strength nor a parameter of the searched model contradicts its
/// prior.
fn leading(models: &SearchModels, conclusion: &Conclusion) -> Option<Extension> {
    let is_open = matches!(
        conclusion.verdict,
        SearchVerdict::Undecided | SearchVerdict::Class(_)
    );
    if !is_open || conclusion.held_back.is_some() || !conclusion.unsupported_noise.is_empty() {
        return None;
    }
    let in_base = |(parameter, _): &(usize, f64)| *parameter < models.base.parameters.len();
    if conclusion.implausible.as_ref().is_some_and(in_base) {
        return None;
    }
    let all = conclusion.ranking.effects.iter();
    let first = all.reduce(|best, e| if e.probability > best.probability { e } else { best })?;
    let candidate = first.candidate?;
    let is_detected = |set: &WeighedSet| {
        let has = set
            .effects
            .as_ref()
            .is_some_and(|effects| effects.contains(&candidate));
        has && set.log_bayes_factor / conclusion.misfit > DETECTED
    };
    let is_plausible = first.is_credible && first.prior_sds.abs() <= MAX_PRIOR_SDS;
    let entry = models.entry(candidate).filter(|entry| entry.not_tried.is_none());
    let entry = entry.filter(|_| is_plausible && conclusion.sets.iter().any(is_detected))?;
    Some(entry.effect.extension.clone())
}

/// Lists the effects in the place of effects of the base.
fn replacements(models: &SearchModels, conclusion: &Conclusion) -> Vec<JudgedReplacement> {
    let judged = |replacement: &Replacement| JudgedReplacement {
        effect: models.name(replacement.candidate),
        in_place_of: models.reductions[replacement.reduction].effect.clone(),
        log_bayes_factor: replacement.log_bayes_factor,
        probability: replacement.probability,
        is_named: replacement.is_claimed,
    };
    conclusion.replacements.iter().map(judged).collect()
}

/// Names the inferred noise sds that do not support a claim.
fn unsupported_noise(models: &SearchModels, conclusion: &Conclusion) -> Vec<String> {
    let sds = conclusion.unsupported_noise.iter();
    sds.filter_map(|&k| Some(models.base.parameters.get(k)?.name.clone()))
        .collect()
}

/// Whether an explanation that is probable enough to be named would be under other priors, too.
fn robust(probability: f64, mut under_other_priors: impl Iterator<Item = f64>) -> Option<bool> {
    (probability > NAMED).then(|| under_other_priors.all(|p| p > NAMED))
}

/// The channels that scatter, by their columns.
fn numerical_noise(sds: &[f64]) -> BTreeMap<String, f64> {
    let by_column = Channel::ALL
        .iter()
        .filter_map(|channel| Some((channel.column().to_owned(), *sds.get(channel.index())?)));
    by_column.filter(|(_, sd)| *sd > 0.0).collect()
}

fn chi_square(chi: Option<FitChiSquare>, models: &SearchModels) -> ChiSquare {
    let data = models.base.likelihood.data().len() as f64;
    ChiSquare {
        value: chi.map(|chi| chi.value),
        degrees_of_freedom: chi.map_or(data, |chi| chi.degrees_of_freedom),
        p: chi.map(|chi| chi.p()),
    }
}

/// Returns the most probable values by the names of the parameters.
fn parameters(entry: &CandidateEntry, values: &[f64]) -> BTreeMap<String, f64> {
    entry.names.iter().cloned().zip(values.iter().copied()).collect()
}

/// Returns the units by the names of the parameters.
fn units(entry: &CandidateEntry) -> BTreeMap<String, String> {
    entry
        .names
        .iter()
        .cloned()
        .zip(entry.units.iter().cloned())
        .collect()
}

/// Lists every explanation by falling probability.
fn effects(models: &SearchModels, conclusion: &Conclusion) -> Vec<JudgedEffect> {
    let base = models.base.parameters.len();
    let judged = |effect: &RankedEffect| {
        let entry = effect.candidate.and_then(|k| models.entry(k));
        JudgedEffect {
            name: entry.map_or(NONE.to_owned(), |entry| entry.effect.name.clone()),
            summary: entry.and_then(|entry| file_summary(&entry.effect)),
            log_bayes_factor: effect.stated_log_bayes_factor,
            prior_sds: entry
                .filter(|entry| !entry.candidate.strengths.is_empty())
                .map(|_| effect.prior_sds),
            probability: effect.probability,
            robust: robust(
                effect.probability,
                conclusion.under_other_priors(effect.candidate),
            ),
            class: effect.class as u32,
            in_credible_set: effect.is_credible,
            strength_prior: entry.and_then(|entry| strength_prior(&entry.effect, models)),
            parameters: entry.map_or(BTreeMap::new(), |entry| parameters(entry, &effect.theta[base..])),
            units: entry.map(units).unwrap_or_default(),
            method: method(effect.method).to_owned(),
        }
    };
    let ranked = &conclusion.ranking.effects;
    let mut effects: Vec<JudgedEffect> = ranked.iter().map(judged).collect();
    let classes = effects.iter().map(|e| e.class).max().unwrap_or(0);
    if let Some((log_bayes_factor, probability)) = conclusion.not_in_library {
        effects.push(JudgedEffect {
            name: NOT_IN_LIBRARY.to_owned(),
            summary: None,
            log_bayes_factor,
            prior_sds: None,
            probability,
            robust: robust(probability, conclusion.law_under_other_priors()),
            class: classes + 1,
            in_credible_set: probability > MIN_CREDIBLE,
            strength_prior: None,
            parameters: BTreeMap::new(),
            units: BTreeMap::new(),
            method: method(EvidenceMethod::Refined).to_owned(),
        });
    }
    let by_factor = |a: &JudgedEffect, b: &JudgedEffect| b.log_bayes_factor.total_cmp(&a.log_bayes_factor);
    effects.sort_by(|a, b| b.probability.total_cmp(&a.probability).then(by_factor(a, b)));
    effects
}

/// Lists every model that was compared.
fn sets(models: &SearchModels, conclusion: &Conclusion) -> Vec<JudgedSet> {
    let set = |set: &WeighedSet| JudgedSet {
        members: match set.effects.as_deref() {
            None => vec![NOT_IN_LIBRARY.to_owned()],
            Some([]) => vec![NONE.to_owned()],
            Some(effects) => effects.iter().map(|&k| models.name(k)).collect(),
        },
        log_bayes_factor: set.log_bayes_factor,
        prior: set.prior,
        probability: set.probability,
        predictive: set.predictive,
    };
    conclusion.sets.iter().map(set).collect()
}

fn method(method: EvidenceMethod) -> &'static str {
    match method {
        EvidenceMethod::Screen => "screen",
        EvidenceMethod::RankOne => "rank_one",
        EvidenceMethod::Refined => "polished",
        EvidenceMethod::Confirmed => "confirmed",
        EvidenceMethod::Sampled => "sampled",
    }
}

/// Returns what a candidate of a file does, in a line; `None` for the catalogue's and the model's.
fn file_summary(candidate: &CandidateEffect) -> Option<String> {
    let is_in_file = matches!(candidate.extension, Extension::File { .. });
    is_in_file.then(|| candidate.effect().map(|effect| effect.summary.clone()))?
}

/// Returns the prior of a candidate's strength: the one under `[discovery.priors]`, otherwise that of the catalogue.
fn strength_prior(candidate: &CandidateEffect, models: &SearchModels) -> Option<String> {
    let stated = &models.job.candidate_priors;
    if let Some(plain) = PlainParameter::find(&candidate.name) {
        let prior = stated
            .get(plain.name)
            .map_or(plain.prior.to_owned(), ToString::to_string);
        return Some(format!("{} = {prior}", plain.name));
    }
    let effect = candidate.effect()?;
    let strength = effect.parameters.iter().find(|p| p.neutral.is_some())?;
    let name = format!("{}.{}", effect.name, strength.name);
    let prior = stated.get(&name).unwrap_or(&strength.prior);
    Some(format!("{name} = {prior}"))
}

/// Returns a form of a law with its formula.
fn fitted_form(models: &SearchModels, law: &LawEntry, form: &WeighedForm) -> Option<FittedForm> {
    let entry = models.entry(form.candidate)?;
    let Extension::File { text, .. } = &entry.effect.extension else {
        return None;
    };
    let hook = law.dependence.acts_on.hook();
    Some(FittedForm {
        form: law.form_name(entry).to_owned(),
        formula: formula(text, hook, &parameters(entry, &form.parameters))?,
        log_bayes_factor: form.log_bayes_factor,
        probability: form.probability,
        class: form.class as u32,
    })
}

/// Returns the formulas of a law: those that were fitted through the model, otherwise those of its curve.
fn formulas(models: &SearchModels, outside: &OutsideLaw, law: &LawEntry) -> Option<LawFormulas> {
    match &models.equation {
        Some(equation) => equation.record(&outside.formulas),
        None => models.equation_of(law, outside.curve.as_ref()?)?.record(&[]),
    }
}

/// Returns the place of a law with its probability.
fn law_place(models: &SearchModels, (law, probability): (usize, f64)) -> Option<LawPlace> {
    let dependence = &models.laws.get(law)?.dependence;
    Some(LawPlace {
        acts_on: dependence.acts_on.name().to_owned(),
        depends_on: dependence.depends_on.name().to_owned(),
        probability,
    })
}

/// Returns the law with its curve, and its file as an extension.
fn outside(models: &SearchModels, outside: &OutsideLaw) -> Option<(Outside, Extension)> {
    let law = models.laws.get(outside.law)?;
    let entry = models.entry(outside.candidate)?;
    let Extension::File { text, .. } = &entry.effect.extension else {
        return None;
    };
    let best = parameters(entry, &outside.forms.first()?.parameters);
    let effect_file = curve::with_values(text, &best);
    let record = Outside {
        acts_on: law.dependence.acts_on.name().to_owned(),
        depends_on: law.dependence.depends_on.name().to_owned(),
        places: outside
            .places
            .iter()
            .filter_map(|place| law_place(models, *place))
            .collect(),
        form: law.form_name(entry).to_owned(),
        log_bayes_factor: outside.log_bayes_factor,
        curve: curve::curve(text, &best, &law.dependence).unwrap_or_default(),
        effect_file: effect_file.clone(),
        left_out_nats: outside.left_out_nats,
        formulas: formulas(models, outside, law),
        forms: outside
            .forms
            .iter()
            .filter_map(|form| fitted_form(models, law, form))
            .collect(),
    };
    let extension = Extension::File {
        name: free_name(&entry.effect.name, &models.job.files),
        text: effect_file,
    };
    Some((record, extension))
}
