//! How much soil that flows to the border lifts the wheel, against the same prototype as for grousers.

use super::Rows;
use super::grousers::of_the_prototype;

#[expect(clippy::approx_constant, reason = "3.14 mm is a sinkage")]
pub(crate) fn add(rows: &mut Rows) {
    // phi_f, credit, z mm, largest difference mm. All the soil flowing (1.0) is left out: the prototype spreads it over the
    // whole border, ours lays it where it leaves the contact, next to the wheel, which climbs 2 mm more.
    for (flow, credit, expected, tolerance) in [
        (0.0, 1.0, 5.17, 0.15),
        (0.25, 1.0, 4.24, 0.15),
        (0.5, 1.0, 3.14, 0.35),
    ] {
        let got = of_the_prototype(0.2, flow, credit).averages();
        let case = format!("flow {flow}, credit {credit}");
        rows.add(&case, "z [mm]", expected, 1e3 * got.sinkage_m, tolerance);
    }
}
