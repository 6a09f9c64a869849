//! Effects in the quasi-static model.

mod hidden;
mod neutral;
mod refusals;
mod signatures;
