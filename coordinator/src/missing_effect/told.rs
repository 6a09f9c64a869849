//! What a search found, in names, numbers and sentences.

use std::collections::BTreeMap;

use discovery::Method;
use discovery::inquiry::{self, Answer, Judgement};

use super::candidate::Explanation;
use super::models::{Entry, Law, Models};
use super::{curve, rig_test};
use record::{
    ChiSquare, Discovery, Extension, JudgedEffect, NONE, NOT_IN_LIBRARY, NextRun, Outside, Verdict,
};

/// An effect of the model that gains it less is dropped \[nats\].
const EARNS: f64 = 3.0;
/// Members of a class with less probability are too weak to be what is missing.
const LEAST_NAMED: f64 = 0.005;
/// Most names in a sentence.
const NAMES: usize = 6;

/// The record of an answer.
pub(super) fn told(models: &Models, answer: &Answer) -> Discovery {
    let name = |k: usize| {
        let entry = models.entry(k);
        entry.map_or(String::new(), |entry| entry.explanation.name.clone())
    };
    let effects = effects(models, answer);
    let outside = answer.outside.as_ref().and_then(|law| outside(models, law));
    let verdict = match answer.verdict {
        inquiry::Verdict::NothingDetectable => Verdict::NothingDetectable,
        inquiry::Verdict::Named(_) => Verdict::Named,
        inquiry::Verdict::Class(_) => Verdict::Class,
        inquiry::Verdict::Outside => Verdict::NotInLibrary,
        inquiry::Verdict::Undecided => Verdict::Undecided,
    };
    let extension = match answer.verdict {
        inquiry::Verdict::Named(k) => models.entry(k).map(|entry| entry.explanation.extension.clone()),
        inquiry::Verdict::Outside => outside.as_ref().map(|(_, extension)| extension.clone()),
        _ => None,
    };
    let drop = models.reductions.iter().zip(&answer.gains);
    let drop = drop.filter(|(_, gain)| gain.is_some_and(|gain| gain < EARNS));
    let cannot_exclude: Vec<String> = answer.cannot_exclude.iter().map(|&k| name(k)).collect();
    let open: Vec<&str> = effects
        .iter()
        .filter(|e| e.in_credible_set && e.name != NONE && e.name != NOT_IN_LIBRARY)
        .map(|e| e.name.as_str())
        .collect();
    let next_runs = answer.next_runs.iter().filter_map(|run| {
        let condition = models.design.get(run.run)?;
        let words = |set: &Vec<usize>| match set.as_slice() {
            [] => NONE.to_owned(),
            [k] if *k >= models.library.len() => NOT_IN_LIBRARY.to_owned(),
            set => set.iter().map(|&k| name(k)).collect::<Vec<String>>().join(" + "),
        };
        Some(NextRun {
            slip: condition.slip,
            wheel_load_n: condition.wheel_load_n,
            sled_speed_m_s: condition.sled_speed_m_s,
            separates: run.separates.iter().map(words).collect(),
            information_nats: run.information_nats,
        })
    });
    Discovery {
        given: models
            .base
            .fit_variant
            .effects
            .iter()
            .map(|e| e.name.clone())
            .collect(),
        verdict,
        text: sentence(
            models,
            answer,
            &effects,
            outside.as_ref().map(|(outside, _)| outside),
        ),
        extension,
        drop: drop.map(|((effect, _), _)| effect.clone()).collect(),
        other_tests: rig_test::deciding(&open, verdict),
        effects,
        outside: outside.map(|(outside, _)| outside),
        cannot_exclude,
        refused: answer.refused.iter().map(|&k| name(k)).collect(),
        next_runs: next_runs.collect(),
        chi2: chi_square(answer.chi_square, models),
        chi2_best: chi_square(answer.chi_square_best, models),
        evaluations_to_name: answer.evaluations_to_name as u64,
        evaluations: answer.evaluations as u64,
    }
}

fn chi_square(chi: Option<inquiry::ChiSquare>, models: &Models) -> ChiSquare {
    ChiSquare {
        value: chi.map(|chi| chi.value),
        degrees_of_freedom: chi.map_or(models.base.likelihood.data().len() as f64, |chi| {
            chi.degrees_of_freedom
        }),
        p: chi.map(|chi| chi.p()),
    }
}

/// Every explanation by falling probability.
fn effects(models: &Models, answer: &Answer) -> Vec<JudgedEffect> {
    let judged = |judgement: &Judgement| {
        let entry = judgement.candidate.and_then(|k| models.entry(k));
        let own = entry.map(|entry| {
            entry
                .names
                .iter()
                .cloned()
                .zip(judgement.parameters.iter().copied())
        });
        JudgedEffect {
            name: entry.map_or(NONE.to_owned(), |entry| entry.explanation.name.clone()),
            log_bayes_factor: judgement.log_bayes_factor,
            probability: judgement.probability,
            class: judgement.class as u32,
            in_credible_set: judgement.is_credible,
            strength_prior: entry.and_then(|entry| strength_prior(&entry.explanation)),
            parameters: own.into_iter().flatten().collect(),
            method: match judgement.method {
                Method::Screen => "screen",
                Method::RankOne => "rank_one",
                Method::Polished => "polished",
                Method::Confirmed => "confirmed",
                Method::Sampled => "sampled",
            }
            .to_owned(),
        }
    };
    let mut effects: Vec<JudgedEffect> = answer.judged.iter().map(judged).collect();
    let classes = effects.iter().map(|e| e.class).max().unwrap_or(0);
    if let Some((log_bayes_factor, probability)) = answer.not_in_library {
        effects.push(JudgedEffect {
            name: NOT_IN_LIBRARY.to_owned(),
            log_bayes_factor,
            probability,
            class: classes + 1,
            in_credible_set: probability > 0.05,
            strength_prior: None,
            parameters: BTreeMap::new(),
            method: "polished".to_owned(),
        });
    }
    let by_factor = |a: &JudgedEffect, b: &JudgedEffect| b.log_bayes_factor.total_cmp(&a.log_bayes_factor);
    effects.sort_by(|a, b| b.probability.total_cmp(&a.probability).then(by_factor(a, b)));
    effects
}

fn strength_prior(explanation: &Explanation) -> Option<String> {
    let effect = formula::catalogue::find(explanation.name.split('.').next()?)?;
    let strength = effect.parameters.iter().find(|p| p.neutral.is_some())?;
    Some(format!("{}.{} = {}", effect.name, strength.name, strength.prior))
}

/// The law with its curve, and its file as an extension.
fn outside(models: &Models, found: &inquiry::Outside) -> Option<(Outside, Extension)> {
    let law: &Law = models.laws.get(found.pair)?;
    let entry: &Entry = models.entry(found.candidate)?;
    let form = law
        .forms
        .iter()
        .find(|(_, own)| own.explanation.name == entry.explanation.name);
    let Extension::File { text, .. } = &entry.explanation.extension else {
        return None;
    };
    let best: BTreeMap<String, f64> = entry
        .names
        .iter()
        .cloned()
        .zip(found.parameters.iter().copied())
        .collect();
    let effect_file = curve::written(text, &best);
    let outside = Outside {
        acts_on: law.pair.acts_on.name().to_owned(),
        depends_on: law.pair.depends_on.name().to_owned(),
        form: form.map_or("spline", |(form, _)| form.name()).to_owned(),
        log_bayes_factor: found.log_bayes_factor,
        curve: curve::curve(text, &best, &law.pair).unwrap_or_default(),
        effect_file: effect_file.clone(),
        left_out_nats: found.left_out_nats,
    };
    let extension = Extension::File {
        name: format!("{}.toml", entry.explanation.name),
        text: effect_file,
    };
    Some((outside, extension))
}

/// What can be said, for a test engineer.
fn sentence(models: &Models, answer: &Answer, effects: &[JudgedEffect], outside: Option<&Outside>) -> String {
    let kind = models.base.model_words();
    let library = || {
        effects
            .iter()
            .filter(|e| e.name != NONE && e.name != NOT_IN_LIBRARY)
    };
    let best = library().reduce(|a, b| {
        if b.log_bayes_factor > a.log_bayes_factor {
            b
        } else {
            a
        }
    });
    match (answer.verdict, outside) {
        (inquiry::Verdict::NothingDetectable, _) => {
            let near = best.filter(|best| best.log_bayes_factor > 0.05);
            let nearest = near.map_or(String::new(), |best| {
                format!("; {} comes nearest with {:.1}", best.name, best.log_bayes_factor)
            });
            let is_beaten = best.is_some_and(|best| best.log_bayes_factor > 3.0);
            let reason = match effects.iter().find(|e| e.name == NONE).filter(|_| is_beaten) {
                Some(none) => format!(
                    "that {kind} misses nothing is the most probable explanation ({:.2})",
                    none.probability
                ),
                None => format!("no effect of the library beats {kind} by more than 3 nats"),
            };
            format!("nothing detectable with these data: {reason}{nearest}")
        }
        (inquiry::Verdict::Named(k), _) => {
            let name = models
                .entry(k)
                .map_or("", |entry| entry.explanation.name.as_str());
            let own = effects.iter().find(|e| e.name == name);
            let summary = formula::catalogue::find(name.split('.').next().unwrap_or_default());
            format!(
                "{name} is missing: {} (probability {:.3}, {:.1} nats over {kind})",
                summary.map_or("", |effect| effect.summary.as_str()),
                own.map_or(0.0, |e| e.probability),
                own.map_or(0.0, |e| e.log_bayes_factor),
            )
        }
        (inquiry::Verdict::Class(class), _) => {
            let own = || library().filter(|e| e.class as usize == class && e.probability > LEAST_NAMED);
            format!(
                "one of {} is missing (together with probability {:.3}); these data cannot tell them apart",
                list(own().map(|e| e.name.as_str())),
                own().map(|e| e.probability).sum::<f64>()
            )
        }
        (inquiry::Verdict::Outside, Some(law)) => format!(
            "not in the library: what is missing acts on {} and depends on {}, like a {} ({:.1} nats over {kind}; levels that were left out are predicted better by {:.1} nats)",
            law.acts_on.replace('_', " "),
            law.depends_on.replace('_', " "),
            law.form,
            law.log_bayes_factor,
            law.left_out_nats[0]
        ),
        _ => match answer.chi_square_best {
            Some(chi) if chi.p() < 0.001 => format!(
                "the library does not reach the measurements (chi-square {:.0} for {:.0} degrees of freedom with the best of it), and these data cannot say what acts",
                chi.value, chi.degrees_of_freedom
            ),
            _ => format!(
                "something is missing, and these data do not say what: the 95 % set holds {}",
                list(
                    effects
                        .iter()
                        .filter(|e| e.in_credible_set)
                        .map(|e| e.name.as_str())
                )
            ),
        },
    }
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    let shown = names[..names.len().min(NAMES)].join(", ");
    match names.len().checked_sub(NAMES) {
        Some(more) if more > 0 => format!("{shown} and {more} more"),
        _ => shown,
    }
}
