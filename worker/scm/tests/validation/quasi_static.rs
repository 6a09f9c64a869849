//! Oracle 3: a smooth wheel on soil that does not flow agrees with the quasi-static model.
//!
//! The differences: soil that unloads at 1e9 Pa/m keeps a strip of contact behind the axle (2.5 mm at 30 kPa), which carries
//! load without resistance, so the wheel sinks less and pulls more; and the grid. With rigid-plastic soil (1e12 Pa/m) only
//! the grid remains.

use super::Rows;
use super::row::Bounds;
use crate::scene::{Track, smooth};

/// Differences found: 0.17 % of the load, 0.05 % of load times radius, 2.2 % of the sinkage (a column of 4 mm in contacts of
/// 31 mm).
const RIGID: Bounds = [0.0025, 0.001, 0.025];
/// Differences found: 1.5 %, 0.45 %, 3.3 %.
const ELASTIC: Bounds = [0.018, 0.006, 0.04];

fn compare(rows: &mut Rows, case: &str, track: &Track) {
    let load = track.case.condition.wheel_load_n;
    let paper = track.case.simulate();
    let expected = [paper.drawbar_pull_n, paper.torque_n_m, paper.sinkage_m];
    for (name, stiffness, bounds) in [("rigid", 1e12, RIGID), ("K_e 1e9", 1e9, ELASTIC)] {
        let mut track = track.clone();
        track.ground.elastic_stiffness_pa_m = stiffness;
        let got = track.averages();
        let case = format!("{case}, {name}");
        rows.add_run(&case, load, expected, &got, bounds);
        if track.case.condition.slip_angle_rad.abs() > 0.0 {
            // the footprint is that of the straight wheel: 3 % for ends between nodes
            let width = 1e3 * paper.b_eff_m;
            rows.add(&case, "b_eff [mm]", width, 1e3 * got.b_eff_m, 0.03 * width);
            let lateral = paper.lateral_force_n;
            rows.add(&case, "F_y [N]", lateral, got.lateral_force_n, bounds[0] * load);
        }
    }
}

pub(crate) fn add(rows: &mut Rows) {
    for friction_angle_deg in [30.0, 11.5] {
        for load in [60.0, 100.0, 150.0] {
            for slip in [0.05, 0.2, 0.6] {
                let case = format!("phi {friction_angle_deg}, {load} N, s {slip}");
                compare(rows, &case, &smooth(slip, load, friction_angle_deg));
            }
        }
    }
    for slip in [-0.3, -1.0] {
        let mut track = smooth(slip, 100.0, 30.0);
        track.case.condition.sled_speed_m_s = 0.01;
        compare(rows, &format!("phi 30, 100 N, s {slip}"), &track);
    }
    let mut track = smooth(0.2, 100.0, 30.0);
    track.case.soil.cohesion_pa = 500.0;
    compare(rows, "c 500 Pa", &track);
    for angle_deg in [10.0_f64, -10.0] {
        let mut track = smooth(0.2, 100.0, 30.0);
        track.case.condition.slip_angle_rad = angle_deg.to_radians();
        compare(rows, &format!("slip angle {angle_deg}"), &track);
    }
}
