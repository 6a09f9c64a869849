//! The limits of the quasi-static model with grousers.

use scm::effects::{Active, Site};
use scm::quasi_static::{self, StraightGrousers};
use scm::{Averages, Rejection, Wheel};

use crate::support::{Case, Draws, assert_near, base, compiled, law};

const NONE: StraightGrousers = StraightGrousers {
    count: 12,
    height_m: 0.0,
    thickness_m: 0.002,
};

fn roll_with(case: &Case, grousers: &StraightGrousers, effects: &mut Active) -> Result<Averages, Rejection> {
    let (soil, wheel, condition) = (&case.soil, &case.wheel, &case.condition);
    quasi_static::simulate_with_grousers(soil, wheel, grousers, condition, effects, &Site::default())
}

fn try_roll(case: &Case, grousers: &StraightGrousers) -> Result<Averages, Rejection> {
    roll_with(case, grousers, &mut Active::default())
}

fn roll(case: &Case, grousers: &StraightGrousers) -> Averages {
    try_roll(case, grousers).unwrap_or_else(|rejection| panic!("{rejection}: {case:?} {grousers:?}"))
}

fn bars(count: u32, height_m: f64) -> StraightGrousers {
    StraightGrousers {
        count,
        height_m,
        ..NONE
    }
}

#[test]
fn without_count_or_height_the_wheel_is_smooth_bit_for_bit() {
    let mut draws = Draws(7);
    for _ in 0..200 {
        let case = draws.case();
        let smooth = case.try_simulate();
        for grousers in [NONE, bars(0, 0.009)] {
            assert_eq!(try_roll(&case, &grousers), smooth, "{case:?}");
        }
    }
}

#[test]
fn low_grousers_make_a_smooth_wheel() {
    for slip in [-0.6, -0.05, 0.05, 0.4, 0.8] {
        let case = base(slip, 100.0, 30.0);
        let (low, smooth) = (roll(&case, &bars(12, 1e-7)), case.simulate());
        assert_near(&low, &smooth, [0.2, 0.025, 2e-3]);
    }
}

/// Grousers fill the whole rim: tips cover R / (R + h) of their circumference, without gaps.
#[test]
fn grousers_side_by_side_make_a_smooth_wheel_of_their_tips() {
    for slip in [0.05, 0.2, 0.6] {
        let case = base(slip, 100.0, 30.0);
        let count = 392;
        let grousers = bars(count, 0.009);
        let tips = case.wheel.radius_m + grousers.height_m;
        let share = f64::from(count) * grousers.thickness_m / (core::f64::consts::TAU * tips);
        let mut smooth = case;
        smooth.wheel = Wheel {
            radius_m: tips,
            ..case.wheel
        };
        smooth.condition.wheel_load_n /= share;
        let (got, expected) = (roll(&case, &grousers), smooth.simulate());
        let load = case.condition.wheel_load_n;
        let expected = Averages {
            drawbar_pull_n: share * expected.drawbar_pull_n,
            torque_n_m: share * expected.torque_n_m,
            sinkage_m: expected.sinkage_m - grousers.height_m,
            ..expected
        };
        assert_near(&got, &expected, [1e-3 * load, 1e-3 * load * tips, f64::INFINITY]);
        assert!((got.sinkage_m - expected.sinkage_m).abs() < 1e-5, "{slip}");
    }
}

#[test]
fn the_more_grousers_the_more_a_rolling_wheel_pulls() {
    let case = base(0.05, 100.0, 30.0);
    let runs = [0, 6, 12, 24, 48, 96, 300].map(|count| roll(&case, &bars(count, 0.009)));
    for pair in runs.windows(2) {
        assert!(pair[1].torque_n_m > pair[0].torque_n_m, "{pair:?}");
        assert!(pair[1].drawbar_pull_n > pair[0].drawbar_pull_n, "{pair:?}");
    }
    // many enough to carry the wheel alone
    assert!(runs[6].sinkage_m < 0.0, "{:?}", runs[6]);
}

#[test]
fn the_higher_the_slip_the_deeper_grousers_dig() {
    let at = |slip| roll(&base(slip, 100.0, 30.0), &bars(12, 0.009)).sinkage_m;
    let sinkages = [0.05, 0.2, 0.4, 0.6, 0.8].map(at);
    assert!(sinkages.is_sorted(), "{sinkages:?}");
    let smooth = base(0.8, 100.0, 30.0).simulate().sinkage_m;
    assert!(sinkages[4] > 3.0 * smooth, "{sinkages:?} {smooth}");
}

#[test]
fn every_draw_has_a_balance_or_a_reason() {
    let mut draws = Draws(11);
    let mut balanced = 0;
    for _ in 0..1_000 {
        let case = draws.case();
        let grousers = StraightGrousers {
            count: draws.uniform(4.0, 40.0) as u32,
            height_m: 0.12 * case.wheel.radius_m * draws.uniform(0.05, 1.0),
            thickness_m: draws.uniform(2e-4, 3e-3),
        };
        match try_roll(&case, &grousers) {
            Ok(averages) => {
                assert!(averages.residual_load_n.abs() < 1e-6 * case.condition.wheel_load_n);
                balanced += 1;
            }
            Err(Rejection::NoSupport { .. }) => {}
            // k* is zero at some footprint
            Err(Rejection::NoConvergence { .. }) if case.soil.k_c < 0.0 => {}
            Err(rejection) => panic!("{rejection}: {case:?} {grousers:?}"),
        }
    }
    assert!(balanced > 700, "{balanced}");
}

#[test]
fn grousers_have_bounds_and_neither_rebound_nor_a_flat() {
    let case = base(0.2, 100.0, 30.0);
    let thin = StraightGrousers {
        thickness_m: 0.0,
        ..bars(12, 0.009)
    };
    for grousers in [bars(12, 0.2), bars(12, f64::NAN), bars(4_000, 0.009), thin] {
        let kind = try_roll(&case, &grousers).map_err(|rejection| rejection.kind());
        assert_eq!(kind, Err("invalid_parameter"), "{grousers:?}");
    }
    for name in ["elastic_rebound", "wheel_flexibility"] {
        let effect = formula::catalogue::find(name).expect("in the catalogue");
        let values = effect.parameters.iter().map(|_| 1e-7).collect();
        let got = roll_with(
            &case,
            &bars(12, 0.009),
            &mut compiled([effect]).activate([values]),
        );
        assert_eq!(
            got.map_err(|rejection| rejection.kind()),
            Err("invalid_parameter")
        );
    }
}

#[test]
fn formulas_see_every_surface() {
    // a law that changes nothing uses the same panels, so the results agree to rounding
    let case = base(-0.1, 100.0, 30.0);
    let law = law(
        "shear = \"tau * (1 + a * 0 * (j / radius + z / radius + v_n / sled_speed + position))\"\n\
                   [parameters.a]\nunit = \"1\"\nneutral = 0\nprior = 0.1",
    );
    let laws = compiled([&law]);
    let got = roll_with(&case, &bars(12, 0.009), &mut laws.activate([vec![1.0]])).expect("a balance");
    let plain = roll(&case, &bars(12, 0.009));
    assert_near(&got, &plain, [1e-6, f64::INFINITY, 1e-7]);
}
