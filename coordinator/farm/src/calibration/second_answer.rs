//! Evaluations that a second worker computes as well: to compare the answers, or because the first worker is slow.
//!
//! A question is kept with all data of its lease, because its round may be over before the second answer arrives. Two equal answers of
//! different workers settle an evaluation. Where answers differ, further workers are asked until no other answer can get as many votes
//! any more; workers with other answers compute wrongly.

use std::collections::{BTreeMap, BTreeSet};

use record::Fingerprint;
use shared::model::ModelVariant;

use super::question::Question;
use crate::lease::{LeaseQueue, SlowLease};
use crate::voting::Voting;

/// The largest number of evaluations that wait for a second answer. Beyond it none is verified: with a single worker, they would accumulate
/// without end.
const MAX_WAITING: usize = 20_000;
/// The number of answers to a disputed evaluation beyond which no vote is awaited. Where these leave no majority, further answers count.
const MAX_ANSWERS: usize = 15;

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
    /// All answers so far are equal.
    Open,
    /// Answers differ.
    Differ,
    /// A worker has given two different answers.
    Contradiction,
}

/// A settled comparison.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settled {
    /// Number of the evaluation.
    pub evaluation: u64,
    /// The worker of the stored answer, which came first, if that is right.
    pub first: Option<String>,
    /// Another worker with the right answer, if there is one.
    pub confirmed_by: Option<String>,
    /// The workers with other answers than the right one.
    pub wrong: Vec<String>,
}

/// The workers that may still answer a compared evaluation.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Undecided {
    /// The number of voters.
    pub voters: usize,
    /// Whether one of them is trusted.
    pub has_trusted: bool,
}

#[derive(Debug)]
struct Repeated {
    variant: String,
    theta: Vec<f64>,
    /// Whether answers are compared; otherwise the first one is enough.
    is_compared: bool,
    /// The answer that is stored.
    first: Option<Answer>,
    answers: Vec<Answer>,
}

impl Repeated {
    /// Returns the right answer, once no other one can get as many votes.
    fn right(&self, voting: &Voting, undecided: Undecided) -> Option<Fingerprint> {
        let trusted = self.answers.iter().find(|answer| voting.trusts(&answer.worker));
        if let Some(trusted) = trusted.filter(|_| self.answers.len() > 1) {
            return Some(trusted.fingerprint);
        }
        let mut votes: BTreeMap<i64, usize> = BTreeMap::new();
        for answer in &self.answers {
            *votes.entry(answer.fingerprint.0).or_default() += 1;
        }
        let (&right, &most) = votes.iter().max_by_key(|(_, count)| **count)?;
        let others = votes.iter().filter(|(fingerprint, _)| **fingerprint != right);
        let stands = match others.map(|(_, count)| *count).max() {
            None => most >= 2,
            Some(_) if undecided.has_trusted => false,
            Some(next) => {
                let to_come = undecided
                    .voters
                    .min(MAX_ANSWERS.saturating_sub(self.answers.len()));
                most >= 2 && most > next + to_come
            }
        };
        stands.then_some(Fingerprint(right))
    }
}

/// The evaluations of a calibration that a second worker is asked for.
#[derive(Debug, Default)]
pub struct SecondAnswers {
    /// The leases of these evaluations.
    pub queue: LeaseQueue,
    repeated: BTreeMap<u64, Repeated>,
    /// The evaluations for which one answer is enough, each with the slow lease beside which it is leased.
    uncompared: BTreeMap<u64, u64>,
    /// The evaluations with several answers.
    comparable: BTreeSet<u64>,
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
            first: None,
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
    pub fn answered(&mut self, evaluation: u64, answer: Answer, voting: &Voting) -> Verdict {
        let Some(repeated) = self.repeated.get_mut(&evaluation) else {
            return Verdict::NotAsked;
        };
        if !repeated.is_compared {
            self.drop(evaluation);
            return Verdict::NotAsked;
        }
        let voter = voting.voter(&answer.worker).to_owned();
        let is_same_voter = |before: &&Answer| voting.voter(&before.worker) == voter;
        if let Some(before) = repeated.answers.iter().find(is_same_voter) {
            return match before.fingerprint == answer.fingerprint {
                true => Verdict::Open,
                false => Verdict::Contradiction,
            };
        }
        self.queue
            .bar(evaluation, &voter, |worker| voting.voter(worker) == voter);
        repeated.first.get_or_insert_with(|| answer.clone());
        let is_equal = repeated
            .answers
            .iter()
            .all(|before| before.fingerprint == answer.fingerprint);
        repeated.answers.push(answer);
        if repeated.answers.len() > 1 {
            self.comparable.insert(evaluation);
        }
        match is_equal {
            true => Verdict::Open,
            false => Verdict::Differ,
        }
    }

    /// Returns whether an evaluation has several answers, and is not settled.
    pub fn has_comparable(&self) -> bool {
        !self.comparable.is_empty()
    }

    /// Settles the evaluations with answers that nobody can outvote any more.
    ///
    /// `undecided` returns the workers that may still answer an evaluation with some answers.
    pub fn settle(
        &mut self,
        voting: &Voting,
        undecided: impl Fn(u64, &[Answer]) -> Undecided,
    ) -> Vec<Settled> {
        let settled = |&evaluation: &u64| {
            let repeated = self.repeated.get(&evaluation)?;
            let right = repeated.right(voting, undecided(evaluation, &repeated.answers))?;
            let first = repeated.first.clone()?;
            let is_right = |answer: &&Answer| answer.fingerprint == right;
            let (same, other): (Vec<&Answer>, Vec<&Answer>) = repeated.answers.iter().partition(is_right);
            let confirmed_by = same.into_iter().find(|answer| answer.worker != first.worker);
            Some(Settled {
                evaluation,
                confirmed_by: confirmed_by.map(|answer| answer.worker.clone()),
                wrong: other.into_iter().map(|answer| answer.worker.clone()).collect(),
                first: (first.fingerprint == right).then_some(first.worker),
            })
        };
        let settled: Vec<Settled> = self.comparable.iter().filter_map(settled).collect();
        for settled in &settled {
            self.drop(settled.evaluation);
        }
        settled
    }

    /// Stops asking for an evaluation.
    pub fn drop(&mut self, evaluation: u64) {
        self.repeated.remove(&evaluation);
        self.uncompared.remove(&evaluation);
        self.comparable.remove(&evaluation);
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

    /// Drops all answers of workers that compute wrongly, and their leases.
    pub fn forget(&mut self, is_wrong: impl Fn(&str) -> bool) {
        for (evaluation, repeated) in &mut self.repeated {
            repeated.answers.retain(|answer| !is_wrong(&answer.worker));
            if repeated.answers.len() < 2 {
                self.comparable.remove(evaluation);
            }
        }
        self.queue.take_back_of(is_wrong);
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

    /// Returns the evaluations whose lease has been out for `hung_ms`.
    pub fn hung(&self, hung_ms: u64, now_ms: u64) -> BTreeSet<u64> {
        self.queue.older_than(hung_ms, now_ms).map(|(e, _)| e).collect()
    }

    /// Drops evaluations that no worker can answer, and hung ones.
    ///
    /// `can_answer` states whether there is a worker besides those that have answered. Returns their number.
    pub fn drop_hopeless(&mut self, can_answer: impl Fn(&[Answer]) -> bool, hung: &BTreeSet<u64>) -> u64 {
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
        second.answered(3, Answer { worker, fingerprint }, &Voting::default())
    }

    /// Settles what can be settled where some voters have not answered. Returns the right first worker, who confirmed it, and who is wrong.
    fn settle(
        second: &mut SecondAnswers,
        voting: &Voting,
        voters: usize,
    ) -> Option<(Option<String>, Option<String>, Vec<String>)> {
        let undecided = Undecided {
            voters,
            has_trusted: false,
        };
        let settled = second.settle(voting, |_, _| undecided).pop()?;
        Some((settled.first, settled.confirmed_by, settled.wrong))
    }

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|&name| name.to_owned()).collect()
    }

    #[test]
    fn two_equal_answers_settle_and_of_different_ones_that_which_cannot_be_outvoted() {
        let voting = Voting::default();
        let mut second = repeated_evaluation(true);
        assert_eq!(answer(&mut second, "a", 1), Verdict::Open);
        assert_eq!(answer(&mut second, "a", 1), Verdict::Open, "said twice");
        assert_eq!(settle(&mut second, &voting, 5), None);
        assert_eq!(answer(&mut second, "b", 1), Verdict::Open);
        let confirmed = (Some("a".into()), Some("b".into()), Vec::new());
        assert_eq!(settle(&mut second, &voting, 5), Some(confirmed));
        assert_eq!(answer(&mut second, "c", 1), Verdict::NotAsked);

        let mut second = repeated_evaluation(true);
        answer(&mut second, "liar", 9);
        assert_eq!(answer(&mut second, "a", 1), Verdict::Differ);
        assert_eq!(answer(&mut second, "fool", 8), Verdict::Differ);
        assert_eq!(answer(&mut second, "b", 1), Verdict::Differ);
        assert_eq!(
            settle(&mut second, &voting, 1),
            None,
            "the last may agree with the liar"
        );
        let found = (None, Some("a".into()), names(&["liar", "fool"]));
        assert_eq!(settle(&mut second, &voting, 0), Some(found));
    }

    #[test]
    fn liars_that_answer_alike_do_not_convict_an_honest_worker_where_they_are_a_minority() {
        let mut second = repeated_evaluation(true);
        let answers = [
            ("a", 1),
            ("liar-1", 9),
            ("liar-2", 9),
            ("liar-3", 9),
            ("b", 1),
            ("c", 1),
        ];
        for (k, (worker, fingerprint)) in answers.into_iter().enumerate() {
            answer(&mut second, worker, fingerprint);
            assert_eq!(settle(&mut second, &Voting::default(), 6 - k), None, "{worker}");
        }
        answer(&mut second, "d", 1);
        let liars = names(&["liar-1", "liar-2", "liar-3"]);
        let found = (Some("a".into()), Some("b".into()), liars);
        assert_eq!(settle(&mut second, &Voting::default(), 0), Some(found));
    }

    #[test]
    fn no_more_than_fifteen_are_asked() {
        let mut second = repeated_evaluation(true);
        answer(&mut second, "liar", 9);
        for k in 0..7 {
            answer(&mut second, &format!("w{k}"), 1);
            assert_eq!(settle(&mut second, &Voting::default(), 1_000), None);
        }
        answer(&mut second, "w7", 1);
        assert!(settle(&mut second, &Voting::default(), 1_000).is_some());
    }

    #[test]
    fn a_trusted_answer_settles_and_a_token_has_one_vote() {
        let voting = Voting {
            is_by_token: true,
            trusted: ["mine".to_owned()].into(),
        };
        let mut second = repeated_evaluation(true);
        let mut answer = |worker: &str, fingerprint: i64| {
            let (worker, fingerprint) = (worker.to_owned(), Fingerprint(fingerprint));
            second.answered(3, Answer { worker, fingerprint }, &voting)
        };
        assert_eq!(answer("lab/1", 9), Verdict::Open);
        assert_eq!(answer("lab/2", 9), Verdict::Open, "no second vote");
        assert_eq!(answer("lab/3", 8), Verdict::Contradiction);
        assert_eq!(answer("mine/1", 1), Verdict::Differ);
        let found = (None, Some("mine/1".into()), names(&["lab/1"]));
        assert_eq!(settle(&mut second, &voting, 1_000), Some(found));
    }

    #[test]
    fn a_worker_that_answers_in_two_ways_contradicts_itself() {
        let mut second = repeated_evaluation(true);
        answer(&mut second, "a", 1);
        assert_eq!(answer(&mut second, "a", 2), Verdict::Contradiction);
        second.forget(|worker| worker == "a");
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
        let none = BTreeSet::new();
        assert_eq!(second.drop_hopeless(has_other(&["a", "b"]), &none), 0);
        assert_eq!(second.drop_hopeless(has_other(&["a"]), &none), 1);
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
            voter: worker,
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
        let hung = second.hung(50, 49);
        assert_eq!(second.drop_hopeless(|_| true, &hung), 0);
        let hung = second.hung(50, 50);
        assert_eq!(second.drop_hopeless(|_| true, &hung), 1);
    }

    #[test]
    fn no_more_than_a_bound_wait() {
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
