//! The quasi-static model with grousers approximates the mean of the three-dimensional one, on soil that does not flow.
//!
//! The differences: the hub keeps its height, soil is rigid-plastic, and there is no grid. On the three-dimensional model's
//! grid a tip that rises behind the axle carries load until it has passed the node of its column.

use super::Rows;
use super::row::Bounds;
use crate::scene::{Track, bars};
use crate::support::base;
use scm::effects::{Active, Site};
use scm::quasi_static::{StraightGrousers, simulate_with_grousers};
use scm::spatial::Shape;

/// Differences found: 0.069 of the load, 0.019 of load times radius, 7.1 % of the sinkage. The smooth rim: 0.20, 0.067, 77 %.
const BOUNDS: Bounds = [0.075, 0.022, 0.08];

pub(crate) fn add(rows: &mut Rows) {
    for (count, height_m) in [(12, 0.009), (24, 0.005)] {
        for slip in [-0.4, -0.05, 0.05, 0.2, 0.6, 0.8] {
            let thickness_m = 0.002;
            let grousers = StraightGrousers {
                count,
                height_m,
                thickness_m,
            };
            let case = base(slip, 100.0, 30.0);
            let mut track = Track::smooth(case);
            track.shape = Shape::Rim(bars(count, height_m, thickness_m));
            let rolled = track.averages();
            let expected = [rolled.drawbar_pull_n, rolled.torque_n_m, rolled.sinkage_m];
            let (mut none, site) = (Active::default(), Site::default());
            let (soil, wheel, condition) = (&case.soil, &case.wheel, &case.condition);
            let got = simulate_with_grousers(soil, wheel, &grousers, condition, &mut none, &site)
                .unwrap_or_else(|rejection| panic!("{rejection}: {case:?}"));
            let case = format!("{count} x {height_m} m, s {slip}");
            rows.add_run(&case, 100.0, expected, &got, BOUNDS);
        }
    }
}
