//! The parameters of a soil, and their bounds.

use crate::rejection::{Rejection, require};

/// Plate width at which the reference pressure of [`bekker_moduli`] is taken `[m]`.
pub const REFERENCE_WIDTH_M: f64 = 0.03;
/// Sinkage at which the reference pressure of [`bekker_moduli`] is taken `[m]`.
pub const REFERENCE_SINKAGE_M: f64 = 0.01;

/// The parameters of one soil, shared by every model of this crate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Soil {
    /// Bekker's cohesive modulus `k_c` `[N/m^(n+1)]`; it may be negative, as plate tests on sand often show.
    pub k_c: f64,
    /// Bekker's frictional modulus `k_phi` `[N/m^(n+2)]`, ≥ 0.
    pub k_phi: f64,
    /// Sinkage exponent n `[–]`, > 0.
    pub n: f64,
    /// Cohesion c `[Pa]`, ≥ 0.
    pub cohesion_pa: f64,
    /// Angle of internal friction `[rad]`, in [0, π/2).
    pub friction_angle_rad: f64,
    /// Slip velocity v0 at which 1 − 1/e of the strength is mobilised `[m/s]`, ≥ 0; 0: the whole strength always.
    pub shear_velocity_m_s: f64,
    /// Exponent m of the pressure distribution `[–]`, ≥ 0; 0: uniform, 0.5: the default in jobs.
    pub gamma_exponent: f64,
}

impl Soil {
    /// Checks that the laws are defined for the soil, and returns it.
    ///
    /// # Errors
    /// [`Rejection::InvalidParameter`] for the first field that is outside its bounds or not finite. A negative `k_c` is
    /// accepted: the balance decides whether the soil carries the wheel.
    pub fn checked(self) -> Result<Self, Rejection> {
        let quarter_turn = core::f64::consts::FRAC_PI_2;
        let phi = self.friction_angle_rad;
        require(true, "k_c", self.k_c, "N/m^(n+1)", "finite")?;
        require(self.k_phi >= 0.0, "k_phi", self.k_phi, "N/m^(n+2)", "at least 0")?;
        require(self.n > 0.0, "n", self.n, "(dimensionless)", "above 0")?;
        require(
            self.cohesion_pa >= 0.0,
            "cohesion_pa",
            self.cohesion_pa,
            "Pa",
            "at least 0",
        )?;
        require(
            (0.0..quarter_turn).contains(&phi),
            "friction_angle_rad",
            phi,
            "rad",
            "at least 0 and below pi/2",
        )?;
        require(
            self.shear_velocity_m_s >= 0.0,
            "shear_velocity_m_s",
            self.shear_velocity_m_s,
            "m/s",
            "at least 0",
        )?;
        require(
            self.gamma_exponent >= 0.0,
            "gamma_exponent",
            self.gamma_exponent,
            "(dimensionless)",
            "at least 0",
        )?;
        Ok(self)
    }
}

/// Returns Bekker's moduli `(k_c, k_phi)` from a reference pressure and the share of the cohesive term.
///
/// `p_ref = (k_c / b_ref + k_phi) z_ref^n`, `kappa = k_c / (k_phi b_ref)`, hence
/// `k_phi = p_ref / (z_ref^n (1 + kappa))` and `k_c = kappa k_phi b_ref`, with `b_ref` = 30 mm, `z_ref` = 10 mm.
///
/// # Arguments
/// - `log10_p_ref`: decimal logarithm of the reference pressure in Pa.
/// - `kappa`: `[–]`, > −1; at −1 the two terms cancel and `k_phi` is infinite (which [`Soil::checked`] refuses).
/// - `n`: sinkage exponent `[–]`.
///
/// # Returns
/// `k_c` `[N/m^(n+1)]` and `k_phi` `[N/m^(n+2)]`: unlike these, `p_ref` hardly correlates with n in a posterior.
///
/// # Example
/// ```
/// // 36.3 kPa at 10 mm, n = 1.1: k_phi = 36308 Pa / 0.01^1.1 = 5.754e6 N/m^3.1
/// let (k_c, k_phi) = scm::bekker_moduli(4.56, 0.0, 1.1);
/// assert!(k_c == 0.0 && (k_phi / 5.754e6 - 1.0).abs() < 1e-3);
/// ```
pub fn bekker_moduli(log10_p_ref: f64, kappa: f64, n: f64) -> (f64, f64) {
    let k_star = libm::exp10(log10_p_ref) / libm::pow(REFERENCE_SINKAGE_M, n);
    let k_phi = k_star / (1.0 + kappa);
    (kappa * k_phi * REFERENCE_WIDTH_M, k_phi)
}
