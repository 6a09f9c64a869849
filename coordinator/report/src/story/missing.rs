//! The answer to "what is missing?": the effect that the model lacks, and its probability.

use job::effect_name;
use record::{Discovery, Extension, NONE, NOT_IN_LIBRARY, Verdict, effect_of};

use super::added::{AddedEffect, added, unseen_runs};
use super::explanation::{Alternative, LEAST, class, p, split, summary};
use result::finished_calibration::FinishedCalibration;
use result::study::Study;
use result::words::number;

/// Maximum number of alternatives.
const ALTERNATIVES: usize = 3;
/// Maximum number of leading explanations.
const LEADING: usize = 4;
/// Maximum number of effects that were not judged and are named.
const NOT_JUDGED: usize = 3;

/// The result of the search of a model.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Missing {
    /// The verdict; null if the model was not searched.
    pub verdict: Option<Verdict>,
    /// The effect that the verdict names, or the members of a class.
    pub named: Vec<NamedEffect>,
    /// Sum of the probabilities of the named effects; if nothing was detected, the probability that nothing is missing; if undecided, the
    /// probability of the leading explanation.
    pub probability: Option<f64>,
    /// At most three other explanations: those that the verdict does not name, or for an undecided verdict those outside the 95 % set.
    pub alternatives: Vec<Alternative>,
    /// The most probable explanations of the search, at most four, by decreasing probability; `none` is one of them.
    pub leading: Vec<Alternative>,
    /// Effects that were not tried because the experiment lacks information, without those that the verdict or the alternatives name.
    pub not_tried: Vec<String>,
    /// Effects that the study added to the model.
    pub already_added: Vec<AddedEffect>,
    /// The same in a sentence.
    pub text: String,
}

/// An effect that a search names.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct NamedEffect {
    /// Name of the effect.
    pub name: String,
    /// The only wheel with the effect; null if all wheels have it.
    pub wheel: Option<String>,
    /// Probability of this effect; null if the search did not judge it by its name.
    pub probability: Option<f64>,
    /// What the effect does, in a few words; null for a law outside the catalogue.
    pub summary: Option<String>,
}

impl NamedEffect {
    /// Names an effect as a search judged it: `EFFECT`, or `EFFECT.WHEEL` on one wheel.
    fn judged(record: &Discovery, name: &str) -> NamedEffect {
        let (effect, wheel) = split(name);
        let judged = record.effects.iter().find(|e| e.name == name);
        let of_replacement = record.named_replacement().filter(|named| named.effect == name);
        let replacement = of_replacement.map(|named| named.probability);
        NamedEffect {
            name: effect.into(),
            wheel: wheel.map(str::to_owned),
            probability: replacement.or(judged.map(|e| e.probability)),
            summary: summary(name),
        }
    }
}

/// Returns the last search of a calibration's model.
pub(super) fn search_of<'a>(study: &'a Study, calibration: &FinishedCalibration) -> Option<&'a Discovery> {
    let mut rounds = study.rounds.iter().rev();
    let search = rounds.find(|round| round.calibration == calibration.row.id)?;
    Some(&search.record)
}

impl Missing {
    pub(super) fn new(study: &Study, calibration: &FinishedCalibration) -> Missing {
        let already_added = added(study, calibration);
        let mut text: Vec<String> = already_added.iter().map(AddedEffect::words).collect();
        text.extend(unseen_runs(study, calibration, &already_added));
        let Some(record) = search_of(study, calibration) else {
            text.push("this model was not searched".into());
            return Missing {
                verdict: None,
                named: Vec::new(),
                probability: None,
                alternatives: Vec::new(),
                leading: Vec::new(),
                not_tried: Vec::new(),
                already_added,
                text: text.join("; "),
            };
        };
        let named = named(record);
        let probability = probability(record, &named);
        let alternatives = alternatives(record, &named);
        let not_tried = not_tried(record, &named, &alternatives);
        text.push(finding(record, probability, !already_added.is_empty()));
        text.extend(less_probable(record, &alternatives));
        text.extend(not_judged(record, &not_tried));
        Missing {
            verdict: Some(record.verdict),
            named,
            probability,
            alternatives,
            leading: leading(record),
            not_tried,
            already_added,
            text: text.join("; "),
        }
    }
}

/// Returns the probability of the verdict.
fn probability(record: &Discovery, named: &[NamedEffect]) -> Option<f64> {
    let effects = record.effects.iter();
    let probability = |name: &str| {
        let mut effects = record.effects.iter();
        effects.find(|e| e.name == name).map(|e| e.probability)
    };
    match record.verdict {
        Verdict::NothingDetectable => probability(NONE),
        Verdict::NotInLibrary => probability(NOT_IN_LIBRARY),
        Verdict::Undecided => Some(effects.fold(0.0, |max, e| f64::max(max, e.probability))),
        Verdict::Named | Verdict::Class => {
            let of_named = effects.filter(|e| named.iter().any(|named| label(named) == e.name));
            Some(of_named.map(|e| e.probability).sum())
        }
    }
}

/// Returns the explanations that the verdict does not name, by decreasing probability.
fn alternatives(record: &Discovery, named: &[NamedEffect]) -> Vec<Alternative> {
    let leader = record.effects.iter().map(|e| e.probability).fold(0.0, f64::max);
    let is_named = |name: &str| match record.verdict {
        Verdict::NothingDetectable => name == NONE,
        Verdict::NotInLibrary => name == NOT_IN_LIBRARY,
        Verdict::Named | Verdict::Class => named.iter().any(|named| label(named) == name),
        Verdict::Undecided => false,
    };
    let further = record.effects.iter().filter(|effect| {
        let is_open = record.verdict == Verdict::Undecided && effect.in_credible_set;
        effect.probability > LEAST && effect.probability < leader && !is_open && !is_named(&effect.name)
    });
    further.take(ALTERNATIVES).map(Alternative::from).collect()
}

/// Returns the most probable explanations, by decreasing probability.
fn leading(record: &Discovery) -> Vec<Alternative> {
    let probable = record.effects.iter().filter(|effect| effect.probability > LEAST);
    let mut probable: Vec<Alternative> = probable.map(Alternative::from).collect();
    probable.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    probable.truncate(LEADING);
    probable
}

/// Lists the alternatives; `None` if nothing is missing, when they do not matter.
fn less_probable(record: &Discovery, alternatives: &[Alternative]) -> Option<String> {
    if record.verdict == Verdict::NothingDetectable || alternatives.is_empty() {
        return None;
    }
    let words: Vec<String> = alternatives.iter().map(Alternative::words).collect();
    Some(format!("less probable: {}", words.join(", ")))
}

/// Returns the verdict in words.
fn finding(record: &Discovery, probability: Option<f64>, is_extended: bool) -> String {
    match record.verdict {
        Verdict::NothingDetectable => format!(
            "{} that these data can show ({} that nothing is missing)",
            if is_extended {
                "beyond that, nothing"
            } else {
                "nothing"
            },
            number::or_none(probability, p)
        ),
        _ => record.text.trim_end_matches('.').to_owned(),
    }
}

/// Names a few effects that the search could not judge, and counts the rest.
fn not_judged(record: &Discovery, not_tried: &[String]) -> Vec<String> {
    let mut text = Vec::new();
    if !not_tried.is_empty() {
        let names = match not_tried.len() > NOT_JUDGED {
            true => number::count(not_tried.len(), "effect"),
            false => not_tried.join(", "),
        };
        text.push(format!("not judged for want of data on the rig: {names}"));
    }
    let outside = record.not_tried.iter().filter(|effect| !effect.lacks_data());
    let outside = outside.count();
    if outside > 0 {
        text.push(format!(
            "not judged: {}, of whose cause this model shows nothing",
            number::count(outside, "effect")
        ));
    }
    text
}

fn named(record: &Discovery) -> Vec<NamedEffect> {
    match (record.verdict, &record.extension) {
        (Verdict::Named, Some(Extension::OnWheel { effect, wheel })) => {
            vec![NamedEffect::judged(record, &format!("{effect}.{wheel}"))]
        }
        (Verdict::Named, Some(extension)) => vec![NamedEffect::judged(record, &effect_of(extension))],
        (Verdict::Class, _) => class(record)
            .map(|e| NamedEffect::judged(record, &e.name))
            .collect(),
        (Verdict::NotInLibrary, _) => {
            let law = record.outside.as_ref();
            let file = law.and_then(|law| effect_name(&law.effect_file));
            let probability = record.effects.iter().find(|e| e.name == NOT_IN_LIBRARY);
            let named = |name| NamedEffect {
                name,
                wheel: None,
                probability: probability.map(|e| e.probability),
                summary: None,
            };
            file.map(named).into_iter().collect()
        }
        _ => Vec::new(),
    }
}

/// Describes a verdict by the names of what is missing: `slip_sinkage is missing (P 0.97)`, `one of slip_sinkage (P 0.58) and
/// slip_softened_pressure (P 0.42) is missing`.
pub(crate) fn short_verdict(record: &Discovery, added: &[AddedEffect]) -> String {
    let names: Vec<String> = named(record)
        .iter()
        .map(|effect| match effect.probability {
            Some(probability) => format!("{} ({})", label(effect), p(probability)),
            None => label(effect),
        })
        .collect();
    let found = match record.verdict {
        Verdict::Named => format!("{} is missing", number::list(&names)),
        Verdict::Class => format!("one of {} is missing", number::list(&names)),
        Verdict::NotInLibrary => "a law outside the library is missing".into(),
        Verdict::Undecided => "undecided".into(),
        Verdict::NothingDetectable if added.is_empty() => "nothing detectable is missing".into(),
        Verdict::NothingDetectable => "nothing further is detectable".into(),
    };
    let mut clauses: Vec<String> = added.iter().map(AddedEffect::short).collect();
    clauses.push(found);
    clauses.join("; ")
}

fn label(effect: &NamedEffect) -> String {
    match &effect.wheel {
        Some(wheel) => format!("{}.{wheel}", effect.name),
        None => effect.name.clone(),
    }
}

/// Returns the effects that were not tried, without their wheels and without those that the verdict or the alternatives name.
fn not_tried(record: &Discovery, named: &[NamedEffect], alternatives: &[Alternative]) -> Vec<String> {
    let is_named = |name: &str| {
        let mut of_set = record.effects.iter().filter(|e| e.in_credible_set);
        match record.verdict {
            Verdict::NothingDetectable => false,
            Verdict::Undecided if of_set.any(|e| split(&e.name).0 == name) => true,
            _ => {
                let mut less_probable = alternatives.iter().map(|alternative| split(&alternative.name).0);
                named.iter().any(|effect| effect.name == name) || less_probable.any(|effect| effect == name)
            }
        }
    };
    let mut names: Vec<String> = Vec::new();
    for effect in record.not_tried.iter().filter(|effect| effect.lacks_data()) {
        let (name, _) = split(&effect.name);
        if !names.iter().any(|listed| listed == name) && !is_named(name) {
            names.push(name.to_owned());
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;
    use result::discovery::DiscoveryRound;

    #[test]
    fn a_model_without_a_search_says_so() {
        let study = fixture::study();
        let missing = Missing::new(&study, &study.lead);
        assert_eq!((missing.verdict, missing.probability), (None, None));
        assert_eq!(missing.text, "this model was not searched");
    }

    #[test]
    fn a_named_effect_has_its_probability_and_its_alternatives() {
        let study = fixture::grown();
        let missing = Missing::new(&study, &study.lead);
        assert_eq!(missing.verdict, Some(Verdict::Named));
        assert_eq!(missing.named[0].name, "slip_sinkage");
        assert_eq!(missing.probability, Some(0.96));
        assert_eq!(missing.alternatives.len(), 1, "{missing:?}");
        assert!(
            missing.text.contains("less probable: bulldozing (P 0.03)"),
            "{}",
            missing.text
        );
    }

    #[test]
    fn what_the_sentence_has_said_is_not_said_again_as_less_probable() {
        let mut study = fixture::grown();
        let record = &mut study.rounds[0].record;
        record.verdict = Verdict::Undecided;
        record.text = "something is missing, and these data do not decide what: the 95 % set is slip_sinkage (0.60), bulldozing (0.36)".into();
        for (effect, (probability, is_open)) in
            record
                .effects
                .iter_mut()
                .zip([(0.60, true), (0.36, true), (0.03, false), (0.01, false)])
        {
            (effect.probability, effect.in_credible_set) = (probability, is_open);
        }
        record.not_tried = ["bulldozing", "end_wall"]
            .map(|name| record::NotTried {
                name: name.into(),
                why: "the density is not stated".into(),
                needs: "density_kg_m3".into(),
            })
            .into();
        let missing = Missing::new(&study, &study.lead);
        let names: Vec<&str> = missing.alternatives.iter().map(|a| a.name.as_str()).collect();
        assert_eq!(names, [NOT_IN_LIBRARY], "{missing:?}");
        assert!(
            missing
                .text
                .contains("; less probable: a law outside the library (P 0.03); "),
            "{}",
            missing.text
        );
        // The effects in the 95 % set count as judged.
        assert_eq!(missing.not_tried, ["end_wall"]);
        let class = fixture::of_a_class();
        let class = Missing::new(&class, &class.lead);
        let names: Vec<&str> = class.alternatives.iter().map(|a| a.name.as_str()).collect();
        assert_eq!(names, ["bulldozing"]);
    }

    #[test]
    fn a_model_that_is_searched_again_says_what_is_left() {
        let mut study = fixture::grown();
        let record = Discovery {
            verdict: Verdict::NothingDetectable,
            extension: None,
            ..study.rounds[0].record.clone()
        };
        study.rounds.push(DiscoveryRound {
            calibration: 3,
            record,
        });
        let missing = Missing::new(&study, &study.extensions[0]);
        assert_eq!(missing.verdict, Some(Verdict::NothingDetectable));
        assert!(
            missing.named.is_empty() && missing.text.contains("that nothing is missing"),
            "{missing:?}"
        );
        // The first search still describes the first model.
        assert_eq!(Missing::new(&study, &study.lead).verdict, Some(Verdict::Named));
    }
}
