//! The names, units and physical bounds of the parameters.
//!
//! A parameter of one wheel among several has the wheel's name after a dot (`wheel_radius_m.smooth`); an inferred noise standard
//! deviation is `noise.` and the channel's column (`noise.drawbar_pull_n`). An effect's parameter is `EFFECT.PARAMETER`, or
//! `EFFECT.PARAMETER.WHEEL`, and is described in the effect's file ([`EffectSet`](crate::model::EffectSet)).

use crate::channel::Channel;
use crate::experiment::{RigError, Scatter};

/// The description of a base parameter of the wheel-soil models.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseParameter {
    /// Name in files, messages and results, with its unit if it has one.
    pub name: &'static str,
    /// Unit for tables and axes.
    pub unit: &'static str,
    /// Smallest admissible value.
    pub lower: f64,
    /// Largest admissible value.
    pub upper: f64,
    /// Default value; `None` if the job must state a prior or a value.
    pub default: Option<f64>,
    /// Default prior as a line of `[priors]`; without default value and prior the job must state one.
    pub prior: Option<&'static str>,
}

type Text = &'static str;

const fn base(name: Text, unit: Text, lower: f64, upper: f64, default: Option<f64>) -> BaseParameter {
    BaseParameter {
        name,
        unit,
        lower,
        upper,
        default,
        prior: None,
    }
}

const fn inferred(name: Text, unit: Text, lower: f64, upper: f64, prior: Text) -> BaseParameter {
    BaseParameter {
        prior: Some(prior),
        ..base(name, unit, lower, upper, None)
    }
}

/// Every base parameter. `wheel_radius_m` defaults to the experiment's radius of each wheel.
pub const BASE: [BaseParameter; 10] = [
    base("k_c", "N/m^(n+1)", f64::NEG_INFINITY, f64::INFINITY, None),
    base("k_phi", "N/m^(n+2)", 0.0, f64::INFINITY, None),
    base("log10_p_ref", "log10 Pa", -3.0, 12.0, None),
    base("kappa", "1", -0.999, f64::INFINITY, None),
    base("n", "1", 0.01, 10.0, None),
    base("friction_angle_deg", "deg", 0.0, 89.0, None),
    base("wheel_radius_m", "m", 1e-4, 100.0, None),
    base("cohesion_pa", "Pa", 0.0, f64::INFINITY, Some(0.0)),
    base("shear_velocity_m_s", "m/s", 0.0, f64::INFINITY, Some(0.001)),
    base("gamma_exponent", "1", 0.0, 100.0, Some(0.5)),
];

/// Parameters of the soil's deformation, which only the three-dimensional model has.
pub const SPATIAL: [BaseParameter; 3] = [
    base("elastic_stiffness_pa_m", "Pa/m", 1e6, 1e13, Some(1e9)),
    base("flow_fraction", "1", 0.0, 1.0, Some(0.25)),
    base("bearing_credit", "1", 0.0, 1.0, Some(0.3)),
];

const C1: Text = "{ normal = [0.35, 0.1], bounds = [0.0, 0.8] }";
const C2: Text = "{ normal = [0.3, 0.15], bounds = [-0.2, 1.0] }";

/// Parameters of `wong_reece` that other models lack or hold at another value.
///
/// Priors: c1 and c2 of published sands lie in 0.18 to 0.43 and 0.32 to 0.41 (Wong & Reece 1967), shear moduli of sands from
/// 5 to 25 mm. gamma and the law of the slip velocity are inactive unless a job uses them.
pub const WONG_REECE: [BaseParameter; 5] = [
    inferred("c1", "1", -1.0, 1.0, C1),
    inferred("c2", "1", -1.0, 2.0, C2),
    inferred(
        "shear_modulus_m",
        "m",
        0.0,
        f64::INFINITY,
        "{ lognormal = [0.01, 2.0] }",
    ),
    base("shear_velocity_m_s", "m/s", 0.0, f64::INFINITY, Some(0.0)),
    base("gamma_exponent", "1", 0.0, 100.0, Some(0.0)),
];

/// Parameters of `rft`, which shares only the wheel's radius with other models. Priors: `xi_n` covers loose to dense dry
/// sand with a wide margin; friction covers polished metal to glued sand.
pub const RFT: [BaseParameter; 2] = [
    inferred("xi_n_pa_m", "Pa/m", 1.0, 1e12, "{ loguniform = [1e4, 1e8] }"),
    inferred("surface_friction", "1", 0.0, 10.0, "{ uniform = [0.1, 0.9] }"),
];

/// The one base parameter that every model has.
pub const WHEEL_RADIUS: &str = "wheel_radius_m";

/// Returns the parameters of every model; a parameter that two models hold at different values appears twice.
pub fn model_parameters() -> impl Iterator<Item = &'static BaseParameter> + Clone {
    BASE.iter().chain(&SPATIAL).chain(&WONG_REECE).chain(&RFT)
}

/// Unit and physical bounds of a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterBounds {
    /// Unit for tables and axes.
    pub unit: String,
    /// Smallest admissible value.
    pub lower: f64,
    /// Largest admissible value.
    pub upper: f64,
}

impl From<&BaseParameter> for ParameterBounds {
    fn from(base: &BaseParameter) -> Self {
        ParameterBounds {
            unit: base.unit.to_owned(),
            lower: base.lower,
            upper: base.upper,
        }
    }
}

/// Returns whether a name already has a meaning in jobs, so that no effect may have it.
pub(crate) fn is_taken(name: &str) -> bool {
    // "none" is the absence of effects in results
    ["none", "noise", "bevameter"].contains(&name) || model_parameters().any(|p| p.name == name)
}

/// Natural logarithm of the ratio of tan(phi) under a ring to tan(phi) under the wheel, which share the other parameters; a
/// parameter of a calibration with readings of a ring.
pub const RING_TRANSFER: &str = "bevameter.ln_transfer";

/// Radius of the plate at which `p_ref` and `kappa` are defined `[m]`.
pub const B_REF_M: f64 = 0.03;
/// Sinkage at which `p_ref` is defined `[m]`.
pub const Z_REF_M: f64 = 0.01;

/// Returns Bekker's moduli `k_c` `[N/m^(n+1)]` and `k_phi` `[N/m^(n+2)]` from `log10_p_ref`, `kappa` and n.
///
/// `p_ref = (k_c / b_ref + k_phi) z_ref^n`, `kappa = k_c / (k_phi b_ref)`, hence `k_phi = p_ref / (z_ref^n (1 + kappa))` and
/// `k_c = kappa k_phi b_ref`. Infinite at `kappa = -1`. The models' own conversion gives the same bits: checked by
/// `worker::model::parameters::tests::moduli_are_converted_alike_everywhere`.
pub fn bekker_moduli(log10_p_ref: f64, kappa: f64, n: f64) -> (f64, f64) {
    let k_phi = libm::exp10(log10_p_ref) / libm::pow(Z_REF_M, n) / (1.0 + kappa);
    (kappa * k_phi * B_REF_M, k_phi)
}

/// Prefix of the inferred noise standard deviations.
pub const NOISE_PREFIX: &str = "noise.";

/// Returns the parameter for the noise sd of a channel: `noise.drawbar_pull_n`.
pub fn noise_parameter(channel: Channel) -> String {
    format!("{NOISE_PREFIX}{}", channel.column())
}

/// Parameter for the sd of the scatter of a sinkage before the steady state between repeats of a condition `[m]`.
pub const TRANSIENT_SCATTER: &str = "noise.transient_sinkage_m";
/// Parameter for the sd of the error of the transient that repeats of a condition share, autocorrelated along the travel `[m]`.
pub const TRANSIENT_ERROR_SD: &str = "noise.transient_model_m";
/// Parameter for the travel over which the correlation of this error decays by a factor e `[m]`.
pub const TRANSIENT_ERROR_LENGTH: &str = "noise.transient_length_m";
/// The parameters for the errors of sinkages before the steady state.
pub const TRANSIENT_ERRORS: [&str; 3] = [TRANSIENT_SCATTER, TRANSIENT_ERROR_SD, TRANSIENT_ERROR_LENGTH];

/// Returns the parameter for a relative scatter: `noise.run_scatter`.
pub fn scatter_parameter(scatter: Scatter) -> String {
    format!("{NOISE_PREFIX}{}", scatter.key())
}

/// Returns the parameter for the sd of an error of the rig: `noise.session_sinkage_m`.
pub fn rig_parameter(error: RigError) -> String {
    format!("{NOISE_PREFIX}{}", error.key())
}

/// Returns a unit after a number in a sentence: ` m`, or nothing for a dimensionless number.
pub fn behind(unit: &str) -> String {
    if unit == "1" {
        String::new()
    } else {
        format!(" {unit}")
    }
}

/// Why a parameter cannot have a value.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BoundsError {
    /// The value is not a finite number.
    #[error("{name} = {value} is not a finite number")]
    NotFinite {
        /// Name of the parameter.
        name: String,
        /// The refused value.
        value: f64,
    },
    /// The value lies outside the physical bounds.
    #[error("{name} = {value}{unit} lies outside [{lower}, {upper}]{unit}")]
    Outside {
        /// Name of the parameter.
        name: String,
        /// The refused value.
        value: f64,
        /// The unit after a space, or nothing.
        unit: String,
        /// Smallest admissible value.
        lower: f64,
        /// Largest admissible value.
        upper: f64,
    },
}

/// Checks one value against the physical bounds of its parameter; [`BoundsError`] has the name, the value, the unit and the bounds.
pub fn check_value(quantity: &ParameterBounds, name: &str, value: f64) -> Result<(), BoundsError> {
    let ParameterBounds { unit, lower, upper } = quantity;
    if !value.is_finite() {
        let name = name.to_owned();
        return Err(BoundsError::NotFinite { name, value });
    }
    if value < *lower || value > *upper {
        return Err(BoundsError::Outside {
            name: name.to_owned(),
            value,
            unit: behind(unit),
            lower: *lower,
            upper: *upper,
        });
    }
    Ok(())
}
