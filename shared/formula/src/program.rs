//! Make a formula ready: what is the same everywhere is computed once, the rest point by point.

use crate::graph::{Binary, Graph, Id, Node, Unary};
use crate::variable::{Variable, Variables};

/// Where an operation at a point finds a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Operand {
    /// The same for all points: position among the scalars.
    Scalar(u16),
    /// A variable that differs from point to point.
    Column(Variable),
    /// What an earlier operation gave.
    Register(u16),
}

/// An operation at every point of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Operation {
    Unary(Unary, Operand),
    Binary(Binary, Operand, Operand),
    If(Operand, Operand, Operand),
}

/// A formula ready to be evaluated, for one choice of what differs from point to point.
#[derive(Debug, Clone)]
pub struct Program {
    /// What is the same at all points; arguments are positions among themselves.
    scalars: Vec<Node>,
    /// What is computed at every point, with the register that takes the result.
    pub(crate) operations: Vec<(Operation, u16)>,
    pub(crate) registers: usize,
    pub(crate) result: Operand,
    uses: Variables,
    local: Variables,
    parameters: Vec<u8>,
    kinked: bool,
}

impl Program {
    /// Compiles the result of a graph, where the variables `local` differ from point to point.
    pub(crate) fn compile(graph: &Graph, result: Id, local: Variables) -> Self {
        let behind = graph.behind(result);
        let mut compiler = Compiler {
            scalars: Vec::new(),
            operations: Vec::new(),
            places: vec![None; graph.len()],
            registers: Registers::new(graph, &behind),
        };
        let mut parameters = Vec::new();
        let mut kinked = false;
        for &id in &behind {
            if let Node::Parameter(place) = graph.node(id) {
                parameters.push(place);
            }
            let place = compiler.place(graph, id, local);
            kinked |= matches!(place, Operand::Register(_)) && has_kink(graph.node(id));
            compiler.places[usize::from(id.0)] = Some(place);
            compiler.registers.release(graph, id, &compiler.places);
        }
        Self {
            result: compiler.places[usize::from(result.0)].unwrap_or(Operand::Scalar(0)),
            scalars: compiler.scalars,
            operations: compiler.operations,
            registers: compiler.registers.most,
            uses: graph.variables(result),
            local,
            parameters,
            kinked,
        }
    }

    /// The variables that the formula uses.
    pub fn uses(&self) -> Variables {
        self.uses
    }

    /// The variables that differ from point to point.
    pub fn local(&self) -> Variables {
        self.local
    }

    /// The parameters that it uses, by their position in the effect.
    pub fn parameters(&self) -> &[u8] {
        &self.parameters
    }

    /// Whether the result has a kink or a jump somewhere between the points of a block.
    pub fn is_kinked(&self) -> bool {
        self.kinked
    }

    /// Computes what is the same at all points, and the result where it is.
    ///
    /// # Arguments
    /// - `variables`: by [`Variable`]; those that differ from point to point are not read.
    /// - `parameters`: of the effect, in its order.
    /// - `scalars`: takes the numbers; its allocation is used again.
    pub fn settle(
        &self,
        variables: &[f64; Variable::COUNT],
        parameters: &[f64],
        scalars: &mut Vec<f64>,
    ) -> Option<f64> {
        scalars.clear();
        for &node in &self.scalars {
            let of = |id: Id| scalars[usize::from(id.0)];
            let value = match node {
                Node::Number(bits) => f64::from_bits(bits),
                Node::Variable(variable) => variables[variable as usize],
                Node::Parameter(place) => parameters[usize::from(place)],
                Node::Unary(operation, a) => unary(operation, of(a)),
                Node::Binary(operation, a, b) => binary(operation, of(a), of(b)),
                Node::If(condition, a, b) => {
                    if of(condition).abs() > 0.0 {
                        of(a)
                    } else {
                        of(b)
                    }
                }
            };
            scalars.push(value);
        }
        match self.result {
            Operand::Scalar(place) => Some(scalars[usize::from(place)]),
            Operand::Column(_) | Operand::Register(_) => None,
        }
    }
}

/// Whether an operation is smooth in its arguments but for kinks or jumps.
fn has_kink(node: Node) -> bool {
    matches!(
        node,
        Node::If(..) | Node::Unary(Unary::Abs, _) | Node::Binary(Binary::Min | Binary::Max, ..)
    )
}

/// The value of an operation at one point, exact to the last bits everywhere.
pub(crate) fn unary(operation: Unary, a: f64) -> f64 {
    match operation {
        Unary::Negate => -a,
        Unary::Exp => libm::exp(a),
        Unary::Log => libm::log(a),
        Unary::Sqrt => a.sqrt(),
        Unary::Tanh => libm::tanh(a),
        Unary::Abs => a.abs(),
        Unary::Sin => libm::sin(a),
        Unary::Cos => libm::cos(a),
        Unary::Tan => libm::tan(a),
    }
}

/// The same for two arguments. A minimum or maximum of what is no number is no number.
#[inline(always)]
pub(crate) fn binary(operation: Binary, a: f64, b: f64) -> f64 {
    let truth = |holds: bool| if holds { 1.0 } else { 0.0 };
    match operation {
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide => a / b,
        Binary::Power => libm::pow(a, b),
        Binary::Min => {
            if a < b || a.is_nan() {
                a
            } else {
                b
            }
        }
        Binary::Max => {
            if a > b || a.is_nan() {
                a
            } else {
                b
            }
        }
        Binary::Less => truth(a < b),
        Binary::LessOrEqual => truth(a <= b),
        Binary::Equal => truth(a >= b && a <= b),
        Binary::Unequal => truth(!(a >= b && a <= b)),
    }
}

struct Compiler {
    scalars: Vec<Node>,
    operations: Vec<(Operation, u16)>,
    /// Where the value of each operation of the graph stands.
    places: Vec<Option<Operand>>,
    registers: Registers,
}

impl Compiler {
    fn of(&self, id: Id) -> Operand {
        // arguments stand before what uses them
        self.places[usize::from(id.0)].unwrap_or(Operand::Scalar(0))
    }

    fn place(&mut self, graph: &Graph, id: Id, local: Variables) -> Operand {
        let node = graph.node(id);
        if let Node::Variable(variable) = node
            && local.contains(variable)
        {
            return Operand::Column(variable);
        }
        let scalar = |operand: Operand| match operand {
            Operand::Scalar(place) => Some(Id(place)),
            Operand::Column(_) | Operand::Register(_) => None,
        };
        let same_everywhere = match node {
            Node::Number(_) | Node::Variable(_) | Node::Parameter(_) => Some(node),
            Node::Unary(operation, a) => scalar(self.of(a)).map(|a| Node::Unary(operation, a)),
            Node::Binary(operation, a, b) => scalar(self.of(a))
                .zip(scalar(self.of(b)))
                .map(|(a, b)| Node::Binary(operation, a, b)),
            Node::If(c, a, b) => match (scalar(self.of(c)), scalar(self.of(a)), scalar(self.of(b))) {
                (Some(c), Some(a), Some(b)) => Some(Node::If(c, a, b)),
                _ => None,
            },
        };
        if let Some(node) = same_everywhere {
            self.scalars.push(node);
            return Operand::Scalar((self.scalars.len() - 1) as u16);
        }
        let operation = match node {
            Node::Unary(operation, a) => Operation::Unary(operation, self.of(a)),
            Node::Binary(Binary::Power, a, b) => match graph.node(b) {
                // the powers that formulas use most need no logarithm
                Node::Number(bits) if bits == 2.0_f64.to_bits() => {
                    Operation::Binary(Binary::Multiply, self.of(a), self.of(a))
                }
                Node::Number(bits) if bits == 0.5_f64.to_bits() => Operation::Unary(Unary::Sqrt, self.of(a)),
                _ => Operation::Binary(Binary::Power, self.of(a), self.of(b)),
            },
            Node::Binary(operation, a, b) => Operation::Binary(operation, self.of(a), self.of(b)),
            Node::If(c, a, b) => Operation::If(self.of(c), self.of(a), self.of(b)),
            Node::Number(_) | Node::Variable(_) | Node::Parameter(_) => return Operand::Scalar(0),
        };
        let register = self.registers.take();
        self.operations.push((operation, register));
        Operand::Register(register)
    }
}

/// Which registers are free, and how often each value is still needed.
struct Registers {
    free: Vec<u16>,
    most: usize,
    uses: Vec<u32>,
}

impl Registers {
    fn new(graph: &Graph, behind: &[Id]) -> Self {
        let mut uses = vec![0; graph.len()];
        for &id in behind {
            for argument in graph.node(id).arguments() {
                uses[usize::from(argument.0)] += 1;
            }
        }
        Self {
            free: Vec::new(),
            most: 0,
            uses,
        }
    }

    fn take(&mut self) -> u16 {
        self.free.pop().unwrap_or_else(|| {
            self.most += 1;
            (self.most - 1) as u16
        })
    }

    /// Frees the registers of arguments that nothing needs any more. They are never the result's own: an operation does
    /// not overwrite what it reads.
    fn release(&mut self, graph: &Graph, id: Id, places: &[Option<Operand>]) {
        for argument in graph.node(id).arguments() {
            let left = &mut self.uses[usize::from(argument.0)];
            *left -= 1;
            if *left == 0
                && let Some(Operand::Register(register)) = places[usize::from(argument.0)]
            {
                self.free.push(register);
            }
        }
    }
}
