//! The unit of a part of a formula: a power of the variable's unit, or whatever a constant gives it.

use crate::op::Op;

/// The unit of a part of a formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unit {
    /// Any: a constant has the unit that its neighbours need.
    Free,
    /// The variable's unit to this many eighths.
    Fixed(i16),
    /// The variable's unit to a fitted exponent; only a constant factor gives it another.
    Fitted,
}

impl Unit {
    /// A pure number.
    pub(crate) const ONE: Unit = Unit::Fixed(0);
    /// The unit of the variable.
    pub(crate) const VARIABLE: Unit = Unit::Fixed(8);

    /// Returns the unit of an operation of one child; `None` where it needs a pure number.
    pub(crate) fn unary(self, op: Op) -> Option<Unit> {
        match (op, self) {
            (Op::Exp | Op::Log | Op::Tanh | Op::Sine, Unit::Free | Unit::Fixed(0)) => Some(Unit::ONE),
            (Op::Exp | Op::Log | Op::Tanh | Op::Sine, _) => None,
            (Op::Power, Unit::Fixed(0)) => Some(Unit::ONE),
            (Op::Power, Unit::Fixed(_)) => Some(Unit::Fitted),
            (Op::Sqrt, Unit::Fixed(eighths)) => (eighths % 2 == 0).then_some(Unit::Fixed(eighths / 2)),
            (Op::Square, Unit::Fixed(eighths)) => Some(Unit::Fixed(2 * eighths)),
            (_, unit) => Some(unit),
        }
    }

    /// Returns the unit of an operation of two children; `None` where a sum has two units.
    pub(crate) fn binary(self, op: Op, other: Unit) -> Option<Unit> {
        match (op, self, other) {
            (Op::Add | Op::Subtract, Unit::Free, unit) | (Op::Add | Op::Subtract, unit, Unit::Free) => {
                Some(unit)
            }
            (Op::Add | Op::Subtract, a, b) => (a == b && a != Unit::Fitted).then_some(a),
            (_, Unit::Free, _) | (_, _, Unit::Free) => Some(Unit::Free),
            (Op::Multiply, Unit::Fixed(a), Unit::Fixed(b)) => Some(Unit::Fixed(a + b)),
            (Op::Divide, Unit::Fixed(a), Unit::Fixed(b)) => Some(Unit::Fixed(a - b)),
            _ => Some(Unit::Fitted),
        }
    }
}
