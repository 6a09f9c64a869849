//! The arithmetic of formulas: one operation, at one point or at many, with the same bits.
//!
//! The functions that vectorise (module [`elementary`]) are used wherever they are defined, and those of `libm`
//! elsewhere, at one point as in a block, so that the result does not depend on how a formula is evaluated.

use crate::evaluation::elementary;
use crate::syntax::graph::{Binary, Unary};

/// Number of points computed together: a multiple of the width of vector registers.
pub(crate) const LANES: usize = 8;

/// The values of a quantity at [`LANES`] points.
pub(crate) type Lanes = [f64; LANES];

/// The largest argument of the exponential that vectorises; below its negative, e^x is 0.
const MAX_EXPONENT: f64 = 700.0;

/// Computes an operation of one argument at one point.
pub(crate) fn unary(operation: Unary, a: f64) -> f64 {
    match operation {
        Unary::Negate => -a,
        Unary::Exp => exp(a),
        Unary::Log => log(a),
        Unary::Sqrt => a.sqrt(),
        Unary::Tanh => tanh(a),
        Unary::Abs => a.abs(),
        Unary::Sin => libm::sin(a),
        Unary::Cos => libm::cos(a),
        Unary::Tan => libm::tan(a),
    }
}

/// Computes an operation of two arguments at one point. A minimum or maximum of NaN is NaN; comparisons give 1 or 0.
#[inline(always)]
pub(crate) fn binary(operation: Binary, a: f64, b: f64) -> f64 {
    let truth = |holds: bool| if holds { 1.0 } else { 0.0 };
    match operation {
        Binary::Add => a + b,
        Binary::Subtract => a - b,
        Binary::Multiply => a * b,
        Binary::Divide => a / b,
        Binary::Power => power(a, b),
        Binary::Min => {
            if (a < b) | a.is_nan() {
                a
            } else {
                b
            }
        }
        Binary::Max => {
            if (a > b) | a.is_nan() {
                a
            } else {
                b
            }
        }
        Binary::Less => truth(a < b),
        Binary::LessOrEqual => truth(a <= b),
        Binary::Equal => truth((a >= b) & (a <= b)),
        Binary::Unequal => truth(!((a >= b) & (a <= b))),
    }
}

/// Returns `a` where the condition is not 0, else `b`.
#[inline(always)]
pub(crate) fn choose(condition: f64, a: f64, b: f64) -> f64 {
    if condition.abs() > 0.0 { a } else { b }
}

/// Computes an operation of one argument at many points. It is inlined where the operation is known, so that each gets
/// its own loop.
#[inline(always)]
pub(crate) fn unary_lanes(operation: Unary, a: &Lanes) -> Lanes {
    match operation {
        Unary::Exp => vector_or_each(a, exp_in_reach, exp),
        Unary::Log => vector_or_each(a, |a| (elementary::ln(a), has_logarithm(a)), log),
        Unary::Negate => map(a, |a| -a),
        Unary::Sqrt => map(a, f64::sqrt),
        Unary::Abs => map(a, f64::abs),
        Unary::Tanh => map(a, tanh),
        Unary::Sin => map(a, libm::sin),
        Unary::Cos => map(a, libm::cos),
        Unary::Tan => map(a, libm::tan),
    }
}

/// Computes an operation of two arguments at many points.
#[inline(always)]
pub(crate) fn binary_lanes(operation: Binary, a: &Lanes, b: &Lanes) -> Lanes {
    match operation {
        Binary::Power => power_lanes(a, b),
        _ => map_both(a, b, |a, b| binary(operation, a, b)),
    }
}

/// Computes [`choose`] at many points.
#[inline(always)]
pub(crate) fn choose_lanes(condition: &Lanes, a: &Lanes, b: &Lanes) -> Lanes {
    let mut out = [0.0; LANES];
    for lane in 0..LANES {
        out[lane] = choose(condition[lane], a[lane], b[lane]);
    }
    out
}

#[inline(always)]
fn map(a: &Lanes, f: impl Fn(f64) -> f64) -> Lanes {
    let mut out = [0.0; LANES];
    for lane in 0..LANES {
        out[lane] = f(a[lane]);
    }
    out
}

#[inline(always)]
fn map_both(a: &Lanes, b: &Lanes, f: impl Fn(f64, f64) -> f64) -> Lanes {
    let mut out = [0.0; LANES];
    for lane in 0..LANES {
        out[lane] = f(a[lane], b[lane]);
    }
    out
}

/// Computes a function without branches if it is defined at all points, else the general one point by point.
#[inline(always)]
fn vector_or_each(a: &Lanes, vector: impl Fn(f64) -> (f64, bool), each: impl Fn(f64) -> f64) -> Lanes {
    let (mut out, mut defined) = ([0.0; LANES], true);
    for lane in 0..LANES {
        let (value, is_valid) = vector(a[lane]);
        out[lane] = value;
        defined &= is_valid; // no early exit, so that the loop vectorises
    }
    if defined { out } else { map(a, each) }
}

/// Returns e^a and whether it is valid: not for large arguments and NaN.
#[inline(always)]
fn exp_in_reach(a: f64) -> (f64, bool) {
    let value = elementary::exp(a);
    (if a < -MAX_EXPONENT { 0.0 } else { value }, a <= MAX_EXPONENT)
}

fn exp(a: f64) -> f64 {
    match exp_in_reach(a) {
        (value, true) => value,
        _ => libm::exp(a),
    }
}

/// Returns whether the vectorised logarithm is defined.
#[inline(always)]
fn has_logarithm(x: f64) -> bool {
    (x >= f64::MIN_POSITIVE) & x.is_finite()
}

fn log(a: f64) -> f64 {
    if has_logarithm(a) {
        elementary::ln(a)
    } else {
        libm::log(a)
    }
}

/// Returns whether a power is 0 because its base is: at the edge of a contact, and in the unused points of a block.
#[inline(always)]
fn is_zero_power(a: f64, b: f64) -> bool {
    (a.to_bits() == 0) & (b > 0.0)
}

#[inline(always)]
fn power_in_reach(a: f64, b: f64) -> (f64, bool) {
    let exponent = b * elementary::ln(a);
    let zero = is_zero_power(a, b);
    let value = elementary::exp(exponent);
    let vectorises = zero | (has_logarithm(a) & (exponent.abs() <= MAX_EXPONENT));
    (if zero { 0.0 } else { value }, vectorises)
}

fn power(a: f64, b: f64) -> f64 {
    match power_in_reach(a, b) {
        (value, true) => value,
        _ => libm::pow(a, b),
    }
}

#[inline(always)]
fn power_lanes(a: &Lanes, b: &Lanes) -> Lanes {
    let (mut out, mut vectorises) = ([0.0; LANES], true);
    for lane in 0..LANES {
        let (value, fine) = power_in_reach(a[lane], b[lane]);
        out[lane] = value;
        vectorises &= fine;
    }
    if vectorises { out } else { map_both(a, b, power) }
}

/// Computes tanh without branches; near 0 by its series, where 1 − e would cancel.
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
