//! Evaluations that a second worker computes as well: to compare the answers, or because the first worker is slow.
//!
//! A question is kept with all data of its lease, because its round may be over before the second answer arrives. Two equal answers of
//! different workers settle an evaluation, and workers with other answers compute wrongly. While all answers differ, another worker is
//! asked.

use std::collections::{BTreeMap, BTreeSet};

use record::Fingerprint;
use shared::model::ModelVariant;

use super::question::Question;
use crate::lease::{LeaseQueue, SlowLease};

/// The largest number of evaluations that wait for a second answer. Beyond it none is verified: with a single worker, they would accumulate
/// without end.
const MAX_WAITING: usize = 1_000;

/// A worker's answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Answer {
    /// Name of the worker.
    pub worker: String,
    /// The fingerprint of its result.
    pub fingerprint: Fingerprint,
}

/// The state of a comparison after an answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    /// The evaluation is not compared.
    NotAsked,
    /// All answers so far are equal, but fewer than two workers have answered.
    Open,
    /// Answers differ, and no two are equal.
    Differ,
    /// Two workers agree.
    Agreed {
        /// The worker that answered first; its answer is stored.
        first: String,
        /// The workers with other answers.
        wrong: Vec<String>,
    },
    /// A worker has given two different answers.
    Contradiction,
}

#[derive(Debug)]
struct Repeated {
    variant: String,
    theta: Vec<f64>,
    /// Whether answers are compared; otherwise the first one is enough.
    is_compared: bool,
    answers: Vec<Answer>,
}

/// The evaluations of a calibration that a second worker is asked for.
#[derive(Debug, Default)]
pub struct SecondAnswers {
    /// The leases of these evaluations.
    pub queue: LeaseQueue,
    repeated: BTreeMap<u64, Repeated>,
    /// The evaluations for which one answer is enough, each with the slow lease beside which it is leased.
    uncompared: BTreeMap<u64, u64>,
    /// The variants of these evaluations, which the calibration may drop.
    variants: BTreeMap<String, ModelVariant>,
}

impl SecondAnswers {
    /// Asks for a second answer, unless too many evaluations wait for one. If the evaluation is repeated already, its answers are compared
    /// from now on, if one of the two calls wants that.
    ///
    /// # Arguments
    /// - `question`: the question of the evaluation.
    /// - `variant`: the variant that the question names.
    /// - `slow`: the slow lease, so that the first answer is enough. Without one, the answers are compared.
    pub fn ask(
        &mut self,
        evaluation: u64,
        question: Question,
        variant: Option<ModelVariant>,
        slow: Option<&SlowLease>,
    ) {
        let is_compared = slow.is_none();
        if let Some(repeated) = self.repeated.get_mut(&evaluation) {
            if is_compared && !repeated.is_compared {
                // The slow worker may still answer. A worker that has answered is not asked again.
                repeated.is_compared = true;
                self.uncompared.remove(&evaluation);
                self.queue.unbar(evaluation);
            }
            return;
        }
        if is_compared && self.repeated.len() >= MAX_WAITING {
            return;
        }
        if let Some(slow) = slow {
            self.uncompared.insert(evaluation, slow.lease);
        }
        if let Some(variant) = variant.filter(|_| !self.variants.contains_key(question.variant)) {
            self.variants.insert(question.variant.to_owned(), variant);
        }
        let repeated = Repeated {
            variant: question.variant.to_owned(),
            theta: question.theta.to_vec(),
            is_compared,
            answers: Vec::new(),
        };
        self.repeated.insert(evaluation, repeated);
        self.queue.add(
            evaluation,
            slow.map(|slow| slow.worker.clone()).into_iter().collect(),
        );
    }

    /// Returns whether a second worker is asked for an evaluation.
    pub fn contains(&self, evaluation: u64) -> bool {
        self.repeated.contains_key(&evaluation)
    }

    /// Returns the question of an evaluation.
    pub fn question(&self, evaluation: u64) -> Option<Question<'_>> {
        self.repeated.get(&evaluation).map(|repeated| Question {
            variant: &repeated.variant,
            theta: &repeated.theta,
        })
    }

    /// Returns the variant with a hash, if an evaluation here uses it.
    pub fn variant(&self, hash: &str) -> Option<&ModelVariant> {
        self.variants.get(hash)
    }

    /// Takes an answer and compares it with the earlier ones.
    pub fn answered(&mut self, evaluation: u64, answer: Answer) -> Verdict {
        let Some(repeated) = self.repeated.get_mut(&evaluation) else {
            return Verdict::NotAsked;
        };
        if !repeated.is_compared {
            self.drop(evaluation);
            return Verdict::NotAsked;
        }
        if let Some(before) = repeated.answers.iter().find(|a| a.worker == answer.worker) {
            return match before.fingerprint == answer.fingerprint {
                true => Verdict::Open,
                false => Verdict::Contradiction,
            };
        }
        self.queue.bar(evaluation, &answer.worker);
        let fingerprint = answer.fingerprint;
        repeated.answers.push(answer);
        let (same, other): (Vec<&Answer>, Vec<&Answer>) = repeated
            .answers
            .iter()
            .partition(|a| a.fingerprint == fingerprint);
        if same.len() >= 2 {
            let wrong = other.iter().map(|a| a.worker.clone()).collect();
            let first = repeated.answers[0].worker.clone();
            self.drop(evaluation);
            return Verdict::Agreed { first, wrong };
        }
        match other.is_empty() {
            true => Verdict::Open,
            false => Verdict::Differ,
        }
    }

    /// Stops asking for an evaluation.
    pub fn drop(&mut self, evaluation: u64) {
        self.repeated.remove(&evaluation);
        self.uncompared.remove(&evaluation);
        self.queue.remove(evaluation);
        if self.repeated.is_empty() {
            self.variants.clear();
        }
    }

    /// Drops evaluations without a holder that need not be compared, unless `is_wanted` returns true for the evaluation and its slow lease.
    pub fn drop_idle(&mut self, is_wanted: impl Fn(u64, u64) -> bool) {
        let is_idle = |&(evaluation, lease): &(u64, u64)| {
            !self.queue.is_leased(evaluation) && !is_wanted(evaluation, lease)
        };
        let pairs = self
            .uncompared
            .iter()
            .map(|(&evaluation, &lease)| (evaluation, lease));
        let idle: Vec<(u64, u64)> = pairs.filter(is_idle).collect();
        for (evaluation, _) in idle {
            self.drop(evaluation);
        }
    }

    /// Drops all answers of a worker that computes wrongly, and its leases.
    pub fn forget(&mut self, worker: &str) {
        for repeated in self.repeated.values_mut() {
            repeated.answers.retain(|answer| answer.worker != worker);
        }
        self.queue.take_back_of(|name| name == worker);
    }

    /// Ends expired leases. Returns their number. An evaluation that failed repeatedly is dropped, because the second answer is not
    /// essential.
    pub fn expire(&mut self, now_ms: u64) -> u64 {
        let expired = self.queue.expire(now_ms);
        let exhausted = expired.failures.iter().filter(|failure| failure.exhausted());
        let lost: Vec<u64> = exhausted
            .map(|failure| failure.evaluation)
            .chain(expired.never_begun)
            .collect();
        for evaluation in lost {
            self.drop(evaluation);
        }
        expired.unstarted + expired.failures.len() as u64
    }

    /// Drops evaluations that no worker can answer, and those whose lease has been out for `hung_ms`.
    ///
    /// `can_answer` states whether there is a worker besides those that have answered. Returns their number.
    pub fn drop_hopeless(
        &mut self,
        can_answer: impl Fn(&[Answer]) -> bool,
        hung_ms: u64,
        now_ms: u64,
    ) -> u64 {
        let hung: BTreeSet<u64> = self.queue.older_than(hung_ms, now_ms).map(|(e, _)| e).collect();
        let is_hopeless = |(&evaluation, repeated): (&u64, &Repeated)| {
            let is_out = self.queue.is_leased(evaluation) && !hung.contains(&evaluation);
            (!is_out && (hung.contains(&evaluation) || !can_answer(&repeated.answers))).then_some(evaluation)
        };
        let hopeless: Vec<u64> = self.repeated.iter().filter_map(is_hopeless).collect();
        hopeless.iter().for_each(|&evaluation| self.drop(evaluation));
        hopeless.len() as u64
    }

    /// Returns the number of evaluations that wait for an answer.
    pub fn waiting(&self) -> usize {
        self.repeated.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn repeated_evaluation(is_compared: bool) -> SecondAnswers {
        let mut second = SecondAnswers::default();
        let question = Question {
            variant: "00ff",
            theta: &[1.5],
        };
        let slow = SlowLease {
            lease: 7,
            worker: "slow".to_owned(),
        };
        second.ask(3, question, None, (!is_compared).then_some(&slow));
        second
    }

    fn answer(second: &mut SecondAnswers, worker: &str, fingerprint: i64) -> Verdict {
        let (worker, fingerprint) = (worker.to_owned(), Fingerprint(fingerprint));
        second.answered(3, Answer { worker, fingerprint })
    }

    fn agreed(first: &str, wrong: &[&str]) -> Verdict {
        Verdict::Agreed {
            first: first.to_owned(),
            wrong: wrong.iter().map(|w| (*w).to_owned()).collect(),
        }
    }

    #[test]
    fn two_equal_answers_settle_and_a_third_finds_who_is_wrong() {
        let mut second = repeated_evaluation(true);
        assert_eq!(answer(&mut second, "a", 1), Verdict::Open);
        assert_eq!(answer(&mut second, "a", 1), Verdict::Open, "said twice");
        assert_eq!(answer(&mut second, "b", 1), agreed("a", &[]));
        assert_eq!(answer(&mut second, "c", 1), Verdict::NotAsked);

        let mut second = repeated_evaluation(true);
        answer(&mut second, "liar", 9);
        assert_eq!(answer(&mut second, "a", 1), Verdict::Differ);
        assert_eq!(answer(&mut second, "fool", 8), Verdict::Differ);
        assert_eq!(answer(&mut second, "b", 1), agreed("liar", &["liar", "fool"]));
    }

    #[test]
    fn a_worker_that_answers_in_two_ways_contradicts_itself() {
        let mut second = repeated_evaluation(true);
        answer(&mut second, "a", 1);
        assert_eq!(answer(&mut second, "a", 2), Verdict::Contradiction);
        second.forget("a");
        assert_eq!(
            answer(&mut second, "b", 1),
            Verdict::Open,
            "it is as if it had not answered"
        );
    }

    #[test]
    fn a_slow_worker_s_evaluation_needs_one_answer() {
        let mut second = repeated_evaluation(false);
        assert_eq!((second.waiting(), second.queue.unleased()), (1, 1));
        assert_eq!(answer(&mut second, "b", 1), Verdict::NotAsked);
        assert_eq!((second.waiting(), second.queue.len()), (0, 0));
    }

    #[test]
    fn nobody_is_asked_beside_a_lease_that_is_out_no_more() {
        let mut second = repeated_evaluation(false);
        second.drop_idle(|_, lease| lease == 7);
        assert_eq!(second.waiting(), 1);
        second.drop_idle(|_, lease| lease == 8);
        assert_eq!(second.waiting(), 0);
    }

    #[test]
    fn what_nobody_can_answer_is_dropped() {
        let mut second = repeated_evaluation(true);
        answer(&mut second, "a", 1);
        let has_other = |names: &'static [&'static str]| {
            move |answers: &[Answer]| names.iter().any(|n| !answers.iter().any(|a| a.worker == *n))
        };
        assert_eq!(second.drop_hopeless(has_other(&["a", "b"]), 50, 0), 0);
        assert_eq!(second.drop_hopeless(has_other(&["a"]), 50, 0), 1);
        assert_eq!(second.waiting(), 0);
    }

    #[test]
    fn a_slow_worker_may_answer_once_answers_are_compared() {
        let mut second = repeated_evaluation(false);
        let question = Question {
            variant: "00ff",
            theta: &[1.5],
        };
        second.ask(3, question, None, None);
        answer(&mut second, "quick", 1);
        let claimant = |worker| crate::lease::Claimant {
            worker,
            holds: 0,
            now_ms: 0,
            expires_ms: 9,
        };
        assert!(
            second
                .queue
                .claim(claimant("quick"), 1, |_| true, || 1)
                .is_empty()
        );
        assert_eq!(second.queue.claim(claimant("slow"), 1, |_| true, || 2).len(), 1);
        // It hangs: at the end nobody waits for it.
        assert_eq!(second.drop_hopeless(|_| true, 50, 49), 0);
        assert_eq!(second.drop_hopeless(|_| true, 50, 50), 1);
    }

    #[test]
    fn no_more_than_a_thousand_wait() {
        let mut second = SecondAnswers::default();
        for evaluation in 0..2 * MAX_WAITING as u64 {
            let question = Question {
                variant: "00ff",
                theta: &[],
            };
            second.ask(evaluation, question, None, None);
        }
        assert_eq!(second.waiting(), MAX_WAITING);
    }
}
