//! Tests of calibrations whose step is being taken on another thread.

use farm::calibration::Step;
use farm::{Control, Farm};
use record::{Fact, SealKey};
use shared::api::CalibrationState;
use shared::exchange::{ExchangeRequest, Lease, WorkResult};

use super::simulation::world::case::{Case, EQUATIONS, Kind};
use super::simulation::world::request::bare;

const KEY: SealKey = SealKey([1; 16]);

fn case() -> Case {
    Case::new(Kind::Sample, 1).expect("the job is valid")
}

fn ask(farm: &mut Farm) -> Vec<Lease> {
    let question = ExchangeRequest {
        want: 1_000,
        ..bare("a".into(), EQUATIONS)
    };
    farm.exchange(question, 0).leases
}

/// Answers leases. Returns the number of results that changed nothing.
fn answer(farm: &mut Farm, case: &Case, leases: &[Lease]) -> u32 {
    let result = |lease: &Lease| WorkResult {
        lease: lease.lease,
        calibration: lease.calibration,
        evaluation: lease.evaluation,
        seal: lease.seal.clone(),
        outcome: case.answers[&lease.evaluation].outcome.clone(),
        repeated: None,
    };
    let answered = ExchangeRequest {
        results: leases.iter().map(result).collect(),
        received: u64::MAX,
        ..bare("a".into(), EQUATIONS)
    };
    farm.exchange(answered, 0).duplicates
}

/// Makes a farm whose calibration has all results of its first round. Returns its step, and the leases of the round.
fn stepping(case: &Case) -> (Farm, Step, Vec<Lease>) {
    let mut farm = Farm::new(1, 1_000);
    farm.add(case.begin(1).expect("the job is valid"), KEY, Vec::new(), 0);
    let leases = ask(&mut farm);
    assert_eq!(answer(&mut farm, case, &leases), 0);
    let step = farm.take_steps().pop().expect("the round is over");
    assert!(farm.take_steps().is_empty(), "each step is handed out once");
    farm.take_facts();
    (farm, step, leases)
}

/// Returns what the second round asks where nothing disturbs the step.
fn second_round(case: &Case) -> Vec<(u64, Vec<f64>)> {
    let (mut farm, step, _) = stepping(case);
    farm.stepped(step.run(), 0);
    questions(&ask(&mut farm))
}

fn questions(leases: &[Lease]) -> Vec<(u64, Vec<f64>)> {
    leases
        .iter()
        .map(|lease| (lease.evaluation, lease.theta.clone()))
        .collect()
}

#[test]
fn nothing_is_asked_while_a_step_is_taken_and_late_results_are_duplicates() {
    let case = case();
    let (mut farm, step, leases) = stepping(&case);
    assert!(!farm.has_work() && ask(&mut farm).is_empty());
    assert_eq!(farm.metrics().stepping, 1);
    let status = farm.status(1, 0).expect("it is in progress");
    let progress = status.progress.expect("a calibration in progress has one");
    assert_eq!(
        (status.state, progress.evaluations),
        (CalibrationState::Running, leases.len() as u64)
    );
    assert_eq!(answer(&mut farm, &case, &leases), leases.len() as u32);
    farm.tick(10_000);
    farm.stepped(step.run(), 10_000);
    assert_eq!(questions(&ask(&mut farm)), second_round(&case));
}

#[test]
fn a_calibration_that_is_cancelled_during_its_step_gets_nothing_of_it() {
    let case = case();
    let (mut farm, step, _) = stepping(&case);
    farm.control(1, Control::Cancel, 0).expect("it is in progress");
    farm.take_facts();
    farm.stepped(step.run(), 0);
    assert!(farm.take_facts().is_empty() && farm.status(1, 0).is_none() && ask(&mut farm).is_empty());
}

#[test]
fn a_pause_during_a_step_lasts_and_the_next_round_has_the_same_bits_after_it() {
    let case = case();
    let resume = Control::Resume { skip_faults: true };
    for resumes_first in [true, false] {
        let (mut farm, step, _) = stepping(&case);
        farm.control(1, Control::Pause, 0).expect("it runs");
        if resumes_first {
            farm.control(1, resume.clone(), 0).expect("it is paused");
        }
        farm.stepped(step.run(), 0);
        if !resumes_first {
            assert!(ask(&mut farm).is_empty(), "a paused calibration leases nothing");
            farm.control(1, resume.clone(), 0).expect("it is paused");
        }
        assert_eq!(questions(&ask(&mut farm)), second_round(&case));
    }
}

#[test]
fn a_calibration_that_was_replayed_during_its_step_takes_its_own_step() {
    let case = case();
    let (mut farm, step, first) = stepping(&case);
    farm.add(case.begin(1).expect("the job is valid"), KEY, Vec::new(), 0);
    let stepped = step.run();
    let leases = ask(&mut farm);
    assert_eq!(questions(&leases), questions(&first), "it begins anew");
    answer(&mut farm, &case, &leases);
    let own = farm.take_steps().pop().expect("the round is over");
    farm.take_facts();
    farm.stepped(stepped, 0);
    assert!(
        farm.take_facts().is_empty() && ask(&mut farm).is_empty(),
        "the old step is not its own"
    );
    farm.stepped(own.run(), 0);
    assert_eq!(questions(&ask(&mut farm)), second_round(&case));
}

#[test]
fn a_step_that_fails_pauses_and_a_user_who_resumes_asks_for_a_replay() {
    let case = case();
    let (mut farm, step, _) = stepping(&case);
    farm.step_failed(1, step.number() + 1, "of another step");
    assert!(farm.take_facts().is_empty());
    farm.step_failed(1, step.number(), "a bug");
    let facts = farm.take_facts();
    let is_pause = |fact: &Fact| matches!(fact, Fact::State { state: CalibrationState::Paused, message: Some(text), .. } if text.ends_with("a bug"));
    assert!(facts.len() == 1 && is_pause(&facts[0]), "{facts:?}");
    let resume = Control::Resume { skip_faults: false };
    farm.control(1, resume, 0).expect("it is paused");
    assert_eq!(farm.take_rewinds(), [1]);
    farm.take_facts();
    farm.rewind_failed(1, "a gap");
    assert_eq!(
        message(&farm),
        "the calibration whose next round could not be proposed cannot be replayed: a gap"
    );
}

#[test]
fn a_failed_replay_names_its_cause() {
    let case = case();
    let (mut farm, ..) = stepping(&case);
    let other = ExchangeRequest {
        want: 1,
        ..bare("b".into(), "scm-8")
    };
    farm.exchange(other, 0);
    farm.control(1, Control::ComputeWith("scm-8".into()), 0)
        .expect("a worker computes it");
    farm.rewind_failed(1, "a gap");
    assert_eq!(
        message(&farm),
        "results of another version of the equations were dropped, but the calibration cannot be replayed: a gap"
    );
}

#[test]
fn a_step_is_awaited_until_its_calibration_is_replayed_or_over() {
    let case = case();
    let (mut farm, step, _) = stepping(&case);
    assert!(farm.awaits_step(1, step.number()) && !farm.awaits_step(1, step.number() + 1));
    farm.add(case.begin(1).expect("the job is valid"), KEY, Vec::new(), 0);
    assert!(!farm.awaits_step(1, step.number()), "it is replayed");
    let (mut farm, step, _) = stepping(&case);
    farm.control(1, Control::Cancel, 0).expect("it is in progress");
    assert!(!farm.awaits_step(1, step.number()), "it is over");
}

fn message(farm: &Farm) -> String {
    let status = farm.status(1, 0).expect("it is in progress");
    status.message.unwrap_or_default()
}
