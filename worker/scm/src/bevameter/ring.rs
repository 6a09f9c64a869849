//! Shear stress under a ring that is turned on the soil.

use crate::rejection::{Rejection, require};
use crate::shear::{ShearDisplacement, strength};
use crate::soil::Soil;

/// Returns the shear stress under a surface that is displaced along the soil under a normal stress.
///
/// `tau = (c + sigma tan(phi)) (1 − exp(−j / K))`
///
/// # Arguments
/// - `soil`: fields carry units and bounds; only cohesion and friction angle matter.
/// - `law`: carries the shear modulus K `[m]`; K = 0: the whole strength at any displacement.
/// - `normal_stress_pa`: sigma `[Pa]`, ≥ 0. `displacement_m`: j `[m]`, ≥ 0.
///
/// # Returns
/// Shear stress `[Pa]`, ≥ 0; 0 at j = 0.
///
/// # Errors
/// [`Rejection::InvalidParameter`]: a field of the soil, sigma or j is outside its bounds.
///
/// # Validity
/// Monotonic shearing without a peak; the ring's sinkage is neglected.
///
/// # Source
/// Janosi & Hanamoto 1961; Wong, *Terramechanics*. Checked by `bevameter::strength_is_reached_by_way`.
pub fn shear_stress(
    soil: &Soil,
    law: &ShearDisplacement,
    normal_stress_pa: f64,
    displacement_m: f64,
) -> Result<f64, Rejection> {
    let soil = soil.checked()?;
    let (sigma, j) = (normal_stress_pa, displacement_m);
    require(sigma >= 0.0, "normal_stress_pa", sigma, "Pa", "at least 0")?;
    require(j >= 0.0, "shear_displacement_m", j, "m", "at least 0")?;
    let tau_max = strength(soil.cohesion_pa, libm::tan(soil.friction_angle_rad), sigma);
    Ok(tau_max * law.mobilised(j))
}

/// An annulus that is pressed on the soil and turned about its axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// Inner radius `r_1` `[m]`, ≥ 0.
    pub inner_radius_m: f64,
    /// Outer radius `r_2` `[m]`, above the inner one.
    pub outer_radius_m: f64,
}

impl Ring {
    /// Checks that the radii are finite and in order, and returns the ring; [`Rejection::InvalidParameter`] names the first
    /// radius that is not.
    pub fn checked(self) -> Result<Self, Rejection> {
        let (inner, outer) = (self.inner_radius_m, self.outer_radius_m);
        require(inner >= 0.0, "inner_radius_m", inner, "m", "at least 0")?;
        require(
            outer > inner,
            "outer_radius_m",
            outer,
            "m",
            "above inner_radius_m",
        )?;
        Ok(self)
    }

    /// Returns the displacement at the mean radius `[m]`: `j = theta (r_1 + r_2) / 2`, theta `[rad]`.
    pub fn displacement_m(&self, angle_rad: f64) -> f64 {
        angle_rad * self.mean_radius_m()
    }

    /// Returns the angle `[rad]` by which the ring has turned after a displacement j `[m]` at its mean radius.
    pub fn angle_rad(&self, displacement_m: f64) -> f64 {
        displacement_m / self.mean_radius_m()
    }

    /// Returns the shear stress `[Pa]` that corresponds to a torque M `[N m]`, taken as uniform: `tau = 3 M / (2 pi
    /// (r_2³ − r_1³))`.
    ///
    /// Checked by `bevameter::torque_of_a_ring_is_the_moment_of_its_stress_and_back`.
    pub fn shear_stress_pa(&self, torque_n_m: f64) -> f64 {
        torque_n_m / self.torque_per_stress_m3()
    }

    /// Returns the torque `[N m]` of a uniform shear stress tau `[Pa]`: `M = 2 pi tau (r_2³ − r_1³) / 3`.
    ///
    /// Checked by `bevameter::torque_of_a_ring_is_the_moment_of_its_stress_and_back`.
    pub fn torque_n_m(&self, shear_stress_pa: f64) -> f64 {
        shear_stress_pa * self.torque_per_stress_m3()
    }

    fn mean_radius_m(&self) -> f64 {
        0.5 * (self.inner_radius_m + self.outer_radius_m)
    }

    fn torque_per_stress_m3(&self) -> f64 {
        let cube = |r: f64| r * r * r;
        2.0 * core::f64::consts::PI / 3.0 * (cube(self.outer_radius_m) - cube(self.inner_radius_m))
    }
}
