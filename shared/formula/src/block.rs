//! Evaluate formulas at many points at a time.

use crate::elementary;
use crate::graph::{Binary, Unary};
use crate::program::{self, Operand, Operation, Program};
use crate::variable::Variable;

/// Most points of a block.
pub const BLOCK: usize = 128;

/// Points are computed so many at a time: a multiple of the width of vector registers.
const STRIDE: usize = 8;

/// The greatest argument of the exponential that vectorises.
const GREATEST: f64 = 700.0;

/// Variables at so many points, and room to compute with them.
///
/// # Example
/// ```
/// use formula::{Effect, Hook, Variable, block::Block, variable::Variables};
/// let effect = Effect::read("name = \"softer\"\nsummary = \"softer soil\"\nsource = \"none\"\npressure = \"p * (1 - a)\"\n\
///     [parameters.a]\nunit = \"1\"\nneutral = 0\nprior = { half_normal = 0.1 }\n").unwrap();
/// let local = Variables::of(&[Variable::P]);
/// let program = effect.program(Hook::Pressure, local).unwrap();
/// let (mut block, mut scalars) = (Block::default(), Vec::new());
/// program.settle(&[0.0; Variable::COUNT], &[0.25], &mut scalars);
/// block.column_mut(Variable::P)[..2].copy_from_slice(&[1e4, 2e4]);
/// block.replace(Variable::P, &program, &scalars, 2);
/// assert_eq!(block.column(Variable::P)[..2], [7.5e3, 1.5e4]);
/// ```
#[derive(Debug, Clone, Default)]
pub struct Block {
    columns: Vec<Vec<f64>>,
    registers: Vec<Vec<f64>>,
}

impl Block {
    /// A variable at all points; zero where nothing was written.
    pub fn column(&mut self, variable: Variable) -> &[f64] {
        self.column_mut(variable)
    }

    /// The same, to be written.
    pub fn column_mut(&mut self, variable: Variable) -> &mut [f64] {
        if self.columns.is_empty() {
            self.columns = vec![vec![0.0; BLOCK]; Variable::LOCAL];
        }
        &mut self.columns[variable as usize]
    }

    /// Replaces a variable at the first `points` points, at most [`BLOCK`], by what a program makes of all of them.
    ///
    /// `scalars` are those that [`Program::settle`] left. Values beyond the last point are unspecified. Checked by
    /// `tests::every_operation_agrees_with_one_point_at_a_time`.
    pub fn replace(&mut self, variable: Variable, program: &Program, scalars: &[f64], points: usize) {
        let points = points.min(BLOCK).next_multiple_of(STRIDE);
        self.column_mut(variable);
        while self.registers.len() < program.registers {
            self.registers.push(vec![0.0; BLOCK]);
        }
        for &(operation, register) in &program.operations {
            let mut out = core::mem::take(&mut self.registers[usize::from(register)]);
            let find = |operand| self.find(operand, scalars, points);
            match operation {
                Operation::Unary(operation, a) => each(operation, find(a), &mut out[..points]),
                Operation::Binary(operation, a, b) => both(operation, find(a), find(b), &mut out[..points]),
                Operation::If(c, a, b) => choose(find(c), find(a), find(b), &mut out[..points]),
            }
            self.registers[usize::from(register)] = out;
        }
        let target = variable as usize;
        match program.result {
            Operand::Scalar(place) => self.columns[target][..points].fill(scalars[usize::from(place)]),
            Operand::Column(own) if own == variable => {}
            Operand::Column(other) => {
                let values = core::mem::take(&mut self.columns[other as usize]);
                self.columns[target].copy_from_slice(&values);
                self.columns[other as usize] = values;
            }
            Operand::Register(register) => {
                core::mem::swap(
                    &mut self.columns[target],
                    &mut self.registers[usize::from(register)],
                );
            }
        }
    }

    fn find<'a>(&'a self, operand: Operand, scalars: &[f64], points: usize) -> Values<'a> {
        match operand {
            Operand::Scalar(place) => Values::Same(scalars[usize::from(place)]),
            Operand::Column(variable) => Values::Each(&self.columns[variable as usize][..points]),
            Operand::Register(register) => Values::Each(&self.registers[usize::from(register)][..points]),
        }
    }
}

/// An argument at all points.
#[derive(Debug, Clone, Copy)]
enum Values<'a> {
    Same(f64),
    Each(&'a [f64]),
}

impl Values<'_> {
    fn at(self, point: usize) -> f64 {
        match self {
            Values::Same(value) => value,
            Values::Each(values) => values[point],
        }
    }
}

fn map(a: Values, out: &mut [f64], f: impl Fn(f64) -> f64) {
    match a {
        Values::Same(a) => out.fill(f(a)),
        Values::Each(a) => out.iter_mut().zip(a).for_each(|(out, &a)| *out = f(a)),
    }
}

fn map_both(a: Values, b: Values, out: &mut [f64], f: impl Fn(f64, f64) -> f64) {
    match (a, b) {
        (Values::Same(a), Values::Same(b)) => out.fill(f(a, b)),
        (Values::Same(a), Values::Each(b)) => out.iter_mut().zip(b).for_each(|(out, &b)| *out = f(a, b)),
        (Values::Each(a), Values::Same(b)) => out.iter_mut().zip(a).for_each(|(out, &a)| *out = f(a, b)),
        (Values::Each(a), Values::Each(b)) => {
            let arguments = a.iter().zip(b);
            out.iter_mut()
                .zip(arguments)
                .for_each(|(out, (&a, &b))| *out = f(a, b));
        }
    }
}

fn choose(condition: Values, a: Values, b: Values, out: &mut [f64]) {
    for (point, out) in out.iter_mut().enumerate() {
        *out = if condition.at(point).abs() > 0.0 {
            a.at(point)
        } else {
            b.at(point)
        };
    }
}

fn each(operation: Unary, a: Values, out: &mut [f64]) {
    match operation {
        Unary::Negate => map(a, out, |a| -a),
        Unary::Sqrt => map(a, out, f64::sqrt),
        Unary::Abs => map(a, out, f64::abs),
        Unary::Exp => {
            map(a, out, |a| if a < -GREATEST { 0.0 } else { elementary::exp(a) });
            let small = |a: f64| a <= GREATEST; // false for what is no number
            if !holds(a, out, small) {
                mend(out, |point| (!small(a.at(point))).then(|| libm::exp(a.at(point))));
            }
        }
        Unary::Log => {
            map(a, out, elementary::ln);
            if !holds(a, out, has_logarithm) {
                mend(out, |point| {
                    (!has_logarithm(a.at(point))).then(|| libm::log(a.at(point)))
                });
            }
        }
        Unary::Tanh => map(a, out, tanh),
        Unary::Sin | Unary::Cos | Unary::Tan => map(a, out, |a| program::unary(operation, a)),
    }
}

fn both(operation: Binary, a: Values, b: Values, out: &mut [f64]) {
    // one loop for each operation, so that it is known while the loop is compiled
    match operation {
        Binary::Add => map_both(a, b, out, |a, b| program::binary(Binary::Add, a, b)),
        Binary::Subtract => map_both(a, b, out, |a, b| program::binary(Binary::Subtract, a, b)),
        Binary::Multiply => map_both(a, b, out, |a, b| program::binary(Binary::Multiply, a, b)),
        Binary::Divide => map_both(a, b, out, |a, b| program::binary(Binary::Divide, a, b)),
        Binary::Min => map_both(a, b, out, |a, b| program::binary(Binary::Min, a, b)),
        Binary::Max => map_both(a, b, out, |a, b| program::binary(Binary::Max, a, b)),
        Binary::Less => map_both(a, b, out, |a, b| program::binary(Binary::Less, a, b)),
        Binary::LessOrEqual => map_both(a, b, out, |a, b| program::binary(Binary::LessOrEqual, a, b)),
        Binary::Equal => map_both(a, b, out, |a, b| program::binary(Binary::Equal, a, b)),
        Binary::Unequal => map_both(a, b, out, |a, b| program::binary(Binary::Unequal, a, b)),
        Binary::Power => {
            map_both(a, b, out, |a, b| b * elementary::ln(a));
            let small = |argument: f64| argument.abs() <= GREATEST;
            let vectorises = holds(a, out, has_logarithm) & holds(Values::Each(out), out, small);
            out.iter_mut().for_each(|value| *value = elementary::exp(*value));
            if !vectorises {
                mend(out, |point| {
                    let vectorises =
                        has_logarithm(a.at(point)) && small(b.at(point) * elementary::ln(a.at(point)));
                    (!vectorises).then(|| libm::pow(a.at(point), b.at(point)))
                });
            }
        }
    }
}

/// Put exact values where a vectorised function is not defined.
fn mend(out: &mut [f64], exact: impl Fn(usize) -> Option<f64>) {
    for (point, value) in out.iter_mut().enumerate() {
        if let Some(exact) = exact(point) {
            *value = exact;
        }
    }
}

/// Whether the vectorised logarithm is defined.
#[inline(always)]
fn has_logarithm(x: f64) -> bool {
    (x >= f64::MIN_POSITIVE) & (x <= f64::MAX)
}

/// Whether something holds at all points; without a way out, so that it vectorises.
fn holds(a: Values, out: &[f64], f: impl Fn(f64) -> bool) -> bool {
    match a {
        Values::Same(a) => out.is_empty() || f(a),
        Values::Each(a) => a.iter().fold(true, |all, &a| all & f(a)),
    }
}

/// tanh without branches: by its series near 0, where 1 − e would cancel.
fn tanh(x: f64) -> f64 {
    let square = x * x;
    let series = x
        * (1.0
            - square
                * (1.0 / 3.0 - square * (2.0 / 15.0 - square * (17.0 / 315.0 - square * 62.0 / 2835.0))));
    let e = elementary::exp(-2.0 * x.abs());
    let far = f64::copysign((1.0 - e) / (1.0 + e), x);
    if x.abs() < 0.02 {
        series
    } else if x.is_nan() {
        x
    } else {
        far
    }
}
