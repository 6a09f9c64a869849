//! Plate and ring tests as data: their information about the soil, compared with a table of another implementation.

use nalgebra::DMatrix;
use statistics::{CommonError, CommonErrorSize, Datum, Discrepancy, ErrorLaw, ErrorSd, Likelihood};

/// The logarithm of a stress as a function of the parameters.
type Law = Box<dyn Fn(&[f64]) -> f64>;

/// Returns the standard deviations and the correlation of the first two parameters after tests, each a list of readings, from
/// the Fisher information: errors of logarithms, 1 / J' S^-1 J.
fn posterior(tests: &[Vec<Law>], theta: &[f64], steps: &[f64], s_u: f64, s_e: f64) -> (Vec<f64>, f64) {
    let readings: Vec<&Law> = tests.iter().flatten().collect();
    let data = (0..readings.len())
        .map(|run| Datum {
            run,
            channel: 0,
            value: readings[run](theta),
            sd: ErrorSd::Known(s_e),
        })
        .collect();
    let mut first = 0;
    let common = tests.iter().map(|test| {
        let members = (first..first + test.len()).collect();
        first += test.len();
        CommonError {
            data: members,
            size: CommonErrorSize::Shift(ErrorSd::Known(s_u)),
        }
    });
    let common = common.collect();
    let likelihood =
        Likelihood::with_common(data, ErrorLaw::Gaussian, common, vec![Discrepancy::None]).unwrap();
    let values: Vec<f64> = readings.iter().map(|f| f(theta)).collect();
    let whitening = likelihood.whitening(&values, &[]).unwrap();
    let columns: Vec<Vec<f64>> = (0..theta.len())
        .map(|k| {
            let at = |side: f64| {
                let mut moved = theta.to_vec();
                moved[k] += side * steps[k];
                moved
            };
            let (above, below) = (at(1.0), at(-1.0));
            let slopes = readings
                .iter()
                .map(|f| (f(&above) - f(&below)) / (2.0 * steps[k]));
            whitening.apply(&slopes.collect::<Vec<f64>>())
        })
        .collect();
    let count = theta.len();
    let information = DMatrix::from_fn(count, count, |k, l| whitening.curvature(&columns[k], &columns[l]));
    let covariance = information.try_inverse().unwrap();
    let sds: Vec<f64> = (0..count).map(|k| covariance[(k, k)].sqrt()).collect();
    let correlation = covariance[(0, 1)] / (sds[0] * sds[1]);
    (sds, correlation)
}

#[track_caller]
fn within(share: f64, given: &[f64], expected: &[f64]) {
    for (g, e) in given.iter().zip(expected) {
        assert!((g / e - 1.0).abs() <= share, "{given:?}, not {expected:?}");
    }
}

/// Truth `k_c` = 0, `k_phi` = 1e7, n = 1.1; 15 readings from 3 to 30 mm, noise 3 %.
#[test]
fn plates_fix_the_moduli_as_well_as_they_should() {
    for (radii_mm, repeats, s_u, sds, correlation) in [
        (&[50.0, 100.0][..], 1, 0.10, [1.4e5, 2.3e6], -0.94),
        (&[50.0, 100.0], 3, 0.10, [8.2e4, 1.3e6], -0.94),
        (&[50.0, 100.0], 3, 0.05, [4.1e4, 6.9e5], -0.91),
        (&[50.0, 100.0], 3, 0.20, [1.6e5, 2.6e6], -0.95),
        (&[30.0, 60.0, 120.0], 3, 0.10, [3.2e4, 7.3e5], -0.86),
        (&[25.0, 50.0, 100.0, 200.0], 3, 0.10, [2.2e4, 5.2e5], -0.78),
    ] {
        let mut laws: Vec<Vec<Law>> = Vec::new();
        for radius_mm in radii_mm {
            for _ in 0..repeats {
                let reading = |i: usize| -> Law {
                    let (b, z) = (radius_mm * 1e-3, 0.003 + 0.027 * i as f64 / 14.0);
                    Box::new(move |theta| (theta[0] / b + theta[1]).ln() + theta[2] * z.ln())
                };
                laws.push((0..15).map(reading).collect());
            }
        }
        let (got, corr) = posterior(&laws, &[0.0, 1e7, 1.1], &[10.0, 1e3, 1e-5], s_u, 0.03);
        within(0.2, &got[..2], &sds);
        assert!((corr - correlation).abs() < 0.05, "{corr}, not {correlation}");
        // The table has .003 to .008, decreasing with the number of tests.
        let per_test = got[2] * ((radii_mm.len() * repeats) as f64).sqrt();
        within(0.2, &[per_test], &[0.011]);
    }
}

/// Truth c = 0, Phi = 30 deg, K = 12 mm; five normal stresses from 5 to 40 kPa, 30 readings from 1 to 60 mm.
#[test]
fn rings_fix_strength_and_modulus_as_well_as_they_should() {
    for (s_u, s_e, sds, correlation) in [
        (0.05, 0.03, [200.0, 0.9, 0.1e-3], -0.79),
        (0.10, 0.03, [390.0, 1.8, 0.1e-3], -0.78),
        (0.03, 0.02, [120.0, 0.5, 0.07e-3], -0.81),
    ] {
        let mut laws: Vec<Vec<Law>> = Vec::new();
        for k in 0..5 {
            let sigma = 5e3 + 35e3 * f64::from(k) / 4.0;
            let reading = |i: usize| -> Law {
                let j = 0.001 + 0.059 * i as f64 / 29.0;
                Box::new(move |theta| {
                    let strength = theta[0] + sigma * theta[1].to_radians().tan();
                    (strength * (1.0 - (-j / theta[2]).exp())).ln()
                })
            };
            laws.push((0..30).map(reading).collect());
        }
        let (got, corr) = posterior(&laws, &[0.0, 30.0, 0.012], &[0.1, 1e-4, 1e-7], s_u, s_e);
        within(0.2, &got[..2], &sds[..2]);
        assert!((corr - correlation).abs() < 0.07, "{corr}, not {correlation}");
        assert!(got[2] < 1.2 * sds[2], "{got:?}, not {sds:?}");
    }
}
