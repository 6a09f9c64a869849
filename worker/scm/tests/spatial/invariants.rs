//! Invariants that hold for all parameters.

use crate::scene::{Track, bars};
use crate::support::Draws;
use scm::Rejection;
use scm::spatial::{Displacement, Shape};

const RUNS: u64 = 120;

/// Returns a random case: half of them with grousers, a third with a displacement law, with a random flow of soil.
fn random(seed: u64) -> Track {
    let mut draws = Draws(seed);
    let case = draws.case();
    let mut track = Track::smooth(case);
    let radius = case.wheel.radius_m;
    if draws.uniform(0.0, 1.0) < 0.5 {
        let (count, height) = (draws.uniform(6.0, 24.0) as u32, draws.uniform(0.02, 0.1));
        let thickness = draws.uniform(0.01, 0.05);
        track.shape = Shape::Rim(bars(count, radius * height, radius * thickness));
    }
    track.ground.flow_fraction = draws.uniform(0.0, 0.5);
    track.ground.bearing_credit = draws.uniform(0.0, 0.5);
    track.ground.elastic_stiffness_pa_m = draws.log_uniform(1e8, 1e10);
    if draws.uniform(0.0, 1.0) < 0.3 {
        track.enter_displacement_law(draws.log_uniform(1e-3, 3e-2));
        if draws.uniform(0.0, 1.0) < 0.5 {
            track.settings.displacement = Displacement::Node;
        }
    }
    track.settings.dem_spacing_m = case.wheel.width_m / 16.0;
    track.end_steady(0.02, 1.5 * radius);
    track
}

#[test]
fn random_cases_put_power_into_the_soil_carry_the_load_and_are_finite() {
    let (mut answered, mut jumps) = (0, 0);
    for seed in 0..RUNS {
        let track = random(seed * 0x9e37_79b9 + 1);
        let load = track.case.condition.wheel_load_n;
        let run = match track.try_roll() {
            Ok(run) => run,
            Err(Rejection::NoSupport { max_carried_n, .. }) => {
                assert!(max_carried_n < load, "{max_carried_n}: {track:?}");
                continue;
            }
            // The load jumps where patches join, and with a negative k_c where k* is zero.
            Err(Rejection::NoConvergence { .. }) => {
                jumps += u64::from(track.case.soil.k_c >= 0.0);
                continue;
            }
            // the model's own checks of energy and finiteness hold
            Err(rejection) => panic!("{rejection}: {track:?}"),
        };
        answered += 1;
        let got = &run.averages;
        let power = run.dissipated_power_w;
        assert!(power >= 0.0, "{power} W: {track:?}");
        assert!(got.residual_load_n <= 0.025 * load, "{got:?}: {track:?}");
        for history in run.history.channels() {
            assert_eq!(history.len(), run.history.len());
            assert!(history.iter().all(|x| x.is_finite()), "{track:?}");
        }
        assert!(got.nodes_in_contact >= 8 && got.contact_length_m > 0.0 && got.b_eff_m > 0.0);
        assert!(got.sinkage_m < track.case.wheel.radius_m);
    }
    assert!(jumps <= RUNS / 50, "{jumps} of {RUNS} runs jump past their load");
    assert!(
        answered > RUNS * 3 / 4,
        "{answered} of {RUNS} runs have an answer"
    );
}
