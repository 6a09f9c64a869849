//! Effective width of a footprint.

/// Returns the effective width of a footprint of area A and contour length L.
///
/// `b_eff = 2 A / L`; a circle of radius r has `b_eff` = r, Bekker's convention for round plates.
///
/// # Arguments
/// - `area`: `[m²]`; `contour_length`: `[m]`, > 0, along the smooth contour, not the staircase of a grid.
#[inline]
pub fn effective_width(area: f64, contour_length: f64) -> f64 {
    2.0 * area / contour_length
}

/// Returns the effective width of a rectangular footprint `[m]`: `l b / (l + b)`.
///
/// # Arguments
/// - `length`: l `[m]`, ≥ 0; `width`: b `[m]`, > 0.
#[inline]
pub fn rectangle_effective_width(length: f64, width: f64) -> f64 {
    effective_width(length * width, 2.0 * (length + width))
}
