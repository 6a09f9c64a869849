//! A part of the bench `stream`: recordings with changes of the soil and without.

use benchmark::posterior_use::recordings;

#[test]
fn a_recording_is_followed_through_two_changes_of_the_soil() {
    let tally = recordings::run(6, 3, true, 0.0).expect("recordings");
    let (found, missed) = tally.delays();
    assert!(missed <= 1 && found[found.len() / 2] <= 5.0, "{tally}");
    assert!((0.75..=0.99).contains(&tally.mean_coverage()), "{tally}");
    let calm = recordings::run(3, 3, false, 0.0).expect("recordings");
    assert!(calm.false_alarms() + tally.false_alarms() <= 1, "{calm}{tally}");
}
