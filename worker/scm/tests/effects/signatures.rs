//! The change of a run by each effect of the catalogue.

use crate::support::base;
use crate::validation::{self, effects};

#[test]
fn effects_agree_with_another_implementation() {
    let rows = validation::rows(effects::add);
    let failed: Vec<_> = rows.iter().filter(|row| !row.passes()).collect();
    assert!(rows.len() > 600 && failed.is_empty(), "{failed:#?}");
}

#[test]
fn the_peak_ahead_of_the_axle_sinks_the_wheel_as_wong_and_reece_have_it() {
    // integrated by 4,000 strips in exact angles, without the model and its quadrature
    let (before, after) = ([51.324, 8.9712, 7.2286], [45.936, 8.9134, 8.3553]);
    let case = base(0.2, 150.0, 30.0);
    let plain = case.simulate();
    let run = effects::with_effect(&case, "peak_pressure_angle", "front_share", 0.4, &effects::SITE);
    for (got, expected) in [(plain, before), (run, after)] {
        let got = [got.drawbar_pull_n, got.torque_n_m, 1e3 * got.sinkage_m];
        for (got, expected) in got.into_iter().zip(expected) {
            assert!((got / expected - 1.0).abs() < 3e-4, "{got} for {expected}");
        }
    }
}
