//! Corrections of textbook laws, found from 200 measurements with multiplicative noise.
//!
//! # Source
//! The package adcd 3.0.0 (PyPI): laws, values, ranges and noise of its scenarios of one variable that are not blind.

use std::sync::Arc;

use equation::{FittedFormula, FormulaLibrary, Host, LocatedCurve, Tree, search};
use statistics::rng::Stream;

use super::truth::Truth;

const MEASUREMENTS: usize = 200;
/// Measurements of neighbouring values of the variable that are averaged, so that a search takes seconds.
const AVERAGED: usize = 4;
const POINTS: usize = MEASUREMENTS / AVERAGED;
/// The sd of noise that is assumed where there is none.
const LEAST_NOISE: f64 = 1e-3;
/// Constants of each correction, or of 1 + it, beside its factor; of a power the exponent, which may be fitted.
const CONSTANTS: usize = 1;
/// Formulas of each curve that are compared.
const COMPARED: usize = 300;
/// A member of a class is listed if it has at least this share of the probability of the class's best.
const LISTED: f64 = 0.1;
/// Points at which formulas are compared.
const GRID: usize = 61;
/// Formulas of one class differ by at most this share of the curve's sd.
const CLASS: f64 = 0.5;

/// A correction vanishes at its limit where it is at most this share of its greatest magnitude in the range.
const VANISHES: f64 = 0.1;
/// Values of the variable that stand for 0 and for infinity, over the highest of the range.
const FAR: [f64; 2] = [1e-6, 1e6];

/// Where the law without its correction holds, which an entry is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Limit {
    Zero,
    Infinity,
}

/// A law whose correction is hidden.
pub struct Scenario {
    pub name: &'static str,
    /// The correction: a factor less 1, or an addition.
    pub correction: fn(f64) -> f64,
    range: [f64; 2],
    /// Where the correction vanishes.
    limit: Limit,
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
        limit: Limit::Zero,
        addition_to: None,
    },
    Scenario {
        name: "Yukawa gravity",
        correction: |r| 0.15 * libm::exp(-r / 2.5),
        range: [0.5, 5.0],
        limit: Limit::Infinity,
        addition_to: None,
    },
    Scenario {
        name: "anharmonic spring",
        correction: |x| 0.15 * x * x * x * x,
        range: [0.1, 3.0],
        limit: Limit::Zero,
        addition_to: Some(ClassicalLaw {
            value: |k, x| 0.5 * k * x * x,
            factors: [5.0, 50.0],
        }),
    },
    Scenario {
        name: "screened Coulomb force",
        correction: |r| libm::expm1(-r / 1.5),
        range: [0.2, 4.0],
        limit: Limit::Zero,
        addition_to: None,
    },
    Scenario {
        name: "net radiation",
        correction: |t| -libm::pow(293.15 / t, 4.0),
        range: [250.0, 800.0],
        limit: Limit::Infinity,
        addition_to: None,
    },
    Scenario {
        name: "nonlinear drag",
        correction: |v| 0.25 * v * v,
        range: [0.1, 5.0],
        limit: Limit::Zero,
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
        limit: Limit::Infinity,
        addition_to: None,
    },
    Scenario {
        name: "sinc of kinetic energy",
        correction: |v| libm::sin(v / 4.5) / (v / 4.5) - 1.0,
        range: [0.1, 10.0],
        limit: Limit::Zero,
        addition_to: None,
    },
    Scenario {
        name: "logarithmic spring",
        correction: |x| libm::log1p(x / 2.0) / (x / 2.0) - 1.0,
        range: [0.1, 5.0],
        limit: Limit::Zero,
        addition_to: None,
    },
];

/// The answer of the search to a scenario, judged by the hidden correction.
pub struct Said {
    /// Probability of the leading class.
    pub probability: f64,
    pub is_in_class: bool,
    pub is_simplest: bool,
    pub members: usize,
    pub simplest: String,
}

/// A formula of the correction, or of 1 + correction.
struct Candidate {
    tree: Arc<Tree>,
    /// Log prior and log evidence.
    weight: f64,
    /// The correction at points of the range.
    values: Vec<f64>,
    /// The correction at its limit.
    far: f64,
    is_true: bool,
}

impl Candidate {
    /// Returns whether the correction vanishes at its limit.
    fn vanishes(&self) -> bool {
        let greatest = self
            .values
            .iter()
            .fold(0.0_f64, |greatest, y| greatest.max(y.abs()));
        self.far.abs() <= VANISHES * greatest
    }
}

/// The correction as measured: a factor less 1, or an addition.
struct Measured {
    points: Vec<f64>,
    values: Vec<f64>,
    /// Variances on the diagonal.
    covariance: Vec<f64>,
}

impl Scenario {
    /// Returns the correction in measurements at drawn values of the variable and of the law's factor. The declared sd of a measurement is
    /// the noise times its value without noise.
    ///
    /// # Arguments
    /// - `noise`: sd of the measurements over their values.
    fn measured(&self, noise: f64, seed: u64, number: u64) -> Measured {
        let mut stream = Stream::new(seed, 2, number, 0);
        let [low, high] = self.range;
        let mut at: Vec<f64> = (0..MEASUREMENTS)
            .map(|_| low + (high - low) * stream.uniform())
            .collect();
        at.sort_by(f64::total_cmp);
        let errors = stream.normals(MEASUREMENTS);
        let assumed = noise.max(LEAST_NOISE);
        // The value of the variable, the correction, and its weight.
        let all: Vec<[f64; 3]> = at
            .iter()
            .zip(errors)
            .map(|(x, e)| {
                let base = self.addition_to.as_ref().map_or(1.0, |law| {
                    let [low, high] = law.factors;
                    (law.value)(low + (high - low) * stream.uniform(), *x)
                });
                let exact = base + (self.correction)(*x);
                let sd = assumed * exact.abs();
                [*x, exact * (1.0 + noise * e) - base, 1.0 / (sd * sd)]
            })
            .collect();
        let mut measured = Measured {
            points: Vec::with_capacity(POINTS),
            values: Vec::with_capacity(POINTS),
            covariance: vec![0.0; POINTS * POINTS],
        };
        for (i, group) in all.chunks(AVERAGED).enumerate() {
            let weight: f64 = group.iter().map(|[_, _, weight]| weight).sum();
            let mean = |k: usize| group.iter().map(|single| single[2] * single[k]).sum::<f64>() / weight;
            measured.points.push(mean(0));
            measured.values.push(mean(1));
            measured.covariance[i * (POINTS + 1)] = 1.0 / weight;
        }
        measured
    }
}

/// Searches the formula of a correction in noisy measurements; `None` if they make no curve.
///
/// A factor is searched as 1 + strength g and as strength g, with the same prior probability. A formula whose correction does not vanish
/// at its limit is left out.
///
/// # Arguments
/// - `noise`: sd of the measurements over their values.
pub fn searched(
    scenario: &Scenario,
    library: &FormulaLibrary,
    noise: f64,
    seed: u64,
    number: u64,
) -> Option<Said> {
    let measured = scenario.measured(noise, seed, number);
    let shifts: &[f64] = match scenario.addition_to {
        None => &[0.0, 1.0],
        Some(_) => &[0.0],
    };
    let [first, last] = [measured.points[0], measured.points[POINTS - 1]];
    let share = |i: usize| i as f64 / (GRID - 1) as f64;
    let grid: Vec<f64> = (0..GRID).map(|i| first + (last - first) * share(i)).collect();
    let far = match scenario.limit {
        Limit::Zero => FAR[0],
        Limit::Infinity => FAR[1],
    };
    let mut candidates: Vec<Candidate> = Vec::new();
    let mut sds: Vec<f64> = Vec::new();
    for shift in shifts {
        let values: Vec<f64> = measured.values.iter().map(|y| y + shift).collect();
        let curve =
            LocatedCurve::new(Host::Addition, &measured.points, &values, &measured.covariance).ok()?;
        sds = grid.iter().map(|x| curve.sd(*x)).collect();
        let truth = Truth::new(|x| (scenario.correction)(x) + shift, scenario.range, CONSTANTS);
        let formulas = search(&curve, library).formulas;
        let candidate = |formula: &FittedFormula| Candidate {
            tree: formula.tree.clone(),
            weight: library.log_prior(&formula.tree) + formula.log_evidence,
            values: grid.iter().map(|x| formula.law(&curve, *x) - shift).collect(),
            far: formula.law(&curve, far * scenario.range[1]) - shift,
            is_true: truth.is(&formula.tree),
        };
        let compared = formulas.iter().take(COMPARED).map(candidate);
        candidates.extend(compared.filter(Candidate::vanishes));
    }
    candidates.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    let best = candidates.first()?;
    let joins = |candidate: &&Candidate| {
        let mut pairs = candidate.values.iter().zip(&best.values).zip(&sds);
        pairs.all(|((a, b), sd)| (a - b).abs() <= CLASS * sd)
    };
    let relative = |candidate: &Candidate| libm::exp(candidate.weight - best.weight);
    let all: f64 = candidates.iter().map(relative).sum();
    let class: Vec<&Candidate> = candidates.iter().filter(joins).collect();
    let listed = class.iter().filter(|candidate| relative(candidate) >= LISTED);
    let listed: Vec<&&Candidate> = listed.collect();
    let simplest = listed.iter().min_by_key(|c| c.tree.size + c.tree.constants)?;
    Some(Said {
        probability: class.iter().map(|candidate| relative(candidate)).sum::<f64>() / all,
        is_in_class: listed.iter().any(|candidate| candidate.is_true),
        is_simplest: simplest.is_true,
        members: listed.len(),
        simplest: simplest.tree.to_string(),
    })
}
