//! The spans of a footprint: gaps and runs of lanes along the travel.

use super::super::pack::Pack;

/// Gaps and runs of four lanes up to a strip, from the rear.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Span {
    /// The gap behind a run that begins in the strip `[m]`.
    pub(crate) gap: Pack,
    /// The largest pressure behind the gap `[Pa]`.
    pub(crate) behind: Pack,
    /// The largest pressure in the present run of lanes so far `[Pa]`.
    pub(crate) run: Pack,
}
