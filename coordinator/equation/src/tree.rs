//! A formula of one variable as a tree, with the properties by which equal families of curves are recognised.

use std::sync::Arc;

use crate::op::Op;
use crate::unit::Unit;

/// The most constants of a formula, beside its strength.
pub(crate) const CONSTANTS: usize = 3;

/// A node of a formula with all below it.
///
/// `order` numbers the nodes of an enumeration, so that a sum or product is written in one order only.
#[derive(Debug)]
pub struct Tree {
    /// What the node computes.
    pub op: Op,
    /// The only or left child.
    pub left: Option<Arc<Tree>>,
    /// The right child.
    pub right: Option<Arc<Tree>>,
    /// Number of nodes; a fitted exponent or threshold counts as one.
    pub size: usize,
    /// Number of fitted constants.
    pub constants: usize,
    pub(crate) unit: Unit,
    pub(crate) order: usize,
    /// Whether a further constant factor would change nothing.
    pub(crate) absorbs_factor: bool,
    /// Whether a further constant summand would change nothing.
    pub(crate) absorbs_shift: bool,
    /// Whether a further constant exponent would change nothing.
    pub(crate) absorbs_power: bool,
    /// Whether it is a product of powers of the variable.
    is_monomial: bool,
    has_power: bool,
    /// Whether it has two values, so that every function of it is a sum or product with a constant.
    is_step: bool,
    /// Number of squares and square roots.
    pub(crate) fixed_powers: usize,
    /// Number of transcendental functions that stand in another one.
    pub(crate) nested: usize,
    /// Whether it has a transcendental function.
    is_transcendental: bool,
}

impl Tree {
    /// Makes the formula that is the variable itself.
    #[must_use]
    pub fn variable() -> Tree {
        Tree::leaf(Op::Variable, false)
    }

    /// Makes a leaf.
    pub(crate) fn leaf(op: Op, is_dimensionless: bool) -> Tree {
        let is_constant = op == Op::Constant;
        let unit = match op {
            Op::Constant => Unit::Free,
            Op::Variable if !is_dimensionless => Unit::VARIABLE,
            _ => Unit::ONE,
        };
        Tree {
            op,
            left: None,
            right: None,
            size: if op == Op::Threshold { 3 } else { 1 },
            constants: usize::from(is_constant || op == Op::Threshold),
            unit,
            order: 0,
            absorbs_factor: is_constant,
            absorbs_shift: is_constant,
            absorbs_power: is_constant,
            is_monomial: op == Op::Variable,
            has_power: false,
            is_step: op == Op::Threshold,
            fixed_powers: 0,
            nested: 0,
            is_transcendental: false,
        }
    }

    /// Returns whether the variable is not in it.
    fn is_number(&self) -> bool {
        matches!(self.op, Op::Constant | Op::One)
    }

    /// Returns whether it is a product with a constant in front.
    fn is_scaled(&self) -> bool {
        self.op == Op::Multiply && self.left.as_ref().is_some_and(|left| left.op == Op::Constant)
    }

    /// Returns the tree without a constant in front.
    fn core(self: &Arc<Self>) -> &Arc<Tree> {
        match &self.right {
            Some(right) if self.is_scaled() => right,
            _ => self,
        }
    }

    /// Applies an operation of one child; `None` where a smaller or another tree gives the same curves, or units contradict.
    pub(crate) fn unary(op: Op, child: &Arc<Tree>) -> Option<Tree> {
        let inner = child.op;
        let is_redundant = match op {
            // exp(log e) = e, and exp(e + c) has a constant factor outside.
            Op::Exp => inner == Op::Log || child.absorbs_shift,
            // The logarithm of a power has the exponent outside.
            Op::Log => {
                child.absorbs_power
                    || matches!(inner, Op::Exp | Op::Sqrt | Op::Square | Op::Divide)
                    || child.is_scaled() && child.core().op == Op::Exp
            }
            Op::Tanh | Op::Sine => matches!(inner, Op::Log | Op::Threshold),
            Op::Sqrt => {
                child.absorbs_power
                    || child.is_scaled()
                    || matches!(inner, Op::Sqrt | Op::Square | Op::Exp | Op::Threshold)
            }
            Op::Square => {
                child.absorbs_power
                    || child.is_scaled()
                    || matches!(inner, Op::Sqrt | Op::Square | Op::Exp | Op::Threshold)
                    || inner == Op::Subtract && child.left.as_ref().is_some_and(|left| left.absorbs_factor)
            }
            Op::Power => {
                child.absorbs_power
                    || child.is_scaled()
                    || matches!(inner, Op::Sqrt | Op::Square | Op::Exp | Op::Threshold)
                    || inner == Op::Divide && child.left.as_ref().is_some_and(|left| left.is_number())
            }
            _ => true,
        };
        if is_redundant || child.is_number() || child.is_step {
            return None;
        }
        let unit = child.unit.unary(op)?;
        let keeps = matches!(op, Op::Sqrt | Op::Square | Op::Power);
        let is_power = op == Op::Power;
        let transcends = matches!(op, Op::Exp | Op::Log | Op::Tanh | Op::Sine);
        Some(Tree {
            op,
            left: Some(child.clone()),
            right: None,
            size: child.size + if is_power { 2 } else { 1 },
            constants: child.constants + usize::from(is_power),
            unit,
            order: 0,
            absorbs_factor: keeps && child.absorbs_factor,
            absorbs_shift: op == Op::Log && child.absorbs_factor,
            absorbs_power: is_power || op == Op::Exp && child.absorbs_factor,
            is_monomial: keeps && child.is_monomial,
            has_power: is_power || child.has_power,
            is_step: false,
            fixed_powers: child.fixed_powers + usize::from(matches!(op, Op::Sqrt | Op::Square)),
            nested: child.nested + usize::from(transcends && child.is_transcendental),
            is_transcendental: transcends || child.is_transcendental,
        })
    }

    /// Joins two children; `None` where a smaller or another tree gives the same curves, or units contradict.
    pub(crate) fn binary(op: Op, left: &Arc<Tree>, right: &Arc<Tree>) -> Option<Tree> {
        let (a, b) = (left, right);
        if a.is_number() && b.is_number() || a.constants + b.constants > CONSTANTS {
            return None;
        }
        let is_sum = matches!(op, Op::Add | Op::Subtract);
        let is_step = a.is_number() && b.is_step || a.is_step && b.is_number();
        if is_step && !(a.op == Op::Constant && b.op == Op::Threshold && matches!(op, Op::Add | Op::Multiply))
        {
            return None;
        }
        let is_same = Arc::ptr_eq(a, b) && a.constants == 0;
        let is_redundant = match op {
            Op::Add => {
                a.order > b.order
                    || matches!(a.op, Op::Add | Op::Subtract)
                    || b.op == Op::Subtract
                    || b.op == Op::Add && b.left.as_ref().is_some_and(|next| a.order > next.order)
                    || a.is_number() && b.absorbs_shift
            }
            Op::Subtract => {
                b.is_number()
                    || matches!(b.op, Op::Subtract | Op::Add)
                    || b.absorbs_factor
                    || a.is_number() && b.absorbs_shift
            }
            Op::Multiply => {
                a.order > b.order
                    || a.op == Op::One
                    || a.op == Op::Multiply
                    || b.op == Op::Multiply && b.left.as_ref().is_some_and(|next| a.order > next.order)
                    || b.is_scaled()
                    || a.op == Op::Divide
                    || b.op == Op::Divide
                        && (a.op != Op::Constant || b.left.as_ref().is_some_and(|n| n.op == Op::One))
                    || a.absorbs_factor && b.absorbs_factor
            }
            Op::Divide => {
                b.is_number()
                    || a.op == Op::Divide
                    || b.op == Op::Divide
                    || a.is_scaled()
                    || b.is_scaled()
                    || a.absorbs_factor && b.absorbs_factor
                    || b.op == Op::Threshold
                    || matches!(b.op, Op::Exp | Op::Power)
            }
            _ => true,
        };
        let is_merged = if is_sum {
            Arc::ptr_eq(a.core(), b.core()) && a.core().constants == 0
        } else {
            a.is_monomial && b.is_monomial && (a.has_power || b.has_power)
                || a.op == Op::Threshold && b.op == Op::Threshold
                || a.op == Op::Exp && b.op == Op::Exp
        };
        if is_redundant || is_same || is_merged {
            return None;
        }
        Some(Tree {
            op,
            unit: a.unit.binary(op, b.unit)?,
            size: 1 + a.size + b.size,
            constants: a.constants + b.constants,
            order: 0,
            absorbs_factor: if is_sum {
                a.absorbs_factor && b.absorbs_factor
            } else {
                a.absorbs_factor || b.absorbs_factor
            },
            absorbs_shift: match op {
                Op::Add | Op::Subtract => a.absorbs_shift || b.absorbs_shift,
                Op::Multiply => a.op == Op::Constant && b.absorbs_shift,
                _ => false,
            },
            absorbs_power: false,
            is_monomial: !is_sum && a.is_monomial && b.is_monomial,
            has_power: a.has_power || b.has_power,
            is_step,
            fixed_powers: a.fixed_powers + b.fixed_powers,
            nested: a.nested + b.nested,
            is_transcendental: a.is_transcendental || b.is_transcendental,
            left: Some(a.clone()),
            right: Some(b.clone()),
        })
    }

    /// Returns whether the tree, times a strength, is a form of its own: the strength is its constant factor, and its sign.
    pub(crate) fn is_root(&self) -> bool {
        let (left, right) = (self.left.as_ref(), self.right.as_ref());
        let is_sign = self.op == Op::Subtract
            && (left.is_some_and(|a| a.absorbs_factor)
                || left.zip(right).is_some_and(|(a, b)| a.order > b.order));
        let is_reciprocal = self.op == Op::Divide && left.is_some_and(|a| a.op == Op::Constant);
        !(self.is_number() || self.absorbs_factor || is_sign || is_reciprocal)
    }
}
