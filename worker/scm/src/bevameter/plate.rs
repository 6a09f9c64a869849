//! Pressure under a plate that is pressed into the soil, lifted and pressed again.

use crate::pressure_sinkage::{self, k_star};
use crate::rejection::{Rejection, require};
use crate::soil::Soil;

/// A rigid, flat plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Plate {
    /// A circular plate.
    Circle {
        /// Radius `[m]`, > 0.
        radius_m: f64,
    },
    /// A rectangular plate.
    Rectangle {
        /// Long side `[m]`, > 0.
        length_m: f64,
        /// Short side `[m]`, > 0; the sides may be in either order.
        width_m: f64,
    },
}

impl Plate {
    /// Returns Bekker's width b of the plate `[m]`: the radius, or the short side.
    pub fn bekker_width_m(&self) -> f64 {
        match *self {
            Plate::Circle { radius_m } => radius_m,
            Plate::Rectangle { length_m, width_m } => length_m.min(width_m),
        }
    }

    /// Returns the area of the plate `[m²]`.
    pub fn area_m2(&self) -> f64 {
        match *self {
            Plate::Circle { radius_m } => core::f64::consts::PI * radius_m * radius_m,
            Plate::Rectangle { length_m, width_m } => length_m * width_m,
        }
    }
}

/// Returns the pressure under a plate during first loading.
///
/// `p = (k_c / b + k_phi) z^n`, uniform over the plate, with b the radius or the short side.
///
/// # Arguments
/// - `soil`: fields carry units and bounds; only `k_c`, `k_phi` and n matter.
/// - `sinkage_m`: z `[m]`, ≥ 0.
///
/// # Returns
/// Pressure `[Pa]`, ≥ 0.
///
/// # Errors
/// [`Rejection::InvalidParameter`]: a field of the soil, a side of the plate or z is outside its bounds, or the modulus k*
/// under this plate is not above 0 (a negative `k_c` under a plate too small for it): no pressure could have been measured
/// there. [`Rejection::NotFinite`]: the pressure overflows.
///
/// # Validity
/// Monotonic, slow loading of deep, homogeneous soil.
///
/// # Source
/// Bekker 1969; Wong, *Terramechanics*. Checked by `bevameter::a_plate_carries_its_area_times_bekkers_pressure`.
pub fn pressure(soil: &Soil, plate: &Plate, sinkage_m: f64) -> Result<f64, Rejection> {
    let soil = soil.checked()?;
    let b = plate.bekker_width_m();
    require(b > 0.0, "plate_width_m", b, "m", "above 0")?;
    require(sinkage_m >= 0.0, "sinkage_m", sinkage_m, "m", "at least 0")?;
    let k = k_star(&soil, b);
    require(k > 0.0, "k_star", k, "N/m^(n+2)", "above 0 under the plate")?;
    let value = pressure_sinkage::pressure(k, sinkage_m, soil.n);
    if value.is_finite() {
        Ok(value)
    } else {
        let quantity = "plate pressure";
        Err(Rejection::NotFinite { quantity, value })
    }
}

/// Returns the load on a plate during first loading `[N]`: its area times [`pressure`], with the same errors.
pub fn load(soil: &Soil, plate: &Plate, sinkage_m: f64) -> Result<f64, Rejection> {
    Ok(plate.area_m2() * pressure(soil, plate, sinkage_m)?)
}

/// The unloading of a soil under a plate that is lifted, and its stiffening when the plate is pressed again.
///
/// `p = p_u − k_u (z_u − z)` with `k_u = k_0 + A_u z_u`: from the pressure `p_u` at the deepest sinkage `z_u`
/// along a straight line, up and down alike.
///
/// # Source
/// Wong, *Terramechanics* (response to repetitive loading).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unloading {
    /// Stiffness of an unloading that begins at the surface, `k_0` `[Pa/m]`, ≥ 0.
    pub stiffness_pa_per_m: f64,
    /// Increase of the stiffness with the sinkage at which the unloading begins, `A_u` `[Pa/m²]`, ≥ 0.
    pub stiffening_pa_per_m2: f64,
}

impl Unloading {
    /// Returns the stiffness `k_u = k_0 + A_u z_u` `[Pa/m]` of an unloading that begins at the sinkage `z_u` `[m]`.
    pub fn stiffness(&self, deepest_m: f64) -> f64 {
        self.stiffness_pa_per_m + self.stiffening_pa_per_m2 * deepest_m
    }

    /// Returns the pressure under a plate that has been `deepest_m` deep and now is at `sinkage_m`.
    ///
    /// # Arguments
    /// - `deepest_m`: `z_u` `[m]`, ≥ 0; `sinkage_m`: z `[m]`, ≥ 0. A plate deeper than `deepest_m` is in first loading.
    ///
    /// # Returns
    /// Pressure `[Pa]`. The soil does not pull: if the line falls below 0 the plate has left the soil, and 0 is returned.
    ///
    /// # Errors
    /// As for [`pressure`], and [`Rejection::InvalidParameter`] for a stiffness that is negative.
    ///
    /// # Validity
    /// Unloading and reloading follow one line; hysteresis is neglected.
    ///
    /// Checked by `bevameter::a_lifted_plate_follows_the_unloading_line_and_leaves_the_soil`.
    pub fn pressure(
        &self,
        soil: &Soil,
        plate: &Plate,
        deepest_m: f64,
        sinkage_m: f64,
    ) -> Result<f64, Rejection> {
        let [k_0, a_u] = [self.stiffness_pa_per_m, self.stiffening_pa_per_m2];
        require(k_0 >= 0.0, "stiffness_pa_per_m", k_0, "Pa/m", "at least 0")?;
        require(a_u >= 0.0, "stiffening_pa_per_m2", a_u, "Pa/m^2", "at least 0")?;
        require(sinkage_m >= 0.0, "sinkage_m", sinkage_m, "m", "at least 0")?;
        if sinkage_m >= deepest_m {
            return pressure(soil, plate, sinkage_m);
        }
        let at_deepest = pressure(soil, plate, deepest_m)?;
        let p = at_deepest - self.stiffness(deepest_m) * (deepest_m - sinkage_m);
        Ok(if p > 0.0 { p } else { 0.0 })
    }
}
