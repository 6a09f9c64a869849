//! A factor of a term: a function of one state, or of a sum or difference.

use libm::{cos, exp, log, pow, sin, tan, tanh};

use super::super::dynamic_system::State;
use super::super::least_squares::Coordinate;

/// What a factor is a function of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Argument {
    State(usize),
    /// 1 less a state.
    Complement(usize),
    Sum(usize, usize),
    Difference(usize, usize),
    /// A state and another times a fitted constant.
    Weighted(usize, usize),
}

/// A function of one argument u, with its fitted constants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    Power(i32),
    Root,
    Absolute,
    Sine,
    Cosine,
    Tangent,
    Cotangent,
    Logarithm,
    /// u to a fitted exponent.
    FittedPower,
    /// exp of u times a constant.
    Exponential,
    /// log of u times a constant.
    ScaledLogarithm,
    /// tanh of u times a constant.
    Tanh,
    /// 1 over the sum of a power of a constant and the same power of u.
    Decay(i32),
    /// The same power of u times this.
    Hill(i32),
    /// The same with a fitted power.
    FittedHill,
    /// 1 over 1 + exp of a constant less u times another.
    Logistic,
}

/// A function of an argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Factor {
    pub argument: Argument,
    pub shape: Shape,
}

/// A fitted constant: its prior, whether its coordinate is its logarithm, and coordinates at which a fit may begin.
#[derive(Debug, Clone)]
pub struct Constant {
    pub coordinate: Coordinate,
    pub is_log: bool,
    pub begins: Vec<f64>,
}

impl Constant {
    fn new(mean: f64, sd: f64, is_log: bool, begins: &[f64]) -> Self {
        Self {
            coordinate: Coordinate { mean, sd, scale: sd },
            is_log,
            begins: begins.to_vec(),
        }
    }

    /// Returns a constant that divides u, by the greatest magnitude of u.
    fn divisor(size: f64) -> Self {
        let mean = log(size);
        Self::new(mean, 2.0, true, &[mean - 3.0, mean - 1.5, mean - 0.5, mean + 0.5])
    }

    /// Returns a constant that multiplies u.
    ///
    /// # Arguments
    /// - `sd`, `begins`: over one by that magnitude.
    fn rate(size: f64, sd: f64, begins: &[f64]) -> Self {
        let begins: Vec<f64> = begins.iter().map(|k| k / size).collect();
        Self::new(0.0, sd / size, false, &begins)
    }
}

impl Argument {
    /// Returns the number of nodes beyond one.
    fn extra_size(self) -> usize {
        match self {
            Argument::State(_) => 0,
            Argument::Complement(_) | Argument::Sum(..) | Argument::Difference(..) => 2,
            Argument::Weighted(..) => 3,
        }
    }

    fn value(self, state: &State, weight: f64) -> f64 {
        match self {
            Argument::State(i) => state[i],
            Argument::Complement(i) => 1.0 - state[i],
            Argument::Sum(i, j) => state[i] + state[j],
            Argument::Difference(i, j) => state[i] - state[j],
            Argument::Weighted(i, j) => state[i] + weight * state[j],
        }
    }

    /// Returns the greatest magnitude, by those of the states.
    fn magnitude(self, sizes: &State) -> f64 {
        match self {
            Argument::State(i) | Argument::Weighted(i, _) => sizes[i],
            Argument::Complement(_) => 1.0,
            Argument::Sum(i, j) | Argument::Difference(i, j) => sizes[i].max(sizes[j]),
        }
    }
}

impl Factor {
    /// Returns the number of nodes: operations, states and constants.
    pub fn size(&self) -> usize {
        let shape = match self.shape {
            Shape::Power(n) if n > 0 => n as usize,
            Shape::Power(n) => n.unsigned_abs() as usize + 1,
            Shape::Root
            | Shape::Absolute
            | Shape::Sine
            | Shape::Cosine
            | Shape::Tangent
            | Shape::Cotangent
            | Shape::Logarithm => 2,
            Shape::FittedPower | Shape::Exponential | Shape::ScaledLogarithm | Shape::Tanh => 3,
            Shape::Decay(n) => 2 + n as usize,
            Shape::Hill(n) => 3 + n as usize,
            Shape::FittedHill | Shape::Logistic => 5,
        };
        shape + self.argument.extra_size()
    }

    /// Returns the number of fitted constants.
    pub fn count(&self) -> usize {
        let shape = match self.shape {
            Shape::FittedPower
            | Shape::Exponential
            | Shape::ScaledLogarithm
            | Shape::Tanh
            | Shape::Decay(_)
            | Shape::Hill(_) => 1,
            Shape::FittedHill | Shape::Logistic => 2,
            _ => 0,
        };
        shape + usize::from(matches!(self.argument, Argument::Weighted(..)))
    }

    /// Returns whether it is a power of its argument.
    pub fn is_power(&self) -> bool {
        matches!(self.shape, Shape::Power(_) | Shape::Root | Shape::FittedPower)
    }

    /// Returns the constants, those of the shape first.
    ///
    /// # Arguments
    /// - `sizes`: the greatest magnitude of each state.
    pub fn constants(&self, sizes: &State) -> Vec<Constant> {
        let size = self.argument.magnitude(sizes);
        let mut constants = match self.shape {
            Shape::FittedPower => vec![Constant::new(1.0, 1.5, false, &[0.5, 1.3, 2.5])],
            Shape::Exponential => vec![Constant::rate(size, 3.0, &[-5.0, -2.0, -0.7, 0.7, 2.0])],
            Shape::Tanh => vec![Constant::rate(size, 3.0, &[1.0, 3.0])],
            Shape::ScaledLogarithm => {
                let mean = -log(size);
                vec![Constant::new(
                    mean,
                    2.0,
                    true,
                    &[mean - 1.0, mean + 1.0, mean + 3.0],
                )]
            }
            Shape::Decay(_) | Shape::Hill(_) => vec![Constant::divisor(size)],
            Shape::FittedHill => vec![
                Constant::divisor(size),
                Constant::new(2.0, 2.0, false, &[1.5, 4.0]),
            ],
            Shape::Logistic => vec![
                Constant::new(0.0, 3.0, false, &[-2.0, 0.0, 2.0]),
                Constant::rate(size, 10.0, &[-20.0, -5.0, -1.5, 1.5, 5.0, 20.0]),
            ],
            _ => Vec::new(),
        };
        if let Argument::Weighted(i, j) = self.argument {
            let ratio = sizes[i] / sizes[j];
            constants.push(Constant::new(
                0.0,
                1.5 * ratio,
                false,
                &[-0.5 * ratio, 0.5 * ratio],
            ));
        }
        constants
    }

    /// Returns the value; NaN where it is undefined.
    pub fn value(&self, state: &State, constants: &[f64]) -> f64 {
        let weight = constants.last().copied().unwrap_or(0.0);
        let u = self.argument.value(state, weight);
        match self.shape {
            Shape::Power(n) => u.powi(n),
            Shape::Root => u.sqrt(),
            Shape::Absolute => u.abs(),
            Shape::Sine => sin(u),
            Shape::Cosine => cos(u),
            Shape::Tangent => tan(u),
            Shape::Cotangent => 1.0 / tan(u),
            Shape::Logarithm => log(u),
            Shape::FittedPower => pow(u, constants[0]),
            Shape::Exponential => exp(constants[0] * u),
            Shape::ScaledLogarithm => log(constants[0] * u),
            Shape::Tanh => tanh(constants[0] * u),
            Shape::Decay(n) => over(1.0, constants[0].powi(n) + u.powi(n)),
            Shape::Hill(n) => over(u.powi(n), constants[0].powi(n) + u.powi(n)),
            Shape::FittedHill => 1.0 / (1.0 + pow(constants[0] / u, constants[1])),
            Shape::Logistic => 1.0 / (1.0 + exp(constants[0] - constants[1] * u)),
        }
    }

    /// Returns the factor as text.
    ///
    /// # Arguments
    /// - `constants`: their values.
    pub fn text(&self, constants: &[f64]) -> String {
        let number = |k: usize| format!("{:.3}", constants[k]);
        let u = match self.argument {
            Argument::State(i) => format!("x{i}"),
            Argument::Complement(i) => format!("(1 - x{i})"),
            Argument::Sum(i, j) => format!("(x{i} + x{j})"),
            Argument::Difference(i, j) => format!("(x{i} - x{j})"),
            Argument::Weighted(i, j) => format!("(x{i} + {} x{j})", number(constants.len() - 1)),
        };
        match self.shape {
            Shape::Power(1) => u,
            Shape::Power(n) => format!("{u}^{n}"),
            Shape::Root => format!("sqrt({u})"),
            Shape::Absolute => format!("abs({u})"),
            Shape::Sine => format!("sin({u})"),
            Shape::Cosine => format!("cos({u})"),
            Shape::Tangent => format!("tan({u})"),
            Shape::Cotangent => format!("cot({u})"),
            Shape::Logarithm => format!("log({u})"),
            Shape::FittedPower => format!("{u}^{}", number(0)),
            Shape::Exponential => format!("exp({} {u})", number(0)),
            Shape::ScaledLogarithm => format!("log({} {u})", number(0)),
            Shape::Tanh => format!("tanh({} {u})", number(0)),
            Shape::Decay(n) => format!("1/({}^{n} + {u}^{n})", number(0)),
            Shape::Hill(n) => format!("{u}^{n}/({}^{n} + {u}^{n})", number(0)),
            Shape::FittedHill => format!("1/(1 + ({}/{u})^{})", number(0), number(1)),
            Shape::Logistic => format!("1/(1 + exp({} - {} {u}))", number(0), number(1)),
        }
    }
}

/// Returns a quotient; NaN where the divisor is not positive, since a term has no pole.
fn over(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { f64::NAN }
}
