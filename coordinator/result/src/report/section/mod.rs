//! The parts of the page, in reading order.

mod comparison;
mod diagnostics;
mod discovery;
mod errors;
mod estimate;
mod figures;
mod groups;
mod ledger;
mod parameters;
mod point_estimates;
mod provenance;
mod rejections;
mod stages;
mod verdict;

pub(super) use comparison::comparison;
pub(super) use diagnostics::diagnostics;
pub(super) use discovery::discovery;
pub(super) use errors::errors;
pub(super) use estimate::{estimate, fit};
pub(super) use figures::figures;
pub(super) use groups::groups;
pub(super) use ledger::ledger;
pub(super) use parameters::parameters;
pub(super) use point_estimates::point_estimates;
pub(super) use provenance::{provenance, subtitle};
pub(super) use rejections::rejections;
pub(super) use stages::stages;
pub(super) use verdict::verdict;
