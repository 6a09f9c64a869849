//! The pictures: inline SVG whose colours come from the page's style.

mod axis;
mod comparison;
mod curve;
mod frame;
mod marginal;
mod pair;
mod scale;
mod stages;

pub(super) use comparison::{ComparisonChart, shared_range};
pub(super) use curve::curve;
pub(super) use frame::{Marker, glyph};
pub(super) use marginal::marginal;
pub(super) use pair::pair;
pub(super) use stages::{drift, exponent};
