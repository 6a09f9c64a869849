//! Tests of leasing in a farm without network and store.

use farm::calibration::{SimulationResult, VerificationRule};
use farm::{Control, Farm};
use record::{Fact, Quarantine, SealKey, Stored};
use shared::api::CalibrationState;
use shared::exchange::{ExchangeRequest, ExchangeResponse, Lease, WorkResult};
use shared::outcome::{Fault, Observables, Outcome};

use super::simulation::world::case::{Case, EQUATIONS, Kind};
use super::simulation::world::request::bare;

const LEASE_MS: u64 = 1_000;

/// Makes a farm with the first job of some kinds, numbered from 1.
fn farm(kinds: &[usize]) -> (Farm, Vec<Vec<Case>>) {
    let cases = Case::all().expect("the jobs are valid");
    let mut farm = Farm::new(1, LEASE_MS);
    for (k, &kind) in kinds.iter().enumerate() {
        let id = k as i64 + 1;
        let calibration = cases[kind][0].begin(id).expect("the job is valid");
        farm.add(calibration, SealKey([id as u8; 16]), Vec::new(), 0);
    }
    (farm, cases)
}

fn request(worker: &str, want: u32) -> ExchangeRequest {
    ExchangeRequest {
        want,
        ..bare(worker.into(), EQUATIONS)
    }
}

/// Counts the leases of each of the first two calibrations.
fn counts(response: &ExchangeResponse) -> [usize; 2] {
    [1, 2].map(|id| response.leases.iter().filter(|l| l.calibration == id).count())
}

fn answer(lease: &Lease, outcome: Outcome) -> WorkResult {
    WorkResult {
        lease: lease.lease,
        calibration: lease.calibration,
        evaluation: lease.evaluation,
        seal: lease.seal.clone(),
        outcome,
        repeated: None,
    }
}

fn fault() -> Outcome {
    let message = "out of memory".into();
    Outcome::Fault(Fault { message })
}

/// Indices of kinds in [`Case::all`]: fifty particles, five particles.
const LARGE: usize = 3;
const SMALL: usize = 0;

#[test]
fn a_small_calibration_does_not_wait_for_a_large_one() {
    let (mut farm, _) = farm(&[LARGE, SMALL]);
    let first = farm.exchange(request("a", 40), 0);
    assert_eq!(counts(&first), [35, 5], "its share is more than it has");
    let (mut farm, _) = self::farm(&[LARGE, LARGE]);
    assert_eq!(counts(&farm.exchange(request("a", 9), 0)), [5, 4]);
    assert_eq!(counts(&farm.exchange(request("b", 5), 0)), [2, 3]);
    // The second calibration takes the leases that the paused one leaves.
    farm.control(1, Control::Pause, 0).expect("it runs");
    assert_eq!(counts(&farm.exchange(request("c", 5), 0)), [0, 5]);
}

#[test]
fn a_suspect_is_alone_in_the_hands_of_its_worker_whatever_else_waits() {
    let (mut farm, _) = farm(&[SMALL, SMALL]);
    let leases = farm.exchange(request("a", 1), 0).leases;
    let failed = ExchangeRequest {
        results: vec![answer(&leases[0], fault())],
        ..request("a", 0)
    };
    farm.exchange(failed, 0);
    let suspect = farm.exchange(request("b", 4), 0);
    assert_eq!(counts(&suspect), [1, 0]);
    assert!(suspect.leases[0].announce);
    assert_eq!(
        counts(&farm.exchange(request("b", 4), 0)),
        [0, 0],
        "it holds a suspect"
    );
    assert_eq!(counts(&farm.exchange(request("c", 4), 0)), [2, 2]);
}

#[test]
fn a_suspect_of_a_younger_calibration_waits_for_no_other() {
    let (mut farm, _) = farm(&[LARGE, SMALL]);
    let leases = farm.exchange(request("a", 2), 0).leases;
    let young = leases.iter().find(|l| l.calibration == 2).expect("they share");
    let failed = ExchangeRequest {
        results: vec![answer(young, fault())],
        ..request("a", 0)
    };
    farm.exchange(failed, 0);
    let suspect = farm.exchange(request("b", 4), 0);
    assert_eq!(counts(&suspect), [0, 1]);
}

#[test]
fn a_result_pins_the_version_and_a_lease_does_not() {
    let (mut farm, cases) = farm(&[SMALL]);
    let wrong = ExchangeRequest {
        model_version: "no-such-version".into(),
        ..request("wrong", 3)
    };
    let theirs = farm.exchange(wrong.clone(), 0).leases;
    let leases = farm.exchange(request("a", 1), 0).leases;
    assert_eq!((theirs.len(), leases.len()), (3, 1));
    let outcome = |lease: &Lease| cases[SMALL][0].answers[&lease.evaluation].outcome.clone();
    let answered = ExchangeRequest {
        results: vec![answer(&leases[0], outcome(&leases[0]))],
        ..request("a", 0)
    };
    farm.take_facts();
    farm.exchange(answered, 0);
    let facts = farm.take_facts();
    let [Fact::ModelVersion { version, .. }, Fact::Evaluated { .. }] = &facts[..] else {
        panic!("{facts:?}");
    };
    assert_eq!(version, EQUATIONS);
    let late = ExchangeRequest {
        results: vec![answer(&theirs[0], outcome(&theirs[0]))],
        ..wrong
    };
    let response = farm.exchange(late, 0);
    assert_eq!((response.leases.len(), response.duplicates), (0, 1));
    assert!(response.refused.is_some());
    assert!(farm.take_facts().is_empty());
    let again: Vec<u64> = farm
        .exchange(request("a", 9), 0)
        .leases
        .iter()
        .map(|l| l.evaluation)
        .collect();
    assert_eq!(
        again,
        [0, 1, 2, 4],
        "what the wrong one held is leased at once, and is not suspected"
    );
}

#[test]
fn a_suspect_does_not_wait_for_a_worker_that_has_become_another() {
    let (mut farm, _) = farm(&[SMALL]);
    // The worker first states the version of this calibration, and later another one.
    farm.exchange(request("other", 0), 0);
    let leases = farm.exchange(request("a", 1), 0).leases;
    let other = ExchangeRequest {
        model_version: "scm-5".into(),
        ..request("other", 0)
    };
    farm.exchange(other, 0);
    let failed = ExchangeRequest {
        results: vec![answer(&leases[0], fault())],
        ..request("a", 1)
    };
    let again = farm.exchange(failed, 0).leases;
    assert_eq!(again[0].evaluation, leases[0].evaluation, "there is no other");
}

#[test]
fn late_results_of_a_calibration_that_ends_in_its_replay_are_compared() {
    let (mut before, cases) = farm(&[SMALL]);
    let case = &cases[SMALL][0];
    let lease = before.exchange(request("a", 1), 0).leases.remove(0);
    let mut calibration = case.begin(1).expect("the job is valid");
    calibration.model_version = Some(EQUATIONS.into());
    while !calibration.state.is_final() {
        for evaluation in calibration.queue.asked() {
            let outcome = case.answers[&evaluation].outcome.clone();
            let computed = SimulationResult::new(outcome).expect("no faults");
            calibration.complete(evaluation, computed, "a").expect("it fits");
            calibration.step();
        }
    }
    let mut after = Farm::new(2, LEASE_MS);
    after.add(calibration, SealKey([1; 16]), Vec::new(), 0);
    let late = ExchangeRequest {
        results: vec![answer(&lease, case.answers[&1].outcome.clone())],
        ..request("a", 1)
    };
    assert!(after.exchange(late, 0).leases.is_empty());
    let facts = after.take_facts();
    assert!(
        matches!(facts[..], [Fact::Duplicate { evaluation: 0, .. }]),
        "{facts:?}"
    );
}

#[test]
fn nothing_counts_behind_the_result_that_convicts_its_worker() {
    let cases = Case::all().expect("the jobs are valid");
    let case = &cases[SMALL][0];
    let outcome = |evaluation: u64| case.answers[&evaluation].outcome.clone();
    let rule = VerificationRule::with_share(1.0);
    let mut farm = Farm::new(1, LEASE_MS).with_rule(rule.clone());
    let key = SealKey([1; 16]);
    let calibration = case.begin(1).expect("the job is valid").verified(&rule, key);
    farm.add(calibration, key, Vec::new(), 0);
    let mut send = |worker: &str, want: u32, results: Vec<WorkResult>| {
        let response = farm.exchange(
            ExchangeRequest {
                results,
                ..request(worker, want)
            },
            0,
        );
        (response.leases, farm.take_facts())
    };
    let (leases, _) = send("a", 2, Vec::new());
    let [first, second] = &leases[..] else {
        panic!("{leases:?}");
    };
    send("a", 0, vec![answer(first, outcome(first.evaluation))]);
    let (leases, _) = send("b", 5, Vec::new());
    let again = leases.iter().find(|lease| lease.evaluation == first.evaluation);
    let again = again.expect("another worker is asked for the same evaluation");
    let (_, facts) = send("b", 0, vec![answer(again, outcome(first.evaluation))]);
    assert!(
        facts.iter().any(|fact| matches!(fact, Fact::Confirmed { .. })),
        "{facts:?}"
    );
    let wrong = answer(first, outcome(second.evaluation));
    let (_, facts) = send("a", 0, vec![wrong, answer(second, outcome(second.evaluation))]);
    let counted = facts.iter().filter(|fact| matches!(fact, Fact::Evaluated { .. }));
    assert_eq!(counted.count(), 0, "{facts:?}");
    assert_eq!(farm.take_rewinds(), [1], "it is replayed without them");
}

#[test]
fn an_answer_of_wrong_shape_beside_a_slow_lease_costs_an_attempt_like_a_fault() {
    for outcome in [fault(), Outcome::Evaluated(Observables::default())] {
        let (mut farm, cases) = farm(&[SMALL]);
        let mut leases = farm.exchange(request("slow", 9), 0).leases;
        let slow = leases.pop().expect("five evaluations wait");
        let answer_of =
            |lease: &Lease| answer(lease, cases[SMALL][0].answers[&lease.evaluation].outcome.clone());
        let answered = ExchangeRequest {
            results: leases.iter().map(answer_of).collect(),
            holding: vec![slow.lease],
            ..request("slow", 0)
        };
        farm.exchange(answered, 10);
        let held = ExchangeRequest {
            holding: vec![slow.lease],
            ..request("slow", 0)
        };
        farm.exchange(held, 1_000);
        farm.tick(1_500);
        farm.exchange(request("other", 0), 1_500);
        // The third failure ends the second lease, and the next tick starts a new one.
        for is_suspect in [false, true, true, false] {
            farm.tick(1_500);
            let [second] = &farm.exchange(request("other", 1), 1_500).leases[..] else {
                panic!("the slow worker's evaluation is leased to another one");
            };
            assert_eq!(
                (second.evaluation, second.announce),
                (slow.evaluation, is_suspect)
            );
            let failed = ExchangeRequest {
                results: vec![answer(second, outcome.clone())],
                ..request("other", 0)
            };
            farm.exchange(failed, 1_500);
        }
        assert_eq!(farm.workers(1_500)["other"].faults, 4);
    }
}

#[test]
fn an_evaluation_that_nobody_begins_pauses_its_calibration() {
    let (mut farm, _) = farm(&[SMALL]);
    let mut now_ms = 0;
    for lost in 1..=20 {
        let running = farm.status(1, now_ms).expect("it is in progress").state;
        assert_ne!(running, CalibrationState::Paused, "after {lost} leases");
        let mut leases = 0;
        // Each worker takes one suspect, or everything, and never sends a message again.
        while !farm
            .exchange(request(&format!("w{lost}-{leases}"), 9), now_ms)
            .leases
            .is_empty()
        {
            leases += 1;
        }
        now_ms += LEASE_MS;
        farm.tick(now_ms);
    }
    let status = farm.status(1, now_ms).expect("it is in progress");
    assert_eq!(status.state, CalibrationState::Paused);
    let message = status.message.expect("it says why");
    assert!(
        message.contains("was leased 20 times in a row") && message.contains("resume"),
        "{message}"
    );
    farm.control(1, Control::Resume { skip_faults: false }, now_ms)
        .expect("it is paused");
    assert!(!farm.exchange(request("cured", 9), now_ms).leases.is_empty());
}

#[test]
fn a_worker_that_takes_everything_and_answers_nothing_stops_no_job() {
    let case = Case::new(Kind::Large, 1).expect("the job is valid");
    let mut farm = Farm::new(1, LEASE_MS);
    let key = SealKey([1; 16]);
    farm.add(case.begin(1).expect("the job is valid"), key, Vec::new(), 0);
    let hoarders = ["h0", "h1", "h2", "h3"];
    let take = |farm: &mut Farm, worker| farm.exchange(request(worker, u32::MAX), 0).leases;
    let hoarded: Vec<Vec<Lease>> = hoarders.map(|worker| take(&mut farm, worker)).into();
    let counts: Vec<usize> = hoarded.iter().map(Vec::len).collect();
    assert_eq!(counts, [64, 64, 64, 8], "they have answered nothing yet");
    assert!(farm.exchange(request("honest", 5), 0).leases.is_empty());
    for now_ms in [400, 800, LEASE_MS] {
        for (worker, leases) in hoarders.iter().zip(&hoarded) {
            let holding = ExchangeRequest {
                holding: leases.iter().map(|lease| lease.lease).collect(),
                ..request(worker, 0)
            };
            farm.exchange(holding, now_ms);
        }
        farm.tick(now_ms);
    }
    assert_eq!(farm.exchange(request("honest", 200), LEASE_MS).leases.len(), 64);
}

#[test]
fn a_version_that_few_workers_compute_pins_nothing() {
    let (mut farm, _) = farm(&[SMALL]);
    for worker in ["a", "b"] {
        farm.exchange(request(worker, 0), 0);
    }
    let invented = ExchangeRequest {
        want: 5,
        ..bare("odd".into(), "no-such-version")
    };
    let response = farm.exchange(invented.clone(), 0);
    assert!(response.leases.is_empty());
    let refused = response.refused.expect("it says why");
    assert!(
        refused.starts_with("most workers compute calibration 1 with model version scm-7"),
        "{refused}"
    );
    assert_eq!(farm.exchange(request("a", 5), 0).leases.len(), 5);
    // Where nobody else is there, it counts.
    let (mut farm, _) = self::farm(&[SMALL]);
    assert_eq!(farm.exchange(invented, 0).leases.len(), 5);
}

#[test]
fn the_operator_says_which_version_goes_on_where_an_invented_one_was_alone() {
    let (mut farm, cases) = farm(&[SMALL]);
    let case = &cases[SMALL][0];
    let of = |worker: &str, version: &str, want| ExchangeRequest {
        model_version: version.into(),
        ..request(worker, want)
    };
    let leases = farm.exchange(of("liar", "invented-1", 2), 0).leases;
    let answered = |lease: &Lease, worker: &str, version: &str| ExchangeRequest {
        results: vec![answer(lease, case.answers[&lease.evaluation].outcome.clone())],
        ..of(worker, version, 0)
    };
    farm.exchange(answered(&leases[0], "liar", "invented-1"), 0);
    let refused = farm.exchange(of("honest", EQUATIONS, 2), 0).refused;
    assert!(refused.is_some_and(|why| why.contains("was begun with model version invented-1")));
    farm.take_facts();
    let refused = farm.control(1, Control::ComputeWith("scm-77".into()), 0);
    assert_eq!(
        refused.expect_err("nobody computes it").to_string(),
        format!(
            "no connected worker computes version \"scm-77\"; the connected ones compute invented-1, {EQUATIONS}"
        )
    );
    assert!(farm.take_facts().is_empty(), "nothing is dropped");
    let command = Control::ComputeWith(EQUATIONS.into());
    let state = farm.control(1, command.clone(), 0).expect("it runs");
    assert_eq!(state, CalibrationState::Running);
    let pinned = case.spec.fit_variant.model_version(EQUATIONS);
    let facts = farm.take_facts();
    assert!(
        matches!(&facts[..], [Fact::Repinned { calibration: 1, version }] if *version == pinned),
        "{facts:?}"
    );
    assert_eq!(farm.take_rewinds(), [1]);
    assert!(
        farm.exchange(of("honest", EQUATIONS, 2), 0).leases.is_empty(),
        "before the replay"
    );
    let stored = Stored {
        state: Some(state),
        model_version: Some(pinned),
        ..Stored::default()
    };
    let mut again = case.begin(1).expect("the job is valid");
    let facts = again.replay(stored).expect("nothing is stored");
    farm.add(again, SealKey([1; 16]), facts, 0);
    farm.exchange(answered(&leases[1], "liar", "invented-1"), 0);
    assert!(
        farm.take_facts().is_empty(),
        "a late result of the other version does not count"
    );
    assert!(farm.exchange(of("liar", "invented-1", 2), 0).leases.is_empty());
    assert_eq!(farm.exchange(of("honest", EQUATIONS, 2), 0).leases.len(), 2);
    // The version that computes already drops nothing.
    farm.take_facts();
    farm.control(1, command, 0).expect("it runs");
    assert!(farm.take_facts().is_empty() && farm.take_rewinds().is_empty());
}

#[test]
fn workers_that_are_shut_out_are_not_counted_as_able_under_any_of_their_names() {
    let out = |worker: &str| Quarantine {
        worker: worker.into(),
        calibration: 1,
        evaluation: 0,
    };
    // Names of before tokens, of a worker with a token, and of all workers of a token.
    let quarantine = vec![out("old"), out("lab/a"), out("other/")];
    let mut farm = Farm::new(1, LEASE_MS).with_quarantine(quarantine);
    for worker in ["lab/old", "old", "lab/a", "other/x"] {
        assert_eq!(farm.exchange(request(worker, 0), 0).workers, 0, "{worker}");
    }
    assert_eq!(farm.exchange(request("lab/b", 0), 0).workers, 1);
    farm.tick(70_000);
    assert_eq!(farm.exchange(request("lab/b", 0), 70_000).workers, 1);
}
