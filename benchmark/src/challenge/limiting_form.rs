//! Whether a formula is but the limit of a constant, in which it is another formula.

use equation::{FittedFormula, LocatedCurve};

/// Magnitudes of a constant, of the variable over its greatest magnitude, beyond which a formula is the limit of another, shorter one: sin(c x)
/// is c x where c is small, and x / (c + x) is x / c where c is great.
const CONSTANT: [f64; 2] = [0.05, 20.0];

/// Returns whether a constant of a fitted formula is so small or great that the formula is another one, which has its own fit.
pub fn is_limit(curve: &LocatedCurve, formula: &FittedFormula) -> bool {
    let [least, greatest] = CONSTANT;
    let constants = &formula.constants(curve)[..formula.tree.constants];
    !constants.iter().all(|c| (least..=greatest).contains(&c.abs()))
}
