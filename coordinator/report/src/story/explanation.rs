//! Explanations of a search and their probabilities in words, and the parts of a model that an explanation stands for.

use job::{EffectOnNodes, ModelSwitch, PlainParameter};
use record::{Discovery, JudgedEffect, LawPlace, NONE, NOT_IN_LIBRARY, NextRun, Verdict, parts_of_effect};

use result::words::number;

/// Minimum probability of an explanation that is named.
pub(super) const LEAST: f64 = 0.01;

/// An explanation of a search.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct Alternative {
    /// The effect (`EFFECT.WHEEL` if one wheel of several has it), `none` or `not_in_library`.
    pub name: String,
    /// Posterior probability of the explanation.
    pub probability: f64,
    /// What the effect does, in a few words; null for an explanation outside the catalogue.
    pub summary: Option<String>,
}

impl From<&JudgedEffect> for Alternative {
    fn from(effect: &JudgedEffect) -> Self {
        Alternative {
            summary: effect.summary.clone().or_else(|| summary(&effect.name)),
            name: effect.name.clone(),
            probability: effect.probability,
        }
    }
}

/// Returns what an effect, a freed parameter or a setting of the model does, in a few words; `None` for an explanation outside the
/// catalogue.
pub(super) fn summary(name: &str) -> Option<String> {
    let plain = PlainParameter::find(name).map(|plain| plain.summary);
    let switch = || ModelSwitch::find(name).map(|switch| switch.summary);
    let effect = || match EffectOnNodes::find(name) {
        Some(on_nodes) => Some(on_nodes.effect),
        None => formula::catalogue::find(split(name).0),
    };
    let effect = || effect().map(|effect| effect.summary.as_str());
    plain.or_else(switch).or_else(effect).map(str::to_owned)
}

impl Alternative {
    /// Returns, for example, `slip_sinkage (P 0.68)`.
    pub(super) fn words(&self) -> String {
        let name = match self.name.as_str() {
            NONE => "nothing",
            NOT_IN_LIBRARY => "a law outside the library",
            effect => effect,
        };
        format!("{name} ({})", p(self.probability))
    }
}

/// Formats a probability such as `P 0.96`, which is never 0 or 1.
pub(super) fn p(probability: f64) -> String {
    match probability {
        p if p > 0.999 => "P > 0.999".into(),
        p if p < 0.001 => "P < 0.001".into(),
        p if p > 0.99 => format!("P {p:.3}"),
        p => format!("P {p:.2}"),
    }
}

/// Splits `EFFECT.WHEEL` into effect and wheel.
pub(super) fn split(name: &str) -> (&str, Option<&str>) {
    match name.split_once('.') {
        Some((effect, wheel)) => (effect, Some(wheel)),
        None => (name, None),
    }
}

/// Lists the parts that an explanation gives a model, by their names.
pub(super) fn parts(explanation: &str) -> Vec<String> {
    parts_of_effect(split(explanation).0)
}

/// Returns the members of the class that a search names; empty for another verdict.
pub(super) fn class(record: &Discovery) -> impl Iterator<Item = &JudgedEffect> {
    let class = record.effects.iter().find(|e| e.class != 0).map(|e| e.class);
    let is_class = record.verdict == Verdict::Class;
    let members = record.effects.iter();
    members.filter(move |e| is_class && Some(e.class) == class && e.probability > LEAST)
}

/// Lists the explanations that a search leaves open: the members of a class, or the 95 % set of an undecided search; none if it names one.
pub(super) fn open(record: &Discovery) -> Vec<&JudgedEffect> {
    match record.verdict {
        Verdict::Class => class(record).collect(),
        Verdict::Undecided => {
            let set = record.effects.iter().filter(|e| e.in_credible_set);
            set.filter(|e| e.probability > LEAST).collect()
        }
        Verdict::Named | Verdict::NotInLibrary | Verdict::NothingDetectable => Vec::new(),
    }
}

/// Lists the places of a claimed law that these data do not tell apart, each with its share of the probability of a law: first the law as
/// it is claimed, by the name of its effect. Empty if one place is claimed.
pub(super) fn law_places(record: &Discovery, claimed: &str) -> Vec<Alternative> {
    let Some(law) = &record.outside else {
        return Vec::new();
    };
    let of_law = record.effects.iter().find(|e| e.name == NOT_IN_LIBRARY);
    let of_law = of_law.map_or(0.0, |e| e.probability);
    let place = |place: &LawPlace| Alternative {
        name: match place.is_of(law) {
            true => claimed.to_owned(),
            false => format!("{}_{}", place.acts_on, place.depends_on),
        },
        probability: of_law * place.probability,
        summary: None,
    };
    let mut places: Vec<Alternative> = law.open_places().iter().map(place).collect();
    // The sort is stable.
    places.sort_by_key(|place| place.name != claimed);
    places
}

/// Describes a run: `slip 0.60 under 80.0 N at 20.0 mm/s`.
pub(super) fn run_words(run: &NextRun) -> String {
    format!(
        "slip {:.2} under {} N at {} mm/s",
        run.slip,
        number::significant(run.wheel_load_n, 3),
        number::significant(1000.0 * run.sled_speed_m_s, 3)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_probability_is_a_certainty() {
        assert_eq!(p(1.0), "P > 0.999");
        assert_eq!(p(0.992), "P 0.992");
        assert_eq!(p(0.641), "P 0.64");
    }

    #[test]
    fn an_effect_on_the_nodes_is_an_effect_and_a_setting() {
        assert_eq!(
            parts("janosi_hanamoto_node"),
            ["janosi_hanamoto", "displacement_node"]
        );
        assert_eq!(parts("slip_sinkage.left"), ["slip_sinkage"]);
    }
}
