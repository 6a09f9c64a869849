//! Simulate a smooth rigid wheel in steady motion: stresses along the rim, balance of the wheel load.
//!
//! # Layout
//! - `kinematics`: the slip velocity along the rim.
//! - `rim`: the soil's force and torque on the rim for a given contact length.
//! - `start`: a closed-form first guess of the contact length.
//! - `balance`: the contact length at which the soil carries the wheel load.
//! - `crossing`: which of several balances the wheel meets first as it sinks.

mod balance;
mod crossing;
mod kinematics;
mod rim;
mod start;

use crate::{Averages, Condition, Rejection, Soil, Wheel};

/// Steady forces, torque and sinkage of a smooth rigid wheel on plastic soil.
///
/// With x = R sin(theta) along the ground from the lowest point, z(x) the sinkage of the rim, contact from
/// theta = 0 to `theta_1 = acos(1 − z/R)` and per projected area dA:
///
/// - `p = gamma k* z(x)^n`, `k* = k_c / b_eff + k_phi`, `b_eff = l b / (l + b)`
/// - `tau = (c + p tan(phi)) (1 − exp(−|v| / v0))` against the slip velocity v of the rim, which has
///   `omega R − v cos(beta) cos(theta)` along the rim and `v sin(beta)` across
/// - `dF_z = (p + tau_x tan(theta)) dA`, `dF_x = (tau_x − p tan(theta)) dA`, `dT = tau_x R dA / cos(theta)`,
///   `dF_y = tau_y dA / cos(theta)`
///
/// and the sinkage is the first one, from the surface down, at which `F_z` is the wheel load.
///
/// # Arguments
/// - `soil`, `wheel`, `condition`: fields carry units and bounds. omega comes from the slip and the *rig's*
///   radius: `omega R_s = v / (1 − s)` for s ≥ 0, `v (1 + s)` for s < 0.
///
/// # Returns
/// [`Averages`]; the simulated travel is 0.
///
/// # Errors
/// - [`Rejection::InvalidParameter`]: a field is outside its bounds. Nothing is clamped.
/// - [`Rejection::NoSupport`]: no balance with z < R; also where k* ≤ 0 for every footprint that a load could meet.
/// - [`Rejection::NoConvergence`]: the soil's force jumps past the load (cohesion at the footprint where a
///   negative `k_c` lets k* pass through zero), so that there is no balance with k* > 0.
/// - [`Rejection::NotFinite`]: the forces overflow.
///
/// # Validity
/// Steady motion, no grousers, no memory: every pass gets the first one's answer, no soil in front of or
/// behind the wheel, no elastic rebound (contact ends below the axle). Stresses act on the rim's *surface*:
/// an element is dA / cos(theta).
///
/// # Numerics
/// Gauss quadrature with panels that end where gamma has kinks and where the slip velocity changes sign:
/// forces within 1e-5 of the wheel load (mostly 1e-7) at z < R/4 for m in {0, 1/2, 1} and within 1e-4 for
/// other m, for v0 below 1e-3 of the rim speed and up to z = 0.75 R; 5e-4 beyond. Balance to 1e-9 of the load.
///
/// # Source
/// Wong & Reece 1967 (integration along the rim); Krenn & Hirzinger's soil contact model (stresses).
/// Departure: surface elements in place of projected ones with unit normals.
/// Checked by `reference_table`, `brute_force`, `invariants`.
///
/// # Example
/// ```
/// use scm::{Condition, Soil, Wheel, quasi_static};
/// let soil = Soil { k_c: 0.0, k_phi: 1e7, n: 1.1, cohesion_pa: 0.0, friction_angle_rad: 30f64.to_radians(),
///     shear_velocity_m_s: 1e-3, gamma_exponent: 0.5 };
/// let wheel = Wheel { radius_m: 0.125, width_m: 0.112, rig_radius_m: 0.125 };
/// let condition = Condition { slip: 0.2, wheel_load_n: 100.0, sled_speed_m_s: 0.008, slip_angle_rad: 0.0, pass: 1 };
/// let averages = quasi_static::simulate(&soil, &wheel, &condition)?;
/// assert!((averages.drawbar_pull_n - 35.9).abs() < 0.1 && (averages.sinkage_m - 5.63e-3).abs() < 1e-5);
/// # Ok::<(), scm::Rejection>(())
/// ```
pub fn simulate(soil: &Soil, wheel: &Wheel, condition: &Condition) -> Result<Averages, Rejection> {
    let rim = rim::Rim::new(&soil.checked()?, &wheel.checked()?, &condition.checked()?);
    let reaction = balance::first_balance(&rim, condition.wheel_load_n)?;
    let averages = Averages {
        drawbar_pull_n: reaction.drawbar_pull,
        torque_n_m: reaction.torque,
        sinkage_m: reaction.sinkage,
        lateral_force_n: reaction.lateral_force,
        b_eff_m: reaction.b_eff,
        contact_length_m: reaction.contact_length,
        residual_load_n: reaction.load() - condition.wheel_load_n,
        nodes_in_contact: reaction.nodes,
        simulated_travel_m: 0.0,
    };
    for (quantity, value) in [
        ("drawbar pull", averages.drawbar_pull_n),
        ("torque", averages.torque_n_m),
        ("lateral force", averages.lateral_force_n),
    ] {
        if !value.is_finite() {
            return Err(Rejection::NotFinite { quantity, value });
        }
    }
    Ok(averages)
}
