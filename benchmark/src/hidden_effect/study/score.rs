//! The score of one trial: the conclusion against the truth.

use std::fmt;

use discovery::{Conclusion, SearchTask, SearchVerdict};

use super::held_out::HeldOut;
use super::kind::HiddenKind;
use super::noise_free::MIN_SEPARATION;
use super::statement::{Comparison, Statement};
use super::truth::Truth;

/// The class of an explanation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum TrialClass {
    /// Effects of the library that the data cannot distinguish; class 0 means that nothing is missing.
    Library(usize),
    Outside,
}

/// The score of one trial.
#[derive(Debug, Clone)]
pub struct TrialScore {
    pub kind: HiddenKind,
    /// The names of what is hidden.
    pub hidden: String,
    /// Nats by which the best rival outside the class of the truth falls short for noise-free data. It is infinite for several effects,
    /// each of which is drawn to be detectable.
    pub separation: f64,
    /// Nats by which the base falls short for noise-free data.
    pub over_base: f64,
    /// Whether an effect, a class or a law is claimed.
    pub is_claimed: bool,
    pub verdict: SearchVerdict,
    /// The most probable explanation, and what the verdict claims.
    pub leading: Statement,
    pub claim: Option<Statement>,
    /// Nats by which the evidence of the truth exceeds that of the most probable set; `None` if the search did not compare the truth.
    pub truth_nats: Option<f64>,
    /// Whether the most probable class is one of the truth.
    pub is_right: bool,
    /// Whether one of the two most probable classes is one of the truth.
    pub is_in_two: bool,
    /// Whether the truth is alone in its class.
    pub is_alone: bool,
    /// Whether the truth is the most probable effect.
    pub is_named: bool,
    /// Whether a class of the truth is claimed, or a law as it is hidden.
    pub claim_is_right: bool,
    /// Probability of the most probable class.
    pub stated: f64,
    /// Whether the 95 % set contains a class of the truth.
    pub is_covered: bool,
    /// The number of classes in the 95 % set.
    pub set_size: usize,
    /// Whether the quantity of the claimed law is right.
    pub quantity: bool,
    /// Whether the quantity and the variable of the claimed law are right.
    pub dependence: bool,
    /// Whether they are of one of the places that are stated, where the data do not tell them apart.
    pub is_in_places: bool,
    /// Whether the best combination is the truth, up to classes.
    pub is_exact: bool,
    pub held_out: HeldOut,
    /// The number of candidates.
    pub candidates: usize,
    /// The number of evaluations before an effect is named, and before it is confirmed.
    pub to_name: usize,
    pub to_confirm: usize,
    pub evaluations: usize,
    pub seconds: f64,
    /// The trial in one line.
    pub line: String,
}

/// The facts of a trial besides its conclusion.
pub struct TrialFacts {
    /// The names of what is hidden.
    pub hidden: String,
    pub separation: f64,
    pub over_base: f64,
    pub held_out: HeldOut,
    pub seconds: f64,
}

/// Returns the probability of each class, the most probable first.
fn by_class(conclusion: &Conclusion) -> Vec<(TrialClass, f64)> {
    let effects = &conclusion.ranking.effects;
    let classes = effects.iter().map(|j| j.class).max().unwrap_or(0);
    let probability = |class: usize| {
        let members = effects.iter().filter(|j| j.class == class);
        members.map(|j| j.probability).sum()
    };
    let all = (0..=classes).map(|class| (TrialClass::Library(class), probability(class)));
    let mut all: Vec<(TrialClass, f64)> = all.collect();
    all.extend(conclusion.not_in_library.map(|(_, p)| (TrialClass::Outside, p)));
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all
}

fn class_of(conclusion: &Conclusion, candidate: Option<usize>) -> Option<TrialClass> {
    let judged = conclusion.ranking.effect(candidate)?;
    Some(TrialClass::Library(judged.class))
}

/// Returns whether two combinations have equally many effects of each class.
fn is_same(conclusion: &Conclusion, a: &[Option<usize>], b: &[Option<usize>]) -> bool {
    let classes = |set: &[Option<usize>]| -> Option<Vec<usize>> {
        let class = |k: &Option<usize>| Some(conclusion.ranking.effect(Some((*k)?))?.class);
        let mut classes: Vec<usize> = set.iter().map(class).collect::<Option<_>>()?;
        classes.sort_unstable();
        Some(classes)
    };
    classes(a).is_some_and(|a| Some(a) == classes(b))
}

impl TrialScore {
    /// Scores a conclusion against the truth.
    pub fn new(
        kind: HiddenKind,
        truth: &Truth,
        task: &SearchTask,
        conclusion: &Conclusion,
        facts: TrialFacts,
    ) -> Self {
        let comparison = Comparison {
            truth,
            task,
            conclusion,
            over_base: facts.over_base,
        };
        let hidden: Vec<Option<usize>> = truth.effects.iter().map(|k| Some(*k)).collect();
        let mut classes: Vec<TrialClass> = hidden.iter().filter_map(|k| class_of(conclusion, *k)).collect();
        classes.extend(truth.law.map(|_| TrialClass::Outside));
        classes.extend(truth.is_nothing().then_some(TrialClass::Library(0)));
        let ranked = by_class(conclusion);
        let is_truth = |class: TrialClass| classes.contains(&class);
        let (best, probability) = ranked[0];
        let mut cumulative = 0.0;
        let credible = ranked.iter().take_while(|(_, p)| {
            let is_in = cumulative < 0.95;
            cumulative += p;
            is_in
        });
        let credible: Vec<TrialClass> = credible.map(|(class, _)| *class).collect();
        let all = conclusion.ranking.effects.iter();
        let effects = all.clone().filter(|j| j.candidate.is_some());
        let first = effects.reduce(|a, b| if b.probability > a.probability { b } else { a });
        let claimed = match conclusion.verdict {
            SearchVerdict::Named(k) => class_of(conclusion, Some(k)),
            SearchVerdict::Class(class) => Some(TrialClass::Library(class)),
            SearchVerdict::NotInLibrary => Some(TrialClass::Outside),
            SearchVerdict::NothingDetectable | SearchVerdict::Undecided => None,
        };
        let claimed_law = conclusion.outside.as_ref();
        let claimed_law = claimed_law.map(|law| task.laws[law.law].curve.name.as_str());
        let stated = comparison.stated_laws();
        let accepts = |is_right: &dyn Fn(&str) -> bool| stated.iter().any(|law| is_right(law));
        let combination: Vec<_> = conclusion.combination.iter().map(|k| Some(*k)).collect();
        Self {
            kind,
            hidden: facts.hidden,
            separation: facts.separation,
            over_base: facts.over_base,
            is_claimed: claimed.is_some(),
            verdict: conclusion.verdict,
            leading: comparison.leading(),
            claim: comparison.claim(),
            truth_nats: comparison.truth_nats(),
            is_right: is_truth(best),
            is_in_two: ranked.iter().take(2).any(|(class, _)| is_truth(*class)),
            is_alone: all.filter(|j| is_truth(TrialClass::Library(j.class))).count() == 1,
            is_named: first.is_some_and(|j| hidden == [j.candidate]),
            claim_is_right: claimed.is_some_and(is_truth)
                && (stated.is_empty() || accepts(&|law| truth.accepts_law(law))),
            stated: probability,
            is_covered: credible.iter().any(|class| is_truth(*class)),
            set_size: credible.len(),
            quantity: claimed_law.is_some_and(|law| truth.has_quantity(law)),
            dependence: claimed_law.is_some_and(|law| truth.has_dependence(law)),
            is_in_places: accepts(&|law| truth.has_dependence(law)),
            is_exact: truth.law.is_none() && is_same(conclusion, &hidden, &combination),
            held_out: facts.held_out,
            candidates: task.library.len(),
            to_name: conclusion.ranking.evaluations.to_name(),
            to_confirm: conclusion.ranking.evaluations.to_confirm(),
            evaluations: conclusion.evaluations,
            seconds: facts.seconds,
            line: String::new(),
        }
    }

    /// Returns whether a law outside the library is claimed.
    pub fn is_outside(&self) -> bool {
        self.verdict == SearchVerdict::NotInLibrary
    }

    /// Returns whether the result is as good as possible. An effect may be confused with a rival that the data cannot distinguish from
    /// it.
    pub fn is_good(&self) -> bool {
        match self.kind {
            HiddenKind::None => !self.is_claimed,
            HiddenKind::Two | HiddenKind::Triple => self.is_exact,
            HiddenKind::Outside => self.dependence || self.separation < MIN_SEPARATION,
            HiddenKind::Twovar => self.quantity || self.separation < MIN_SEPARATION,
            HiddenKind::Outlib => self.is_right && (!self.is_claimed || self.claim_is_right),
            HiddenKind::Session => !self.is_claimed || self.claim_is_right,
            HiddenKind::One
            | HiddenKind::Spatial
            | HiddenKind::Geometry
            | HiddenKind::Sparse
            | HiddenKind::Heavy => self.is_right || self.separation < MIN_SEPARATION,
        }
    }
}

impl fmt::Display for TrialScore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.line)
    }
}
