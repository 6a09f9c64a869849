//! The operations of one effect's formulas, without repetition.

use std::collections::BTreeMap;

use crate::unit::Unit;
use crate::variable::{Variable, Variables};

/// Operations of one argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Unary {
    Negate,
    Exp,
    Log,
    Sqrt,
    Tanh,
    Abs,
    Sin,
    Cos,
    Tan,
}

/// Operations of two arguments; comparisons give 1 or 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Min,
    Max,
    Less,
    LessOrEqual,
    Equal,
    Unequal,
}

/// Position of an operation in its [`Graph`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Id(pub(crate) u16);

/// One operation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Node {
    /// A number, by its bits.
    Number(u64),
    Variable(Variable),
    /// Position among the effect's parameters.
    Parameter(u8),
    Unary(Unary, Id),
    Binary(Binary, Id, Id),
    /// The second argument where the first is not 0, else the third.
    If(Id, Id, Id),
}

impl Node {
    /// Returns the arguments of the operation.
    pub(crate) fn arguments(self) -> impl Iterator<Item = Id> {
        let arguments = match self {
            Node::Number(_) | Node::Variable(_) | Node::Parameter(_) => [None; 3],
            Node::Unary(_, a) => [Some(a), None, None],
            Node::Binary(_, a, b) => [Some(a), Some(b), None],
            Node::If(a, b, c) => [Some(a), Some(b), Some(c)],
        };
        arguments.into_iter().flatten()
    }
}

/// The operations of an effect; arguments precede the operations that use them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Graph {
    nodes: Vec<Node>,
    /// The unit of each operation, if it is determined.
    units: Vec<Option<Unit>>,
    positions: BTreeMap<Node, Id>,
}

impl Graph {
    /// The maximum number of operations of an effect.
    pub(crate) const MAX_OPERATIONS: usize = 1000;

    /// Adds an operation with its unit, or finds it if the graph has it; `None` if there are too many.
    pub(crate) fn add(&mut self, node: Node, unit: Option<Unit>) -> Option<Id> {
        if let Some(&id) = self.positions.get(&node) {
            return Some(id);
        }
        if self.nodes.len() >= Self::MAX_OPERATIONS {
            return None;
        }
        let id = Id(self.nodes.len() as u16);
        self.nodes.push(node);
        self.units.push(unit);
        self.positions.insert(node, id);
        Some(id)
    }

    /// Returns the position of an operation, if it is in the graph.
    pub(crate) fn find(&self, node: Node) -> Option<Id> {
        self.positions.get(&node).copied()
    }

    pub(crate) fn node(&self, id: Id) -> Node {
        self.nodes[usize::from(id.0)]
    }

    /// Returns the unit of an operation, if it is determined.
    pub(crate) fn unit(&self, id: Id) -> Option<Unit> {
        self.units[usize::from(id.0)]
    }

    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Returns the operations that a result depends on: arguments first, the result last.
    pub(crate) fn behind(&self, result: Id) -> Vec<Id> {
        let mut needed = vec![false; usize::from(result.0) + 1];
        needed[usize::from(result.0)] = true;
        for place in (0..needed.len()).rev() {
            if needed[place] {
                for argument in self.nodes[place].arguments() {
                    needed[usize::from(argument.0)] = true;
                }
            }
        }
        (0..needed.len())
            .filter(|&i| needed[i])
            .map(|i| Id(i as u16))
            .collect()
    }

    /// Returns the variables that a result depends on.
    pub(crate) fn variables(&self, result: Id) -> Variables {
        self.behind(result)
            .into_iter()
            .fold(Variables::default(), |set, id| match self.node(id) {
                Node::Variable(variable) => set.with(variable),
                _ => set,
            })
    }
}
