//! A hub that moves under its mass, compared with one in balance.

use crate::scene::{Track, smooth};
use crate::support::base;
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
    for (track, sinkage) in [
        (smooth(0.2, 100.0, 30.0), 0.01),
        (Track::with_grousers(base(0.2, 100.0, 30.0)), 0.03),
    ] {
        let track = track.for_a_travel_of(0.2, 0.105);
        let (got, expected) = (dynamic(track.clone(), 2000.0).averages(), track.averages());
        assert!(
            (got.drawbar_pull_n - expected.drawbar_pull_n).abs() < 1.0,
            "{got:?} {expected:?}"
        );
        assert!(
            (got.torque_n_m - expected.torque_n_m).abs() < 0.125,
            "{got:?} {expected:?}"
        );
        assert!(
            (got.sinkage_m / expected.sinkage_m - 1.0).abs() < sinkage,
            "{got:?} {expected:?}"
        );
    }
}

#[test]
fn damping_does_not_change_the_means() {
    let track = smooth(0.2, 100.0, 30.0).for_a_travel_of(0.12, 0.05);
    let means = [500.0, 1000.0, 3000.0].map(|damping| dynamic(track.clone(), damping).averages());
    for pair in means.windows(2) {
        assert!(
            (pair[0].drawbar_pull_n - pair[1].drawbar_pull_n).abs() < 0.2,
            "{means:?}"
        );
        assert!(
            (pair[0].sinkage_m / pair[1].sinkage_m - 1.0).abs() < 5e-3,
            "{means:?}"
        );
    }
}

#[test]
fn a_hub_with_mass_comes_to_carry_its_load_and_to_rest() {
    let run = dynamic(smooth(0.2, 100.0, 30.0), 1000.0)
        .for_a_travel_of(0.12, 0.05)
        .roll();
    let swing = |part: &[f64]| {
        let (low, high) = part
            .iter()
            .fold((f64::MAX, f64::MIN), |(low, high), &x| (low.min(x), high.max(x)));
        high - low
    };
    // in steady motion the grid makes the soil's force oscillate about the load
    let load = &run.history.wheel_load_n;
    let last = &load[load.len() * 3 / 4..];
    let mean = last.iter().sum::<f64>() / last.len() as f64;
    assert!((mean - 100.0).abs() < 0.1, "{mean}");
    let sinkage = &run.history.sinkage_m;
    let (start, end) = sinkage.split_at(sinkage.len() / 2);
    assert!(swing(end) < 0.2 * swing(start), "{} {}", swing(start), swing(end));
}
