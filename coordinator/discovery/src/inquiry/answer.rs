//! What is said in the end.

use super::found::{Found, Law, Set};
use super::next_run::{Explanation, NextRun, draws};
use super::steps::DETECTED;
use super::task::Task;
use crate::chi_square::{ChiSquare, WRONG};
use crate::descent::Descent;
use crate::evidence::log_sum_exp;
use crate::finding::{Judged, Method};

/// Prior probability that nothing is missing.
const PRIOR_OF_NONE: f64 = 0.5;
/// A class or an effect with more probability is named.
const NAMED: f64 = 0.9;
/// A law outside the library may leave so much of the misfit that the library leaves.
const MOST_LEFT: f64 = 0.25;
/// Probability that the credible set holds.
const CREDIBLE: f64 = 0.95;
/// Explanations with less probability are not told apart by further runs.
const OPEN: f64 = 0.02;
/// Draws of what the data leave of a model's parameters, and their streams, behind those of the explanations that remain open.
const DRAWS: usize = 33;
const OF_BASE: u64 = 1000;
const OF_BEST: u64 = 1001;
/// Most explanations that further runs are to tell apart.
const MOST_OPEN: usize = 5;

/// What can be said.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing beats the model as it is.
    NothingDetectable,
    /// This candidate is missing.
    Named(usize),
    /// Candidates of this class, which the data cannot tell apart.
    Class(usize),
    /// A law outside the library.
    Outside,
    /// Something is missing, and the data do not say what.
    Undecided,
}

/// One explanation.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// The effect; `None`: nothing is missing.
    pub candidate: Option<usize>,
    /// Log-evidence over that of the base.
    pub log_bayes_factor: f64,
    /// Its probability, that of sets led by it included.
    pub probability: f64,
    /// Effects that the data cannot tell apart have the same; that of none is 0.
    pub class: usize,
    /// Whether its class is in the credible set.
    pub is_credible: bool,
    /// How its evidence was computed.
    pub method: Method,
    /// Its own most probable parameters.
    pub parameters: Vec<f64>,
}

/// A model with what the data leave of its parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// Its effects beyond the base.
    pub effects: Vec<usize>,
    /// Draws of the base's parameters and theirs by Laplace's approximation, the most probable ones first.
    pub draws: Vec<Vec<f64>>,
}

/// A law outside the library.
#[derive(Debug, Clone, PartialEq)]
pub struct Outside {
    /// Quantity and variable.
    pub pair: usize,
    /// Its form, or its curve.
    pub candidate: usize,
    /// Log-evidence over that of the base.
    pub log_bayes_factor: f64,
    /// Its most probable parameters.
    pub parameters: Vec<f64>,
    /// Log predictive density of left-out levels over that of the base and of the library's best.
    pub left_out_nats: [f64; 2],
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// What can be said.
    pub verdict: Verdict,
    /// None, then the effects, in their order.
    pub judged: Vec<Judgement>,
    /// Log Bayes factor and probability of a law outside the library, whichever; `None`: not looked for.
    pub not_in_library: Option<(f64, f64)>,
    /// The law that was confirmed, if one was.
    pub outside: Option<Outside>,
    /// Effects of the best set that was found.
    pub best_set: Vec<usize>,
    /// Log Bayes factor of each of the base's effects that may be dropped.
    pub gains: Vec<Option<f64>>,
    /// Effects that these data could not show.
    pub cannot_exclude: Vec<usize>,
    /// Effects that the model always refused.
    pub refused: Vec<usize>,
    /// How well the base fits.
    pub chi_square: Option<ChiSquare>,
    /// How well the best explanation does.
    pub chi_square_best: Option<ChiSquare>,
    /// The base.
    pub base: Fitted,
    /// What the verdict would add to it: the law, or the best set.
    pub best: Fitted,
    /// Runs to make next.
    pub next_runs: Vec<NextRun>,
    /// Evaluations until the effect had a name.
    pub evaluations_to_name: usize,
    /// And until that was confirmed.
    pub evaluations_to_confirm: usize,
    /// All evaluations.
    pub evaluations: usize,
}

/// The probabilities of everything that was found.
struct Weighed {
    judged: Vec<Judgement>,
    not_in_library: Option<(f64, f64)>,
}

/// What was found of one effect, by the better fit where the way back from a set has led to one.
fn refitted(judged: &Judged, found: &Found) -> Judged {
    let alone = |k: usize| found.sets.iter().find(|set| set.effects == [k]);
    let better = judged.candidate.and_then(alone);
    match better.filter(|set| set.log_bayes_factor > judged.log_bayes_factor) {
        Some(set) => Judged {
            log_bayes_factor: set.log_bayes_factor,
            theta: set.fit.frame.theta(&set.fit.point.position),
            ..judged.clone()
        },
        None => judged.clone(),
    }
}

/// Log prior odds of each explanation: 1/2 for nothing missing, the rest equal over classes and what is not in the library, and
/// within a class over its members. A set has the prior of its leader times, for each further effect, that of one among all.
fn weigh(task: &Task, found: &Found) -> Weighed {
    let singles = found.singles.iter().flat_map(|finding| &finding.judged);
    let judged: Vec<Judged> = singles.map(|judged| refitted(judged, found)).collect();
    let classes = judged.iter().map(|j| j.class).max().unwrap_or(0);
    let outside = usize::from(found.laws.is_some());
    let each = (1.0 - PRIOR_OF_NONE) / (classes + outside).max(1) as f64;
    let members = |class: usize| judged.iter().filter(|j| j.class == class).count().max(1) as f64;
    let prior = |class: usize| match class {
        0 if classes + outside == 0 => 1.0,
        0 => PRIOR_OF_NONE,
        class => each / members(class),
    };
    let single = |candidate: usize| judged.iter().find(|j| j.candidate == Some(candidate));
    let leader = |set: &Set| {
        let factor = |k: &usize| single(*k).map_or(f64::NEG_INFINITY, |j| j.log_bayes_factor);
        let members = set.effects.iter().copied();
        members.reduce(|a, b| if factor(&b) > factor(&a) { b } else { a })
    };
    let further = libm::log(task.library.len().max(1) as f64);
    let weight_of = |candidate: Option<usize>, class: usize, factor: f64| {
        let own = std::iter::once(libm::log(prior(class)) + factor);
        let sets = found.sets.iter().filter(|set| set.effects.len() > 1);
        let led = sets
            .filter(|set| candidate.is_some() && leader(set) == candidate)
            .map(|set| {
                libm::log(prior(class)) + set.log_bayes_factor - further * (set.effects.len() as f64 - 1.0)
            });
        let all: Vec<f64> = own.chain(led).collect();
        log_sum_exp(all.into_iter())
    };
    let weights: Vec<f64> = judged
        .iter()
        .map(|j| weight_of(j.candidate, j.class, j.log_bayes_factor))
        .collect();
    // One law outside the library is one of all pairs, those that were not fitted counted as without evidence.
    let laws = found.laws.as_ref().map(|laws| {
        let means = laws.iter().map(|law| law.mean_log_bayes_factor);
        log_sum_exp(means) - libm::log(task.pairs.len().max(1) as f64)
    });
    let outside_weight = laws.map(|factor| libm::log(each) + factor);
    let all: Vec<f64> = weights.iter().copied().chain(outside_weight).collect();
    let sum = log_sum_exp(all.into_iter());
    let probabilities: Vec<f64> = weights.iter().map(|w| libm::exp(w - sum)).collect();
    let not_in_library = laws.zip(outside_weight.map(|w| libm::exp(w - sum)));
    let of_class = |class: usize| -> f64 {
        let own = judged
            .iter()
            .zip(&probabilities)
            .filter(|(j, _)| j.class == class);
        own.map(|(_, p)| p).sum()
    };
    let mut by_class: Vec<(Option<usize>, f64)> = (0..=classes).map(|c| (Some(c), of_class(c))).collect();
    by_class.extend(not_in_library.map(|(_, p)| (None, p)));
    by_class.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut held = 0.0;
    let mut credible = Vec::new();
    for (class, probability) in by_class {
        if held >= CREDIBLE {
            break;
        }
        held += probability;
        credible.push(class);
    }
    let own = task.prior.len();
    let judged = judged
        .iter()
        .zip(&probabilities)
        .map(|(j, &probability)| Judgement {
            candidate: j.candidate,
            log_bayes_factor: j.log_bayes_factor,
            probability,
            class: j.class,
            is_credible: credible.contains(&Some(j.class)),
            method: j.method,
            parameters: j.theta[own.min(j.theta.len())..].to_vec(),
        });
    Weighed {
        judged: judged.collect(),
        not_in_library,
    }
}

/// Whether a law explains most of what the best of the library leaves, or leaves nothing that chance would not.
fn explains(task: &Task, of_library: Option<ChiSquare>, law: &Law) -> bool {
    let excess = |chi: ChiSquare| chi.value - chi.degrees_of_freedom;
    match (of_library, ChiSquare::of(&law.fit, &task.likelihood)) {
        (Some(library), Some(own)) => own.p() > WRONG || excess(own) < MOST_LEFT * excess(library),
        _ => true,
    }
}

/// What can be said of weighed explanations; the law is one that was confirmed and explains the misfit.
fn verdict(weighed: &Weighed, found: &Found, misfit_p: Option<f64>, law: Option<&Law>) -> Verdict {
    let judged = &weighed.judged;
    let best_set = found.best_set();
    let library = best_set.map_or(0.0, |set| set.log_bayes_factor);
    let detected = library > DETECTED;
    let is_wrong = misfit_p.is_some_and(|p| p < WRONG);
    let probability = weighed.not_in_library.map_or(0.0, |(_, probability)| probability);
    if let Some(law) = law
        && (is_wrong || law.log_bayes_factor - library.max(0.0) > DETECTED)
        // Where the library sees nothing, one of many laws may fit by chance: its probability counts the choice.
        && probability > if detected { 0.5 } else { NAMED }
    {
        return Verdict::Outside;
    }
    if is_wrong {
        return Verdict::Undecided;
    }
    if !detected {
        return Verdict::NothingDetectable;
    }
    let of_class = |class: usize| -> f64 {
        let own = judged.iter().filter(|j| j.class == class);
        own.map(|j| j.probability).sum()
    };
    let best = judged
        .iter()
        .reduce(|a, b| if b.probability > a.probability { b } else { a });
    match best {
        // What is most probably nothing is not said to be something.
        Some(best) if best.probability > NAMED || best.candidate.is_none() => {
            best.candidate.map_or(Verdict::NothingDetectable, Verdict::Named)
        }
        Some(_) => {
            let classes = judged.iter().map(|j| j.class).max().unwrap_or(0);
            let class = (1..=classes).find(|&class| of_class(class) > NAMED);
            class.map_or(Verdict::Undecided, Verdict::Class)
        }
        None => Verdict::NothingDetectable,
    }
}

impl Answer {
    /// The explanations that further runs should tell apart.
    pub(super) fn open<'a>(task: &Task, found: &'a Found) -> Vec<Explanation<'a>> {
        let weighed = weigh(task, found);
        let Some(base) = found.fit() else {
            return Vec::new();
        };
        let detected = found
            .best_set()
            .is_some_and(|set| set.log_bayes_factor > DETECTED);
        if !detected {
            return Vec::new();
        }
        let fit = |candidate: Option<usize>| match candidate {
            None => Some(base),
            Some(k) => {
                let own = found.sets.iter().find(|set| set.effects == [k]);
                own.map(|set| &set.fit)
            }
        };
        let judged = weighed.judged.iter().filter(|j| j.probability > OPEN);
        let explanations = judged.filter_map(|j| {
            Some(Explanation {
                effects: j.candidate.into_iter().collect(),
                probability: j.probability,
                fit: fit(j.candidate)?,
            })
        });
        let mut explanations: Vec<Explanation> = explanations.collect();
        let law = found.laws.as_ref().zip(found.confirmed).map(|(laws, k)| &laws[k]);
        let outside = weighed.not_in_library.filter(|(_, p)| *p > OPEN);
        if let (Some(law), Some((_, probability))) = (law, outside) {
            explanations.push(Explanation {
                effects: vec![law.candidate],
                probability,
                fit: &law.fit,
            });
        }
        explanations.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        explanations.truncate(MOST_OPEN);
        explanations
    }

    pub(super) fn new(task: &Task, found: &Found, next_runs: Vec<NextRun>, evaluations: usize) -> Self {
        let weighed = weigh(task, found);
        let singles = found.singles.as_ref();
        let law = found.laws.as_ref().zip(found.confirmed).map(|(laws, k)| &laws[k]);
        let of_library = found.best_chi_square(&task.likelihood, DETECTED);
        let law = law.filter(|law| explains(task, of_library, law));
        let verdict = verdict(&weighed, found, of_library.map(|chi| chi.p()), law);
        let own = task.prior.len();
        let outside = law.map(|law| Outside {
            pair: law.pair,
            candidate: law.candidate,
            log_bayes_factor: law.log_bayes_factor,
            parameters: law.fit.frame.theta(&law.fit.point.position)[own..].to_vec(),
            left_out_nats: law.left_out.unwrap_or([0.0; 2]),
        });
        let best_set = found.best_set().filter(|set| set.log_bayes_factor > DETECTED);
        let fitted = |effects: Vec<usize>, fit: Option<&Descent>, number: u64| {
            let seed = task.settings.seed;
            let draws = fit.map_or(Vec::new(), |fit| {
                draws(fit, &task.likelihood, seed, number, DRAWS)
            });
            Fitted { effects, draws }
        };
        let (effects, fit) = match (verdict, law, best_set) {
            (Verdict::Outside, Some(law), _) => (vec![law.candidate], Some(&law.fit)),
            (_, _, Some(set)) => (set.effects.clone(), Some(&set.fit)),
            _ => (Vec::new(), found.fit()),
        };
        let chi_square_best = match (verdict, law) {
            (Verdict::Outside, Some(law)) => ChiSquare::of(&law.fit, &task.likelihood),
            _ => of_library,
        };
        Self {
            verdict,
            judged: weighed.judged,
            not_in_library: weighed.not_in_library,
            outside: outside.filter(|_| verdict == Verdict::Outside),
            best_set: best_set.map_or(Vec::new(), |set| set.effects.clone()),
            gains: found.gains.clone(),
            cannot_exclude: singles.map_or(Vec::new(), |f| f.cannot_exclude.clone()),
            refused: singles.map_or(Vec::new(), |f| f.refused.clone()),
            chi_square: found.fit().and_then(|fit| ChiSquare::of(fit, &task.likelihood)),
            chi_square_best,
            base: fitted(Vec::new(), found.fit(), OF_BASE),
            best: fitted(effects, fit, OF_BEST),
            next_runs,
            evaluations_to_name: found.to_name,
            evaluations_to_confirm: singles.map_or(0, |finding| finding.spent.to_confirm()),
            evaluations,
        }
    }
}
