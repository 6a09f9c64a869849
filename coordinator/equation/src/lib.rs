//! Which formula a curve follows: every expression up to a size is fitted, weighed by its evidence, and grouped with those that the
//! curve cannot tell from it.
//!
//! # Layout
//! - `op`, `tree`, `unit`, `enumeration`: the formulas, each family of curves once, with units.
//! - `program`: a formula as operations, with derivatives.
//! - `link`, `end`: how a formula makes the values of a curve, and the end of the variable at which it vanishes.
//! - `curve`, `fit`, `start`, `prior`: the curve of a located law with its covariance, and the fit of one formula to it.
//! - `answer`: the search, its probabilities and classes.
//! - `limit`: what a formula says beyond the range, and the condition that splits two. `text`: a formula in the grammar of effect files.
//!   `parameters`: its parameters as coordinates, and their prior.
//!
//! Everything is pure and deterministic: results do not depend on the number of threads.

mod answer;
mod curve;
mod end;
mod enumeration;
mod fit;
mod limit;
mod link;
mod op;
mod parameters;
mod prior;
mod program;
mod start;
mod text;
mod tree;
mod unit;

pub use answer::{
    Answer, FittedFormula, FormulaClass, WeighedFit, answer, fits, fitted, probabilities, ranked, search,
};
pub use curve::{CurveError, Host, LocatedCurve};
pub use end::End;
pub use enumeration::FormulaLibrary;
pub use limit::{Limit, SplittingCondition, splitting};
pub use link::Link;
pub use op::Op;
pub use program::ConstantRole;
pub use text::{FormulaParameter, FormulaText, ParameterKind};
pub use tree::Tree;
