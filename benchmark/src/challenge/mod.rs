//! Challenges that others stated: laws that are missing from systems that have nothing to do with wheels.
//!
//! # Layout
//! - [`dynamic_system`]: equations of motion with a law left out, and what is measured of them. [`least_squares`]: a fit.
//! - [`located_law`]: the missing law as a curve. [`parametric_law`], [`weighed`]: formulas of the curve, fitted and weighed through the
//!   equations of motion. [`design`]: the experiment that separates them.
//! - [`truth`]: whether a formula is the hidden one. [`limiting_form`]: whether it is but the limit of a constant.
//! - [`grouping`]: formulas that measurements cannot tell apart.
//! - [`bioreactor`]: Monod's law in a fed-batch reactor, by experiments that are designed one after the other.
//! - [`scenario`]: textbook laws with hidden corrections. [`correction`]: the search of their formulas.
//! - [`odebench`]: a term that is removed from each of 63 systems of ordinary differential equations.

pub mod bioreactor;
pub mod correction;
pub mod design;
pub mod dynamic_system;
pub mod grouping;
pub mod least_squares;
pub mod limiting_form;
pub mod located_law;
pub mod odebench;
pub mod parametric_law;
pub mod scenario;
pub mod truth;
pub mod weighed;
