//! Some trials of the bench `hidden_effect`: a hidden effect is found, and without a hidden effect nothing is claimed.

use discovery::SearchVerdict;

use benchmark::hidden_effect::reference;
use benchmark::hidden_effect::rig::untryable::{self, Answer};
use benchmark::hidden_effect::rig::{self, Flaw};
use benchmark::hidden_effect::study::case::SyntheticCase;
use benchmark::hidden_effect::study::draw::{
    NAMED, draw, draw_beyond_library, draw_combination, draw_in_sessions, draw_misstated, draw_named,
};
use benchmark::hidden_effect::study::geometry::Misstatement;
use benchmark::hidden_effect::study::kind::HiddenKind;
use benchmark::hidden_effect::study::laws::HiddenLaw;
use benchmark::hidden_effect::study::noise_free::MIN_SEPARATION;
use benchmark::hidden_effect::study::score::TrialScore;
use benchmark::hidden_effect::study::session::SessionError;
use benchmark::hidden_effect::study::tally::Tally;
use benchmark::hidden_effect::study::trial::search;
use benchmark::parallel::each;

const SEED: u64 = 1;
const ONE: [&str; 6] = [
    "slip_sinkage",
    "rate_dependent_pressure",
    "janosi_hanamoto",
    "multipass_hardening",
    "sled_tare",
    "sled_drag",
];
/// The numbers of air in the pores, a wave over slip, and a peak of shear over slip.
const OUTSIDE: [u64; 3] = [2, 5, 10];
/// The numbers of a reference velocity with slip-softened pressure, and of a peak of the pressure with friction of the rim.
const TWO: [u64; 2] = [3, 15];

/// Laws, each with an effect beside it.
const OUTLIB: [&[&str]; 2] = [&["shaken_bed", "elastic_rebound"], &["slip_wave", "sled_tare"]];
const TRIPLE: [&[&str]; 1] = [&["sled_tare", "stick_slip", "slip_sinkage"]];
const SPARSE: [&[&str]; 2] = [&["peak_pressure_angle"], &["slip_sinkage"]];
const HEAVY: [&[&str]; 2] = [&["sled_tare"], &["stretched_mobilisation"]];

fn scores(kind: HiddenKind, numbers: &[u64]) -> Vec<TrialScore> {
    let one = |place: u64| {
        let number = numbers[place as usize];
        search(kind, &draw(kind, SEED, number)?, number)
    };
    let scores = each(numbers.len() as u64, one);
    scores.expect("every experiment is searched")
}

fn drawn(effect: &str) -> SyntheticCase {
    draw_named(effect, SEED).expect("the model takes a draw")
}

/// Searches experiments in which these effects and laws act together.
fn combined(kind: HiddenKind, hidden: &[&[&str]]) -> Vec<TrialScore> {
    let one = |place: u64| {
        search(
            kind,
            &draw_combination(kind, hidden[place as usize], SEED)?,
            place,
        )
    };
    each(hidden.len() as u64, one).expect("every experiment is searched")
}

fn wrong_claims(scores: &[TrialScore]) -> usize {
    count(scores, |f| f.is_claimed && !f.claim_is_right)
}

fn count(scores: &[TrialScore], holds: impl Fn(&TrialScore) -> bool) -> usize {
    scores.iter().filter(|score| holds(score)).count()
}

#[test]
fn an_effect_is_named_and_the_error_falls() {
    let one = |place: u64| search(HiddenKind::One, &drawn(ONE[place as usize]), place);
    let scores = each(ONE.len() as u64, one).expect("every experiment is searched");
    let shown = Tally(&scores).to_string();
    assert!(count(&scores, |f| f.separation >= MIN_SEPARATION) >= 5, "{shown}");
    assert!(count(&scores, |f| f.is_right && f.is_covered) >= 5, "{shown}");
    assert!(scores.iter().all(|f| f.is_in_two), "{shown}");
    assert_eq!(
        count(&scores, |f| f.is_claimed && !f.claim_is_right),
        0,
        "{shown}"
    );
    let [before, after] = [
        scores.iter().map(|f| f.held_out.before).sum::<f64>(),
        scores.iter().map(|f| f.held_out.after).sum::<f64>(),
    ];
    assert!(after < 0.25 * before, "{shown}");
    for score in &scores {
        assert!(score.held_out.after < score.held_out.before, "{score}");
        // The mean is two thirds of these bounds. Sampling doubtful evidences is most expensive with several effects.
        assert!(score.to_name <= 900 && score.to_confirm <= 4000, "{score}");
    }
}

#[test]
fn where_nothing_is_missing_nothing_is_claimed() {
    let scores = scores(HiddenKind::None, &[0, 1, 2, 3, 4, 5]);
    let shown = Tally(&scores).to_string();
    assert_eq!(count(&scores, |f| f.is_claimed), 0, "{shown}");
    let open = count(&scores, |f| f.verdict == SearchVerdict::NothingDetectable);
    assert!(open >= 5, "{shown}");
}

#[test]
fn noise_stated_too_small_is_not_taken_for_nothing_missing() {
    let mut case = draw(HiddenKind::None, SEED, 0).expect("the model takes a draw");
    case.sds = case.sds.map(|sd| sd / 3.0);
    let score = search(HiddenKind::None, &case, 0).expect("it is searched");
    assert_ne!(score.verdict, SearchVerdict::NothingDetectable, "{score}");
}

#[test]
fn a_law_of_no_library_is_said_to_be_outside() {
    let scores = scores(HiddenKind::Outside, &OUTSIDE);
    let shown = Tally(&scores).to_string();
    assert!(count(&scores, TrialScore::is_outside) >= 2, "{shown}");
    assert!(count(&scores, |f| f.quantity) >= 2, "{shown}");
}

#[test]
fn of_two_effects_both_are_named() {
    let scores = scores(HiddenKind::Two, &TWO);
    let shown = Tally(&scores).to_string();
    assert!(count(&scores, |f| f.is_exact) >= 1, "{shown}");
    assert_eq!(count(&scores, |f| f.is_outside()), 0, "{shown}");
}

#[test]
fn of_three_effects_the_first_name_is_one() {
    let scores = combined(HiddenKind::Triple, &TRIPLE);
    let shown = Tally(&scores).to_string();
    assert_eq!(count(&scores, |f| f.claim_is_right), 1, "{shown}");
}

#[test]
fn beside_a_law_no_effect_is_named_that_is_not_hidden() {
    let scores = combined(HiddenKind::Outlib, &OUTLIB);
    let shown = Tally(&scores).to_string();
    let is_wrong = |f: &TrialScore| f.is_claimed && !f.is_outside() && !f.claim_is_right;
    assert_eq!(count(&scores, is_wrong), 0, "{shown}");
    assert!(count(&scores, |f| f.claim_is_right) >= 1, "{shown}");
}

#[test]
fn of_a_law_of_two_variables_the_quantity_is_found() {
    let law = HiddenLaw::find("loaded_chain").expect("it is a law of the benchmark");
    let case = draw_beyond_library(law, SEED, NAMED).expect("the model takes a draw");
    let score = search(HiddenKind::Twovar, &case, 0).expect("it is searched");
    assert!(score.is_outside() && score.quantity, "{score}");
}

#[test]
fn a_wrong_dimension_is_taken_for_no_other_effect() {
    let one = |place: u64| {
        let case = draw_misstated(Misstatement::ALL[place as usize], SEED, NAMED + place)?;
        search(HiddenKind::Geometry, &case, place)
    };
    let scores = each(Misstatement::ALL.len() as u64, one).expect("every experiment is searched");
    let shown = Tally(&scores).to_string();
    assert_eq!(wrong_claims(&scores), 0, "{shown}");
    // A wrong radius of the wheel is the only one of these that the data determine well.
    let radius = |f: &TrialScore| f.hidden == "wheel_radius_error" && f.claim_is_right;
    assert_eq!(count(&scores, radius), 2, "{shown}");
}

#[test]
fn of_eight_runs_and_of_noise_with_heavy_tails_nothing_wrong_is_claimed() {
    let sparse = combined(HiddenKind::Sparse, &SPARSE);
    let scores = [sparse, combined(HiddenKind::Heavy, &HEAVY)].concat();
    let shown = Tally(&scores).to_string();
    assert_eq!(wrong_claims(&scores), 0, "{shown}");
    assert!(count(&scores, |f| f.claim_is_right) >= 3, "{shown}");
}

#[test]
fn an_error_of_the_sessions_is_taken_for_no_effect() {
    let hidden = [
        (SessionError::Offset(0), None),
        (SessionError::Stiffness, None),
        (SessionError::Offset(0), Some("slip_sinkage")),
    ];
    let one = |place: u64| {
        let (error, effect) = hidden[place as usize];
        search(
            HiddenKind::Session,
            &draw_in_sessions(error, effect, SEED)?,
            place,
        )
    };
    let scores = each(hidden.len() as u64, one).expect("every experiment is searched");
    let shown = Tally(&scores).to_string();
    assert_eq!(wrong_claims(&scores), 0, "{shown}");
    assert_eq!(count(&scores, |f| f.claim_is_right), 1, "{shown}");
}

#[test]
fn a_truth_that_is_swapped_for_another_is_not_found() {
    let mut case = drawn(ONE[0]);
    case.hidden = drawn(ONE[1]).hidden;
    let score = search(HiddenKind::One, &case, 0).expect("it is searched");
    assert!(!score.is_right && !score.claim_is_right, "{score}");
}

#[test]
fn a_rig_that_states_its_order_and_preparations_is_not_taken_for_physics() {
    let [sorted, random] = Flaw::DRIFTS;
    for flaw in [sorted, random, Flaw::Preparations, Flaw::Understated] {
        let tally = rig::stated(flaw, 0..2, SEED).expect("every campaign is searched");
        assert_eq!(tally.false_claims(), 0, "{tally}");
    }
}

#[test]
fn where_the_truth_cannot_be_tried_no_stand_in_is_named() {
    for number in 0..2 {
        let (answer, line) = untryable::one(SEED, number).expect("it is searched");
        assert_ne!(answer, Answer::StandIn, "{line}");
    }
}

#[test]
fn what_changed_since_a_reference_campaign_is_named_and_nothing_else() {
    let changed = reference::named("slip_sinkage", SEED).expect("both campaigns are searched");
    assert_eq!(changed.is_right(), Some(true), "{}", changed.line(0));
    let unchanged = reference::one(SEED, 3).expect("both campaigns are searched");
    assert_eq!(unchanged.is_right(), None, "{}", unchanged.line(3));
}
