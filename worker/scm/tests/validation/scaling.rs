//! Oracles 6 and 7: moduli and load scale forces alone; slip is the rig's.

use super::Rows;
use super::row::Bounds;
use crate::scene::{grousered, smooth};

/// A power of two changes no digit, so the search takes the same trials.
const EXACT: Bounds = [1e-9, 1e-9, 1e-9];

/// Rounding may end the search at another trial, within 0.1 % of the load, which the soil remembers.
const SEARCH: Bounds = [2e-3, 2e-3, 5e-3];

pub(crate) fn add(rows: &mut Rows) {
    for (name, track) in [("smooth", smooth(0.2, 100.0, 30.0)), ("grousers", grousered(0.2))] {
        let unscaled = track.averages();
        for (factor, bounds) in [(4.0, EXACT), (0.3, SEARCH)] {
            let mut scaled = track.clone();
            scaled.case.soil.k_phi *= factor;
            scaled.ground.elastic_stiffness_pa_m *= factor;
            scaled.case.condition.wheel_load_n *= factor;
            let expected = [
                factor * unscaled.drawbar_pull_n,
                factor * unscaled.torque_n_m,
                unscaled.sinkage_m,
            ];
            let load = scaled.case.condition.wheel_load_n;
            let case = format!("{name}, k, K_e, W by {factor}");
            rows.add_run(&case, load, expected, &scaled.averages(), bounds);
        }

        // s_true = 1 − (1 − s) R_s / R = 1 − 0.8 · 0.125 / 0.15 = 1/3
        let mut by_rig = track.clone();
        by_rig.case.wheel.radius_m = 0.15;
        let mut by_model = by_rig.clone();
        by_model.case.wheel.rig_radius_m = 0.15;
        by_model.case.condition.slip = 1.0 - 0.8 * 0.125 / 0.15;
        let by_model = by_model.averages();
        let expected = [by_model.drawbar_pull_n, by_model.torque_n_m, by_model.sinkage_m];
        let case = format!("{name}, R_s 125, R 150 mm");
        rows.add_run(&case, 100.0, expected, &by_rig.averages(), SEARCH);
    }
}
