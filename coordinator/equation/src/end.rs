//! The end of its variable at which a correction vanishes.

use crate::program::{Dual, Program};

/// A formula is defined at an end where its value on the way differs from that at the end by at most this share of its greatest change.
const REACHED: f64 = 0.1;

/// The end of a variable at which a correction vanishes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum End {
    /// The variable goes to 0 from above.
    Zero,
    /// The variable grows without bound.
    Infinity,
}

impl End {
    /// Returns the variable that stands for the end, and one on the way to it, over the greatest magnitude of the range.
    const fn places(self) -> [f64; 2] {
        match self {
            End::Zero => [1e-6, 1e-4],
            End::Infinity => [1e6, 1e4],
        }
    }

    /// Returns the value of a formula at the end.
    pub(crate) fn value(self, program: &Program, constants: &[f64]) -> f64 {
        program.value(self.places()[0], constants)
    }

    /// Returns the value of a formula at the end, with its derivatives.
    pub(crate) fn dual(self, program: &Program, constants: &[f64]) -> Dual {
        program.dual(self.places()[0], constants)
    }

    /// Returns whether a formula tends to a value at the end.
    ///
    /// # Arguments
    /// - `change`: the greatest distance of the formula from its value at the end, in the range.
    pub(crate) fn is_reached(self, program: &Program, constants: &[f64], change: f64) -> bool {
        let [there, before] = self.places().map(|x| program.value(x, constants));
        (there - before).abs() <= REACHED * change
    }
}
