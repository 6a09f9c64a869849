//! How many parameters a formula has, and the widths of their priors.

use crate::tree::CONSTANTS;

/// The largest number of parameters that a formula has: its strength and its constants.
pub(crate) const PARAMETERS: usize = 1 + CONSTANTS;
/// Prior sd of the strength, over the root mean square of the curve, where the formula has a root mean square of 1.
pub(crate) const STRENGTH_SD: f64 = 2.0;
/// Prior sd of a constant's coordinate.
pub(crate) const CONSTANT_SD: f64 = 1.5;
