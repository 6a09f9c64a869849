//! Textbook laws with hidden corrections, and 200 measurements of each with multiplicative noise.
//!
//! # Source
//! The package adcd 3.0.0 (PyPI): laws, values, ranges and noise of its scenarios of one variable that are not blind.

use equation::{CurveError, End, Host, Link, LocatedCurve};
use statistics::rng::Stream;

const MEASUREMENTS: usize = 200;
/// Measurements of neighbouring values of the variable that are averaged where formulas are screened.
const AVERAGED: usize = 8;
/// Error of a mean of neighbours by the bend of the correction between them, over the root mean square of the correction.
const AVERAGING: f64 = 0.01;
/// The sd of noise that is assumed where there is none.
const LEAST_NOISE: f64 = 1e-3;

/// A law whose correction is hidden.
pub struct Scenario {
    pub name: &'static str,
    /// The correction: a factor less 1, or an addition.
    pub correction: fn(f64) -> f64,
    pub range: [f64; 2],
    /// Where the correction vanishes.
    pub limit: End,
    /// The law to which the correction is added; absent if the correction is a factor.
    addition_to: Option<ClassicalLaw>,
}

/// A law of the variable, with a factor that is drawn for each measurement.
struct ClassicalLaw {
    /// By the factor and the variable.
    value: fn(f64, f64) -> f64,
    factors: [f64; 2],
}

/// The nine scenarios. Speeds of the first are in units of the speed of light.
pub const SCENARIOS: [Scenario; 9] = [
    Scenario {
        name: "relativistic kinetic energy",
        correction: |v| 0.75 * v * v,
        range: [0.1, 0.85],
        limit: End::Zero,
        addition_to: None,
    },
    Scenario {
        name: "Yukawa gravity",
        correction: |r| 0.15 * libm::exp(-r / 2.5),
        range: [0.5, 5.0],
        limit: End::Infinity,
        addition_to: None,
    },
    Scenario {
        name: "anharmonic spring",
        correction: |x| 0.15 * x * x * x * x,
        range: [0.1, 3.0],
        limit: End::Zero,
        addition_to: Some(ClassicalLaw {
            value: |k, x| 0.5 * k * x * x,
            factors: [5.0, 50.0],
        }),
    },
    Scenario {
        name: "screened Coulomb force",
        correction: |r| libm::expm1(-r / 1.5),
        range: [0.2, 4.0],
        limit: End::Zero,
        addition_to: None,
    },
    Scenario {
        name: "net radiation",
        correction: |t| -libm::pow(293.15 / t, 4.0),
        range: [250.0, 800.0],
        limit: End::Infinity,
        addition_to: None,
    },
    Scenario {
        name: "nonlinear drag",
        correction: |v| 0.25 * v * v,
        range: [0.1, 5.0],
        limit: End::Zero,
        addition_to: Some(ClassicalLaw {
            value: |b, v| b * v,
            factors: [0.5, 5.0],
        }),
    },
    Scenario {
        name: "tanh of gravity",
        correction: |r| {
            let t = libm::tanh(1.2 / r);
            -t * t
        },
        range: [0.5, 5.0],
        limit: End::Infinity,
        addition_to: None,
    },
    Scenario {
        name: "sinc of kinetic energy",
        correction: |v| libm::sin(v / 4.5) / (v / 4.5) - 1.0,
        range: [0.1, 10.0],
        limit: End::Zero,
        addition_to: None,
    },
    Scenario {
        name: "logarithmic spring",
        correction: |x| libm::log1p(x / 2.0) / (x / 2.0) - 1.0,
        range: [0.1, 5.0],
        limit: End::Zero,
        addition_to: None,
    },
];

/// The correction as measured: a factor less 1, or an addition.
#[derive(Debug)]
pub struct Measured {
    /// By rising variable: its value, the correction, and the inverse of its variance.
    all: Vec<[f64; 3]>,
}

impl Measured {
    /// Returns the curve of all measurements.
    pub fn curve(&self) -> Result<LocatedCurve, CurveError> {
        curve(&self.all, 0.0)
    }

    /// Returns the curve of means of neighbouring measurements, for a search that takes seconds.
    pub fn averaged(&self) -> Result<LocatedCurve, CurveError> {
        let groups = self.all.chunks(AVERAGED).map(|group| {
            let weight: f64 = group.iter().map(|[_, _, weight]| weight).sum();
            let mean = |k: usize| group.iter().map(|single| single[2] * single[k]).sum::<f64>() / weight;
            [mean(0), mean(1), weight]
        });
        let groups: Vec<[f64; 3]> = groups.collect();
        let square = groups.iter().map(|[_, y, _]| y * y).sum::<f64>() / groups.len() as f64;
        curve(&groups, AVERAGING * AVERAGING * square)
    }
}

/// Makes a curve of values of the variable, values of the law, and their weights.
///
/// # Arguments
/// - `variance`: what is added to each variance.
fn curve(points: &[[f64; 3]], variance: f64) -> Result<LocatedCurve, CurveError> {
    let column = |k: usize| points.iter().map(|point| point[k]).collect::<Vec<f64>>();
    let mut covariance = vec![0.0; points.len() * points.len()];
    for (i, [_, _, weight]) in points.iter().enumerate() {
        covariance[i * (points.len() + 1)] = 1.0 / weight + variance;
    }
    LocatedCurve::new(Host::Addition, &column(0), &column(1), &covariance)
}

impl Scenario {
    /// Returns how a formula may make the correction: times a strength, or, as a factor, by itself.
    pub fn links(&self) -> Vec<Link> {
        let vanishing = Link::Vanishing(self.limit);
        match self.addition_to {
            None => vec![vanishing, Link::Normalised(self.limit)],
            Some(_) => vec![vanishing],
        }
    }

    /// Returns the correction in measurements at drawn values of the variable and of the law's factor. The declared sd of a measurement is
    /// the noise times its value without noise.
    ///
    /// # Arguments
    /// - `noise`: sd of the measurements over their values.
    pub fn measured(&self, noise: f64, seed: u64, number: u64) -> Measured {
        let mut stream = Stream::new(seed, 2, number, 0);
        let [low, high] = self.range;
        let mut at: Vec<f64> = (0..MEASUREMENTS)
            .map(|_| low + (high - low) * stream.uniform())
            .collect();
        at.sort_by(f64::total_cmp);
        let errors = stream.normals(MEASUREMENTS);
        let assumed = noise.max(LEAST_NOISE);
        let single = |(x, e): (&f64, f64)| {
            let base = self.addition_to.as_ref().map_or(1.0, |law| {
                let [low, high] = law.factors;
                (law.value)(low + (high - low) * stream.uniform(), *x)
            });
            let exact = base + (self.correction)(*x);
            let sd = assumed * exact.abs();
            [*x, exact * (1.0 + noise * e) - base, 1.0 / (sd * sd)]
        };
        Measured {
            all: at.iter().zip(errors).map(single).collect(),
        }
    }
}
