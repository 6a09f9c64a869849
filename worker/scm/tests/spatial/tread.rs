//! Grousers in rows, oblique, V-shaped and bent.

use super::surfaces::{Surface, across};
use crate::scene::{Track, bars, grousered};
use scm::Averages;
use scm::spatial::{Grousers, Normals, Shape, Tread};

const R: f64 = 0.125;
const B: f64 = 0.112;
const BARS: Grousers = bars(12, 0.009, 0.002);

fn straight() -> Tread {
    Tread::straight(BARS)
}

/// Rows, each shifted against the one before by a share of the pitch.
fn rows(rows: u32, stagger: f64) -> Tread {
    Tread {
        rows,
        stagger,
        ..straight()
    }
}

fn staggered() -> Tread {
    rows(2, 0.5)
}

/// Grousers at an angle to the axle, a V of another angle, and with ends in front `[m]`.
fn bent(angle_rad: f64, chevron_rad: f64, bow_m: f64) -> Tread {
    Tread {
        angle_rad,
        chevron_rad,
        bow_m,
        ..straight()
    }
}

fn chevron() -> Tread {
    bent(0.0, 20f64.to_radians(), 0.0)
}

fn oblique() -> Tread {
    bent(20f64.to_radians(), 0.0, 0.006)
}

/// Gives the grousers of each row a width `[m]`.
fn with_width(tread: Tread, width_m: f64) -> Tread {
    Tread {
        width_m: Some(width_m),
        ..tread
    }
}

fn track(shape: Shape) -> Track {
    let mut track = grousered(0.2).for_a_travel_of(0.5, 0.3);
    track.shape = shape;
    track
}

/// Differences of F, T and z, relative to W, W R and z.
fn differences(got: &Averages, expected: &Averages) -> [f64; 3] {
    [
        (got.drawbar_pull_n - expected.drawbar_pull_n) / 100.0,
        (got.torque_n_m - expected.torque_n_m) / (100.0 * R),
        got.sinkage_m / expected.sinkage_m - 1.0,
    ]
}

fn assert_near(got: &Averages, expected: &Averages, bounds: [f64; 3], what: &str) {
    let deviations = differences(got, expected);
    println!("{what}: {deviations:.5?}");
    let mut pairs = deviations.iter().zip(bounds);
    let near = pairs.all(|(difference, bound)| difference.abs() < bound);
    assert!(near, "{what}: {deviations:?}");
}

#[test]
fn bars_across_the_whole_wheel_are_straight_grousers_bit_for_bit() {
    let expected = track(Shape::Rim(BARS)).roll();
    for tread in [straight(), with_width(rows(4, 0.0), 0.25 * B), rows(1, 0.5)] {
        assert_eq!(track(Shape::Tread(tread)).roll(), expected, "{tread:?}");
    }
}

#[test]
fn little_stagger_and_small_angles_join_on_to_straight_grousers() {
    let expected = track(Shape::Rim(BARS)).averages();
    let mut whole = track(Shape::Rim(BARS));
    whole.settings.both_halves = true;
    println!("both halves: {:.5?}", differences(&whole.averages(), &expected));
    for (what, tread) in [
        ("stagger", rows(2, 1e-6)),
        ("angle", bent(1e-6, 0.0, 0.0)),
        ("chevron", bent(0.0, 1e-6, 0.0)),
        ("bow", bent(0.0, 0.0, 1e-8)),
        ("width", with_width(straight(), B - 1e-7)),
    ] {
        let got = track(Shape::Tread(tread)).averages();
        // a search with both halves may end at a different trial, see `symmetry`
        assert_near(&got, &expected, [5e-3, 5e-3, 1e-2], what);
    }
}

/// Returns the wheel of a tread as triangles, with bars along those of the tread.
fn mesh(tread: Tread) -> Shape {
    let mut surface = Surface::default().rim(R, 360, &across(B, 4), |_| 1.0);
    let pitch = std::f64::consts::TAU * R / 12.0;
    for row in 0..tread.rows {
        let row_width = B / f64::from(tread.rows);
        let middle = (f64::from(row) + 0.5) * row_width - 0.5 * B;
        let width = tread.width_m.unwrap_or(row_width);
        let parts = 16 / tread.rows;
        let ys: Vec<f64> = across(width, parts).iter().map(|y| middle + y).collect();
        let ahead = |y: f64| {
            f64::from(row) * tread.stagger * pitch
                + y * tread.angle_rad.tan()
                + y.abs() * tread.chevron_rad.tan()
                + tread.bow_m * (2.0 * y / B).powi(2)
        };
        surface = surface.bent_grousers(R, 12, 0.009, 0.002, &ys, ahead);
    }
    Shape::Mesh {
        surface: surface.0,
        repeats_per_turn: Some(12),
        normals: Normals::Radial,
    }
}

#[test]
fn every_tread_is_the_mesh_of_the_same_wheel() {
    // the mesh's samples break an oblique bar into patches: it converges from 5.61 mm at 4 mm to 5.45 mm at 2 mm, the tread
    // from 5.37 mm to 5.40 mm
    for (what, tread, dem_spacing_m) in [
        ("staggered", staggered(), 0.004),
        ("narrow", with_width(staggered(), 0.04), 0.004),
        ("chevron", chevron(), 0.004),
        ("oblique", oblique(), 0.002),
    ] {
        let roll = |shape| {
            let mut track = track(shape);
            track.settings.dem_spacing_m = dem_spacing_m;
            track.averages()
        };
        let (expected, got) = (roll(mesh(tread)), roll(Shape::Tread(tread)));
        assert_near(&got, &expected, [0.01, 0.005, 0.015], what);
    }
}

#[test]
fn a_mirrored_tread_at_the_opposite_slip_angle_has_the_opposite_lateral_force() {
    let other = bent(-oblique().angle_rad, 0.0, 0.006);
    for (what, tread, mirrored) in [
        ("stagger", rows(2, 0.25), rows(2, 0.75)),
        ("angle", oblique(), other),
    ] {
        let roll = |tread, slip_angle_rad| {
            let mut track = track(Shape::Tread(tread));
            track.case.condition.slip_angle_rad = slip_angle_rad;
            track.averages()
        };
        let (left, right) = (roll(tread, 0.15), roll(mirrored, -0.15));
        assert!(left.lateral_force_n > 20.0, "{left:?}");
        let sum = left.lateral_force_n + right.lateral_force_n;
        println!("{what}: {sum:+.3} N of {:.3} N", left.lateral_force_n);
        assert!(sum.abs() < 0.5, "{what}: {left:?} {right:?}");
        assert_near(&left, &right, [0.005, 0.005, 0.02], what);
    }
}

#[test]
fn half_of_a_symmetric_tread_stands_for_both_and_no_other_is_halved() {
    for (what, tread, symmetric) in [
        ("chevron", chevron(), true),
        ("three rows", rows(3, 0.5), true),
        ("two rows", staggered(), false),
        ("oblique", oblique(), false),
    ] {
        let mut track = track(Shape::Tread(tread)).for_a_travel_of(0.1, 0.05);
        let halved = track.roll();
        track.settings.both_halves = true;
        let whole = track.roll();
        assert_eq!(halved == whole, !symmetric, "{what}");
        assert_near(&halved.averages, &whole.averages, [1e-3; 3], what);
    }
}

#[test]
fn it_does_not_matter_where_on_the_grid_a_row_ends() {
    // widths of 48 mm to 56 mm end anywhere in lanes of 4 mm
    let run = |mm: u32| {
        track(Shape::Tread(with_width(
            staggered(),
            0.048 + 1e-3 * f64::from(mm),
        )))
        .averages()
    };
    let runs: Vec<Averages> = (0..=8).map(run).collect();
    for quantity in [
        |a: &Averages| a.drawbar_pull_n / 100.0,
        |a: &Averages| a.torque_n_m / (100.0 * R),
        |a: &Averages| 0.3 * a.sinkage_m / 0.005,
    ] {
        let values: Vec<f64> = runs.iter().map(quantity).collect();
        println!("{values:.4?}");
        let (first, last) = (values[0], values[8]);
        for (i, value) in values.iter().enumerate() {
            let between = first + (last - first) * i as f64 / 8.0;
            assert!((value - between).abs() < 0.004, "{i}: {values:?}");
        }
    }
}

#[test]
fn treads_that_no_wheel_has_are_named() {
    type Change = fn(&mut Tread);
    let changes: [(&str, Change); 6] = [
        ("grouser_rows = 0 (count) must be between 1 and 100", |t| {
            t.rows = 0
        }),
        (
            "grouser_stagger = 1 (dimensionless) must be at least 0 and below 1",
            |t| t.stagger = 1.0,
        ),
        (
            "grouser_width_m = 0.06 m must be above 0, and at most the wheel's width over the number of rows",
            |t| (t.rows, t.width_m) = (2, Some(0.06)),
        ),
        (
            "grouser_angle_rad = -1.6 rad must be above -pi/2 and below pi/2",
            |t| t.angle_rad = -1.6,
        ),
        (
            "grouser_chevron_rad = 1.6 rad must be above -pi/2 and below pi/2",
            |t| t.chevron_rad = 1.6,
        ),
        (
            "grouser_bow_m = 0.2 m must be at most the wheel's radius, forward or back",
            |t| t.bow_m = 0.2,
        ),
    ];
    for (message, change) in changes {
        let mut tread = straight();
        change(&mut tread);
        let wheel = track(Shape::Rim(BARS)).case.wheel;
        let rejection = Shape::Tread(tread).checked(&wheel).expect_err("a rejection");
        assert_eq!(rejection.to_string(), format!("invalid parameter: {message}"));
    }
    let tread = Tread {
        grousers: Grousers {
            height_m: 0.0,
            ..BARS
        },
        ..staggered()
    };
    let wheel = track(Shape::Rim(BARS)).case.wheel;
    assert!(Shape::Tread(tread).checked(&wheel).is_err());
}
