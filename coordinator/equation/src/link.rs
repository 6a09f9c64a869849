//! How a formula makes the values of a curve.

use crate::end::End;
use crate::program::{Dual, Program};
use crate::tree::CONSTANTS;

/// A formula is normalised where its value at the end is at least this share of its greatest change in the range.
const LEAST_AT_END: f64 = 0.01;

/// How a formula g with the strength a makes the values of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Link {
    /// a g: an addition, or the logarithm of a factor exp(a g).
    Proportional,
    /// The logarithm of a factor 1 + a g.
    Relative,
    /// a (g - g(end)): an addition, or a factor less 1, that vanishes at an end.
    Vanishing(End),
    /// g / g(end) - 1, without a strength: a factor less 1 that vanishes at an end.
    Normalised(End),
}

impl Link {
    /// Returns whether a strength is fitted.
    pub(crate) const fn has_strength(self) -> bool {
        !matches!(self, Link::Normalised(_))
    }

    /// Returns the end at which the formula vanishes.
    pub(crate) const fn end(self) -> Option<End> {
        match self {
            Link::Proportional | Link::Relative => None,
            Link::Vanishing(end) | Link::Normalised(end) => Some(end),
        }
    }

    /// Returns the formula's value at the end, with its derivatives; 0 without an end.
    pub(crate) fn at_end(self, program: &Program, constants: &[f64; CONSTANTS]) -> Dual {
        self.end()
            .map_or(Dual::of(0.0), |end| end.dual(program, constants))
    }

    /// Returns what the strength multiplies.
    ///
    /// # Arguments
    /// - `at_end`: value of the formula at the end.
    pub(crate) fn anchored(self, value: f64, at_end: f64) -> f64 {
        match self {
            Link::Proportional | Link::Relative => value,
            Link::Vanishing(_) => value - at_end,
            Link::Normalised(_) => value / at_end - 1.0,
        }
    }

    /// Returns what the strength multiplies, with its derivatives.
    pub(crate) fn anchored_dual(self, dual: Dual, at_end: Dual) -> Dual {
        let value = self.anchored(dual.value, at_end.value);
        match self {
            Link::Proportional | Link::Relative => dual,
            Link::Vanishing(_) => dual.chain2(at_end, value, [1.0, -1.0]),
            Link::Normalised(_) => {
                let slope = 1.0 / at_end.value;
                dual.chain2(at_end, value, [slope, -dual.value * slope * slope])
            }
        }
    }

    /// Returns what the strength multiplies at some places; `None` where the formula has no value at the end by which to do so.
    pub(crate) fn anchored_values(
        self,
        program: &Program,
        constants: &[f64; CONSTANTS],
        points: &[f64],
    ) -> Option<Vec<f64>> {
        let at_end = self.end().map_or(0.0, |end| end.value(program, constants));
        let values: Vec<f64> = points.iter().map(|x| program.value(*x, constants)).collect();
        let farther = |change: f64, value: &f64| change.max((value - at_end).abs());
        let change = values.iter().fold(0.0, farther);
        let is_reached = self
            .end()
            .is_none_or(|end| end.is_reached(program, constants, change));
        let is_normal = self.has_strength() || at_end.abs() >= LEAST_AT_END * change;
        let anchored = values.iter().map(|value| self.anchored(*value, at_end));
        (is_reached && is_normal).then(|| anchored.collect())
    }
}
