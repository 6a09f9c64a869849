//! The lift of the wheel by soil that flows to the border, compared with the prototype for grousers.

use super::Rows;
use super::grousers::prototype;

#[expect(clippy::approx_constant, reason = "3.14 mm is a sinkage")]
pub(crate) fn add(rows: &mut Rows) {
    // The columns are phi_f, credit, z mm, largest difference mm. Complete flow (1.0) is left out: the prototype spreads the soil
    // over the whole border, while this model leaves it where it exits the contact, next to the wheel, which climbs 2 mm more.
    for (flow, credit, expected, tolerance) in [
        (0.0, 1.0, 5.17, 0.15),
        (0.25, 1.0, 4.24, 0.15),
        (0.5, 1.0, 3.14, 0.35),
    ] {
        let got = prototype(0.2, flow, credit).averages();
        let case = format!("flow {flow}, credit {credit}");
        rows.add(&case, "z [mm]", expected, 1e3 * got.sinkage_m, tolerance);
    }
}
