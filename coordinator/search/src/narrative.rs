//! The narrative of a search: its verdict in one sentence for a test engineer.

use discovery::{Conclusion, DETECTED, NAMED, Replacement, SearchVerdict, WeighedSet};
use formula::Hook;
use job::{EffectOnNodes, ModelSwitch, PlainParameter};
use record::{Discovery, JudgedEffect, JudgedRigError, NONE, NOT_IN_LIBRARY, Outside};
use shared::parameters::WHEEL_RADIUS;
use statistics::ErrorSd;

use super::candidate::candidate_of;
use super::models::SearchModels;

/// Members of a class with less probability are not listed.
const MIN_LISTED: f64 = 0.005;
/// An effect with a smaller log Bayes factor is not worth mentioning \[nats\].
const MIN_MENTIONED: f64 = 0.05;
/// Maximum number of names in a sentence.
const NAMES: usize = 6;

/// Writes the verdict, and what remains unexplained, as a sentence.
///
/// # Arguments
/// - `record`: of the conclusion, complete but for this sentence.
pub(super) fn sentence(models: &SearchModels, conclusion: &Conclusion, record: &Discovery) -> String {
    let effects = record.effects.as_slice();
    let mut text = if let Some(claim) = claimed_replacement(models, conclusion) {
        claim
    } else if let Some(reason) = implausible(models, conclusion) {
        format!("something is missing or the prior is wrong: {reason}")
    } else if let Some(reason) = held_back(models, conclusion, effects) {
        reason
    } else if let Some(reason) = unsupported_noise(models, conclusion) {
        format!("nothing is named: {reason}; {}", credible_set(effects))
    } else {
        verdict(models, conclusion, effects, record.outside.as_ref())
    };
    text += &better_replacement(models, conclusion);
    let is_claim = conclusion.verdict.is_claim();
    if let (true, Some(false), Some(chi)) = (is_claim, conclusion.complete, conclusion.chi_square_best) {
        let explained = conclusion.explained.map_or(String::new(), |share| {
            format!("{:.0} % of the excess chi-square is explained, ", 100.0 * share)
        });
        text += &format!(
            "; incomplete: {explained}chi-square {:.0} with {:.0} degrees of freedom remains",
            chi.value, chi.degrees_of_freedom
        );
    }
    let claimed = match conclusion.verdict {
        SearchVerdict::Named(k) => Some(models.name(k)),
        SearchVerdict::NotInLibrary => Some(NOT_IN_LIBRARY.to_owned()),
        _ => None,
    };
    let is_fragile =
        |effect: &JudgedEffect| effect.robust == Some(false) && claimed.as_ref() == Some(&effect.name);
    if effects.iter().any(is_fragile) {
        text += "; under other priors (strengths half or twice as wide, nothing missing with 0.2 or 0.8) its probability falls below 0.9";
    }
    if let Some(worst) = record.remaining.first() {
        text += &format!("; what remains is largest in {}", worst.words());
    }
    text += &rig(&record.rig);
    if let Some(k) = conclusion.agreed {
        text += &format!(
            "; the most probable set also predicts left-out levels best, and {} is its leading effect",
            models.name(k)
        );
    }
    text
}

/// Names the errors of the rig that act.
fn rig(errors: &[JudgedRigError]) -> String {
    let acting: Vec<String> = errors
        .iter()
        .filter(|error| error.probability > NAMED)
        .map(JudgedRigError::words)
        .collect();
    if acting.is_empty() {
        return String::new();
    }
    format!(
        "; runs share errors of the rig, which count as noise: {}",
        acting.join("; ")
    )
}

/// Writes the claim that an effect belongs in the place of one of the model: `elastic_rebound is missing in the place of bin_slope`.
fn claimed_replacement(models: &SearchModels, conclusion: &Conclusion) -> Option<String> {
    let replacement = conclusion.claimed_replacement()?;
    let name = models.name(replacement.candidate);
    Some(format!(
        "{name} is missing in the place of {}: {} ({}, {:.1} nats over {})",
        models.reductions[replacement.reduction].effect,
        summary(models, &name),
        probability(replacement.probability),
        replacement.log_bayes_factor,
        models.base.model_words(),
    ))
}

/// Names the best replacement that improves the model, is not claimed, and is not far less probable than one more effect is.
fn better_replacement(models: &SearchModels, conclusion: &Conclusion) -> String {
    let best = conclusion.replacements.first();
    let is_better = |best: &&Replacement| {
        !best.is_claimed && best.log_bayes_factor > DETECTED && best.probability > MIN_LISTED
    };
    best.filter(is_better).map_or(String::new(), |best| {
        format!(
            "; {} in the place of {} would be {:.1} nats better than the model as it is",
            models.name(best.candidate),
            models.reductions[best.reduction].effect,
            best.log_bayes_factor
        )
    })
}

/// Returns the sentence that states the assumption of a candidate; empty for a law outside the catalogue.
fn summary(models: &SearchModels, name: &str) -> String {
    let plain = PlainParameter::find(name).map(|plain| plain.summary.to_owned());
    let switch = || ModelSwitch::find(name).map(|switch| switch.summary.to_owned());
    let effect = || {
        let entry = models.library.iter().find(|entry| entry.effect.name == name)?;
        Some(entry.effect.effect()?.summary.clone())
    };
    plain.or_else(switch).or_else(effect).unwrap_or_default()
}

/// Names the parameter that contradicts its prior in the best explanation, with advice.
fn implausible(models: &SearchModels, conclusion: &Conclusion) -> Option<String> {
    let (k, sds) = conclusion.implausible?;
    let best = conclusion.best.effects.iter().map(|&k| models.name(k));
    let best: Vec<String> = best.collect();
    let side = if sds < 0.0 { "below" } else { "above" };
    let mut text = format!(
        "the best fit ({}) puts {} {:.1} sds of its prior {side} the middle, so ",
        list(best.iter().map(String::as_str)),
        parameter_name(models, conclusion, k)?,
        sds.abs()
    );
    text += if k < models.base.parameters.len() {
        "the probabilities tell little; widen that prior and search again"
    } else {
        "the effect is not named: something else may act that it imitates; if you expect such a strength, state a wider prior under [discovery.priors]"
    };
    Some(text)
}

/// Names the strength in the model of which the leading effect would be more, with advice.
fn held_back(models: &SearchModels, conclusion: &Conclusion, effects: &[JudgedEffect]) -> Option<String> {
    let (k, sds) = conclusion.held_back?;
    let parameter = parameter_name(models, conclusion, k)?;
    let effect = parameter.split('.').next()?;
    Some(format!(
        "what is left looks like more of {effect}; its strength is held back by its prior ({:.1} sds out); widen that prior and search again; {}",
        sds.abs(),
        credible_set(effects)
    ))
}

/// Returns what an error of a wheel's dimension comes to: `: it may be 131 mm, not 125 mm; measure it`. `None` for other effects, and
/// where several wheels share the error.
fn dimension(models: &SearchModels, name: &str, judged: &JudgedEffect) -> Option<String> {
    let (effect, _) = candidate_of(name)?;
    let [error] = effect.parameters.as_slice() else {
        return None;
    };
    // Another effect takes a length from the wheel.
    if error.unit != "1" {
        return None;
    }
    let mut wheels = models.base.experiment.wheels.iter();
    let (wheel, geometry) = match name.split_once('.') {
        Some((_, only)) => wheels.find(|(wheel, _)| *wheel == only)?,
        None if wheels.len() == 1 => wheels.next()?,
        None => return None,
    };
    let held = |parameter: &str| models.base.model.fixed.get(parameter).copied();
    let stated_m = match effect.hooks().next()? {
        Hook::Radius => held(&format!("{WHEEL_RADIUS}.{wheel}"))
            .or(held(WHEEL_RADIUS))
            .unwrap_or(geometry.radius_m),
        Hook::Width => geometry.width_m,
        _ => return None,
    };
    let error = judged.parameters.values().next()?;
    Some(format!(
        ": it may be {:.1} mm, not {:.1} mm; measure it",
        1e3 * stated_m * (1.0 + error),
        1e3 * stated_m
    ))
}

/// Returns the name of a parameter of the best explanation by its place.
pub(super) fn parameter_name(models: &SearchModels, conclusion: &Conclusion, place: usize) -> Option<String> {
    let base = models.base.parameters.iter().map(|p| p.name.clone());
    let effects = conclusion.best.effects.iter().filter_map(|&k| models.entry(k));
    base.chain(effects.flat_map(|entry| entry.names.clone()))
        .nth(place)
}

/// Names the inferred noise that does not support a claim, with advice.
fn unsupported_noise(models: &SearchModels, conclusion: &Conclusion) -> Option<String> {
    let data = models.base.likelihood.data();
    let in_words = |&parameter: &usize| {
        let inferred = ErrorSd::Inferred { parameter };
        let count = data.iter().filter(|datum| datum.sd == inferred).count();
        let name = &models.base.parameters.get(parameter)?.name;
        Some(format!("{name} from {count} measurements"))
    };
    let sds = conclusion.unsupported_noise.iter();
    let sds: Vec<String> = sds.filter_map(in_words).collect();
    (!sds.is_empty()).then(|| {
        format!(
            "the noise is inferred ({}), with too few measurements beside the fitted parameters and fewer than three repeats, so each effect that is added shrinks it; state its sds under [noise] or repeat at least three runs, and search again",
            list(sds.iter().map(String::as_str))
        )
    })
}

fn verdict(
    models: &SearchModels,
    conclusion: &Conclusion,
    effects: &[JudgedEffect],
    outside: Option<&Outside>,
) -> String {
    let kind = models.base.model_words();
    let library = || {
        effects
            .iter()
            .filter(|e| e.name != NONE && e.name != NOT_IN_LIBRARY)
    };
    match (conclusion.verdict, outside) {
        (SearchVerdict::NothingDetectable, _) => {
            let best = library().reduce(|a, b| {
                if b.log_bayes_factor > a.log_bayes_factor {
                    b
                } else {
                    a
                }
            });
            let near = best.filter(|best| best.log_bayes_factor > MIN_MENTIONED);
            let nearest = near.map_or(String::new(), |best| {
                format!("; {} comes closest with {:.1}", best.name, best.log_bayes_factor)
            });
            let is_beaten = best.is_some_and(|best| best.log_bayes_factor > DETECTED);
            let reason = match effects.iter().find(|e| e.name == NONE).filter(|_| is_beaten) {
                Some(none) => format!(
                    "the most probable explanation is that {kind} misses nothing ({:.2})",
                    none.probability
                ),
                None => format!("no effect of the library beats {kind} by more than {DETECTED:.0} nats"),
            };
            format!("nothing detectable with these data: {reason}{nearest}")
        }
        (SearchVerdict::Named(k), _) => {
            let name = models.name(k);
            let judged = effects.iter().find(|e| e.name == name);
            if let Some(untried) = models.entry(k).and_then(|entry| entry.not_tried.as_ref()) {
                return format!(
                    "{name} would explain the data best ({}, {:.1} nats over {kind}), but {}; state {} and search again",
                    probability(judged.map_or(0.0, |e| e.probability)),
                    judged.map_or(0.0, |e| e.log_bayes_factor),
                    untried.why,
                    untried.needs
                );
            }
            let claim = match (PlainParameter::find(&name), ModelSwitch::find(&name)) {
                (Some(_), _) => format!("{name} is missing: {}", summary(models, &name)),
                (None, Some(switch)) => format!("{} fits: {}", switch.line(), switch.summary),
                (None, None) => {
                    let summary = summary(models, &name);
                    let place =
                        EffectOnNodes::find(&name).map_or("", |_| ", counted where the soil is sheared");
                    let dimension = judged.and_then(|judged| dimension(models, &name, judged));
                    format!(
                        "{name} is missing: {summary}{place}{}",
                        dimension.unwrap_or_default()
                    )
                }
            };
            format!(
                "{claim} ({}{}, {:.1} nats over {kind}{})",
                probability(judged.map_or(0.0, |e| e.probability)),
                same_parameter(models, k, effects),
                judged.map_or(0.0, |e| e.log_bayes_factor),
                beside(&conclusion.sets, k, |k| models.name(k)),
            )
        }
        (SearchVerdict::Class(class), _) => {
            let members = || library().filter(|e| e.class as usize == class && e.probability > MIN_LISTED);
            let untried = models.not_tried();
            let untried = untried.filter(|untried| members().any(|e| e.name == untried.name));
            let needs = untried.map(|untried| format!("; {} needs {}", untried.name, untried.needs));
            let weighed_members: Vec<String> = members().map(weighed).collect();
            format!(
                "one of {} is missing (joint {}); these data cannot distinguish them{}",
                list(weighed_members.iter().map(String::as_str)),
                probability(members().map(|e| e.probability).sum()),
                needs.collect::<String>()
            )
        }
        (SearchVerdict::NotInLibrary, Some(law)) => format!(
            "not in the library: the missing law {}, in the form of {} {} ({:.1} nats over {kind}; left-out levels are predicted better by {:.1} nats){}{}",
            place(law),
            if law.form.starts_with('i') { "an" } else { "a" },
            law.form.replace('_', " "),
            law.log_bayes_factor,
            law.left_out_nats[0],
            law.forms_alike()
                .map_or(String::new(), |alike| format!("; the forms {alike} fit alike")),
            formulas(models, conclusion, law)
        ),
        _ => match conclusion.chi_square_best {
            Some(chi) if chi.is_wrong() => format!(
                "the best explanation of the library contradicts the data (chi-square {:.0} with {:.0} degrees of freedom), and these data do not decide what is missing: {}",
                chi.value,
                chi.degrees_of_freedom,
                credible_set(effects)
            ),
            _ => undecided(effects),
        },
    }
}

/// Writes where a law acts: `acts on shear and depends on z`, or all places that these data do not tell apart.
fn place(law: &Outside) -> String {
    let [acts_on, depends_on] = [&law.acts_on, &law.depends_on].map(|name| name.replace('_', " "));
    match law.places_alike() {
        None => format!("acts on {acts_on} and depends on {depends_on}"),
        Some(places) => {
            format!(
                "changes {places}, which these data do not tell apart; it is shown for {acts_on} by {depends_on}"
            )
        }
    }
}

/// Writes what formulas the law may follow: `; as a formula the curve is ...`; empty where they were not searched.
fn formulas(models: &SearchModels, conclusion: &Conclusion, law: &Outside) -> String {
    let claimed = conclusion.outside.as_ref();
    let entry = claimed.and_then(|claimed| models.laws.get(claimed.law));
    let words = entry.map(|entry| entry.dependence.depends_on.words());
    let sentence = words
        .zip(law.formulas.as_ref())
        .and_then(|(words, formulas)| formulas.words(words));
    sentence.map_or(String::new(), |sentence| format!("; {sentence}"))
}

/// Writes the sentence for data that do not decide between the explanations.
fn undecided(effects: &[JudgedEffect]) -> String {
    let mut credible = effects.iter().filter(|e| e.in_credible_set);
    let question = match credible.any(|e| e.name == NONE) {
        true => "these data do not decide whether something is missing",
        false => "something is missing, and these data do not decide what",
    };
    format!("{question}: {}", credible_set(effects))
}

/// Writes the credible set: `the 95 % set is moisture (0.50), adhesion (0.47)`.
fn credible_set(effects: &[JudgedEffect]) -> String {
    let credible = effects.iter().filter(|e| e.in_credible_set);
    let set: Vec<String> = credible.map(weighed).collect();
    format!("the 95 % set is {}", list(set.iter().map(String::as_str)))
}

/// Writes an effect with its probability: `slip_sinkage (0.68)`.
fn weighed(effect: &JudgedEffect) -> String {
    let name = match effect.name.as_str() {
        NONE => "nothing",
        NOT_IN_LIBRARY => "a law outside the library",
        name => name,
    };
    match effect.probability {
        p if p < 0.001 => format!("{name} (< 0.001)"),
        p => format!("{name} ({p:.2})"),
    }
}

/// Names the candidate that gives the same parameter another value, if it is probable: `; shear_velocity_scale (0.10) changes the
/// same parameter`.
fn same_parameter(models: &SearchModels, named: usize, effects: &[JudgedEffect]) -> String {
    let Some(named) = models.entry(named).map(|entry| &entry.candidate) else {
        return String::new();
    };
    let is_same = |e: &&JudgedEffect| {
        let entry = models.library.iter().find(|entry| entry.candidate.name == e.name);
        e.name != named.name && entry.is_some_and(|entry| entry.candidate.is_same_parameter(named))
    };
    let same = effects
        .iter()
        .filter(|e| e.probability > MIN_LISTED)
        .find(is_same);
    same.map_or(String::new(), |e| {
        format!("; {} changes the same parameter", weighed(e))
    })
}

/// Names the other effects of the most probable set with an effect.
///
/// # Arguments
/// - `sets`: by falling probability.
fn beside(sets: &[WeighedSet], effect: usize, name: impl Fn(usize) -> String) -> String {
    let mut with = sets.iter().filter_map(|set| set.effects.as_ref());
    match with.find(|effects| effects.contains(&effect)) {
        Some(effects) if effects.len() > 1 => {
            let rest = effects.iter().filter(|k| **k != effect);
            let names: Vec<String> = rest.map(|&k| name(k)).collect();
            format!("; most probably with {}", list(names.iter().map(String::as_str)))
        }
        _ => String::new(),
    }
}

/// Writes a probability, never as a certainty.
fn probability(value: f64) -> String {
    match value {
        value if value > 0.999 => "probability > 0.999".into(),
        value => format!("probability {value:.3}"),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::read;

    fn effect(name: &str, probability: f64, in_credible_set: bool) -> JudgedEffect {
        JudgedEffect {
            name: name.into(),
            summary: None,
            log_bayes_factor: 1.0,
            prior_sds: None,
            probability,
            robust: None,
            class: 0,
            in_credible_set,
            strength_prior: None,
            parameters: Default::default(),
            units: Default::default(),
            method: "confirmed".into(),
        }
    }

    #[test]
    fn an_error_of_a_dimension_is_said_in_millimetres() {
        let (job, files, _) = read("tests/data/shear-mobilisation");
        let sentence = |name: &str, parameter: &str, value: f64| {
            let models = SearchModels::new(&job, &files, 1).unwrap();
            let judged = JudgedEffect {
                parameters: [(format!("{name}.{parameter}"), value)].into(),
                ..effect(name, 0.99, true)
            };
            dimension(&models, name, &judged)
        };
        assert_eq!(
            sentence("wheel_radius_error", "relative_error", -0.05).as_deref(),
            Some(": it may be 118.8 mm, not 125.0 mm; measure it")
        );
        let width = sentence("wheel_width_error", "relative_error", 0.05);
        assert!(width.is_some_and(|text| text.contains("measure it")));
        // It changes the width by a length, which is no error of the statement.
        assert_eq!(sentence("edge_loss", "loss_m", 0.005), None);
    }

    #[test]
    fn where_nothing_may_be_missing_it_is_not_said_that_something_is() {
        let with_none = [effect(NONE, 0.6, true), effect("stick_slip", 0.36, true)];
        assert_eq!(
            undecided(&with_none),
            "these data do not decide whether something is missing: the 95 % set is nothing (0.60), stick_slip (0.36)"
        );
        let without = [
            effect("moisture", 0.5, true),
            effect("adhesion", 0.47, true),
            effect(NONE, 0.03, false),
        ];
        assert_eq!(
            undecided(&without),
            "something is missing, and these data do not decide what: the 95 % set is moisture (0.50), adhesion (0.47)"
        );
    }

    #[test]
    fn a_name_says_with_what_its_most_probable_set_has_it() {
        let set = |effects: &[usize], log_bayes_factor: f64| WeighedSet {
            effects: Some(effects.to_vec()),
            log_bayes_factor,
            prior: 0.0,
            probability: 0.0,
            predictive: None,
        };
        let sets = [set(&[2, 0, 3], 44.6), set(&[0], 22.7), set(&[1, 0], 60.0)];
        let name = |k: usize| ["slip", "skid", "pan", "drag"][k].to_owned();
        assert_eq!(beside(&sets, 0, name), "; most probably with pan, drag");
        assert_eq!(beside(&sets[1..], 0, name), "");
        assert_eq!(beside(&sets[..2], 1, name), "");
    }
}
