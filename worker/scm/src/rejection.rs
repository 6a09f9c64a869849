//! The reasons why a parameter vector has no solution.

/// A property of the parameters: the model has no equilibrium there, or they lie outside its validity.
///
/// A rejection is a result (likelihood zero), not a fault of the machine: the same arguments are always
/// rejected, on every machine. Messages are fragments that complete "failed to simulate: …".
#[non_exhaustive]
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Rejection {
    /// The soil cannot carry the wheel load at any sinkage below the wheel radius.
    #[error(
        "no support: the soil carries at most {max_carried_n:.4} N of the {wheel_load_n} N wheel load \
         before the sinkage reaches the wheel radius {wheel_radius_m} m"
    )]
    NoSupport {
        /// The largest vertical soil force met `[N]`.
        max_carried_n: f64,
        /// The load to be carried `[N]`.
        wheel_load_n: f64,
        /// The model's wheel radius `[m]`.
        wheel_radius_m: f64,
    },
    /// The vertical balance was not met to its tolerance: the soil's vertical force jumps past the load.
    #[error(
        "no convergence: after {evaluations} evaluations the soil carries {residual_load_n:e} N more than \
         the {wheel_load_n} N wheel load at a sinkage of {sinkage_m} m"
    )]
    NoConvergence {
        /// Vertical soil force less wheel load at the last trial `[N]`.
        residual_load_n: f64,
        /// The load to be carried `[N]`.
        wheel_load_n: f64,
        /// Sinkage of the last trial `[m]`.
        sinkage_m: f64,
        /// Number of trial sinkages.
        evaluations: u32,
    },
    /// A number overflowed or became undefined during the computation.
    #[error("not finite: {quantity} is {value}")]
    NotFinite {
        /// Name of the quantity.
        quantity: &'static str,
        /// The refused value.
        value: f64,
    },
    /// The soil seems to drive the wheel: the model breaks its own energy balance.
    #[error("energy gained: the soil gives {power_w:e} W of the {throughput_w} W that go through the wheel")]
    EnergyGained {
        /// Mean power that goes into the soil, negative `[W]`.
        power_w: f64,
        /// Sum of the magnitudes of the powers of motor and sled `[W]`.
        throughput_w: f64,
    },
    /// The protocol does not fit the run.
    #[error("the protocol does not fit the run: {0}")]
    Protocol(#[from] signal::SignalError),
    /// A formula of an effect gave an inadmissible value.
    #[error(transparent)]
    Formula(Box<FormulaRefusal>),
    /// A parameter lies outside the bounds within which the model is defined.
    #[error("invalid parameter: {name} = {value} {unit} must be {bound}")]
    InvalidParameter {
        /// Name of the field, with its unit.
        name: &'static str,
        /// The refused value.
        value: f64,
        /// Unit of the value.
        unit: &'static str,
        /// The violated bound.
        bound: &'static str,
    },
}

/// The formula that gave an inadmissible value, with its inputs.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "effect {effect}: {hook} is {value}{}, which must be {bound} ({values})",
    shown(unit)
)]
pub struct FormulaRefusal {
    /// Name of the effect.
    pub effect: String,
    /// The quantity that the formula replaces.
    pub hook: &'static str,
    /// The inadmissible value.
    pub value: f64,
    /// Unit of the value.
    pub unit: &'static str,
    /// The violated bound.
    pub bound: &'static str,
    /// The variables and parameters that the formula uses, with their values and units.
    pub values: String,
}

/// Returns a unit after a number; nothing for a dimensionless one.
pub(crate) fn shown(unit: &str) -> String {
    match unit {
        "1" => String::new(),
        unit => format!(" {unit}"),
    }
}

impl Rejection {
    /// Returns a stable word for counting rejections by kind; part of the wire format.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NoSupport { .. } => "no_support",
            Self::NoConvergence { .. } => "no_convergence",
            Self::NotFinite { .. } => "not_finite",
            Self::EnergyGained { .. } => "energy_gained",
            Self::Protocol(_) => "protocol",
            Self::Formula(_) => "formula",
            Self::InvalidParameter { .. } => "invalid_parameter",
        }
    }
}

/// Returns `Ok` if `accepted`; NaN fails every comparison, so a bound written as a positive condition rejects it.
pub(crate) fn require(
    accepted: bool,
    name: &'static str,
    value: f64,
    unit: &'static str,
    bound: &'static str,
) -> Result<(), Rejection> {
    if accepted && value.is_finite() {
        Ok(())
    } else {
        Err(Rejection::InvalidParameter {
            name,
            value,
            unit,
            bound,
        })
    }
}
