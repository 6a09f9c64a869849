//! A hub that moves under its mass, compared with one in balance.

use crate::scene::{Track, both, range, smooth};
use crate::support::assert_near;
use scm::spatial::Vertical;

fn dynamic(mut track: Track, damping_n_s_m: f64) -> Track {
    track.settings.vertical = Vertical::Dynamic {
        damping_n_s_m,
        gravity_m_s2: 9.81,
    };
    track
}

#[test]
fn means_of_a_hub_with_mass_are_those_of_the_balance() {
    // 1 % of load, of load times radius and of the sinkage for a smooth wheel; soil pressed by bounces stays pressed, which
    // with grousers costs 2 to 3 %
    for (track, sinkage) in both().into_iter().zip([0.01, 0.03]) {
        let track = track.for_a_travel_of(0.2, 0.105);
        let (got, expected) = (dynamic(track.clone(), 2000.0).averages(), track.averages());
        assert_near(&got, &expected, [1.0, 0.125, sinkage]);
    }
}

#[test]
fn damping_does_not_change_the_means() {
    let track = smooth(0.2, 100.0, 30.0).for_a_travel_of(0.12, 0.05);
    let means = [500.0, 1000.0, 3000.0].map(|damping| dynamic(track.clone(), damping).averages());
    for pair in means.windows(2) {
        assert_near(&pair[0], &pair[1], [0.2, f64::INFINITY, 5e-3]);
    }
}

#[test]
fn a_hub_with_mass_comes_to_carry_its_load_and_to_rest() {
    let track = smooth(0.2, 100.0, 30.0).for_a_travel_of(0.12, 0.05);
    let run = dynamic(track, 1000.0).roll();
    // in steady motion the grid makes the soil's force oscillate about the load
    let load = &run.history.wheel_load_n;
    let last = &load[load.len() * 3 / 4..];
    let mean = last.iter().sum::<f64>() / last.len() as f64;
    assert!((mean - 100.0).abs() < 0.1, "{mean}");
    let sinkage = &run.history.sinkage_m;
    let (start, end) = sinkage.split_at(sinkage.len() / 2);
    let (start, end) = (range(start), range(end));
    assert!(end < 0.2 * start, "{start} {end}");
}
