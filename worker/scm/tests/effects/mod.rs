//! Effects in the quasi-static model.

mod brute_force;
mod dimensions;
mod hidden;
mod neutral;
mod refusals;
mod signatures;
mod slip_angle;
