//! What follows from the channels of a run: traction, power, efficiency, slopes, energy.

use job::{PlannedRun, QuantityValues};
use shared::experiment::rim_speed_m_s;

/// Returns the values of all quantities of a run, in the order of [`job::QUANTITIES`]; NaN where one has no value.
///
/// With the load W normal to the ground, the load G on level ground, the slope a, the speed of travel v, the rig's radius R, the rim speed
/// w R by the slip, drawbar pull F and torque M:
/// - traction coefficient F / W;
/// - power number M w / (W v);
/// - tractive efficiency F v / (M w), of a wheel that is driven and pulls;
/// - balanced slope atan(F / W) `[deg]`: the slope on which the pull at this slip and load balances the weight along the ground;
/// - net pull F - G sin a `[N]`: what is left beyond the weight along the slope;
/// - energy per metre M w / v `[J/m]`.
///
/// # Validity
/// One wheel in straight travel that carries its share of the weight. The transfer of load between the wheels of a vehicle is not in it,
/// nor the losses of motor and gear.
///
/// # Source
/// Wong 2008, *Theory of Ground Vehicles*, 4th ed., chapter 4 (tractive efficiency, drawbar pull coefficient); Creager, Asnani, Oravec and
/// Woodward 2017, NASA/TP-2017-219384 (power number, slope of equal pull). Checked by `tests::quantities_have_their_hand_numbers`.
///
/// # Arguments
/// - `rig_radius_m`: radius with which slip becomes rim speed `[m]`. `channels`: in the order of `Channel::ALL`.
/// - `is_stuck`: whether no slip balances the slope.
pub fn quantity_values(
    planned: &PlannedRun,
    rig_radius_m: f64,
    channels: [f64; 4],
    is_stuck: bool,
) -> QuantityValues {
    let run = &planned.run;
    let [pull, torque, sinkage, lateral] = channels;
    let (load, speed) = (run.wheel_load_n, run.sled_speed_m_s);
    let angular_speed = rim_speed_m_s(run.slip, speed) / rig_radius_m;
    let power = torque * angular_speed;
    let efficiency = if power > 0.0 {
        pull * speed / power
    } else {
        f64::NAN
    };
    let slope = libm::atan(pull / load).to_degrees();
    let along = planned.weight_n * libm::sin(planned.slope_deg.to_radians());
    [
        pull,
        torque,
        sinkage,
        lateral,
        pull / load,
        power / (load * speed),
        efficiency,
        slope,
        pull - along,
        power / speed,
        run.slip,
        load,
        speed,
        run.slip_angle_deg,
        planned.gravity_m_s2,
        planned.slope_deg,
        f64::from(u8::from(is_stuck)),
    ]
}

#[cfg(test)]
pub(crate) mod tests {
    use job::position_of;
    use shared::experiment::{RunUse, TestRun};

    use super::*;

    /// Returns a run at a slip on a slope, with 100 N on level ground.
    pub(crate) fn planned(slip: f64, slope_deg: f64) -> PlannedRun {
        let run = TestRun {
            name: "p".into(),
            wheel: "w".into(),
            soil: "s".into(),
            slip,
            wheel_load_n: 100.0 * libm::cos(slope_deg.to_radians()),
            sled_speed_m_s: 0.02,
            slip_angle_deg: 0.0,
            pass: 1,
            order: None,
            prepared: None,
            session: None,
            zero: None,
            operator: None,
            measured: [None; 4],
            history: None,
            sd: [None; 4],
            usage: RunUse::Holdout,
        };
        PlannedRun {
            run,
            weight_n: 100.0,
            gravity_m_s2: 9.81,
            slope_deg,
        }
    }

    #[test]
    fn quantities_have_their_hand_numbers() {
        let values = quantity_values(&planned(0.2, 0.0), 0.125, [20.0, 4.0, 0.008, 0.0], false);
        let value = |name: &str| values[position_of(name).unwrap()];
        // The rim moves at 0.025 m/s, the wheel turns with 0.2 rad/s and takes 0.8 W.
        for (name, expected) in [
            ("traction_coefficient", 0.2),
            ("power_number", 0.4),
            ("tractive_efficiency", 0.5),
            ("balanced_slope_deg", 11.309_932_474_020_215),
            ("net_pull_n", 20.0),
            ("energy_j_m", 40.0),
            ("stuck", 0.0),
        ] {
            assert!((value(name) - expected).abs() < 1e-9, "{name} {}", value(name));
        }
        let values = quantity_values(&planned(0.2, 30.0), 0.125, [50.0, -1.0, 0.0, 0.0], true);
        let value = |name: &str| values[position_of(name).unwrap()];
        // The weight along a slope of 30 degrees is half of the load on level ground.
        assert!(value("net_pull_n").abs() < 1e-9 && (value("balanced_slope_deg") - 30.0).abs() < 1e-9);
        assert!(value("tractive_efficiency").is_nan() && (value("stuck") - 1.0).abs() < 1e-15);
    }
}
