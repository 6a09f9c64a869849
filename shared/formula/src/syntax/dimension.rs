//! The dimensions of a formula: the check of its units.
//!
//! Only a certain contradiction is an error. A number takes the unit that its neighbour needs, as in `v_t / 0.02` or
//! `1.5 * p`; so does a quantity whose unit depends on a parameter, such as `k_star` or `z^n`.

use crate::syntax::graph::{Binary, Graph, Id, Node, Unary};
use crate::unit::Unit;

/// A contradiction between units, with its operation.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Contradiction {
    #[error("{0} needs an angle in rad, not in deg: multiply it by pi / 180")]
    Degrees(&'static str),
    #[error("{0} needs a number without unit, not one in {1}")]
    HasUnit(&'static str, Unit),
    #[error("{0} must have the same unit, not {1} and {2}")]
    Unlike(&'static str, Unit, Unit),
}

/// Returns the unit of an operation on nodes of a graph, if the units of its arguments determine it.
///
/// `parameters` are the units of the effect's parameters. Checked by `gallery::every_message_is_as_written`.
pub(crate) fn unit_of(
    graph: &Graph,
    node: Node,
    parameters: impl Fn(u8) -> Unit,
) -> Result<Option<Unit>, Contradiction> {
    let unit = |id: Id| graph.unit(id);
    match node {
        Node::Number(_) => Ok(None),
        Node::Variable(variable) => Ok(variable.unit()),
        Node::Parameter(place) => Ok(Some(parameters(place))),
        Node::Unary(operation, a) => unary(operation, unit(a)),
        Node::Binary(operation, a, b) => binary(operation, unit(a), unit(b), graph.node(b)),
        Node::If(_, a, b) => same("both branches of if", unit(a), unit(b)),
    }
}

fn unary(operation: Unary, argument: Option<Unit>) -> Result<Option<Unit>, Contradiction> {
    let name = match operation {
        Unary::Negate | Unary::Abs => return Ok(argument),
        Unary::Sqrt => return Ok(argument.and_then(|unit| unit.to_the(0.5))),
        Unary::Exp => "exp",
        Unary::Log => "log",
        Unary::Tanh => "tanh",
        Unary::Sin => "sin",
        Unary::Cos => "cos",
        Unary::Tan => "tan",
    };
    match (operation, argument) {
        (Unary::Sin | Unary::Cos | Unary::Tan, Some(Unit::DEGREE)) => Err(Contradiction::Degrees(name)),
        _ => plain(name, argument).map(|()| Some(Unit::ONE)),
    }
}

fn binary(
    operation: Binary,
    left: Option<Unit>,
    right: Option<Unit>,
    right_node: Node,
) -> Result<Option<Unit>, Contradiction> {
    let both = |combine: fn(Unit, Unit) -> Option<Unit>| left.zip(right).and_then(|(a, b)| combine(a, b));
    match operation {
        Binary::Add => same("both sides of +", left, right),
        Binary::Subtract => same("both sides of -", left, right),
        Binary::Min => same("both arguments of min", left, right),
        Binary::Max => same("both arguments of max", left, right),
        Binary::Less | Binary::LessOrEqual | Binary::Equal | Binary::Unequal => {
            same("both sides of a comparison", left, right)?;
            Ok(None)
        }
        Binary::Multiply => Ok(both(Unit::times)),
        Binary::Divide => Ok(both(Unit::over)),
        Binary::Power => {
            plain("an exponent", right)?;
            Ok(match (left, right_node) {
                (Some(Unit::ONE), _) => Some(Unit::ONE),
                (Some(unit), Node::Number(bits)) => unit.to_the(f64::from_bits(bits)),
                _ => None,
            })
        }
    }
}

/// Checks that an argument has no unit.
fn plain(what: &'static str, unit: Option<Unit>) -> Result<(), Contradiction> {
    match unit {
        Some(unit) if unit != Unit::ONE => Err(Contradiction::HasUnit(what, unit)),
        _ => Ok(()),
    }
}

/// Checks that two arguments have the same unit, and returns it if either has one.
fn same(what: &'static str, left: Option<Unit>, right: Option<Unit>) -> Result<Option<Unit>, Contradiction> {
    match (left, right) {
        (Some(a), Some(b)) if a != b => Err(Contradiction::Unlike(what, a, b)),
        (a, b) => Ok(a.or(b)),
    }
}
