//! How the farm leases and verifies.

/// A lease lasts so long without renewal `[ms]`.
pub const LEASE_MS: u64 = 15_000;
/// So many of the evaluations are computed by a second worker `[%]`.
pub const VERIFIED_PERCENT: f64 = 1.0;

/// How the farm leases and verifies.
#[derive(Debug, Clone, Copy)]
pub struct FarmSettings {
    /// A lease lasts so long without renewal `[ms]`.
    pub lease_ms: u64,
    /// Share of the evaluations that a second worker computes, in [0, 1]; with 0 nothing is verified.
    pub verified_share: f64,
}
