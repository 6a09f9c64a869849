//! What lanes of a footprint span along the travel.

use super::super::pack::Pack;

/// What four lanes hold up to a strip, from the rear.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Span {
    /// The gap behind a run that begins in the strip `[m]`.
    pub(crate) gap: Pack,
    /// The greatest pressure behind that gap, and in the run so far `[Pa]`.
    pub(crate) behind: Pack,
    pub(crate) run: Pack,
}
