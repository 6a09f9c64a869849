//! A rigid wheel in steady motion: stresses along the rim, balance of the wheel load.
//!
//! # Layout
//! - `kinematics`: the slip velocity along the rim.
//! - `rim`: the quantities of a run that do not depend on the sinkage.
//! - `reaction`: the soil's force and torque on the rim for a given contact length.
//! - `footing`: the rim, with or without effects.
//! - `panel`: nodes of the quadrature on a piece of the rim.
//! - `grousered`: the shares of the ground that rim, flanks and tips of grousers press.
//! - `reshaped`: the rim with effects or grousers; `displacement`: the sliding of the rim.
//! - `straight`: straight grousers on the rim.
//! - `start`: a closed-form first guess of the contact length.
//! - `balance`: the contact length at which the soil carries the wheel load.
//! - `crossing`: the first of several balances that the wheel meets as it sinks.
//! - `transient`: the sinkage on the way to the steady state.

mod balance;
mod crossing;
mod displacement;
mod footing;
mod grousered;
mod kinematics;
mod panel;
#[cfg(test)]
mod prior_draws;
mod reaction;
mod reshaped;
mod rim;
mod start;
mod straight;
mod transient;

use footing::Footing;
use formula::Variable;
use reshaped::{Mechanics, Panels, Reshaping};
use rim::Rim;
pub use straight::StraightGrousers;
pub use transient::{Way, transient_sinkage};

use crate::effects::{Active, Site};
use crate::pressure_sinkage::k_star;
use crate::rejection::require;
use crate::{Averages, Condition, Rejection, Soil, Wheel, WongReece};

/// Computes the steady forces, torque and sinkage of a smooth rigid wheel on plastic soil.
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
/// - [`Rejection::NoSupport`]: no balance with z < R; also if k* ≤ 0 for every footprint that a load could meet.
/// - [`Rejection::NoConvergence`]: the soil's force jumps past the load (cohesion at the footprint where a
///   negative `k_c` lets k* pass through zero), so that there is no balance with k* > 0.
/// - [`Rejection::NotFinite`]: the forces overflow.
///
/// # Validity
/// Steady motion, no grousers, no memory: every pass has the answer of the first, no soil in front of or behind the wheel,
/// no elastic rebound (contact ends below the axle). Stresses act on the rim's *surface*: an element is dA / cos(theta).
///
/// # Numerics
/// Gauss quadrature with panels that end at kinks of gamma and at sign changes of the slip velocity: forces within 1e-5 of
/// the wheel load (usually 1e-7) at z < R/4 for m in {0, 1/2, 1} and within 1e-4 for other m, for v0 below 1e-3 of the rim
/// speed and up to z = 0.75 R; 5e-4 beyond. Balance to 1e-9 of the load.
///
/// # Source
/// Wong & Reece 1967, <https://doi.org/10.1016/0022-4898(67)90105-X> (integration along the rim); Krenn & Hirzinger 2009
/// (stresses); see [Literature](crate#literature).
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
    simulate_with(soil, wheel, condition, &mut Active::default(), &Site::default())
}

/// Simulates the wheel of [`simulate`] with effects.
///
/// In the order of [`Hook::ALL`](formula::Hook::ALL): slip, dimensions and sinkage exponent are replaced first; the
/// pressure, the strength and the shear stress at every node of the rim; a load that depends on pull and torque at every
/// trial of the balance; the channels at the end. Formulas at nodes and the flat see the load before the formulas that
/// depend on pull and torque; channels see the carried load. Two mechanisms are in code:
///
/// - *rebound*, with the compliance a: the soil behind the axle springs back by `e = min(a p_0, z_0/2)`, `p_0 = k* z_0^n`,
///   and carries `gamma p_0 (1 − h/e)` where it has risen by h; gamma covers the whole contact.
/// - *flat patch*, with the deflection per load a: the rim is flat at the distance R − δ from the axle, `δ = a W`, over a length of
///   `2 sqrt(δ (2R − δ))`; shear stress turns the wheel there at that distance, against the slip velocity
///   `omega (R − δ) − v`. Sinkage refers to the flat, like the reading of a rig zeroed under load on hard ground.
///
/// # Arguments
/// - `effects`: compiled for [`ModelForm::QuasiStatic`](crate::effects::ModelForm::QuasiStatic), with working memory.
///   Without an active effect the result equals that of [`simulate`], bit for bit.
/// - `site`: properties of the test site that formulas may use.
///
/// # Errors
/// As for [`simulate`], and [`Rejection::Formula`] if a formula gives an inadmissible value at any trial of the balance.
///
/// # Validity
/// As for [`simulate`]. The displacement `j` belongs to an element of the rim in steady motion; `pass` is the only
/// difference between passes. A jump of a law between two nodes of the quadrature is interpolated, so that forces are
/// continuous in the parameters.
///
/// # Source
/// The catalogue states the source of each effect. Checked by `effects::*`.
pub fn simulate_with(
    soil: &Soil,
    wheel: &Wheel,
    condition: &Condition,
    effects: &mut Active,
    site: &Site,
) -> Result<Averages, Rejection> {
    roll(soil, wheel, condition, &Form::Smooth, effects, site)
}

/// Simulates the wheel of [`simulate_with`] with the stresses of [`WongReece`] in place of the base's.
///
/// # Arguments
/// - `law`: the peak of the pressure, and the shear modulus; evaluated at the slip after the effects.
/// - `effects`: compiled for [`ModelForm::WongReece`](crate::effects::ModelForm::WongReece).
///
/// # Errors
/// As for [`simulate_with`], and [`Rejection::InvalidParameter`] where `c1 + c2 slip` lies outside [0, 1).
///
/// # Validity
/// As for [`WongReece`]; the model has neither rebound nor a flat.
///
/// # Example
/// ```
/// use scm::effects::{Active, Site};
/// use scm::{Condition, Soil, Wheel, WongReece, quasi_static};
/// let soil = Soil { k_c: 0.0, k_phi: 1e7, n: 1.1, cohesion_pa: 0.0, friction_angle_rad: 30f64.to_radians(),
///     shear_velocity_m_s: 1e-3, gamma_exponent: 0.5 };
/// let wheel = Wheel { radius_m: 0.125, width_m: 0.112, rig_radius_m: 0.125 };
/// let condition = Condition { slip: 0.2, wheel_load_n: 150.0, sled_speed_m_s: 0.008, slip_angle_rad: 0.0, pass: 1 };
/// let law = WongReece { c1: 0.4, c2: 0.0, shear_modulus_m: 0.0 };
/// let (mut none, site) = (Active::default(), Site::default());
/// let averages = quasi_static::simulate_wong_reece(&soil, &wheel, &condition, &law, &mut none, &site)?;
/// assert!((averages.drawbar_pull_n - 46.0).abs() < 0.1 && (averages.sinkage_m - 8.35e-3).abs() < 1e-5);
/// # Ok::<(), scm::Rejection>(())
/// ```
pub fn simulate_wong_reece(
    soil: &Soil,
    wheel: &Wheel,
    condition: &Condition,
    law: &WongReece,
    effects: &mut Active,
    site: &Site,
) -> Result<Averages, Rejection> {
    roll(soil, wheel, condition, &Form::Peaked(law), effects, site)
}

/// Simulates the wheel of [`simulate_with`] with straight grousers, averaged over their period at constant hub height.
///
/// It approximates [`spatial`](crate::spatial) on soil that does not flow.
///
/// On rigid-plastic soil a place bears while the wheel is lower there than before. With N grousers of height h and thickness
/// t, `R_t = R + h`, `rho = omega R_t / (v cos(beta))` and `G(a) = rho sin(a) − a`, an element dA of the ground at x ahead
/// of the axle, under tips at `a = asin(x / R_t)`, is pressed on average by
///
/// - tips, a share `N t / 2π R_t` of it, at their depth;
/// - flanks, `(N / 2π) tan(a) e / ((R + h/2) cos(a))`, at the mean depth of their height e (projected on the vertical) in the soil,
///   where their middle moves backwards over it. e is the minimum of `h cos(a)`, the tips' depth, and the depth that a tip reaches
///   beyond the one ahead: the marks' spacing on the ground, less t, times the slope of the tips' path over it;
/// - the rim, on the ground that tips neither cover nor have swept, less the flanks' share. Tips have swept the share
///   `(N / 2π) |G(a) − G(a')|`, with a' where they were as deep as the rim is at x, `R_t sin(a') = sqrt(x² + R_t² − R²)`: at
///   high slip they dig all soil from under the rim.
///
/// Behind the axle flanks push in skid, down to where the rim or the grouser ahead has pressed deeper. Each surface follows
/// the base's laws: pressure at its depth, shear against its slip velocity, both along the radius and across it; there is
/// one footprint with its gamma and `b_eff`, the width times the length from the axle to the entry of the tips.
///
/// # Arguments
/// - `grousers`: without count or height the result equals that of [`simulate_with`], bit for bit.
/// - `effects`: as for [`simulate_with`]. `lug_thrust` (passive pressure on the flanks' full height) and `slip_digging`
///   (soil carried away beyond the swept share) add effects that neither this model nor [`spatial`](crate::spatial) has.
///
/// # Returns
/// [`Averages`]; the sinkage refers to the rim, and is negative if the tips alone carry the load. The contact is that of the tips.
///
/// # Errors
/// As for [`simulate_with`], and [`Rejection::InvalidParameter`] for grousers outside their bounds, for rebounding soil
/// and for a rim that its load flattens.
///
/// # Validity
/// As for [`simulate`]; at slip angles tips are assumed to leave the same marks as straight ahead. Over 200 runs (wheels of
/// 58 and 125 mm, 12 and 24 grousers of 5 and 9 mm by 2 mm, slip −0.7 to 0.9, `k_c` = 0) the rms difference from
/// [`spatial`](crate::spatial) without flow is, relative to load, to load times radius, and in mm, 0.078, 0.025, 1.5 (the
/// smooth rim: 0.134, 0.072, 12.4). The pull is too low by 0.060 on average: in [`spatial`](crate::spatial) unloading soil
/// lifts tips from behind, and the grid lets tips bear behind the axle (for 24 of 5 mm on 58 mm at slip 0.4, its pull falls
/// from 0.31 to 0.25 of the load as the grid is refined from 4 mm to 0.5 mm; here it is 0.21). If a quarter of the soil
/// flows, the rms is 0.107, 0.032, 3.2 (0.125, 0.072, 10.3), and the pull of wheels of 58 mm is no closer than the smooth
/// rim's (0.139 and 0.141). Grousers must be shorter than about a tenth of the radius; errors grow with their height.
///
/// # Source
/// This model is new, for a height field. The two cylinders are those of Jia, Smith & Peng 2012,
/// <https://doi.org/10.1017/S0263574711000798>, who average the pressures of grousers and rim and let soil shear at the
/// tips; the filling of marks with slip follows Skonieczny, Moreland & Wettergreen 2012 (grouser spacing, IROS). Checked by
/// `grousers`, `quasi_static::grousered::tests`, `validation::grousered`.
///
/// # Example
/// ```
/// use scm::effects::{Active, Site};
/// use scm::quasi_static::{self, StraightGrousers};
/// use scm::{Condition, Soil, Wheel};
/// let soil = Soil { k_c: 0.0, k_phi: 1e7, n: 1.1, cohesion_pa: 0.0, friction_angle_rad: 30f64.to_radians(),
///     shear_velocity_m_s: 1e-3, gamma_exponent: 0.5 };
/// let wheel = Wheel { radius_m: 0.125, width_m: 0.112, rig_radius_m: 0.125 };
/// let grousers = StraightGrousers { count: 12, height_m: 0.009, thickness_m: 0.002 };
/// let condition = Condition { slip: 0.6, wheel_load_n: 100.0, sled_speed_m_s: 0.004, slip_angle_rad: 0.0, pass: 1 };
/// let (mut none, site) = (Active::default(), Site::default());
/// let averages = quasi_static::simulate_with_grousers(&soil, &wheel, &grousers, &condition, &mut none, &site)?;
/// assert!((averages.torque_n_m - 6.67).abs() < 0.01 && (averages.sinkage_m - 10.8e-3).abs() < 1e-4);
/// # Ok::<(), scm::Rejection>(())
/// ```
pub fn simulate_with_grousers(
    soil: &Soil,
    wheel: &Wheel,
    grousers: &StraightGrousers,
    condition: &Condition,
    effects: &mut Active,
    site: &Site,
) -> Result<Averages, Rejection> {
    let form = if grousers.are_absent() {
        Form::Smooth
    } else {
        Form::Grousered(grousers)
    };
    roll(soil, wheel, condition, &form, effects, site)
}

/// The kind of rim.
enum Form<'f> {
    /// The smooth rim.
    Smooth,
    /// The smooth rim with the stresses of Wong & Reece.
    Peaked(&'f WongReece),
    /// A rim with grousers.
    Grousered(&'f StraightGrousers),
}

fn roll(
    soil: &Soil,
    wheel: &Wheel,
    condition: &Condition,
    form: &Form,
    effects: &mut Active,
    site: &Site,
) -> Result<Averages, Rejection> {
    let (soil, wheel, condition) = (soil.checked()?, wheel.checked()?, condition.checked()?);
    if effects.is_empty() && matches!(form, Form::Smooth) {
        let mut base = Footing {
            rim: Rim::new(&soil, &wheel, &condition),
            reshaping: None,
        };
        return average(&mut base, condition.wheel_load_n).map(|(averages, _)| averages);
    }
    let case = effects.case(&soil, &wheel, &condition, site)?;
    let (soil, wheel, condition) = (case.soil, case.wheel.checked()?, case.condition.checked()?);
    let mut variables = case.variables;
    let mechanics = Mechanics::new(effects, &case)?;
    let mut rim = Rim::new(&soil, &wheel, &condition);
    let mut grousers = None;
    match form {
        Form::Smooth => rim.flat = mechanics.flat(rim.radius),
        Form::Peaked(law) => rim.peaked = Some(law.at(condition.slip)?),
        Form::Grousered(straight) => {
            mechanics.require_rigid()?;
            let straight = straight.checked(wheel.radius_m)?;
            let tips = Wheel {
                radius_m: wheel.radius_m + straight.height_m,
                ..wheel
            };
            rim = Rim::new(&soil, &tips, &condition);
            grousers = Some(straight);
        }
    }
    // these buffers are lent to the rim and reused by the next run: nothing may fail before their return
    let laws = effects.nodes.take();
    let mut panels = Panels::default();
    let reshaping = Reshaping::new(
        effects,
        &rim,
        case,
        mechanics,
        laws,
        &mut panels,
        grousers.as_ref(),
    );
    let mut footing = Footing {
        rim,
        reshaping: Some(reshaping),
    };
    let averages = average(&mut footing, condition.wheel_load_n);
    effects.nodes = footing.reshaping.and_then(|reshaping| reshaping.laws);
    let (mut averages, load_n) = averages?;
    if effects.change_channels() {
        variables[Variable::WheelLoad as usize] = load_n;
        let modulus = k_star(&soil, averages.b_eff_m);
        effects.measure_averages(&mut variables, modulus, &mut averages)?;
        // a reading with the wheel in the soil up to its hub describes no test
        require(
            averages.sinkage_m < wheel.radius_m,
            "sinkage_m",
            averages.sinkage_m,
            "m",
            "below the wheel's radius, with the effects on it",
        )?;
    }
    Ok(averages)
}

/// Balances the wheel load; returns the averages and the carried load.
fn average(footing: &mut Footing, wheel_load: f64) -> Result<(Averages, f64), Rejection> {
    let reaction = balance::first_balance(footing, wheel_load)?;
    let averages = Averages {
        drawbar_pull_n: reaction.drawbar_pull,
        torque_n_m: reaction.torque,
        sinkage_m: reaction.sinkage,
        lateral_force_n: reaction.lateral_force,
        b_eff_m: reaction.b_eff,
        contact_length_m: reaction.footprint_length,
        residual_load_n: reaction.load() - wheel_load,
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
    Ok((averages, wheel_load + reaction.extra_load))
}
