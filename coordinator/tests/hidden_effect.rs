//! A slice of the bench `hidden_effect`: what is hidden is found, and where nothing is, nothing is claimed.

#[expect(dead_code, reason = "the bench uses more of it")]
#[path = "../benches/hidden_effect/study/mod.rs"]
mod study;

use discovery::inquiry::Verdict;

use study::clear::CLEAR;
use study::each;
use study::fate::Fate;
use study::kind::Kind;
use study::tally::Tally;

const SEED: u64 = 1;
/// Slip-sinkage, pressure by rate, displacement of shear, hardening by passes, bulldozing, the sled's drag.
const ONE: [u64; 6] = [2, 4, 21, 44, 108, 111];
/// Air in the pores, a wave over slip, a peak of shear over slip.
const OUTSIDE: [u64; 3] = [2, 5, 10];
/// A reference velocity with slip-softened pressure, and the pressure's peak with the rim's friction.
const TWO: [u64; 2] = [3, 15];

fn fates(kind: Kind, numbers: &[u64]) -> Vec<Fate> {
    let one = |place: u64| {
        let number = numbers[place as usize];
        let case = kind.draw(SEED, number)?;
        kind.search(&case, number)
    };
    let fates = each(numbers.len() as u64, one).expect("no thread panics");
    let fates: Result<Vec<Fate>, String> = fates.into_iter().collect();
    fates.expect("every experiment is searched")
}

fn count(fates: &[Fate], holds: impl Fn(&Fate) -> bool) -> usize {
    fates.iter().filter(|fate| holds(fate)).count()
}

#[test]
fn an_effect_is_named_and_the_error_falls() {
    let fates = fates(Kind::One, &ONE);
    let shown = Tally(&fates).to_string();
    assert!(fates.iter().all(|f| f.separation >= CLEAR), "{shown}");
    assert!(count(&fates, |f| f.is_right && f.is_covered) >= 5, "{shown}");
    assert!(fates.iter().all(|f| f.is_in_two), "{shown}");
    assert_eq!(count(&fates, |f| f.is_claimed && !f.claim_is_right), 0, "{shown}");
    for fate in &fates {
        assert!(fate.held_out.after < 0.5 * fate.held_out.before, "{fate}");
        assert!(fate.to_name <= 900 && fate.to_confirm <= 3000, "{fate}");
    }
}

#[test]
fn where_nothing_is_missing_nothing_is_claimed() {
    let fates = fates(Kind::None, &[0, 1, 2, 3, 4, 5]);
    let shown = Tally(&fates).to_string();
    assert_eq!(count(&fates, |f| f.is_claimed), 0, "{shown}");
    assert!(
        count(&fates, |f| f.verdict == Verdict::NothingDetectable) >= 5,
        "{shown}"
    );
}

#[test]
fn noise_stated_too_small_is_not_taken_for_nothing_missing() {
    let mut case = Kind::None.draw(SEED, 0).expect("the model takes a draw");
    case.sds = case.sds.map(|sd| sd / 3.0);
    let fate = Kind::None.search(&case, 0).expect("it is searched");
    assert_ne!(fate.verdict, Verdict::NothingDetectable, "{fate}");
}

#[test]
fn a_law_of_no_library_is_said_to_be_outside() {
    let fates = fates(Kind::Outside, &OUTSIDE);
    let shown = Tally(&fates).to_string();
    assert!(count(&fates, Fate::is_outside) >= 2, "{shown}");
    assert!(count(&fates, |f| f.quantity) >= 2, "{shown}");
}

#[test]
fn of_two_effects_both_are_named() {
    let fates = fates(Kind::Two, &TWO);
    let shown = Tally(&fates).to_string();
    assert!(count(&fates, |f| f.is_exact) >= 1, "{shown}");
    assert_eq!(count(&fates, |f| f.is_outside()), 0, "{shown}");
}

#[test]
fn a_truth_that_is_swapped_for_another_is_not_found() {
    let mut case = Kind::One.draw(SEED, ONE[0]).expect("the model takes a draw");
    case.hidden = Kind::One
        .draw(SEED, ONE[1])
        .expect("the model takes a draw")
        .hidden;
    let fate = Kind::One.search(&case, ONE[0]).expect("it is searched");
    assert!(!fate.is_right && !fate.claim_is_right, "{fate}");
}
