//! Oracle 2: a frictionless smooth wheel with uniform pressure has closed forms of sinkage, pull and torque.

use super::Rows;
use super::profile::Profile;
use crate::scene::{Track, smooth};
use crate::support::Case;

/// Bekker's closed form for small angles, `W = b k z^(n + 1/2) √(2R) I_n`, contact in front of the axle only.
fn bekker_sinkage(case: &Case, integral: f64) -> f64 {
    let per_load = case.wheel.width_m * case.soil.k_phi * (2.0 * case.wheel.radius_m).sqrt() * integral;
    (case.condition.wheel_load_n / per_load).powf(1.0 / (case.soil.n + 0.5))
}

fn frictionless(n: f64, load: f64, elastic_stiffness_pa_m: f64) -> Track {
    let mut track = smooth(0.2, load, 0.0);
    (track.case.soil.n, track.case.soil.gamma_exponent) = (n, 0.0);
    track.ground.elastic_stiffness_pa_m = elastic_stiffness_pa_m;
    track
}

pub(crate) fn add(rows: &mut Rows) {
    for (n, integral) in [(1.0, 2.0 / 3.0), (1.1, 0.648_84)] {
        for load in [40.0, 100.0, 160.0] {
            // stiff enough that the contact ends under the axle: 3 % for the small angles and the grid
            let track = frictionless(n, load, 1e12);
            let got = track.averages();
            let case = format!("n {n}, {load} N, rigid-plastic");
            let expected = bekker_sinkage(&track.case, integral);
            rows.add_sinkage(&case, expected, got.sinkage_m, 0.03);

            // with the usual stiffness, compared with the integrated profile
            let track = frictionless(n, load, 1e9);
            let got = track.averages();
            let case = format!("n {n}, {load} N, K_e 1e9");
            let paper = Profile::in_balance(&track);
            let resistance = paper.resistance();
            rows.add_sinkage(&case, paper.sinkage, got.sinkage_m, 0.03);
            rows.add(&case, "F [N]", -resistance, got.drawbar_pull_n, 0.05 * resistance);
            // F follows from the simulated sinkage, with its grid error
            let mut simulated = paper;
            simulated.sinkage = got.sinkage_m;
            let force = simulated.resistance();
            rows.add(&case, "F(z) [N]", -force, got.drawbar_pull_n, 0.015 * force);
            rows.add(&case, "T [N m]", 0.0, got.torque_n_m, 1e-9);
        }
    }
}
