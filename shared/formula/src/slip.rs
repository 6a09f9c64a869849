//! Slip along and across the heading, from the nominal slip and the slip angle.

use crate::Variable;

/// Computes the variables of a sliding wheel: slip, slip angle, and the slip along and across the heading.
///
/// The slip of a run is nominal: it compares the rim, which moves along the heading with ωR, with the sled, which moves along the travel
/// with v. The lowest point of the rim slides over the soil at ωR − v cos β along the heading and at v sin β across; both over the
/// greater of the two speeds are
///
/// - longitudinal slip `(ωR − v cos β) / max(ωR, v)`, in [−1, 1], negative in skid. Straight ahead it is the nominal slip, to the last
///   bit; at 90° it is 0 for a locked wheel and 1 for one that is faster than the sled.
/// - lateral slip `v sin β / max(ωR, v)`, in [−1, 1], of the sign of β. The literature's tan β has no bound at 90°; this has one.
///
/// # Arguments
/// - `slip`: nominal, `(ωR − v) / max(ωR, v)`, in [−1, 1); negative: skid.
/// - `slip_angle_rad`: β, from the heading to the travel, in [−π/2, π/2].
///
/// # Source
/// Ishigami et al. 2007, J. Field Robotics 24(3):233, <https://doi.org/10.1002/rob.20187>: its slip ratio where the rim is faster than
/// the sled; where it is slower, the sled's whole speed takes the place of v cos β, which vanishes at 90°.
/// Checked by `tests::the_parts_of_slip_are_those_of_the_velocities`.
pub fn variables(slip: f64, slip_angle_rad: f64) -> [(Variable, f64); 4] {
    let sled_share = 1.0 - slip.max(0.0); // v / max(ωR, v)
    let backwards = sled_share * (1.0 - libm::cos(slip_angle_rad));
    [
        (Variable::Slip, slip),
        (Variable::SlipAngle, slip_angle_rad),
        (Variable::LongitudinalSlip, slip + backwards),
        (Variable::LateralSlip, sled_share * libm::sin(slip_angle_rad)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_slip_are_those_of_the_velocities() {
        let root = |x: f64| x.sqrt();
        for (slip, degrees, longitudinal, lateral) in [
            (0.5, 0.0, 0.5, 0.0),
            (-0.7, 0.0, -0.7, 0.0),
            // the rim drives at 10 mm/s, the sled at 5 mm/s along the heading and 8.66 mm/s across
            (0.0, 60.0, 0.5, root(0.75)),
            (0.0, -60.0, 0.5, -root(0.75)),
            // nominal skid that drives along the heading, 8 mm/s against 5 mm/s; and a weaker skid, 3 mm/s against 5 mm/s
            (-0.2, 60.0, 0.3, root(0.75)),
            (-0.7, 60.0, -0.2, root(0.75)),
            // the rim at 20 mm/s, the sled at 10 mm/s across
            (0.5, 90.0, 1.0, 0.5),
            (-1.0, 45.0, -root(0.5), root(0.5)),
            (-1.0, 90.0, 0.0, 1.0),
        ] {
            let slips = variables(slip, f64::to_radians(degrees));
            assert!(
                (slips[2].1 - longitudinal).abs() < 1e-12 && (slips[3].1 - lateral).abs() < 1e-12,
                "slip {slip} at {degrees} degrees: {slips:?}"
            );
        }
        for percent in -100..100 {
            let slip = f64::from(percent) / 100.0;
            assert_eq!(variables(slip, 0.0)[2].1.to_bits(), slip.to_bits());
        }
    }
}
