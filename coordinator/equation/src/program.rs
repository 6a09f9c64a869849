//! A formula as operations on a stack: its value, and its derivatives by its constants.

use crate::op::Op;
use crate::tree::{CONSTANTS, Tree};

/// What a constant does in a formula; its prior follows from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ConstantRole {
    /// A factor or a summand.
    Coefficient,
    /// An exponent.
    Exponent,
    /// The value of the variable above which a part acts.
    Threshold,
}

/// One operation, with the index of its constant if it has one.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Step {
    op: Op,
    constant: usize,
}

/// A value with its derivatives by the constants.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dual {
    pub(crate) value: f64,
    pub(crate) by: [f64; CONSTANTS],
}

impl Dual {
    pub(crate) const fn of(value: f64) -> Self {
        Self {
            value,
            by: [0.0; CONSTANTS],
        }
    }

    /// A function of the value, with its derivative by it.
    fn chain(self, value: f64, slope: f64) -> Self {
        Self {
            value,
            by: self.by.map(|d| slope * d),
        }
    }

    /// A function of two values, with its derivatives by them.
    pub(crate) fn chain2(self, other: Self, value: f64, slopes: [f64; 2]) -> Self {
        let mut by = [0.0; CONSTANTS];
        for ((by, a), b) in by.iter_mut().zip(self.by).zip(other.by) {
            *by = slopes[0] * a + slopes[1] * b;
        }
        Self { value, by }
    }
}

/// A formula, ready to be evaluated.
#[derive(Debug, Clone)]
pub(crate) struct Program {
    steps: Vec<Step>,
    pub(crate) roles: Vec<ConstantRole>,
}

/// Depth of the stack: a formula of seven nodes needs four.
const DEPTH: usize = 8;

impl Program {
    pub(crate) fn new(tree: &Tree) -> Self {
        let mut program = Self {
            steps: Vec::new(),
            roles: Vec::new(),
        };
        program.push(tree);
        program
    }

    fn push(&mut self, tree: &Tree) {
        for child in [&tree.left, &tree.right].into_iter().flatten() {
            self.push(child);
        }
        let role = match tree.op {
            Op::Constant => Some(ConstantRole::Coefficient),
            Op::Power => Some(ConstantRole::Exponent),
            Op::Threshold => Some(ConstantRole::Threshold),
            _ => None,
        };
        self.steps.push(Step {
            op: tree.op,
            constant: self.roles.len(),
        });
        self.roles.extend(role);
    }

    /// Returns the value; NaN where it is undefined.
    pub(crate) fn value(&self, x: f64, constants: &[f64]) -> f64 {
        self.guarded(x, constants, &mut |_| {})
    }

    /// Returns the value, and shows each divisor on the way.
    pub(crate) fn guarded(&self, x: f64, constants: &[f64], divisor: &mut impl FnMut(f64)) -> f64 {
        let mut stack = [0.0; DEPTH];
        let mut top = 0;
        for step in &self.steps {
            match step.op {
                Op::Variable | Op::Constant | Op::One | Op::Threshold => {
                    stack[top] = match step.op {
                        Op::Variable => x,
                        Op::One => 1.0,
                        Op::Threshold => f64::from(x > constants[step.constant]),
                        _ => constants[step.constant],
                    };
                    top += 1;
                }
                Op::Add | Op::Subtract | Op::Multiply | Op::Divide => {
                    let (a, b) = (stack[top - 2], stack[top - 1]);
                    top -= 1;
                    stack[top - 1] = match step.op {
                        Op::Add => a + b,
                        Op::Subtract => a - b,
                        Op::Multiply => a * b,
                        _ => {
                            divisor(b);
                            a / b
                        }
                    };
                }
                op => {
                    let a = stack[top - 1];
                    stack[top - 1] = match op {
                        Op::Power => libm::pow(a, constants[step.constant]),
                        Op::Exp => libm::exp(a),
                        Op::Log => libm::log(a),
                        Op::Tanh => libm::tanh(a),
                        Op::Sine => libm::sin(a),
                        Op::Sqrt => a.sqrt(),
                        _ => a * a,
                    };
                }
            }
        }
        stack[0]
    }

    /// Returns the value with its derivatives by the constants; those by a threshold are 0.
    pub(crate) fn dual(&self, x: f64, constants: &[f64]) -> Dual {
        let mut stack = [Dual::of(0.0); DEPTH];
        let mut top = 0;
        for step in &self.steps {
            match step.op {
                Op::Variable | Op::Constant | Op::One | Op::Threshold => {
                    stack[top] = match step.op {
                        Op::Variable => Dual::of(x),
                        Op::One => Dual::of(1.0),
                        Op::Threshold => Dual::of(f64::from(x > constants[step.constant])),
                        _ => {
                            let mut leaf = Dual::of(constants[step.constant]);
                            leaf.by[step.constant] = 1.0;
                            leaf
                        }
                    };
                    top += 1;
                }
                Op::Add | Op::Subtract | Op::Multiply | Op::Divide => {
                    let (a, b) = (stack[top - 2], stack[top - 1]);
                    top -= 1;
                    stack[top - 1] = match step.op {
                        Op::Add => a.chain2(b, a.value + b.value, [1.0, 1.0]),
                        Op::Subtract => a.chain2(b, a.value - b.value, [1.0, -1.0]),
                        Op::Multiply => a.chain2(b, a.value * b.value, [b.value, a.value]),
                        _ => {
                            let value = a.value / b.value;
                            a.chain2(b, value, [1.0 / b.value, -value / b.value])
                        }
                    };
                }
                op => {
                    let a = stack[top - 1];
                    stack[top - 1] = match op {
                        Op::Power => {
                            let exponent = constants[step.constant];
                            let value = libm::pow(a.value, exponent);
                            let is_zero = a.value == 0.0;
                            let slope = if is_zero { 0.0 } else { exponent * value / a.value };
                            let mut power = a.chain(value, slope);
                            power.by[step.constant] += if is_zero { 0.0 } else { value * libm::log(a.value) };
                            power
                        }
                        Op::Exp => {
                            let value = libm::exp(a.value);
                            a.chain(value, value)
                        }
                        Op::Log => a.chain(libm::log(a.value), 1.0 / a.value),
                        Op::Tanh => {
                            let value = libm::tanh(a.value);
                            a.chain(value, 1.0 - value * value)
                        }
                        Op::Sine => a.chain(libm::sin(a.value), libm::cos(a.value)),
                        Op::Sqrt => {
                            let value = a.value.sqrt();
                            a.chain(value, if value > 0.0 { 0.5 / value } else { 0.0 })
                        }
                        _ => a.chain(a.value * a.value, 2.0 * a.value),
                    };
                }
            }
        }
        stack[0]
    }
}
