//! Janosi and Hanamoto's displacement law, on the rim and on the soil, compared with a quasi-static prototype.
//!
//! The prototype's contact ends under the axle. Here it continues behind it, where the shear has its longest displacement:
//! more pull, as without the law (0.94 N at 100 N).

use super::Rows;
use super::row::Bounds;
use crate::scene::smooth;
use scm::spatial::Displacement;

const BOUNDS: Bounds = [0.015, 0.01, 0.04];

pub(crate) fn add(rows: &mut Rows) {
    // K mm, keeper, F N, T N m, z mm: s 0.2, 100 N
    const TABLE: [(f64, Displacement, [f64; 3]); 8] = [
        (3.0, Displacement::Rim, [25.4, 4.69, 5.69]),
        (6.0, Displacement::Rim, [14.5, 3.34, 5.74]),
        (10.0, Displacement::Rim, [6.6, 2.37, 5.78]),
        (15.0, Displacement::Rim, [1.4, 1.73, 5.80]),
        (25.0, Displacement::Rim, [-3.5, 1.12, 5.82]),
        (10.0, Displacement::Node, [9.5, 2.73, 5.76]),
        (15.0, Displacement::Node, [3.8, 2.03, 5.79]),
        (25.0, Displacement::Node, [-1.8, 1.33, 5.81]),
    ];
    for (modulus_mm, keeper, [pull, torque, sinkage_mm]) in TABLE {
        let mut track = smooth(0.2, 100.0, 30.0);
        track.enter_displacement_law(1e-3 * modulus_mm);
        track.settings.displacement = keeper;
        let case = format!("K {modulus_mm} mm, {keeper:?}");
        let expected = [pull, torque, 1e-3 * sinkage_mm];
        rows.add_run(&case, 100.0, expected, &track.averages(), BOUNDS);
    }
}
