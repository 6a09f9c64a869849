//! Left and right, the mirrored half, and the start on the grid.

use crate::scene::{both, grousered, max_abs, range, smooth};
use crate::support::assert_near;

#[test]
fn a_straight_wheel_has_no_lateral_force() {
    for mut track in both() {
        track.settings.both_halves = true;
        let largest = max_abs(&track.roll().history.lateral_force_n);
        assert!(largest < 1e-9, "{largest} N");
    }
}

#[test]
fn both_halves_agree_with_one_mirrored() {
    // Sums in another order differ in the last bits, so the search for the balance may end at another trial within 0.1 % of
    // the load, which the soil remembers.
    for (mut track, bound) in both().into_iter().zip([1e-6, 5e-3]) {
        let half = track.averages();
        track.settings.both_halves = true;
        let whole = track.averages();
        assert_near(&half, &whole, [bound * 100.0, bound * 12.5, 2.0 * bound]);
        assert!(half.nodes_in_contact.abs_diff(whole.nodes_in_contact) <= 4);
    }
}

#[test]
fn slip_angles_mirror_each_other() {
    for mut track in both() {
        track.case.condition.slip_angle_rad = 0.15;
        let left = track.averages();
        track.case.condition.slip_angle_rad = -0.15;
        let right = track.averages();
        // the wheel on lanes in reverse order agrees within the search's tolerance
        assert!(left.lateral_force_n > 20.0, "{left:?}");
        assert!(
            (left.lateral_force_n + right.lateral_force_n).abs() < 0.3,
            "{right:?}"
        );
        assert_near(&left, &right, [0.3, f64::INFINITY, 0.01]);
    }
}

#[test]
fn a_small_slip_angle_joins_on_to_none() {
    // The terrain then has both halves and room to drift; only the end of a search differs.
    for (mut track, bound) in both().into_iter().zip([1e-3, 5e-3]) {
        for k_c in [0.0, 2e4] {
            track.case.soil.k_c = k_c;
            track.case.condition.slip_angle_rad = 0.0;
            let straight = track.averages();
            for angle in [1e-6, 1e-3] {
                track.case.condition.slip_angle_rad = angle;
                let angled = track.averages();
                assert_near(&straight, &angled, [bound * 100.0, f64::INFINITY, 3.0 * bound]);
                assert!(
                    (straight.b_eff_m / angled.b_eff_m - 1.0).abs() < 0.05,
                    "{angled:?}"
                );
            }
        }
    }
}

#[test]
fn averages_of_a_smooth_wheel_do_not_depend_on_their_start_on_the_grid() {
    // columns of 4 mm, begun 1, 2 and 3 mm later
    let track = smooth(0.2, 100.0, 30.0);
    let average = |shift: f64| track.clone().for_a_travel_of(0.3 + shift, 0.08).averages();
    for shift in [1e-3, 2e-3, 3e-3] {
        // with a window of whole columns only the search's tolerance differs
        assert_near(&average(0.0), &average(shift), [0.05, 0.005, 2e-3]);
    }
}

#[test]
fn another_phase_of_the_grousers_on_the_grid_gives_the_same_means() {
    // spacings near 4 mm shift every grouser relative to the columns
    let runs = [3.9e-3, 3.95e-3, 4e-3, 4.05e-3, 4.1e-3].map(|spacing| {
        let mut track = grousered(0.2);
        track.settings.dem_spacing_m = spacing;
        track.for_a_travel_of(0.5, 0.263).averages()
    });
    // a fifth of the noise of an experiment: 1.2 N, 0.15 N m, 0.4 mm
    assert!(range(&runs.map(|run| run.drawbar_pull_n)) < 0.5, "{runs:?}");
    assert!(range(&runs.map(|run| run.torque_n_m)) < 0.03, "{runs:?}");
    assert!(range(&runs.map(|run| run.sinkage_m)) < 1e-4, "{runs:?}");
}

#[test]
fn the_same_run_gives_the_same_bits() {
    for mut track in both() {
        track.case.condition.slip_angle_rad = 0.1;
        track.enter_displacement_law(0.01);
        assert_eq!(track.roll(), track.roll());
    }
}
