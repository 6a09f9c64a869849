//! The reach of the Gaussian kernel.

/// Reach of the kernel in bandwidths: exp(-32) of its height is neglected.
pub(super) const REACH: f64 = 8.0;
