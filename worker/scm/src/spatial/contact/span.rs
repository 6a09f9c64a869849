//! Gaps and runs of lanes of a footprint along the travel.

use super::super::pack::Pack;

/// Gaps and runs of four lanes up to a strip, from the rear.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Span {
    /// The gap behind a run that begins in the strip `[m]`.
    pub(crate) gap: Pack,
    /// The largest pressure behind that gap, and in the run so far `[Pa]`.
    pub(crate) behind: Pack,
    pub(crate) run: Pack,
}
