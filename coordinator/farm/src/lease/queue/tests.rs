use super::*;
use proptest::prelude::*;

fn queue(evaluations: u64) -> LeaseQueue {
    let mut queue = LeaseQueue::default();
    queue.ask(0..evaluations, |_| Vec::new());
    queue
}

/// Claims for the only worker.
fn claim(queue: &mut LeaseQueue, worker: &str, want: usize, holds: usize, first: u64) -> Vec<(u64, u64)> {
    claim_beside(queue, worker, want, holds, first, &[])
}

fn claim_beside(
    queue: &mut LeaseQueue,
    worker: &str,
    want: usize,
    holds: usize,
    first: u64,
    other_workers: &[&str],
) -> Vec<(u64, u64)> {
    let mut next = first;
    let has_other = |failed: &[String]| {
        other_workers
            .iter()
            .any(|other| !failed.iter().any(|f| f == other))
    };
    let claimant = Claimant {
        worker,
        voter: worker,
        holds,
        now_ms: 0,
        expires_ms: 100,
    };
    let claims = queue.claim(claimant, want, has_other, || {
        next += 1;
        next
    });
    claims
        .iter()
        .map(|claim| (claim.lease, claim.evaluation))
        .collect()
}

#[test]
fn a_late_completion_counts_once() {
    let mut queue = queue(1);
    claim(&mut queue, "a", 1, 0, 0);
    assert_eq!(queue.expire(100).unstarted, 1);
    assert_eq!(queue.complete(0), Completion::First);
    assert_eq!(queue.complete(0), Completion::Duplicate);
    assert_eq!(queue.complete(7), Completion::Unknown);
    assert_eq!(queue.unleased(), 0);
}

#[test]
fn a_lost_batch_comes_back_one_by_one_and_only_to_empty_hands_and_costs_what_had_begun() {
    let mut queue = queue(3);
    let leases = claim(&mut queue, "a", 3, 0, 0);
    assert!(!queue.start(leases[1].0, "b", 100), "not its own");
    assert!(queue.start(leases[1].0, "a", 100));
    let expired = queue.expire(100);
    let failed: Vec<(u64, u32)> = expired
        .failures
        .iter()
        .map(|f| (f.evaluation, f.attempt))
        .collect();
    assert_eq!((failed, expired.unstarted), (vec![(1, 1)], 2));
    assert_eq!(claim(&mut queue, "b", 3, 1, 10), vec![]);
    assert_eq!(claim(&mut queue, "b", 3, 0, 10), vec![(11, 0)]);
    assert!(queue.holds_suspect("b") && !queue.holds_suspect("a"));
}

#[test]
fn leases_of_an_answer_that_never_arrived_come_back_at_no_cost() {
    let mut queue = queue(6);
    let received = claim(&mut queue, "a", 2, 0, 0)[1].0;
    claim(&mut queue, "b", 1, 0, 10);
    claim(&mut queue, "a", 3, 2, 20);
    assert_eq!(queue.take_back_above(received, "a"), 3);
    assert_eq!(queue.take_back_above(received, "a"), 0);
    assert_eq!(queue.leased(), 3);
    let again: Vec<u64> = claim(&mut queue, "c", 6, 0, 30).iter().map(|c| c.1).collect();
    assert_eq!(again, [3, 4, 5], "in their order, and no suspects");
}

#[test]
fn an_evaluation_that_kills_its_workers_is_given_up_at_the_third_attempt() {
    for names in [["a", "b", "c"], ["a", "a", "b"]] {
        let mut queue = queue(1);
        for (k, name) in names.into_iter().enumerate() {
            let lease = claim(&mut queue, name, 1, 0, 10 * k as u64)[0].0;
            let failure = queue.fail(lease).unwrap();
            assert_eq!((failure.attempt, failure.exhausted()), (k as u32 + 1, k == 2));
            assert_eq!(failure.is_evaluations_own(), k == 2 && names[1] == "b");
        }
    }
}

#[test]
fn a_worker_gets_what_it_failed_at_again_only_if_there_is_no_other() {
    let mut queue = queue(1);
    let lease = claim(&mut queue, "a", 1, 0, 0)[0].0;
    queue.fail(lease);
    assert_eq!(claim_beside(&mut queue, "a", 1, 0, 10, &["a", "b"]), vec![]);
    assert_eq!(claim_beside(&mut queue, "a", 1, 0, 10, &["a"]), vec![(11, 0)]);
}

#[test]
fn a_returned_lease_costs_no_attempt() {
    let mut queue = queue(2);
    let leases = claim(&mut queue, "a", 2, 0, 0);
    assert!(!queue.give_back(leases[1].0, "b"), "not its own");
    assert!(queue.give_back(leases[1].0, "a"));
    assert!(!queue.give_back(leases[1].0, "a"));
    assert_eq!(claim(&mut queue, "b", 5, 0, 10), vec![(11, 1)]);
}

#[test]
fn an_evaluation_that_nobody_begins_is_told_after_twenty_leases_in_a_row() {
    let mut queue = queue(1);
    for begun in [true, false] {
        for lost in 1..=MAX_UNSTARTED {
            let lease = claim(&mut queue, "a", 1, 0, u64::from(lost))[0].0;
            if begun && lost == 10 {
                assert!(queue.start(lease, "a", 100));
                queue.give_back(lease, "a");
            } else {
                let never_begun = queue.expire(100).never_begun;
                assert_eq!(never_begun.len(), usize::from(!begun && lost == 10), "{lost}");
            }
        }
    }
}

#[test]
fn leases_of_some_workers_come_back_at_no_cost() {
    let mut queue = queue(4);
    claim(&mut queue, "a", 1, 0, 0);
    claim(&mut queue, "b", 2, 0, 10);
    queue.take_back_of(|worker| worker == "b");
    assert_eq!((queue.leased(), queue.held_by("b")), (1, 0));
    let again: Vec<u64> = claim(&mut queue, "c", 4, 0, 20).iter().map(|c| c.1).collect();
    assert_eq!(again, [1, 2, 3], "in their order, and no suspects");
}

#[test]
fn a_renewed_lease_outlives_its_first_time() {
    let mut queue = queue(1);
    let lease = claim(&mut queue, "a", 1, 0, 0)[0].0;
    assert!(!queue.renew(lease, "b", 300), "not its own");
    assert!(queue.renew(lease, "a", 200));
    assert_eq!(queue.expire(100), Expired::default());
    assert_eq!(queue.expire(200).unstarted, 1);
    assert!(!queue.renew(lease, "a", 300));
}

proptest! {
    /// For events in any order, no evaluation is held twice, none is lost, and each completes once.
    #[test]
    fn random_histories_lose_nothing(steps in prop::collection::vec((0u8..7, 0u64..12), 1..200)) {
        let mut queue = queue(12);
        let (mut next, mut now) = (0u64, 0u64);
        let mut out: Vec<(u64, u64)> = Vec::new();
        let mut completed = std::collections::BTreeSet::new();
        for (action, target) in steps {
            match action {
                0 => {
                    let claimant = Claimant { worker: "w", voter: "w", holds: 0, now_ms: now, expires_ms: now + 5 };
                    let new = queue.claim(claimant, (target % 4) as usize + 1, |_| false, || { next += 1; next });
                    for claim in &new {
                        prop_assert!(!completed.contains(&claim.evaluation));
                    }
                    out.extend(new.iter().map(|claim| (claim.lease, claim.evaluation)));
                }
                1 => {
                    let first = queue.complete(target) == Completion::First;
                    prop_assert_eq!(first, completed.insert(target));
                }
                2 => { if let Some(&(lease, _)) = out.first() { queue.give_back(lease, "w"); out.remove(0); } }
                3 => { if let Some(&(lease, _)) = out.last() { queue.fail(lease); out.pop(); } }
                4 => { if let Some(&(lease, _)) = out.last() { queue.start(lease, "w", now + 5); } }
                5 => { queue.take_back_above(next.saturating_sub(target), "w"); }
                _ => { now += target; queue.expire(now); }
            }
            prop_assert_eq!(queue.unleased() + queue.leased() + completed.len(), 12);
        }
    }
}

#[test]
fn a_barred_worker_gets_nothing_and_loses_what_it_holds() {
    let mut queue = queue(0);
    queue.add(7, vec!["a".into()]);
    queue.add(8, Vec::new());
    assert_eq!(claim(&mut queue, "a", 5, 0, 0), vec![(1, 8)]);
    assert_eq!(claim(&mut queue, "b", 5, 0, 10), vec![(11, 7)]);
    queue.bar(7, "b", |worker| worker == "b");
    assert_eq!((queue.unleased(), queue.held_by("b")), (1, 0));
    assert_eq!(claim(&mut queue, "b", 5, 0, 20), vec![]);
    let lease = claim(&mut queue, "c", 5, 0, 25)[0].0;
    queue.fail(lease);
    assert_eq!(
        claim_beside(&mut queue, "c", 5, 0, 30, &["a", "b", "c"]),
        vec![(31, 7)],
        "those that may not claim it are no others"
    );
    queue.remove(7);
    queue.remove(8);
    assert_eq!((queue.len(), queue.leased(), queue.held_by("a")), (0, 0, 0));
}

#[test]
fn what_is_out_for_long_is_listed_the_longest_first() {
    let mut queue = queue(3);
    let leases = claim(&mut queue, "a", 3, 0, 0);
    assert_eq!(queue.age_ms(leases[0].0, "a", 40), Some(40));
    assert_eq!(queue.age_ms(leases[0].0, "b", 40), None);
    assert_eq!(queue.older_than(50, 40).count(), 0);
    queue.fail(leases[1].0);
    claim(&mut queue, "b", 1, 0, 10);
    let old: Vec<(u64, String)> = queue
        .older_than(40, 40)
        .map(|(e, slow)| (e, slow.worker))
        .collect();
    assert_eq!(
        old,
        [(0, "a"), (2, "a"), (1, "b")].map(|(e, w)| (e, w.to_owned()))
    );
    assert_eq!(queue.lease_of(0), Some(leases[0].0));
}
