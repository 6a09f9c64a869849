//! A compiled formula: values that all points share are computed once, the rest point by point.

use crate::evaluation::address::Address;
use crate::evaluation::arithmetic::{binary, choose, unary};
use crate::syntax::graph::{Binary, Graph, Id, Node, Unary};
use crate::variable::{Variable, Variables};

/// The source of a number that an operation at a point reads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Operand {
    /// A value that all points share: its position among the scalars.
    Scalar(u16),
    /// A variable that differs from point to point.
    Column(Variable),
    /// The result of an earlier operation.
    Register(u16),
}

/// An operation at every point of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Operation<T> {
    Unary(Unary, T),
    Binary(Binary, T, T),
    If(T, T, T),
    /// One of the four operations of arithmetic, followed at once by a second one on its result.
    Pair(Arithmetic, T, T, Then<T>),
}

/// The operations that are cheap enough to be combined with the next one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Arithmetic {
    Add,
    Subtract,
    Multiply,
    Divide,
}

impl Arithmetic {
    fn new(operation: Binary) -> Option<Self> {
        match operation {
            Binary::Add => Some(Self::Add),
            Binary::Subtract => Some(Self::Subtract),
            Binary::Multiply => Some(Self::Multiply),
            Binary::Divide => Some(Self::Divide),
            _ => None,
        }
    }
}

/// The operation that follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Then<T> {
    Exp,
    /// The result to a power.
    Power(T),
    /// An operation with the result as its left argument.
    Left(Arithmetic, T),
    /// An operation with the result as its right argument.
    Right(Arithmetic, T),
}

impl<T> Operation<T> {
    /// Returns the same operation with its arguments mapped.
    fn map<U>(self, mut f: impl FnMut(T) -> U) -> Operation<U> {
        match self {
            Operation::Unary(operation, a) => Operation::Unary(operation, f(a)),
            Operation::Binary(operation, a, b) => Operation::Binary(operation, f(a), f(b)),
            Operation::If(c, a, b) => Operation::If(f(c), f(a), f(b)),
            Operation::Pair(operation, a, b, then) => {
                let (a, b) = (f(a), f(b));
                let then = match then {
                    Then::Exp => Then::Exp,
                    Then::Power(exponent) => Then::Power(f(exponent)),
                    Then::Left(operation, other) => Then::Left(operation, f(other)),
                    Then::Right(operation, other) => Then::Right(operation, f(other)),
                };
                Operation::Pair(operation, a, b, then)
            }
        }
    }
}

/// A compiled formula, for one choice of the variables that differ from point to point.
#[derive(Debug, Clone)]
pub struct Program {
    /// The nodes whose values all points share; arguments are positions in this list.
    scalars: Vec<Node>,
    /// The operations at every point with their registers, except the last.
    pub(crate) operations: Vec<(Operation<Address>, Address)>,
    /// The operation that gives the result, if it is computed point by point.
    pub(crate) last: Option<Operation<Address>>,
    pub(crate) registers: usize,
    /// The scalars that operations at points read.
    pub(crate) constants: Vec<u16>,
    pub(crate) result: Address,
    /// The position of the result among the scalars, if all points share it.
    scalar: Option<u16>,
    uses: Variables,
    local: Variables,
    parameters: Vec<u8>,
    kinks: Variables,
}

impl Program {
    /// Compiles the result of a graph; the variables `local` differ from point to point.
    pub(crate) fn compile(graph: &Graph, result: Id, local: Variables) -> Self {
        let behind = graph.behind(result);
        let mut compiler = Compiler {
            scalars: Vec::new(),
            operations: Vec::new(),
            places: vec![None; graph.len()],
            registers: Registers::new(graph, &behind),
        };
        let mut parameters = Vec::new();
        let mut kinks = Variables::default();
        for &id in &behind {
            if let Node::Parameter(place) = graph.node(id) {
                parameters.push(place);
            }
            let place = compiler.place(graph, id, local);
            kinks = kinks.union(kinks_by(graph, id));
            compiler.places[usize::from(id.0)] = Some(place);
            compiler.registers.release(graph, id, &compiler.places);
        }
        let result_operand = compiler.operand(result);
        let registers = compiler.registers.count;
        let mut constants = Vec::new();
        let mut place = |operand: Operand| match operand {
            Operand::Column(variable) => Address::column(variable),
            Operand::Register(register) => Address::register(usize::from(register)),
            Operand::Scalar(scalar) => {
                let position = constants.iter().position(|&s| s == scalar);
                let constant = position.unwrap_or_else(|| {
                    constants.push(scalar);
                    constants.len() - 1
                });
                Address::constant(registers, constant)
            }
        };
        let mut operations: Vec<(Operation<Address>, Address)> =
            Vec::with_capacity(compiler.operations.len());
        for (operation, register) in compiler.operations {
            operations.push((
                operation.map(&mut place),
                Address::register(usize::from(register)),
            ));
        }
        let last = match result_operand {
            Operand::Register(_) => operations.pop().map(|(operation, _)| operation),
            Operand::Scalar(_) | Operand::Column(_) => None,
        };
        let scalar = match result_operand {
            Operand::Scalar(scalar) => Some(scalar),
            Operand::Column(_) | Operand::Register(_) => None,
        };
        Self {
            result: place(result_operand),
            last,
            scalar,
            constants,
            scalars: compiler.scalars,
            operations,
            registers,
            uses: graph.variables(result),
            local,
            parameters,
            kinks,
        }
    }

    /// Returns the variables that the formula uses.
    pub fn uses(&self) -> Variables {
        self.uses
    }

    /// Returns the variables that differ from point to point.
    pub fn local(&self) -> Variables {
        self.local
    }

    /// Returns the parameters that it uses, by their position in the effect.
    pub fn parameters(&self) -> &[u8] {
        &self.parameters
    }

    /// Returns the variables on which the result depends through a kink or a jump.
    pub fn kinks(&self) -> Variables {
        self.kinks
    }

    /// Computes the values that all points share, and returns the result if it is one of them.
    ///
    /// # Arguments
    /// - `variables`: by [`Variable`], in their units; those that differ from point to point are not read.
    /// - `parameters`: of the effect, in its order and its units.
    /// - `scalars`: receives the numbers for [`Block::replace`]; its allocation is reused.
    ///
    /// # Returns
    /// The result in the unit of the quantity that the formula replaces, not checked by [`Hook::admits`]; `None` if it
    /// differs from point to point. Undefined values are NaN, as the [crate](crate#numbers) says; there is no error.
    ///
    /// # Panics
    /// If there are fewer parameters than the effect has.
    ///
    /// Checked by `evaluation::operators_bind_as_in_mathematics` and `fuzzed::formulas_follow_the_precedence_of_their_operators`.
    ///
    /// [`Block::replace`]: crate::evaluation::block::Block::replace
    /// [`Hook::admits`]: crate::Hook::admits
    pub fn settle(
        &self,
        variables: &[f64; Variable::COUNT],
        parameters: &[f64],
        scalars: &mut Vec<f64>,
    ) -> Option<f64> {
        scalars.clear();
        for &node in &self.scalars {
            let argument = |id: Id| scalars[usize::from(id.0)];
            let value = match node {
                Node::Number(bits) => f64::from_bits(bits),
                Node::Variable(variable) => variables[variable as usize],
                Node::Parameter(place) => parameters[usize::from(place)],
                Node::Unary(operation, a) => unary(operation, argument(a)),
                Node::Binary(operation, a, b) => binary(operation, argument(a), argument(b)),
                Node::If(condition, a, b) => choose(argument(condition), argument(a), argument(b)),
            };
            scalars.push(value);
        }
        self.scalar.map(|place| scalars[usize::from(place)])
    }
}

/// Returns the variables whose change takes an operation through a kink or a jump.
fn kinks_by(graph: &Graph, id: Id) -> Variables {
    match graph.node(id) {
        Node::If(condition, ..) => graph.variables(condition),
        node @ (Node::Unary(Unary::Abs, _) | Node::Binary(Binary::Min | Binary::Max, ..)) => {
            node.arguments().fold(Variables::default(), |set, argument| {
                set.union(graph.variables(argument))
            })
        }
        _ => Variables::default(),
    }
}

/// Replaces the most frequent powers: x^2 by x x, and x^0.5 by the square root.
fn without_power(graph: &Graph, node: Node) -> Node {
    let Node::Binary(Binary::Power, a, b) = node else {
        return node;
    };
    match graph.node(b) {
        Node::Number(bits) if bits == 2.0_f64.to_bits() => Node::Binary(Binary::Multiply, a, a),
        Node::Number(bits) if bits == 0.5_f64.to_bits() => Node::Unary(Unary::Sqrt, a),
        _ => node,
    }
}

struct Compiler {
    scalars: Vec<Node>,
    operations: Vec<(Operation<Operand>, u16)>,
    /// The place of the value of each operation of the graph.
    places: Vec<Option<Operand>>,
    registers: Registers,
}

impl Compiler {
    fn operand(&self, id: Id) -> Operand {
        // arguments precede the operations that use them
        self.places[usize::from(id.0)].unwrap_or(Operand::Scalar(0))
    }

    fn place(&mut self, graph: &Graph, id: Id, local: Variables) -> Operand {
        let node = without_power(graph, graph.node(id));
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
            Node::Unary(operation, a) => scalar(self.operand(a)).map(|a| Node::Unary(operation, a)),
            Node::Binary(operation, a, b) => scalar(self.operand(a))
                .zip(scalar(self.operand(b)))
                .map(|(a, b)| Node::Binary(operation, a, b)),
            Node::If(c, a, b) => match (
                scalar(self.operand(c)),
                scalar(self.operand(a)),
                scalar(self.operand(b)),
            ) {
                (Some(c), Some(a), Some(b)) => Some(Node::If(c, a, b)),
                _ => None,
            },
        };
        if let Some(node) = same_everywhere {
            self.scalars.push(node);
            return Operand::Scalar((self.scalars.len() - 1) as u16);
        }
        let operation = match node {
            Node::Unary(operation, a) => Operation::Unary(operation, self.operand(a)),
            Node::Binary(operation, a, b) => Operation::Binary(operation, self.operand(a), self.operand(b)),
            Node::If(c, a, b) => Operation::If(self.operand(c), self.operand(a), self.operand(b)),
            Node::Number(_) | Node::Variable(_) | Node::Parameter(_) => return Operand::Scalar(0),
        };
        let operation = self.without_sign(node, operation);
        let operation = self.paired(node, operation);
        let register = self.registers.take();
        self.operations.push((operation, register));
        Operand::Register(register)
    }

    /// Rewrites (−x) s or (−x) / s, with s equal at all points, as x (−s) or x / (−s): the same bits without a loop for the sign.
    fn without_sign(&mut self, node: Node, operation: Operation<Operand>) -> Operation<Operand> {
        if let Node::Binary(_, x, _) = node
            && let Operation::Binary(
                product @ (Binary::Multiply | Binary::Divide),
                negated,
                Operand::Scalar(s),
            ) = operation
            && let Some(&(Operation::Unary(Unary::Negate, positive), register)) = self.operations.last()
            && negated == Operand::Register(register)
            && self.registers.uses[usize::from(x.0)] == 1
        {
            self.operations.pop();
            self.scalars.push(Node::Unary(Unary::Negate, Id(s)));
            let negative = Operand::Scalar((self.scalars.len() - 1) as u16);
            return Operation::Binary(product, positive, negative);
        }
        operation
    }

    /// Joins the operation with the preceding one if only it uses that result: this saves reading, writing and dispatch.
    fn paired(&mut self, node: Node, operation: Operation<Operand>) -> Operation<Operand> {
        let Some(&(Operation::Binary(first, a, b), register)) = self.operations.last() else {
            return operation;
        };
        let is_first = |operand: Operand| operand == Operand::Register(register);
        let then = match operation {
            Operation::Unary(Unary::Exp, x) if is_first(x) => Some(Then::Exp),
            Operation::Binary(Binary::Power, x, y) if is_first(x) && !is_first(y) => Some(Then::Power(y)),
            Operation::Binary(second, x, y) if is_first(x) && !is_first(y) => {
                Arithmetic::new(second).map(|second| Then::Left(second, y))
            }
            Operation::Binary(second, x, y) if is_first(y) && !is_first(x) => {
                Arithmetic::new(second).map(|second| Then::Right(second, x))
            }
            _ => None,
        };
        let Some((first, then)) = Arithmetic::new(first).zip(then) else {
            return operation;
        };
        let mut arguments = node.arguments();
        let alone =
            arguments.any(|id| is_first(self.operand(id)) && self.registers.uses[usize::from(id.0)] == 1);
        if !alone {
            return operation;
        }
        self.operations.pop();
        Operation::Pair(first, a, b, then)
    }
}

/// The free registers, and the number of uses that each value still has.
struct Registers {
    free: Vec<u16>,
    count: usize,
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
            count: 0,
            uses,
        }
    }

    fn take(&mut self) -> u16 {
        self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            (self.count - 1) as u16
        })
    }

    /// Frees the registers of arguments that have no further use. The register of the result is never among them,
    /// because an operation does not overwrite its arguments.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effect::Effect;
    use crate::hook::Hook;

    /// Compiles a formula where z differs from point to point.
    fn program(formula: &str) -> Program {
        let text = format!("name = \"a\"\nsummary = \"a\"\nsource = \"a\"\npressure = \"{formula}\"\n");
        let effect = Effect::read(&text).unwrap();
        effect
            .program(Hook::Pressure, Variables::new(&[Variable::Z]))
            .unwrap()
    }

    #[test]
    fn a_value_used_twice_by_one_operation_frees_its_register_once() {
        let mut graph = Graph::default();
        let z = graph.add(Node::Variable(Variable::Z), None).unwrap();
        let e = graph.add(Node::Unary(Unary::Exp, z), None).unwrap();
        let square = graph.add(Node::Binary(Binary::Multiply, e, e), None).unwrap();
        let behind = graph.behind(square);
        let mut registers = Registers::new(&graph, &behind);
        let mut places = vec![None; graph.len()];
        places[usize::from(e.0)] = Some(Operand::Register(registers.take()));
        places[usize::from(square.0)] = Some(Operand::Register(registers.take()));
        registers.release(&graph, square, &places);
        // a register freed twice would be given to two values at once
        assert_eq!(registers.free, [0]);
    }

    #[test]
    fn operations_of_arithmetic_run_with_what_follows() {
        for (formula, loops) in [
            ("z * (1 - exp(-z / 0.01)) * 1", 3), // exp(z / -0.01); z (1 - e); times 1
            ("(z / 0.02)^1.1 * 1", 2),
            ("(z + 1) * (z + 1) * 1", 2), // z + 1 is needed twice
            ("-z * 1", 1),
        ] {
            let program = program(formula);
            let count = program.operations.len() + usize::from(program.last.is_some());
            assert_eq!(count, loops, "{formula}");
        }
    }
}
