//! Settings of leases and verification.

use farm::calibration::VerificationRule;

/// Duration of a lease that is not renewed `[ms]`.
pub const LEASE_MS: u64 = 15_000;
/// Share of the evaluations that a second worker computes `[%]`.
pub const VERIFIED_PERCENT: f64 = 1.0;

/// Settings of leases and verification.
#[derive(Debug, Clone)]
pub struct FarmSettings {
    /// Duration of a lease that is not renewed `[ms]`.
    pub lease_ms: u64,
    /// Which evaluations a second worker computes, and who counts as another worker.
    pub rule: VerificationRule,
}
