//! What a model misses, and how sure that is.

use job::effect_name;
use record::{Discovery, Extension, NONE, NOT_IN_LIBRARY, Verdict, effect_of};

use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;
use crate::words::number;

/// Most alternatives.
const ALTERNATIVES: usize = 3;
/// Least probability of an alternative.
const LEAST: f64 = 0.01;

/// The answer of the search of a model.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Missing {
    /// The verdict; null where the model was not searched.
    pub verdict: Option<Verdict>,
    /// What the verdict names: one effect, or the members of a class.
    pub named: Vec<NamedEffect>,
    /// Probability of what is named, together; that nothing is missing where nothing is; of the leading explanation where it is
    /// undecided.
    pub probability: Option<f64>,
    /// Other explanations, at most three.
    pub alternatives: Vec<Alternative>,
    /// Effects that need what the experiment does not state.
    pub not_tried: Vec<String>,
    /// Effects that the study added to the model.
    pub already_added: Vec<AddedEffect>,
    /// The same in a sentence.
    pub text: String,
}

/// An effect that a search names.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct NamedEffect {
    /// Its name.
    pub name: String,
    /// The wheel that alone has it; null where all have.
    pub wheel: Option<String>,
}

/// Another explanation.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Alternative {
    /// The effect, `EFFECT.WHEEL` on one wheel of several; or `none`, or `not_in_library`.
    pub name: String,
    /// Its probability.
    pub probability: f64,
}

/// An effect that the study added.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct AddedEffect {
    /// Its name.
    pub name: String,
    /// The probability with which a search named it; null where none did.
    pub probability: Option<f64>,
}

impl Study {
    /// The search of a calibration's model; of several the last.
    pub(super) fn search_of(&self, calibration: &FinishedCalibration) -> Option<&Discovery> {
        let mut rounds = self.rounds.iter().rev();
        let of_it = rounds.find(|round| round.calibration == calibration.row.id)?;
        Some(&of_it.record)
    }
}

impl Missing {
    pub(super) fn of(study: &Study, calibration: &FinishedCalibration) -> Missing {
        let already_added = already_added(study, calibration);
        let before: Vec<String> = already_added.iter().map(added).collect();
        let Some(record) = study.search_of(calibration) else {
            let text = [before.as_slice(), &["this model was not searched".into()]].concat();
            return Missing {
                verdict: None,
                named: Vec::new(),
                probability: None,
                alternatives: Vec::new(),
                not_tried: Vec::new(),
                already_added,
                text: text.join("; "),
            };
        };
        let named = named(record);
        let is_named = |name: &str| named.iter().any(|effect| label(effect) == name);
        let others = record.effects.iter().filter(|effect| !is_named(&effect.name));
        let leading = |effects: &mut dyn Iterator<Item = f64>| effects.fold(0.0, f64::max);
        let of = |name: &str| {
            record
                .effects
                .iter()
                .find(|e| e.name == name)
                .map(|e| e.probability)
        };
        let probability = match record.verdict {
            Verdict::NothingDetectable => of(NONE),
            Verdict::NotInLibrary => of(NOT_IN_LIBRARY),
            Verdict::Undecided => Some(leading(&mut record.effects.iter().map(|e| e.probability))),
            Verdict::Named | Verdict::Class => {
                let own = record.effects.iter().filter(|effect| is_named(&effect.name));
                Some(own.map(|effect| effect.probability).sum())
            }
        };
        let says_itself = |name: &str| match record.verdict {
            Verdict::NothingDetectable => name == NONE,
            Verdict::NotInLibrary => name == NOT_IN_LIBRARY,
            _ => false,
        };
        let alternatives: Vec<Alternative> = others
            .filter(|effect| effect.probability > LEAST && !says_itself(&effect.name))
            .take(ALTERNATIVES)
            .map(|effect| Alternative {
                name: effect.name.clone(),
                probability: effect.probability,
            })
            .collect();
        let not_tried = folded(record);
        let mut text = before;
        text.push(finding(record, probability, !already_added.is_empty()));
        if !alternatives.is_empty() && record.verdict != Verdict::NothingDetectable {
            let words = alternatives
                .iter()
                .map(|a| format!("{} ({})", a.name, p(a.probability)));
            text.push(format!("less probable: {}", words.collect::<Vec<_>>().join(", ")));
        }
        if !not_tried.is_empty() {
            text.push(format!(
                "not judged for want of data on the rig: {}",
                not_tried.join(", ")
            ));
        }
        let outside = record
            .not_tried
            .iter()
            .filter(|effect| !effect.lacks_data())
            .count();
        if outside > 0 {
            text.push(format!(
                "not judged: {}, of whose cause this model shows nothing",
                number::count(outside, "effect")
            ));
        }
        Missing {
            verdict: Some(record.verdict),
            named,
            probability,
            alternatives,
            not_tried,
            already_added,
            text: text.join("; "),
        }
    }
}

/// The verdict in words.
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

/// `slip_sinkage was missing (P 0.960) and is added`.
fn added(effect: &AddedEffect) -> String {
    match effect.probability {
        Some(probability) => format!("{} was missing ({}) and is added", effect.name, p(probability)),
        None => format!("{} was added by hand", effect.name),
    }
}

/// `P 0.96`; never a certainty.
fn p(probability: f64) -> String {
    match probability {
        p if p > 0.999 => "P > 0.999".into(),
        p if p < 0.001 => "P < 0.001".into(),
        p if p > 0.99 => format!("P {p:.3}"),
        p => format!("P {p:.2}"),
    }
}

fn named(record: &Discovery) -> Vec<NamedEffect> {
    match (record.verdict, &record.extension) {
        (Verdict::Named, Some(Extension::OnWheel { effect, wheel })) => vec![NamedEffect {
            name: effect.clone(),
            wheel: Some(wheel.clone()),
        }],
        (Verdict::Named, Some(extension)) => vec![NamedEffect {
            name: effect_of(extension),
            wheel: None,
        }],
        (Verdict::Class, _) => {
            let class = record.effects.iter().find(|e| e.class != 0).map(|e| e.class);
            let members = record.effects.iter().filter(|e| Some(e.class) == class);
            members.map(|e| split(&e.name)).collect()
        }
        (Verdict::NotInLibrary, _) => {
            let file = record
                .outside
                .as_ref()
                .and_then(|law| effect_name(&law.effect_file));
            file.map(|name| NamedEffect { name, wheel: None })
                .into_iter()
                .collect()
        }
        _ => Vec::new(),
    }
}

fn split(name: &str) -> NamedEffect {
    match name.split_once('.') {
        Some((effect, wheel)) => NamedEffect {
            name: effect.into(),
            wheel: Some(wheel.into()),
        },
        None => NamedEffect {
            name: name.into(),
            wheel: None,
        },
    }
}

fn label(effect: &NamedEffect) -> String {
    match &effect.wheel {
        Some(wheel) => format!("{}.{wheel}", effect.name),
        None => effect.name.clone(),
    }
}

/// The effects that were not tried, without the wheels.
fn folded(record: &Discovery) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for effect in record.not_tried.iter().filter(|effect| effect.lacks_data()) {
        let name = split(&effect.name).name;
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

fn already_added(study: &Study, calibration: &FinishedCalibration) -> Vec<AddedEffect> {
    let had = study.lead.effects();
    let added = study
        .parts(calibration)
        .into_iter()
        .filter(|name| !had.contains(name));
    let probability = |name: &str| {
        let naming = study.rounds.iter().map(|round| &round.record).find(|record| {
            let extension = record.extension.as_ref();
            extension.is_some_and(|extension| effect_of(extension) == name)
        })?;
        let own = naming.effects.iter().find(|e| split(&e.name).name == name);
        let outside = || naming.effects.iter().find(|e| e.name == NOT_IN_LIBRARY);
        own.or_else(outside).map(|e| e.probability)
    };
    let added = added.map(|name| AddedEffect {
        probability: probability(&name),
        name,
    });
    added.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::discovery::DiscoveryRound;
    use crate::fixture;

    #[test]
    fn a_model_without_a_search_says_so() {
        let study = fixture::study();
        let missing = Missing::of(&study, &study.lead);
        assert_eq!((missing.verdict, missing.probability), (None, None));
        assert_eq!(missing.text, "this model was not searched");
    }

    #[test]
    fn a_named_effect_has_its_probability_and_its_alternatives() {
        let study = fixture::grown();
        let missing = Missing::of(&study, &study.lead);
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
        let missing = Missing::of(&study, &study.extensions[0]);
        assert_eq!(missing.verdict, Some(Verdict::NothingDetectable));
        assert!(
            missing.named.is_empty() && missing.text.contains("that nothing is missing"),
            "{missing:?}"
        );
        // The first search still speaks of the first model.
        assert_eq!(Missing::of(&study, &study.lead).verdict, Some(Verdict::Named));
    }

    #[test]
    fn no_probability_is_a_certainty() {
        assert_eq!(p(1.0), "P > 0.999");
        assert_eq!(p(0.992), "P 0.992");
        assert_eq!(p(0.641), "P 0.64");
    }
}
