//! How one experiment fared: what was said against what was hidden.

use std::fmt;

use discovery::inquiry::{Answer, Task, Verdict};

use super::case::Case;
use super::clear::CLEAR;
use super::held_out::HeldOut;
use super::kind::Kind;

/// What the most probable explanation is one of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Class {
    /// Effects of the library that the data cannot tell apart; 0: nothing is missing.
    Library(usize),
    Outside,
}

/// How one experiment fared.
#[derive(Debug, Clone)]
pub(crate) struct Fate {
    pub(crate) kind: Kind,
    /// Nats by which the best rival outside the truth's class falls short without noise, and the base; infinite of several effects,
    /// which were drawn so.
    pub(crate) separation: f64,
    pub(crate) over_base: f64,
    /// Something is said to be missing, and what: P > 0.9 or a law.
    pub(crate) is_claimed: bool,
    pub(crate) verdict: Verdict,
    /// The most probable class is the truth's; one of the two most probable is.
    pub(crate) is_right: bool,
    pub(crate) is_in_two: bool,
    /// Whether the truth is alone in its class, and the most probable effect.
    pub(crate) is_alone: bool,
    pub(crate) is_named: bool,
    /// What was claimed is right.
    pub(crate) claim_is_right: bool,
    /// Probability of the most probable class.
    pub(crate) stated: f64,
    /// The 95 % set holds the truth's class; how many it holds.
    pub(crate) is_covered: bool,
    pub(crate) set_size: usize,
    /// Of a law: the quantity is right; the variable too.
    pub(crate) quantity: bool,
    pub(crate) pair: bool,
    /// The best set is what was hidden, up to classes.
    pub(crate) is_exact: bool,
    pub(crate) held_out: HeldOut,
    /// Effects that were looked for, and evaluations.
    pub(crate) candidates: usize,
    pub(crate) to_name: usize,
    pub(crate) to_confirm: usize,
    pub(crate) evaluations: usize,
    pub(crate) seconds: f64,
    /// One line on it.
    pub(crate) line: String,
}

/// What is known about an experiment beside its answer.
pub(crate) struct Known {
    pub(crate) number: u64,
    pub(crate) separation: f64,
    pub(crate) over_base: f64,
    pub(crate) held_out: HeldOut,
    pub(crate) seconds: f64,
}

/// The probability of each class, the most probable first.
fn by_class(answer: &Answer) -> Vec<(Class, f64)> {
    let classes = answer.judged.iter().map(|j| j.class).max().unwrap_or(0);
    let own = |class: usize| answer.judged.iter().filter(move |j| j.class == class);
    let mut all: Vec<(Class, f64)> = (0..=classes)
        .map(|class| (Class::Library(class), own(class).map(|j| j.probability).sum()))
        .collect();
    all.extend(answer.not_in_library.map(|(_, p)| (Class::Outside, p)));
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all
}

fn class_of(answer: &Answer, candidate: Option<usize>) -> Option<Class> {
    let judged = answer.judged.iter().find(|j| j.candidate == candidate)?;
    Some(Class::Library(judged.class))
}

/// Whether two sets hold as many effects of each class.
fn is_same(answer: &Answer, mut a: Vec<Option<usize>>, mut b: Vec<Option<usize>>) -> bool {
    let classes = |set: &mut Vec<Option<usize>>| {
        let own = set.iter().map(|k| match class_of(answer, *k) {
            Some(Class::Library(class)) if k.is_some() => Some(class),
            _ => None,
        });
        let mut own: Vec<Option<usize>> = own.collect();
        own.sort_unstable();
        own
    };
    let (a, b) = (classes(&mut a), classes(&mut b));
    a == b && !a.contains(&None)
}

impl Fate {
    /// # Arguments
    /// - `pair`: what is right of a law.
    pub(crate) fn new(
        kind: Kind,
        case: &Case,
        task: &Task,
        answer: &Answer,
        pair: Option<&str>,
        known: Known,
    ) -> Self {
        let place = |name: &String| task.library.iter().position(|c| c.name == *name);
        let hidden: Vec<Option<usize>> = case.hidden.iter().map(place).collect();
        let truth = match (kind, hidden.as_slice()) {
            (Kind::Outside, _) => Some(Class::Outside),
            (_, []) => Some(Class::Library(0)),
            (_, [Some(k)]) => class_of(answer, Some(*k)),
            _ => None,
        };
        let ranked = by_class(answer);
        let is_truth = |class: Class| Some(class) == truth;
        let (best, stated) = ranked[0];
        let mut held = 0.0;
        let credible = ranked.iter().take_while(|(_, p)| {
            let is_in = held < 0.95;
            held += p;
            is_in
        });
        let credible: Vec<Class> = credible.map(|(class, _)| *class).collect();
        let effects = answer.judged.iter().filter(|j| j.candidate.is_some());
        let first = effects.reduce(|a, b| if b.probability > a.probability { b } else { a });
        let claimed = match answer.verdict {
            Verdict::Named(k) => class_of(answer, Some(k)),
            Verdict::Class(class) => Some(Class::Library(class)),
            Verdict::Outside => Some(Class::Outside),
            Verdict::NothingDetectable | Verdict::Undecided => None,
        };
        let found = answer
            .outside
            .as_ref()
            .map(|o| task.pairs[o.pair].curve.name.as_str());
        let quantity = |pair: &str| match pair.split('_').next() {
            Some("drawbar") => "drawbar".to_owned(),
            first => first.unwrap_or_default().to_owned(),
        };
        let members = answer.judged.iter().filter(|j| is_truth(Class::Library(j.class)));
        let mut fate = Self {
            kind,
            separation: known.separation,
            over_base: known.over_base,
            is_claimed: claimed.is_some(),
            verdict: answer.verdict,
            is_right: is_truth(best),
            is_in_two: ranked.iter().take(2).any(|(class, _)| is_truth(*class)),
            is_alone: members.count() == 1,
            is_named: first.is_some_and(|j| hidden == [j.candidate]),
            claim_is_right: claimed.is_some() && claimed == truth,
            stated,
            is_covered: credible.iter().any(|class| is_truth(*class)),
            set_size: credible.len(),
            quantity: found.zip(pair).is_some_and(|(a, b)| quantity(a) == quantity(b)),
            pair: found.is_some() && found == pair,
            is_exact: is_same(
                answer,
                hidden.clone(),
                answer.best_set.iter().map(|k| Some(*k)).collect(),
            ),
            held_out: known.held_out,
            candidates: task.library.len(),
            to_name: answer.evaluations_to_name,
            to_confirm: answer.evaluations_to_confirm,
            evaluations: answer.evaluations,
            seconds: known.seconds,
            line: String::new(),
        };
        fate.line = fate.described(case, task, answer, known.number);
        fate
    }

    /// Whether a law outside the library is claimed.
    pub(crate) fn is_outside(&self) -> bool {
        self.verdict == Verdict::Outside
    }

    /// Whether nothing is to be complained of; what cannot be told from a rival may be named so.
    pub(super) fn is_good(&self) -> bool {
        match self.kind {
            Kind::None => !self.is_claimed,
            Kind::Two | Kind::Three => self.is_exact,
            Kind::Outside => self.pair || self.separation < CLEAR,
            Kind::One | Kind::Spatial => self.is_right || self.separation < CLEAR,
        }
    }
}

impl fmt::Display for Fate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.line)
    }
}
