//! The table of a prototype: base case, 60 strips, printed to 0.1 N, 0.01 N m, 0.01 mm.

use crate::support::base;

#[test]
fn table_of_the_prototype_is_reproduced_within_its_rounding() {
    #[expect(clippy::approx_constant, reason = "3.14 N m is a torque")]
    // phi deg, W, slip, F N, T N m, z mm
    const TABLE: [[f64; 6]; 6] = [
        [30.0, 60.0, 0.2, 22.7, 3.61, 4.11],
        [30.0, 100.0, 0.05, 12.8, 3.14, 5.73],
        [30.0, 100.0, 0.2, 35.9, 6.00, 5.63],
        [30.0, 100.0, 0.6, 42.3, 6.79, 5.61],
        [30.0, 150.0, 0.2, 51.3, 8.97, 7.23],
        [11.5, 100.0, 0.2, 5.21, 2.20, 5.77],
    ];
    for [phi, load, slip, drawbar_pull, torque, sinkage_mm] in TABLE {
        let got = base(slip, load, phi).simulate();
        println!(
            "phi {phi:4} W {load:5} s {slip:4}: F {drawbar_pull:5} {:8.4}  T {torque:4} {:7.4}  z {sinkage_mm:4} {:7.4}",
            got.drawbar_pull_n,
            got.torque_n_m,
            1e3 * got.sinkage_m
        );
        assert!((got.drawbar_pull_n - drawbar_pull).abs() < 0.05, "{got:?}");
        assert!((got.torque_n_m - torque).abs() < 0.006, "{got:?}");
        assert!((1e3 * got.sinkage_m - sinkage_mm).abs() < 0.01, "{got:?}");
    }
}
