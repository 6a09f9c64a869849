//! Reference values of soil parameters for the figures: stated in the job, else estimated from plate and ring tests.

use std::collections::BTreeMap;

use inference::diagnostics::mean;
use job::{BevameterReadings, Spec};

/// Returns values of parameters by name: those that the job states, else those that the plate and ring tests give.
pub(super) fn values(spec: &Spec) -> BTreeMap<String, f64> {
    let mut values = BTreeMap::new();
    values.extend(sinkage_exponent(&spec.bevameter).map(|n| ("n".to_owned(), n)));
    values.extend(friction_angle_deg(&spec.bevameter).map(|phi| ("friction_angle_deg".to_owned(), phi)));
    values.extend(spec.reference.clone());
    values
}

/// Fits the sinkage exponent to plate tests: the common slope of ln p over ln z by least squares, with one intercept for each test.
fn sinkage_exponent(bevameter: &BevameterReadings) -> Option<f64> {
    let mut tests: BTreeMap<&str, Vec<[f64; 2]>> = BTreeMap::new();
    for reading in &bevameter.plates {
        let point = [
            libm::log(reading.condition.sinkage_m),
            libm::log(reading.stress_pa),
        ];
        tests.entry(&reading.test).or_default().push(point);
    }
    let (mut cross, mut squares) = (0.0, 0.0);
    for points in tests.values() {
        let middle = [0, 1].map(|i| mean(&points.iter().map(|p| p[i]).collect::<Vec<_>>()).unwrap_or(0.0));
        for p in points {
            let (z, pressure) = (p[0] - middle[0], p[1] - middle[1]);
            cross += z * pressure;
            squares += z * z;
        }
    }
    (squares > 0.0).then(|| cross / squares)
}

/// Estimates the friction angle from ring tests in cohesionless soil `[deg]`. The strength of a test is its reading at the largest
/// displacement, where shear is fully mobilised; tan(phi) is shear stress over normal stress. The logarithms are averaged, as the
/// likelihood has lognormal errors.
fn friction_angle_deg(bevameter: &BevameterReadings) -> Option<f64> {
    let mut last: BTreeMap<&str, [f64; 2]> = BTreeMap::new();
    for reading in &bevameter.rings {
        let way = reading.condition.shear_displacement_m;
        let ratio = libm::log(reading.stress_pa / reading.condition.normal_stress_pa);
        let entry = last.entry(&reading.test).or_insert([way, ratio]);
        if way > entry[0] {
            *entry = [way, ratio];
        }
    }
    let ratios: Vec<f64> = last.values().map(|r| r[1]).collect();
    mean(&ratios).map(|ratio| libm::atan(libm::exp(ratio)).to_degrees())
}

#[cfg(test)]
mod tests {
    use job::Reading;
    use shared::model::{PlateCondition, RingCondition};

    use super::*;

    #[test]
    fn plates_give_the_exponent_and_rings_the_angle() {
        let plate = |test: &str, level: f64, z: f64| Reading {
            test: test.into(),
            condition: PlateCondition {
                plate_radius_m: 0.03,
                sinkage_m: z,
            },
            stress_pa: level * z.powf(1.1),
        };
        let ring = |test: &str, sigma: f64, way: f64, mobilised: f64| Reading {
            test: test.into(),
            condition: RingCondition {
                normal_stress_pa: sigma,
                shear_displacement_m: way,
            },
            stress_pa: mobilised * sigma * 30.0_f64.to_radians().tan(),
        };
        let bevameter = BevameterReadings {
            plates: vec![
                plate("a", 1e7, 0.002),
                plate("a", 1e7, 0.01),
                plate("b", 2e7, 0.005),
                plate("b", 2e7, 0.02),
            ],
            rings: vec![
                ring("c", 5e3, 0.1, 1.0),
                ring("c", 5e3, 0.01, 0.6),
                ring("d", 2e4, 0.1, 1.0),
            ],
        };
        assert!((sinkage_exponent(&bevameter).unwrap() - 1.1).abs() < 1e-12);
        assert!((friction_angle_deg(&bevameter).unwrap() - 30.0).abs() < 1e-12);
        let none = BevameterReadings::default();
        assert_eq!((sinkage_exponent(&none), friction_angle_deg(&none)), (None, None));
    }
}
