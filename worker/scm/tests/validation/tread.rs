//! A wheel with grousers in rows on nearly rigid ground: it rolls over the tips of all rows.
//!
//! n tips per turn, t thick on a radius r, hold the hub at `r cos(a) + t/2 sin|a|`, |a| <= pi / n, and on average at
//! `(n / pi) (r sin(pi / n) + t/2 (1 - cos(pi / n)))`.

use super::Rows;
use crate::scene::{bars, grousered};
use scm::spatial::{Grousers, Shape, Tread};

const GROUSERS: Grousers = bars(12, 0.009, 0.002);

/// Elastic ground, into which a tip of half the width goes 0.09 mm `[Pa/m]`.
const STIFFNESS_PA_M: f64 = 1e10;

pub(crate) fn add(rows: &mut Rows) {
    for (case, number, stagger) in [("1 row", 1, 0.0), ("2 rows", 2, 0.5), ("3 rows", 3, 1.0 / 3.0)] {
        let mut track = grousered(0.0).for_a_travel_of(0.2, 2.0 * pitch());
        track.case.soil.k_phi = 1e13;
        track.ground.elastic_stiffness_pa_m = STIFFNESS_PA_M;
        track.shape = Shape::Tread(Tread {
            rows: number,
            stagger,
            ..Tread::straight(GROUSERS)
        });
        let got = track.averages();
        let radius = track.case.wheel.radius_m;
        let half_angle = core::f64::consts::PI / f64::from(12 * number);
        let tips = (radius + GROUSERS.height_m) * half_angle.sin()
            + 0.5 * GROUSERS.thickness_m * (1.0 - half_angle.cos());
        let area = track.case.wheel.width_m / f64::from(number) * GROUSERS.thickness_m;
        let pressed = 100.0 / area / STIFFNESS_PA_M;
        let sinkage = radius - tips / half_angle + pressed;
        rows.add(case, "z [mm]", 1e3 * sinkage, 1e3 * got.sinkage_m, 0.15);
    }
}

/// Travel from one grouser of a row to the next `[m]`.
fn pitch() -> f64 {
    core::f64::consts::TAU * 0.125 / 12.0
}
