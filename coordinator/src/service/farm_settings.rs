//! Settings of leases and verification.

/// Duration of a lease that is not renewed `[ms]`.
pub const LEASE_MS: u64 = 15_000;
/// Share of the evaluations that a second worker computes `[%]`.
pub const VERIFIED_PERCENT: f64 = 1.0;

/// Settings of leases and verification.
#[derive(Debug, Clone, Copy)]
pub struct FarmSettings {
    /// Duration of a lease that is not renewed `[ms]`.
    pub lease_ms: u64,
    /// Share of the evaluations that a second worker computes, in [0, 1]; with 0 nothing is verified.
    pub verified_share: f64,
}
