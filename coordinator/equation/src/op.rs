//! The operations of a formula.

/// What a node of a formula computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Op {
    /// The variable.
    Variable,
    /// A constant that is fitted.
    Constant,
    /// The number 1.
    One,
    /// 1 above a fitted threshold of the variable, else 0.
    Threshold,
    /// The sum of both children.
    Add,
    /// The left child less the right one.
    Subtract,
    /// The product of both children.
    Multiply,
    /// The left child over the right one.
    Divide,
    /// The child to a fitted exponent.
    Power,
    /// The exponential.
    Exp,
    /// The natural logarithm.
    Log,
    /// The hyperbolic tangent.
    Tanh,
    /// The sine, in formulas of corrections alone.
    Sine,
    /// The square root.
    Sqrt,
    /// The second power.
    Square,
}
