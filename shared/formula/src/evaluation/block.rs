//! Evaluation of formulas at many points together.

pub use crate::evaluation::address::BLOCK;
use crate::evaluation::address::{Address, COLUMNS};
use crate::evaluation::arithmetic::{LANES, Lanes, binary_lanes, choose_lanes, unary_lanes};
use crate::evaluation::program::{Arithmetic, Operation, Program, Then};
use crate::syntax::graph::{Binary, Unary};
use crate::variable::Variable;

/// Variables at up to [`BLOCK`] points, with working memory.
///
/// # Example
/// ```
/// use formula::{Effect, Hook, Variable, block::Block, variable::Variables};
/// let effect = Effect::read("name = \"softer\"\nsummary = \"softer soil\"\nsource = \"none\"\npressure = \"p * (1 - a)\"\n\
///     [parameters.a]\nunit = \"1\"\nneutral = 0\nprior = { half_normal = 0.1 }\n").unwrap();
/// let local = Variables::new(&[Variable::P]);
/// let program = effect.program(Hook::Pressure, local).unwrap();
/// let (mut block, mut scalars) = (Block::default(), Vec::new());
/// program.settle(&[0.0; Variable::COUNT], &[0.25], &mut scalars);
/// block.column_mut(Variable::P)[..2].copy_from_slice(&[1e4, 2e4]);
/// block.replace(Variable::P, &program, &scalars, 2);
/// assert_eq!(block.column(Variable::P)[..2], [7.5e3, 1.5e4]);
/// ```
#[derive(Debug, Clone)]
pub struct Block {
    /// The columns of variables, one after the other, then the memory of programs.
    memory: Vec<f64>,
}

impl Default for Block {
    fn default() -> Self {
        Self {
            memory: vec![0.0; COLUMNS],
        }
    }
}

impl Block {
    /// Returns the values of a variable at all points; zero where nothing was written.
    ///
    /// # Panics
    /// Panics for a variable beyond the first [`Variable::LOCAL`].
    #[inline]
    pub fn column(&self, variable: Variable) -> &[f64] {
        let first = variable as usize * BLOCK;
        &self.memory[..COLUMNS][first..first + BLOCK]
    }

    /// Returns the column of a variable, writable.
    #[inline]
    pub fn column_mut(&mut self, variable: Variable) -> &mut [f64] {
        let first = variable as usize * BLOCK;
        &mut self.memory[..COLUMNS][first..first + BLOCK]
    }

    fn reserve(&mut self, needed: usize) {
        if self.memory.len() < needed {
            self.memory.resize(needed, 0.0);
        }
    }

    /// Replaces a variable at the first `points` points, at most [`BLOCK`], by the values of a program.
    ///
    /// `scalars` are the values that [`Program::settle`] left. Values beyond the last point are unspecified. Each value
    /// has the bits that [`Program::settle`] gives when nothing differs from point to point. Checked by
    /// `evaluation::every_operation_agrees_with_one_point_at_a_time` and `fuzz`.
    pub fn replace(&mut self, variable: Variable, program: &Program, scalars: &[f64], points: usize) {
        let constants = |constant| Address::constant(program.registers, constant).at(0);
        self.reserve(constants(program.constants.len()));
        for (constant, &scalar) in program.constants.iter().enumerate() {
            self.store(constants(constant), &[scalars[usize::from(scalar)]; LANES]);
        }
        let groups = points.min(BLOCK).div_ceil(LANES);
        for &(operation, out) in &program.operations {
            self.compute(operation, out, groups);
        }
        let target = Address::column(variable);
        match program.last {
            Some(operation) => self.compute(operation, target, groups),
            None => self.each(program.result, target, groups, |values| *values),
        }
    }

    fn compute(&mut self, operation: Operation<Address>, out: Address, groups: usize) {
        // each arm has a constant operation, so that the compiler specialises it
        macro_rules! unary {
            ($a:ident, $operation:ident, $($name:ident)*) => {
                match $operation {
                    $(Unary::$name => self.each($a, out, groups, |a| unary_lanes(Unary::$name, a)),)*
                }
            };
        }
        macro_rules! binary {
            ($a:ident, $b:ident, $operation:ident, $($name:ident)*) => {
                match $operation {
                    $(Binary::$name => self.both($a, $b, out, groups, |a, b| binary_lanes(Binary::$name, a, b)),)*
                }
            };
        }
        match operation {
            Operation::Unary(operation, a) => {
                unary!(a, operation, Negate Exp Log Sqrt Tanh Abs Sin Cos Tan);
            }
            Operation::Binary(operation, a, b) => {
                binary!(a, b, operation, Add Subtract Multiply Divide Power Min Max Less LessOrEqual Equal Unequal);
            }
            Operation::Pair(first, a, b, then) => self.pair(first, a, b, then, out, groups),
            Operation::If(c, a, b) => {
                for group in 0..groups {
                    let [c, a, b] = [c, a, b].map(|place| self.load(place, group));
                    self.store(out.at(group), &choose_lanes(&c, &a, &b));
                }
            }
        }
    }

    fn pair(
        &mut self,
        first: Arithmetic,
        a: Address,
        b: Address,
        then: Then<Address>,
        out: Address,
        groups: usize,
    ) {
        macro_rules! pair {
            ($first:ident, $($second:ident)*) => {
                match then {
                    Then::Exp => self.both(a, b, out, groups, |a, b| {
                        unary_lanes(Unary::Exp, &binary_lanes(Binary::$first, a, b))
                    }),
                    Then::Power(c) => self.three(a, b, c, out, groups, |a, b, c| {
                        binary_lanes(Binary::Power, &binary_lanes(Binary::$first, a, b), c)
                    }),
                    $(Then::Left(Arithmetic::$second, c) => self.three(a, b, c, out, groups, |a, b, c| {
                        binary_lanes(Binary::$second, &binary_lanes(Binary::$first, a, b), c)
                    }),
                    Then::Right(Arithmetic::$second, c) => self.three(a, b, c, out, groups, |a, b, c| {
                        binary_lanes(Binary::$second, c, &binary_lanes(Binary::$first, a, b))
                    }),)*
                }
            };
        }
        match first {
            Arithmetic::Add => pair!(Add, Add Subtract Multiply Divide),
            Arithmetic::Subtract => pair!(Subtract, Add Subtract Multiply Divide),
            Arithmetic::Multiply => pair!(Multiply, Add Subtract Multiply Divide),
            Arithmetic::Divide => pair!(Divide, Add Subtract Multiply Divide),
        }
    }

    #[inline(always)]
    fn three(
        &mut self,
        a: Address,
        b: Address,
        c: Address,
        out: Address,
        groups: usize,
        f: impl Fn(&Lanes, &Lanes, &Lanes) -> Lanes,
    ) {
        for group in 0..groups {
            let [a, b, c] = [a, b, c].map(|place| self.load(place, group));
            self.store(out.at(group), &f(&a, &b, &c));
        }
    }

    #[inline(always)]
    fn each(&mut self, a: Address, out: Address, groups: usize, f: impl Fn(&Lanes) -> Lanes) {
        for group in 0..groups {
            let values = f(&self.load(a, group));
            self.store(out.at(group), &values);
        }
    }

    #[inline(always)]
    fn both(
        &mut self,
        a: Address,
        b: Address,
        out: Address,
        groups: usize,
        f: impl Fn(&Lanes, &Lanes) -> Lanes,
    ) {
        for group in 0..groups {
            let values = f(&self.load(a, group), &self.load(b, group));
            self.store(out.at(group), &values);
        }
    }

    #[inline(always)]
    fn load(&self, place: Address, group: usize) -> Lanes {
        let first = place.at(group);
        let mut lanes = [0.0; LANES];
        lanes.copy_from_slice(&self.memory[first..first + LANES]);
        lanes
    }

    #[inline(always)]
    fn store(&mut self, first: usize, values: &Lanes) {
        self.memory[first..first + LANES].copy_from_slice(values);
    }
}
