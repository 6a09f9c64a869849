//! A slice of the bench `simulation`: the farm keeps its promises, and planted bugs are found.

#[expect(dead_code, reason = "the bench uses more of it")]
#[path = "../benches/simulation/world/mod.rs"]
pub(crate) mod world;

use world::case::Case;
use world::plant::Plant;
use world::promise::Promise;
use world::search::{Search, search};

const SCHEDULES: u64 = 2_000;

fn cases() -> Vec<Vec<Case>> {
    Case::all().expect("the jobs are valid")
}

#[test]
fn every_promise_is_kept_through_any_weather_and_the_bits_are_those_of_a_run_without_faults() {
    let Search { tally, broken, .. } = search(&cases(), None, 1..SCHEDULES + 1, None);
    assert!(
        broken.is_none(),
        "{broken:?}: cargo bench -p farm --bench simulation -- seed S"
    );
    // Every kind of fault has occurred.
    assert_eq!(tally.schedules, SCHEDULES);
    assert!(tally.finished > SCHEDULES && tally.cancelled > 0, "{tally}");
    assert!(
        tally.crashes > 500 && tally.restores > 20 && tally.deaths > 500,
        "{tally}"
    );
    assert!(
        tally.lost > 500 && tally.twice > 500 && tally.delayed > 200,
        "{tally}"
    );
    assert!(tally.forged > 500 && tally.disputes > 50, "{tally}");
}

/// A regression: an evaluation was dropped because the lease beside which it was asked had ended, and was asked again after it had been
/// leased anew.
#[test]
fn a_schedule_that_broke_a_promise_keeps_it() {
    let Search { broken, .. } = search(&cases(), None, 418_118..418_119, None);
    assert!(broken.is_none(), "{broken:?}");
}

#[test]
fn planted_bugs_are_found() {
    let cases = cases();
    // These bugs need rare sequences of events, which only the bench reaches.
    let rare = [Plant::HoleInFacts, Plant::KeyAgain];
    for plant in Plant::ALL.iter().copied().filter(|plant| !rare.contains(plant)) {
        let found = search(&cases, Some(plant), 1..SCHEDULES + 1, None).broken;
        assert!(found.is_some(), "{plant:?} is not found in {SCHEDULES} schedules");
    }
}

#[test]
fn an_answer_before_its_facts_are_on_disk_is_told_as_such() {
    let found = search(&cases(), Some(Plant::AnswerBeforeDisk), 1..SCHEDULES + 1, None).broken;
    let (_, broken) = found.expect("it is found");
    assert_eq!(broken.promise, Promise::Acknowledged, "{broken}");
}
