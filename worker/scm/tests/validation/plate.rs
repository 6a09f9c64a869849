//! Oracle 1: a flat plate carries its area times Bekker's pressure.
//!
//! A wheel is no plate, so the plate is that of the bevameter, and the flat contact of the three-dimensional model is a unit
//! test of `spatial::contact`. This oracle is a wheel lowered without rolling: both halves of its contact carry load.

use super::Rows;
use crate::scene::smooth;
use crate::support::base;
use scm::bevameter::plate::{self, Plate};

pub(crate) fn add(rows: &mut Rows) {
    let soil = base(0.2, 100.0, 30.0).soil;
    let disc = Plate::Circle { radius_m: 0.05 };
    let area = core::f64::consts::PI * 0.05 * 0.05;
    let expected = area * soil.k_phi * 0.01_f64.powf(soil.n);
    let got = plate::load(&soil, &disc, 0.01).expect("a plate on sand");
    rows.add("bevameter, 10 mm", "W [N]", expected, got, 1e-9 * expected);

    for load in [60.0, 150.0] {
        // W = 2 b k √(2R) I_n z^(n + 1/2), I_1.1 = 0.64884
        let mut track = smooth(0.2, load, 0.0);
        track.case.soil.gamma_exponent = 0.0;
        let per_load = 2.0 * track.case.wheel.width_m * soil.k_phi * 0.25_f64.sqrt() * 0.648_84;
        let expected = (load / per_load).powf(1.0 / (soil.n + 0.5));
        let run = track.roll();
        let got = run.history.sinkage_m[0];
        // small angles neglect z/4R of the chord, 1 % here; the trial load adds 0.1 %, the grid's ends the rest
        rows.add_sinkage(&format!("lowered wheel, {load} N"), expected, got, 0.02);
    }
}
