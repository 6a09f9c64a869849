//! What a search states with a probability, and whether it is right.

use discovery::{Conclusion, LawCandidate, NAMED, RankedEffect, SearchTask, SearchVerdict, WeighedSet};

use super::truth::Truth;

/// Nats below which what is hidden counts as absent: it changes noise-free data by less than a detection needs.
const NEGLIGIBLE: f64 = 3.0;

/// A statement with its probability.
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    /// The name of an effect, the names of a class with `|` between them, `law` with quantity and variable, or `none`.
    pub text: String,
    pub probability: f64,
    pub is_right: bool,
    /// Whether it says that something is missing.
    pub is_something: bool,
    /// Whether the data cannot distinguish a wrong effect from a hidden one.
    pub is_alias: bool,
}

/// A conclusion beside the truth.
pub struct Comparison<'a> {
    pub truth: &'a Truth,
    pub task: &'a SearchTask,
    pub conclusion: &'a Conclusion,
    /// Nats by which the base falls short of the truth for noise-free data.
    pub over_base: f64,
}

impl Comparison<'_> {
    /// Returns the most probable explanation. The members of a class are one explanation, unless one of them is probable enough to be
    /// named.
    pub fn leading(&self) -> Statement {
        let effects = &self.conclusion.ranking.effects;
        let by_probability = |a: &&RankedEffect, b: &&RankedEffect| a.probability.total_cmp(&b.probability);
        let classes = effects.iter().map(|effect| effect.class).max().unwrap_or(0);
        let probability = |class: usize| self.conclusion.ranking.class_probability(class);
        let class = (0..=classes).max_by(|a, b| probability(*a).total_cmp(&probability(*b)));
        let class = class.unwrap_or(0);
        let of_law = self
            .conclusion
            .not_in_library
            .map_or(0.0, |(_, probability)| probability);
        if of_law > probability(class) {
            return self.law(of_law);
        }
        let members = effects.iter().filter(|effect| effect.class == class);
        match members.max_by(by_probability) {
            Some(member) if member.probability > NAMED => match member.candidate {
                Some(effect) => self.effect(effect, member.probability),
                None => self.nothing(member.probability),
            },
            _ if class == 0 => self.nothing(probability(0)),
            _ => self.class(class),
        }
    }

    /// Returns what the verdict claims; `None` without a claim.
    pub fn claim(&self) -> Option<Statement> {
        match self.conclusion.verdict {
            SearchVerdict::Named(effect) => {
                let ranked = self.conclusion.ranking.effect(Some(effect))?;
                Some(self.effect(effect, ranked.probability))
            }
            SearchVerdict::Class(class) => Some(self.class(class)),
            SearchVerdict::NotInLibrary => {
                let has_law = |effects: &Option<Vec<usize>>| {
                    let is_law = |k: &usize| *k >= self.task.library.len();
                    effects.as_ref().is_none_or(|effects| effects.iter().any(is_law))
                };
                let sets = self.conclusion.sets.iter().filter(|set| has_law(&set.effects));
                Some(self.law(sets.map(|set| set.probability).sum()))
            }
            SearchVerdict::NothingDetectable | SearchVerdict::Undecided => None,
        }
    }

    /// Returns the nats by which the evidence of the truth exceeds that of the most probable set; `None` if it is not among the sets.
    pub fn truth_nats(&self) -> Option<f64> {
        let best = self.conclusion.sets.first()?.log_bayes_factor;
        // The search weighs all laws without an effect beside them as one set.
        let is_law = self.truth.law.is_some() && self.truth.effects.is_empty();
        let is_truth = |set: &&WeighedSet| set.effects.as_ref().map_or(is_law, |set| self.is_truth(set));
        let truths = self.conclusion.sets.iter().filter(is_truth);
        let highest = truths.map(|set| set.log_bayes_factor).reduce(f64::max)?;
        Some(highest - best)
    }

    /// Returns whether a set has the hidden effects and, if a law is hidden, a law that describes it, and nothing else.
    fn is_truth(&self, set: &[usize]) -> bool {
        let candidates = self.task.candidates();
        let (effects, laws): (Vec<usize>, Vec<usize>) =
            set.iter().partition(|k| **k < self.task.library.len());
        let describes = |law: &LawCandidate, k: usize| {
            let mut names = std::iter::once(&law.curve).chain(&law.forms);
            names.any(|form| form.name == candidates[k].name) && self.truth.accepts_law(&law.curve.name)
        };
        let is_law = |k: &usize| self.task.laws.iter().any(|law| describes(law, *k));
        effects.len() == self.truth.effects.len()
            && effects.iter().all(|k| self.truth.effects.contains(k))
            && laws.len() == usize::from(self.truth.law.is_some())
            && laws.iter().all(is_law)
    }

    fn nothing(&self, probability: f64) -> Statement {
        Statement {
            text: "none".to_owned(),
            probability,
            is_right: self.truth.is_nothing() || self.over_base < NEGLIGIBLE,
            is_something: false,
            is_alias: false,
        }
    }

    fn effect(&self, effect: usize, probability: f64) -> Statement {
        let ranking = &self.conclusion.ranking;
        let class = |effect: usize| ranking.effect(Some(effect)).map(|ranked| ranked.class);
        let is_right = self.truth.effects.contains(&effect);
        let mut hidden = self.truth.effects.iter();
        Statement {
            text: self.task.library[effect].name.clone(),
            probability,
            is_right,
            is_something: true,
            is_alias: !is_right && hidden.any(|&hidden| class(hidden) == class(effect)),
        }
    }

    fn class(&self, class: usize) -> Statement {
        let effects = self.conclusion.ranking.effects.iter();
        let members = effects.filter(|effect| effect.class == class);
        let members: Vec<usize> = members.filter_map(|effect| effect.candidate).collect();
        let names: Vec<&str> = members
            .iter()
            .map(|&k| self.task.library[k].name.as_str())
            .collect();
        Statement {
            text: names.join("|"),
            probability: self.conclusion.ranking.class_probability(class),
            is_right: members.iter().any(|effect| self.truth.effects.contains(effect)),
            is_something: true,
            is_alias: false,
        }
    }

    /// Returns the names of the laws that the claim of a law states; none without such a claim.
    pub(super) fn stated_laws(&self) -> Vec<&str> {
        let task = self.task;
        let claimed = self.conclusion.outside.as_ref();
        let stated = claimed.map_or(Vec::new(), |outside| outside.stated());
        stated
            .into_iter()
            .map(|law| task.laws[law].curve.name.as_str())
            .collect()
    }

    /// Returns the statement of a law outside the library, whose quantity and variable are stated only if it is claimed.
    fn law(&self, probability: f64) -> Statement {
        let claimed = self.stated_laws();
        Statement {
            text: format!("law {}", claimed.join("|")).trim_end().to_owned(),
            probability,
            is_right: match claimed.is_empty() {
                true => self.truth.law.is_some(),
                false => claimed.iter().any(|law| self.truth.accepts_law(law)),
            },
            is_something: true,
            is_alias: false,
        }
    }
}
