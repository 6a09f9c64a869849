//! Resistive force theory: a plate, symmetry, convergence, and meshes against the analytic wheel.

use core::f64::consts::TAU;

use scm::effects::{Active, Site};
use scm::rft::{self, RftShape, RftSoil};
use scm::spatial::{Grousers, SurfaceMesh};
use scm::{Averages, Condition, Rejection, Wheel};

use crate::scene::bars;
use crate::support::assert_near;

const SOIL: RftSoil = RftSoil {
    xi_n_pa_m: 5e5,
    surface_friction: 0.4,
};
const WHEEL: Wheel = Wheel {
    radius_m: 0.125,
    width_m: 0.112,
    rig_radius_m: 0.125,
};

fn condition(slip: f64, wheel_load_n: f64, slip_angle_deg: f64) -> Condition {
    Condition {
        slip,
        wheel_load_n,
        sled_speed_m_s: 0.01,
        slip_angle_rad: slip_angle_deg.to_radians(),
        pass: 1,
    }
}

fn run_on(soil: &RftSoil, shape: &RftShape, condition: &Condition) -> Result<Averages, Rejection> {
    let (mut none, site) = (Active::default(), Site::default());
    rft::simulate(soil, &WHEEL, shape, condition, &mut none, &site)
}

fn run(shape: &RftShape, condition: &Condition) -> Averages {
    run_on(&SOIL, shape, condition).expect("a balance")
}

/// Returns a closed cylinder about the axle with a number of facets, or a box if `facets` is 4 and `turned` half a facet.
fn prism(facets: u32, radius: f64, width: f64, turned: f64) -> SurfaceMesh {
    let mut vertices_m = vec![[0.0, -0.5 * width, 0.0], [0.0, 0.5 * width, 0.0]];
    for i in 0..facets {
        let angle = TAU * (f64::from(i) + turned) / f64::from(facets);
        for y in [-0.5 * width, 0.5 * width] {
            vertices_m.push([radius * angle.sin(), y, -radius * angle.cos()]);
        }
    }
    let corner = |i: u32, side: u32| 2 + 2 * (i % facets) + side;
    let mut triangles = Vec::new();
    for i in 0..facets {
        triangles.push([corner(i, 0), corner(i, 1), corner(i + 1, 0)]);
        triangles.push([corner(i, 1), corner(i + 1, 1), corner(i + 1, 0)]);
        triangles.push([0, corner(i, 0), corner(i + 1, 0)]);
        triangles.push([1, corner(i + 1, 1), corner(i, 1)]);
    }
    SurfaceMesh {
        vertices_m,
        triangles,
    }
}

#[test]
fn the_load_on_a_plate_grows_linearly_with_depth() {
    // the law gives alpha = 0.87504 under a level plate of any shape that moves down
    for depth_m in [0.002, 0.01, 0.05] {
        let carried = rft::plate_force_n(&SOIL, 0.01, depth_m).unwrap();
        let expected = 5e5 * 0.875_04 * 0.01 * depth_m;
        assert!((carried / expected - 1.0).abs() < 1e-12, "{carried}");
    }
}

#[test]
fn load_is_carried_and_scales_with_the_factor() {
    let shape = RftShape::rim(Grousers::default());
    for slip in [-0.5, 0.0, 0.3, 0.8] {
        let run_once = run(&shape, &condition(slip, 100.0, 0.0));
        assert!(run_once.residual_load_n.abs() < 1e-9 && run_once.sinkage_m > 0.0);
        // stresses are proportional to the factor: twice the load on a soil twice as stiff has the same sinkage
        let stiff = RftSoil {
            xi_n_pa_m: 1e6,
            ..SOIL
        };
        let twice = run_on(&stiff, &shape, &condition(slip, 200.0, 0.0)).unwrap();
        assert!((twice.sinkage_m / run_once.sinkage_m - 1.0).abs() < 1e-9);
        assert!((twice.drawbar_pull_n / run_once.drawbar_pull_n - 2.0).abs() < 1e-9);
    }
}

#[test]
fn a_driven_wheel_pulls_more_the_more_it_slips_and_a_locked_one_is_dragged() {
    let shape = RftShape::rim(Grousers::default());
    let at = |slip: f64| run(&shape, &condition(slip, 100.0, 0.0));
    let [locked, skid, rolling, driven] = [-1.0, -0.4, 0.0, 0.5].map(at);
    assert!(locked.drawbar_pull_n < 0.0 && skid.drawbar_pull_n < rolling.drawbar_pull_n);
    assert!(rolling.drawbar_pull_n < driven.drawbar_pull_n);
    assert!(locked.torque_n_m < 0.0 && driven.torque_n_m > 0.0);
}

#[test]
fn left_mirrors_right() {
    for shape in [Grousers::default(), bars(12, 0.01, 0.002)].map(RftShape::rim) {
        let [left, right] = [-20.0, 20.0].map(|angle| run(&shape, &condition(0.2, 100.0, angle)));
        assert!(right.lateral_force_n > 5.0, "{right:?}");
        assert!((left.lateral_force_n + right.lateral_force_n).abs() < 1e-9);
        assert_near(&left, &right, [1e-9; 3]);
        assert!((left.sinkage_m - right.sinkage_m).abs() < 1e-9);
    }
}

#[test]
fn a_mesh_of_ever_finer_facets_becomes_the_analytic_wheel() {
    for (slip, angle) in [(0.3, 0.0), (-0.3, 0.0), (0.2, 25.0)] {
        let condition = condition(slip, 100.0, angle);
        let exact = run(&RftShape::rim(Grousers::default()), &condition);
        let off = |facets: u32| {
            let shape = RftShape::mesh(&prism(facets, 0.125, 0.112, 0.0)).unwrap();
            let got = run(&shape, &condition);
            let force = (got.drawbar_pull_n - exact.drawbar_pull_n).abs() / 100.0;
            let lateral = (got.lateral_force_n - exact.lateral_force_n).abs() / 100.0;
            (force.max(lateral), (got.sinkage_m / exact.sinkage_m - 1.0).abs())
        };
        let (coarse, fine) = (off(45), off(360));
        println!("slip {slip}, angle {angle}: 45 facets {coarse:?}, 360 facets {fine:?}");
        assert!(fine.0 < 0.01 && fine.1 < 0.02, "{fine:?}");
        assert!(fine.1 < coarse.1, "{coarse:?} {fine:?}");
    }
}

#[test]
fn grousers_add_thrust() {
    let [smooth, lugged] = [Grousers::default(), bars(12, 0.012, 0.002)]
        .map(|grousers| run(&RftShape::rim(grousers), &condition(0.3, 100.0, 0.0)));
    assert!(lugged.drawbar_pull_n > smooth.drawbar_pull_n + 5.0);
    assert!(lugged.residual_load_n.abs() < 1e-9);
}

#[test]
fn too_weak_a_soil_is_refused_with_the_largest_load_that_it_carries() {
    let shape = RftShape::rim(Grousers::default());
    for (xi_n_pa_m, surface_friction, kind) in [
        (1e3, SOIL.surface_friction, "no_support"),
        (SOIL.xi_n_pa_m, -0.1, "invalid_parameter"),
    ] {
        let soil = RftSoil {
            xi_n_pa_m,
            surface_friction,
        };
        let refused = run_on(&soil, &shape, &condition(0.2, 100.0, 0.0)).unwrap_err();
        assert_eq!(refused.kind(), kind);
    }
}
