//! Several workers that compute wrongly, alike or apart: they change no bit of a posterior where one of them is found and most workers are
//! honest.

use std::collections::BTreeMap;
use std::sync::Arc;

use farm::calibration::VerificationRule;
use farm::{Farm, Voting};
use record::SealKey;
use shared::exchange::{ExchangeRequest, Lease, WorkResult};
use shared::outcome::Outcome;
use statistics::rng::Stream;

use super::simulation::world::case::{Case, EQUATIONS, Kind};
use super::simulation::world::ledger::{Entry, Ledger};
use super::simulation::world::request::bare;

const LEASE_MS: u64 = 1_000;
/// The stage of the random streams, which no sampler uses.
const STAGE: u64 = 1 << 42;

/// Workers that compute wrongly.
#[derive(Debug, Clone, Copy)]
struct Liars {
    /// Their number; they are the first of the workers.
    count: usize,
    /// The share of their results that are wrong, the same evaluations for all.
    share: f64,
    /// Whether they give the same wrong answers.
    are_alike: bool,
}

/// The end of a calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct End {
    /// Whether the posterior has the bits of honest workers.
    is_right: bool,
    /// How many workers that compute wrongly were found.
    found: usize,
    /// How many honest workers were quarantined.
    accused: usize,
    /// Number of results that were taken for each row of the calibration `[%]`.
    cost_percent: usize,
}

/// Returns the outcome of a worker, wrong at some evaluations.
fn outcome(case: &Case, farm: &Farm, lease: &Lease, worker: usize, liars: Liars) -> Outcome {
    let variant = farm.variant(&lease.variant).expect("a leased variant is known");
    let mut outcome = case.kind.evaluate(&variant, &lease.theta);
    let draw = Stream::new(lease.evaluation, STAGE, 0, 0).uniform();
    if worker < liars.count
        && draw < liars.share
        && let Outcome::Evaluated(observables) = &mut outcome
    {
        let wrong = if liars.are_alike {
            0.5
        } else {
            0.5 + 0.25 * worker as f64
        };
        observables
            .drawbar_pull_n
            .iter_mut()
            .for_each(|value| *value += wrong);
    }
    outcome
}

/// Calibrates with workers of which the first ones compute wrongly, in an order that follows from the seed.
fn calibrate(case: &Case, names: &[String], liars: Liars, rule: &VerificationRule, seed: u64) -> End {
    let mut stream = Stream::new(seed, STAGE, 1, 0);
    let key = SealKey(std::array::from_fn(|_| stream.below(256) as u8));
    let mut farm = Farm::new(1, LEASE_MS).with_rule(rule.clone());
    let mut ledger = Ledger::default();
    ledger.push(Entry::Submitted { id: 1, case, key });
    let begun = case.begin(1).expect("the job is valid").verified(rule, key);
    farm.add(begun, key, Vec::new(), 0);
    let mut results: BTreeMap<usize, Vec<WorkResult>> = BTreeMap::new();
    let (mut now_ms, mut taken) = (0, 0);
    while ledger.table(1).is_some_and(|table| !table.state.is_final()) {
        now_ms += 1;
        let worker = stream.below(names.len());
        let results_of = results.remove(&worker).unwrap_or_default();
        taken += results_of.len();
        let request = ExchangeRequest {
            results: results_of,
            want: 1 + stream.below(5) as u32,
            ..bare(names[worker].clone(), EQUATIONS)
        };
        let response = farm.exchange(request, now_ms);
        let answers = response.leases.iter().map(|lease| WorkResult {
            lease: lease.lease,
            calibration: lease.calibration,
            evaluation: lease.evaluation,
            seal: lease.seal.clone(),
            outcome: outcome(case, &farm, lease, worker, liars),
            repeated: None,
        });
        results.insert(worker, answers.collect());
        farm.tick(now_ms);
        for step in farm.take_steps() {
            farm.stepped(step.run(), now_ms);
        }
        for fact in farm.take_facts() {
            ledger.push(Entry::Fact(fact));
        }
        for id in farm.take_rewinds() {
            let stored = ledger.table(id).expect("it was submitted").stored();
            let mut again = case.begin(id).expect("the job is valid").verified(rule, key);
            let facts = again.replay(stored).expect("it is of the same job");
            farm.add(again, key, facts, now_ms);
            for fact in farm.take_facts() {
                ledger.push(Entry::Fact(fact));
            }
        }
        assert!(now_ms < 1_000_000, "seed {seed}: no end in sight");
    }
    let table = ledger.table(1).expect("it was submitted");
    let is_liar = |quarantined: &&String| {
        names[..liars.count]
            .iter()
            .any(|name| includes(quarantined, name))
    };
    let found = ledger.quarantine().keys().filter(is_liar).count();
    End {
        is_right: table.result.as_ref() == Some(&case.result),
        found,
        accused: ledger.quarantine().len() - found,
        cost_percent: 100 * taken / case.answers.len(),
    }
}

/// Returns whether a name in the quarantine is that of a worker, or of its token.
fn includes(quarantined: &str, worker: &str) -> bool {
    quarantined == worker || quarantined.ends_with('/') && worker.starts_with(quarantined)
}

/// Makes the rule that verifies a share of the evaluations.
fn rule(share: f64, voting: Voting) -> VerificationRule {
    let voting = Arc::new(voting);
    VerificationRule { share, voting }
}

fn case() -> Case {
    Case::new(Kind::Large, 1).expect("the job is valid")
}

/// Returns the names of seven workers, each of a token of its own.
fn seven() -> Vec<String> {
    (0..7).map(|token| format!("token-{token}/w")).collect()
}

#[test]
fn liars_change_no_bit_once_one_of_them_is_found_and_accuse_nobody() {
    let case = case();
    let mut found_any = 0;
    for count in 1..=3 {
        for (are_alike, share, verified) in [
            (true, 0.1, 0.05),
            (false, 0.1, 0.05),
            (true, 0.01, 0.05),
            (false, 0.01, 0.05),
            (true, 0.1, 1.0),
            (true, 0.01, 1.0),
        ] {
            let liars = Liars {
                count,
                share,
                are_alike,
            };
            for seed in 1..=4 {
                let end = calibrate(&case, &seven(), liars, &rule(verified, Voting::default()), seed);
                println!("{liars:?} verified {verified} seed {seed}: {end:?}");
                assert_eq!(end.accused, 0, "{liars:?} seed {seed}: {end:?}");
                assert!(end.found == 0 || end.is_right, "{liars:?} seed {seed}: {end:?}");
                assert!(
                    verified < 1.0 || count > 1 || end.is_right,
                    "{liars:?} seed {seed}"
                );
                found_any += usize::from(end.found > 0);
            }
        }
    }
    assert!(found_any >= 48, "liars were found in {found_any} of 72 runs");
}

#[test]
fn honest_workers_are_computed_once_and_verified_ones_twice() {
    let case = case();
    let liars = Liars {
        count: 0,
        share: 0.0,
        are_alike: false,
    };
    for (share, least, most) in [(0.0, 100, 100), (0.01, 101, 105), (1.0, 200, 200)] {
        let end = calibrate(&case, &seven(), liars, &rule(share, Voting::default()), 1);
        assert!(end.is_right && end.found + end.accused == 0, "{end:?}");
        assert!((least..=most).contains(&end.cost_percent), "{share}: {end:?}");
    }
}

#[test]
fn a_process_that_poses_as_three_outvotes_two_workers_but_not_two_tokens() {
    let case = case();
    let names: Vec<String> = ["lab/1", "lab/2", "lab/3", "other/1", "mine/1"]
        .map(str::to_owned)
        .into();
    let liars = Liars {
        count: 3,
        share: 0.1,
        are_alike: true,
    };
    let by_worker = calibrate(&case, &names, liars, &rule(1.0, Voting::default()), 1);
    assert!(!by_worker.is_right && by_worker.accused == 2, "{by_worker:?}");
    let voting = Voting {
        is_by_token: true,
        ..Voting::default()
    };
    let by_token = calibrate(&case, &names, liars, &rule(1.0, voting), 1);
    assert!(
        by_token.is_right && (by_token.found, by_token.accused) == (1, 0),
        "{by_token:?}"
    );
}

#[test]
fn a_trusted_worker_is_right_against_a_majority() {
    let case = case();
    let liars = Liars {
        count: 4,
        share: 0.1,
        are_alike: true,
    };
    let voting = Voting {
        trusted: ["token-6".to_owned()].into(),
        ..Voting::default()
    };
    for seed in 1..=4 {
        let end = calibrate(&case, &seven(), liars, &rule(1.0, voting.clone()), seed);
        assert!(
            end.is_right && (end.found, end.accused) == (4, 0),
            "seed {seed}: {end:?}"
        );
    }
}
