//! The test for trends in residuals on linear models with normal errors, where every answer is known.

use crate::setup::{lognormal, normal};
use inference::diagnostics::{PredictedDraw, Trend, TrendTest};
use nalgebra::{Cholesky, DMatrix, DVector};
use statistics::rng::Stream;
use statistics::{Datum, ErrorSd, Likelihood, Prior};

const CHANNELS: usize = 3;
const SLIPS: [f64; 4] = [0.05, 0.2, 0.4, 0.6];
const LOADS: [f64; 2] = [60.0, 120.0];
const SPEEDS: [f64; 3] = [0.01, 0.03, 0.08];
const PARAMETERS: usize = 4;
const SD: f64 = 0.5;

/// Slip, load and speed of every run, from -0.5 to 0.5.
fn conditions() -> Vec<[f64; 3]> {
    let scaled = |values: &[f64], x: f64| {
        let (low, high) = (values[0], values[values.len() - 1]);
        (x - low) / (high - low) - 0.5
    };
    let mut all = Vec::new();
    for slip in SLIPS {
        for load in LOADS {
            for speed in SPEEDS {
                all.push([scaled(&SLIPS, slip), scaled(&LOADS, load), scaled(&SPEEDS, speed)]);
            }
        }
    }
    all
}

/// Returns the regressors of a channel: constant, slip, load, speed, slip times speed, the last four about their means.
fn regressor(channel: usize, which: usize) -> Vec<f64> {
    let values: Vec<f64> = conditions()
        .iter()
        .map(|[slip, load, speed]| [1.0, *slip, *load, *speed, slip * speed][which])
        .collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let about = if which == 0 { 0.0 } else { mean };
    (0..CHANNELS)
        .flat_map(|c| {
            values
                .iter()
                .map(move |v| if c == channel { v - about } else { 0.0 })
        })
        .collect()
}

/// `y = X theta + sd e`: 24 runs with three channels, four standard normal parameters that bend all of them.
struct Rig {
    design: DMatrix<f64>,
    inferred: bool,
}

impl Rig {
    fn new(inferred: bool) -> Self {
        let runs = conditions();
        let design = DMatrix::from_fn(CHANNELS * runs.len(), PARAMETERS, |i, k| {
            let [slip, load, speed] = runs[i % runs.len()];
            let channel = (i / runs.len()) as f64;
            match k {
                0 => 3.0 * (1.0 + load) * (1.0 + 0.3 * channel),
                1 => 2.0 * (slip + 0.5) * (2.0 - channel),
                2 => (1.0 + slip * slip) * (channel - 0.5),
                _ => load * (1.0 - 0.5 * channel) + 0.4 * speed,
            }
        });
        Rig { design, inferred }
    }

    fn covariance(&self) -> DMatrix<f64> {
        let gram = self.design.transpose() * &self.design / (SD * SD);
        (DMatrix::identity(PARAMETERS, PARAMETERS) + gram)
            .try_inverse()
            .unwrap()
    }

    fn prior(&self) -> Prior {
        let mut marginals = vec![normal(0.0, 1.0); PARAMETERS];
        if self.inferred {
            marginals.extend(vec![lognormal(SD, 2.0); CHANNELS]);
        }
        Prior::new(marginals)
    }

    fn likelihood(&self, y: &DVector<f64>) -> Likelihood {
        let runs = conditions().len();
        let datum = |(i, value): (usize, &f64)| Datum {
            run: i % runs,
            channel: i / runs,
            value: *value,
            sd: match self.inferred {
                true => ErrorSd::Inferred {
                    parameter: PARAMETERS + i / runs,
                },
                false => ErrorSd::Known(SD),
            },
        };
        Likelihood::new(y.iter().enumerate().map(datum).collect()).unwrap()
    }

    fn data(&self, stream: &mut Stream) -> DVector<f64> {
        let theta = DVector::from_vec(stream.normals(PARAMETERS));
        let clean = &self.design * theta;
        let noise = DVector::from_vec(stream.normals(clean.len()));
        clean + SD * noise
    }

    /// Returns random draws of the posterior; inferred noise sds vary about the truth by a tenth.
    fn posterior(&self, y: &DVector<f64>, draws: usize, stream: &mut Stream) -> Vec<PredictedDraw> {
        let covariance = self.covariance();
        let mean = &covariance * self.design.transpose() * y / (SD * SD);
        let root = Cholesky::new(covariance).unwrap().unpack();
        (0..draws)
            .map(|_| {
                let theta = &mean + &root * DVector::from_vec(stream.normals(PARAMETERS));
                let values = (&self.design * &theta).iter().copied().collect();
                let mut theta: Vec<f64> = theta.iter().copied().collect();
                if self.inferred {
                    let sds = stream.normals(CHANNELS);
                    theta.extend(sds.iter().map(|e| SD * libm::exp(0.1 * e)));
                }
                PredictedDraw { theta, values }
            })
            .collect()
    }

    /// Returns every channel against every regressor.
    fn trends(&self, y: &DVector<f64>, stream: &mut Stream) -> Vec<Option<Trend>> {
        let likelihood = self.likelihood(y);
        let draws = self.posterior(y, 200, stream);
        let test = TrendTest::new(&likelihood, &self.prior(), &draws)
            .unwrap()
            .unwrap();
        let pairs = (0..CHANNELS).flat_map(|c| (0..5).map(move |k| (c, k)));
        pairs
            .map(|(channel, which)| test.against(&regressor(channel, which)))
            .collect()
    }
}

fn stream(k: u64) -> Stream {
    Stream::new(11, 0, k, 0)
}

#[test]
fn a_trend_of_a_line_is_its_closed_form() {
    let rig = Rig::new(false);
    let mut normals = stream(0);
    let y = rig.data(&mut normals);
    let trend = rig.trends(&y, &mut normals);
    // The prior predictive expectation of the data.
    let expected = &rig.design * rig.design.transpose() + DMatrix::identity(y.len(), y.len()) * (SD * SD);
    let inverse = expected.try_inverse().unwrap();
    for (pair, trend) in trend.iter().enumerate() {
        let trend = trend.unwrap();
        let x = DVector::from_vec(regressor(pair / 5, pair % 5));
        let information = x.dot(&(&inverse * &x));
        assert!((trend.sd * information.sqrt() - 1.0).abs() < 1e-9, "{pair}");
        let statistic = x.dot(&(&inverse * &y)) / information.sqrt();
        assert!((trend.statistic - statistic).abs() < 1e-9, "{pair}: {trend:?}");
        assert!((trend.slope / trend.sd - statistic).abs() < 1e-9);
        let whole = x.norm_squared() / (SD * SD);
        assert!((trend.share_left - information / whole).abs() < 1e-9);
        let p = libm::erfc(statistic.abs() / 2.0_f64.sqrt());
        assert!((trend.p - p).abs() < 1e-12);
    }
}

/// Shares of tests below 5 %, and of data sets with a flag at 1 % after correction.
fn alarms(rig: &Rig, sets: u64, disturb: impl Fn(&mut DVector<f64>)) -> (f64, f64) {
    let (mut single, mut flagged, mut tests) = (0, 0, 0);
    for k in 0..sets {
        let mut normals = stream(1 + k);
        let mut y = rig.data(&mut normals);
        disturb(&mut y);
        let p: Vec<f64> = rig
            .trends(&y, &mut normals)
            .iter()
            .flatten()
            .map(|t| t.p)
            .collect();
        single += p.iter().filter(|p| **p < 0.05).count();
        flagged += usize::from(p.iter().any(|one| one * (p.len() as f64) < 0.01));
        tests += p.len();
    }
    (single as f64 / tests as f64, flagged as f64 / sets as f64)
}

#[test]
fn trends_keep_their_level() {
    const SETS: u64 = 4000;
    for inferred in [false, true] {
        let (single, flagged) = alarms(&Rig::new(inferred), SETS, |_| {});
        assert!((0.042..0.058).contains(&single), "inferred {inferred}: {single}");
        // One in a hundred, and two standard errors of its count.
        let limit = 0.01 + 2.0 * (0.01 / SETS as f64).sqrt();
        assert!(flagged <= limit, "inferred {inferred}: {flagged}");
    }
}

#[test]
fn a_real_trend_is_found() {
    for inferred in [false, true] {
        // The torque follows slip, by five noise sds from one end to the other.
        let torque = DVector::from_vec(regressor(1, 1)) * (5.0 * SD);
        let (_, flagged) = alarms(&Rig::new(inferred), 200, |y| *y += &torque);
        assert!(flagged > 0.87, "inferred {inferred}: {flagged}");
    }
}

#[test]
fn what_the_fit_takes_up_is_not_judged() {
    let rig = Rig::new(false);
    let mut normals = stream(5);
    let y = rig.data(&mut normals);
    let (likelihood, draws) = (rig.likelihood(&y), rig.posterior(&y, 50, &mut normals));
    let test = TrendTest::new(&likelihood, &rig.prior(), &draws)
        .unwrap()
        .unwrap();
    let first: Vec<f64> = rig.design.column(0).iter().copied().collect();
    assert_eq!(test.against(&first), None);
    assert_eq!(
        test.against(&vec![0.0; y.len()]),
        None,
        "there is nothing to follow"
    );
    // One draw, or draws that do not spread, do not determine what the fit absorbs.
    for draws in [vec![draws[0].clone()], vec![draws[0].clone(); 9]] {
        assert!(
            TrendTest::new(&likelihood, &rig.prior(), &draws)
                .unwrap()
                .is_none()
        );
    }
}
