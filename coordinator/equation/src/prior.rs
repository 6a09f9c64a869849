//! How many parameters a formula has, and the widths of their priors.

use crate::tree::CONSTANTS;

/// The largest number of parameters that a formula has: its strength and its constants.
pub(crate) const PARAMETERS: usize = 1 + CONSTANTS;
/// Prior sd of the strength, over the root mean square of the curve, where the formula has a root mean square of 1.
pub(crate) const STRENGTH_SD: f64 = 2.0;
/// Prior sd of a constant's coordinate.
pub(crate) const CONSTANT_SD: f64 = 1.5;
/// ln √(2π).
const LOG_ROOT_TWO_PI: f64 = 0.918_938_533_204_672_7;

/// Returns ln N(x; 0, sd).
pub(crate) fn log_normal(x: f64, sd: f64) -> f64 {
    -0.5 * (x / sd) * (x / sd) - libm::log(sd) - LOG_ROOT_TWO_PI
}
