//! Laws outside the library, as effect files.
//!
//! # Layout
//! - `range`: the variables along which an experiment can show a dependence, and their ranges.
//! - `dependence`: a quantity that depends on a variable, as a curve; `form`: in simple forms.
//! - `equation`: every formula that a curve may follow. `formula_file`: one of them as text and as an effect file.
//! - `file`: which of these a job can take. `curve`: the values of such a law, and its file for the user. `formula`: its formula
//!   with fitted values.

pub(super) mod curve;
pub(super) mod dependence;
pub(super) mod equation;
pub(super) mod file;
pub(super) mod form;
pub(super) mod formula;
mod formula_file;
mod range;
