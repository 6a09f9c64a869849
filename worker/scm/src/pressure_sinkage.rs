//! Normal pressure of a soil at a sinkage (Bekker).

use crate::soil::Soil;

/// Modulus k* of pressure–sinkage for a footprint of effective width `b_eff`.
///
/// `k* = k_c / b_eff + k_phi`
///
/// # Arguments
/// - `b_eff`: `[m]`, > 0; see [`footprint`](crate::footprint).
///
/// # Returns
/// k* `[N/m^(n+2)]`. It is not positive for a small footprint when `k_c` < 0: then there is no support, which the caller
/// must detect; nothing is clamped here.
///
/// # Source
/// Bekker 1969, pressure–sinkage relation, see [Literature](crate#literature). Checked by `closed_forms::plate_load_is_area_times_bekker_pressure`.
#[inline]
pub fn k_star(soil: &Soil, b_eff: f64) -> f64 {
    soil.k_c / b_eff + soil.k_phi
}

/// Returns the normal pressure under a flat footprint at a sinkage, before its distribution over the footprint.
///
/// `p = k* z^n`
///
/// # Arguments
/// - `k_star`: `[N/m^(n+2)]`, > 0. `sinkage`: z `[m]`, ≥ 0. `n`: `[–]`, > 0.
///
/// # Returns
/// Pressure `[Pa]`, compression positive; the local pressure is gamma times this.
///
/// # Validity
/// Monotonic loading of homogeneous soil, z vertical below the undisturbed surface.
///
/// # Source
/// Bekker 1969. Checked by `closed_forms::plate_load_is_area_times_bekker_pressure`.
#[inline]
pub fn pressure(k_star: f64, sinkage: f64, n: f64) -> f64 {
    k_star * libm::pow(sinkage, n)
}
