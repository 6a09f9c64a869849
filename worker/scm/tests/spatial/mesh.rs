//! A wheel of triangles agrees with the wheel that the triangles describe.

use super::surfaces::{Surface, across};
use crate::scene::{bars, max_abs};
use crate::support::{Case, base};
use scm::effects::{Active, Site};
use scm::spatial::{
    Footprint, Ground, Normals, Protocol, RunSettings, Scene, Shape, SpatialRun, SurfaceMesh,
};

const R: f64 = 0.125;
const B: f64 = 0.112;

fn case() -> Case {
    base(0.2, 100.0, 30.0)
}

fn roll(case: &Case, shape: &Shape, settings: RunSettings) -> SpatialRun {
    let scene = Scene {
        soil: &case.soil,
        ground: &Ground::default(),
        wheel: &case.wheel,
        shape,
        effects: &Active::default(),
        site: Site::default(),
    };
    scm::spatial::simulate(&scene, &case.condition, &settings)
        .unwrap_or_else(|rejection| panic!("{rejection}"))
}

/// Returns a window of 0.3 m after a transient of 0.2 m.
fn fixed(case: &Case) -> RunSettings {
    let second = 1.0 / case.condition.sled_speed_m_s;
    RunSettings {
        protocol: Protocol::Fixed {
            duration_s: 0.5 * second,
            transient_force_s: 0.2 * second,
            transient_sinkage_s: 0.2 * second,
            lowpass_hz: 0.0,
        },
        ..RunSettings::default()
    }
}

fn mesh(surface: SurfaceMesh, repeats_per_turn: Option<u32>, normals: Normals) -> Shape {
    Shape::Mesh {
        surface,
        repeats_per_turn,
        normals,
    }
}

fn rim(grousers: u32) -> Shape {
    Shape::Rim(bars(grousers, 0.009, 0.002))
}

/// Differences of F, T and z, relative to W, W R and z.
fn differences(case: &Case, got: &SpatialRun, expected: &SpatialRun) -> [f64; 3] {
    let (load, a, e) = (case.condition.wheel_load_n, got.averages, expected.averages);
    [
        (a.drawbar_pull_n - e.drawbar_pull_n) / load,
        (a.torque_n_m - e.torque_n_m) / (load * R),
        a.sinkage_m / e.sinkage_m - 1.0,
    ]
}

/// Returns a smooth wheel of flat facets.
fn cylinder(facets: u32) -> SurfaceMesh {
    Surface::default().rim(R, facets, &across(B, 4), |_| 1.0).0
}

/// Returns a wheel of flat facets with boxes for grousers.
fn with_boxes(facets: u32) -> SurfaceMesh {
    let rim = Surface::default().rim(R, facets, &across(B, 4), |_| 1.0);
    rim.grousers(R, 12, 0.009, 0.002, &across(B, 4)).0
}

#[test]
fn a_faceted_cylinder_is_the_analytic_rim_to_second_order_in_its_facets() {
    let case = case();
    let settings = fixed(&case);
    let expected = roll(&case, &rim(0), settings);
    for normals in [Normals::Surface, Normals::Radial] {
        let mut last: Option<f64> = None;
        for facets in [45, 90, 180, 360] {
            let got = roll(&case, &mesh(cylinder(facets), None, normals), settings);
            let [f, t, z] = differences(&case, &got, &expected);
            println!("{normals:?}, {facets} facets: F {f:+.5} W, T {t:+.5} W R, z {z:+.5} z");
            // chords lie above the arc by R (π/N)²/3 on average, 0.2 mm of 5 mm for 45 facets
            let bound = 0.05 * (45.0 / f64::from(facets)).powi(2) + 0.002;
            assert!(f.abs() < 0.002 && (facets < 180 || z.abs() < 0.004));
            assert!(t.abs() < 0.04 * bound + 5e-4 && z.abs() < bound);
            // with more facets the remaining 0.3 % come from the grid
            if let Some(before) = last.filter(|_| facets <= 90) {
                assert!(before / z > 3.0, "{before} {z}");
            }
            last = Some(z);
        }
    }
}

#[test]
fn a_faceted_cylinder_is_the_analytic_rim_at_an_angle_in_skid_and_on_a_second_pass() {
    type Change = fn(&mut Case);
    let changes: [Change; 3] = [
        |case| case.condition.slip_angle_rad = 0.2,
        |case| case.condition.slip = -0.3,
        |case| case.condition.pass = 2,
    ];
    for change in changes {
        let mut case = case();
        change(&mut case);
        let settings = fixed(&case);
        let expected = roll(&case, &rim(0), settings);
        let got = roll(&case, &Shape::from(cylinder(360)), settings);
        let [f, t, z] = differences(&case, &got, &expected);
        let lateral = got.averages.lateral_force_n - expected.averages.lateral_force_n;
        println!("F {f:+.5} W, T {t:+.5} W R, z {z:+.5} z, lateral {lateral:+.4} N");
        assert!(f.abs() < 0.002 && t.abs() < 0.002 && z.abs() < 0.005 && lateral.abs() < 0.2);
    }
}

#[test]
fn boxes_on_a_rim_are_the_analytic_grousers_but_for_the_thrust_of_their_flanks() {
    let case = case();
    for (dem_spacing_m, bounds) in [(0.004, [0.003, 0.003, 0.012]), (0.001, [0.002, 0.002, 0.006])] {
        let settings = RunSettings {
            dem_spacing_m,
            ..fixed(&case)
        };
        let expected = roll(&case, &rim(12), settings);
        let shape = |normals| mesh(with_boxes(360), Some(12), normals);
        let got = roll(&case, &shape(Normals::Radial), settings);
        let deviations = differences(&case, &got, &expected);
        println!("{dem_spacing_m} m, radial: {deviations:.5?}");
        for (difference, bound) in deviations.into_iter().zip(bounds) {
            assert!(difference.abs() < bound, "{deviations:?}");
        }
        // the rear flank of a grouser pushes the wheel forward; the analytic wheel has radial normals there
        let got = roll(&case, &shape(Normals::Surface), settings);
        let [f, t, z] = differences(&case, &got, &expected);
        println!("{dem_spacing_m} m, surface: F {f:+.5} W, T {t:+.5} W R, z {z:+.5} z");
        assert!((0.05..0.14).contains(&f) && (0.06..0.18).contains(&t) && (-0.05..0.0).contains(&z));
    }
}

#[test]
fn the_period_is_found_from_the_vertices() {
    let case = case();
    let settings = RunSettings::default();
    let [found, given] = [None, Some(12)]
        .map(|repeats| roll(&case, &mesh(with_boxes(360), repeats, Normals::Surface), settings));
    assert_eq!(found, given);
}

/// Returns a barrel: 3 mm lower at the sides than in the middle, with grousers.
fn barrel() -> SurfaceMesh {
    let round = |y: f64| 1.0 - 0.05 * (2.0 * y / B).powi(2);
    let rim = Surface::default().rim(R, 180, &across(B, 32), round);
    rim.grousers(R, 12, 0.004, 0.003, &across(0.08, 4)).0
}

#[test]
fn a_symmetric_mesh_feels_no_lateral_force_and_half_of_it_stands_for_both() {
    let case = case();
    let half = fixed(&case);
    let whole = RunSettings {
        both_halves: true,
        ..half
    };
    let shape = Shape::from(barrel());
    let (halved, got) = (roll(&case, &shape, half), roll(&case, &shape, whole));
    let largest = max_abs(&got.history.lateral_force_n);
    println!("largest lateral force {largest:e} N");
    assert!(largest < 1e-9 * case.condition.wheel_load_n, "{largest:e} N");
    let [f, t, z] = differences(&case, &halved, &got);
    println!("half: F {f:+.2e} W, T {t:+.2e} W R, z {z:+.2e} z");
    assert!(f.abs() < 1e-9 && t.abs() < 1e-9 && z.abs() < 1e-9);
    let shape = rim(12);
    let [f, t, z] = differences(&case, &roll(&case, &shape, half), &roll(&case, &shape, whole));
    println!("half of an analytic wheel: F {f:+.2e} W, T {t:+.2e} W R, z {z:+.2e} z");
    assert!(f.abs() < 1e-9 && t.abs() < 1e-9 && z.abs() < 1e-9);
}

#[test]
fn a_barrel_sinks_deeper_than_the_cylinder() {
    let case = case();
    let settings = fixed(&case);
    let round = |y: f64| 1.0 - 0.05 * (2.0 * y / B).powi(2);
    let surface = Surface::default().rim(R, 360, &across(B, 32), round).0;
    let barrel = roll(&case, &Shape::from(surface), settings).averages;
    let cylinder = roll(&case, &Shape::from(cylinder(360)), settings).averages;
    println!("{barrel:?}\n{cylinder:?}");
    assert!(barrel.sinkage_m > 1.2 * cylinder.sinkage_m);
}

#[test]
fn two_narrow_rims_are_two_wheels_of_half_the_load() {
    const NARROW: f64 = 0.024;
    let mut both = case();
    both.soil.k_c = 1e4; // so that the effective width counts
    let mut one = both;
    (one.condition.wheel_load_n, one.wheel.width_m) = (50.0, 0.5 * B);
    let ring = |surface: Surface, from: f64| surface.rim(R, 180, &[from, from + NARROW], |_| 1.0);
    let two = ring(ring(Surface::default(), -0.5 * B), 0.5 * B - NARROW).0;
    let single = ring(Surface::default(), -0.5 * NARROW).0;
    let two = Shape::from(two);
    let joint = roll(&both, &two, fixed(&both)).averages;
    let patches = RunSettings {
        footprint: Footprint::Patches,
        ..fixed(&both)
    };
    let two = roll(&both, &two, patches).averages;
    let single = roll(&one, &Shape::from(single), fixed(&one)).averages;
    println!("{two:?}\n{single:?}");
    let near = |a: f64, b: f64, tolerance: f64| (a / b - 1.0).abs() < tolerance;
    assert!(near(two.sinkage_m, single.sinkage_m, 0.03), "sinkage");
    assert!(near(two.torque_n_m, 2.0 * single.torque_n_m, 0.02), "torque");
    assert!(near(two.b_eff_m, single.b_eff_m, 0.05), "effective width");
    assert!(single.b_eff_m < NARROW && two.b_eff_m < NARROW);
    let (area, expected) = (two.contact_length_m * B, 2.0 * single.contact_length_m * NARROW);
    assert!(near(area, expected, 0.03), "no soil touches the gap");
    // in one hull they are a wheel of their joint width
    let length = joint.contact_length_m * B / (2.0 * NARROW);
    let hull = length * 2.0 * NARROW / (length + 2.0 * NARROW);
    assert!(near(joint.b_eff_m, hull, 0.05), "{joint:?}");
}

#[test]
fn invalid_meshes_are_rejected() {
    let good = || cylinder(12);
    type Change = fn(&mut SurfaceMesh);
    let changes: [(Change, &str); 6] = [
        (
            |m| m.triangles.clear(),
            "triangles = 0 (count) must be at least 1",
        ),
        (
            |m| m.triangles[3][1] = 4_000,
            "triangles = 4000 (position) must be below the number of vertices",
        ),
        (
            |m| m.vertices_m[5][2] = f64::NAN,
            "vertices_m = NaN m must be finite",
        ),
        (
            |m| m.vertices_m[5][0] = f64::INFINITY,
            "vertices_m = inf m must be finite",
        ),
        (
            |m| m.vertices_m.iter_mut().for_each(|v| (v[0], v[2]) = (0.0, 0.0)),
            "vertices_m = 0 m must be above 0 at the largest distance from the axle",
        ),
        (
            |m| m.vertices_m.iter_mut().for_each(|v| v[1] = 0.0),
            "vertices_m = 0 m must be above 0 at the largest distance from the middle plane",
        ),
    ];
    for (change, message) in changes {
        let mut surface = good();
        change(&mut surface);
        let rejection = Shape::from(surface)
            .checked(&case().wheel)
            .expect_err("a rejection");
        assert_eq!(rejection.to_string(), format!("invalid parameter: {message}"));
    }
    let never = mesh(good(), Some(0), Normals::Surface);
    let rejection = never.checked(&case().wheel).expect_err("a rejection").to_string();
    assert_eq!(
        rejection,
        "invalid parameter: repeats_per_turn = 0 (count) must be at least 1"
    );
    assert!(Shape::from(good()).checked(&case().wheel).is_ok());
}

#[test]
fn a_mesh_gives_the_same_bits_again() {
    let case = case();
    let [once, again] = [(); 2].map(|()| roll(&case, &Shape::from(barrel()), fixed(&case)));
    assert_eq!(once, again);
}
