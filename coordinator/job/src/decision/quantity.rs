//! The quantities of a run that losses and statements are about: names, units and meaning.

/// A quantity of a run, by the name that formulas have for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quantity {
    /// Name with the unit at its end, as in a column of runs.csv.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// The name in words.
    pub words: &'static str,
}

const fn quantity(name: &'static str, unit: &'static str, words: &'static str) -> Quantity {
    Quantity { name, unit, words }
}

/// Number of channels, which come first.
const CHANNELS: usize = 4;
/// Number of quantities that follow from channels and condition, which come next.
const DERIVED: usize = 6;

/// All quantities: channels, what follows from them, the condition, and whether the wheel is stuck.
pub const QUANTITIES: [Quantity; 17] = [
    quantity("drawbar_pull_n", "N", "drawbar pull"),
    quantity("torque_n_m", "N m", "torque"),
    quantity("sinkage_m", "m", "sinkage"),
    quantity("lateral_force_n", "N", "lateral force"),
    quantity("traction_coefficient", "1", "traction coefficient"),
    quantity("power_number", "1", "power number"),
    quantity("tractive_efficiency", "1", "tractive efficiency"),
    quantity("balanced_slope_deg", "deg", "balanced slope"),
    quantity("net_pull_n", "N", "net pull"),
    quantity("energy_j_m", "J/m", "energy per metre"),
    quantity("slip", "1", "slip"),
    quantity("wheel_load_n", "N", "wheel load"),
    quantity("sled_speed_m_s", "m/s", "sled speed"),
    quantity("slip_angle_deg", "deg", "slip angle"),
    quantity("gravity_m_s2", "m/s^2", "gravity"),
    quantity("slope_deg", "deg", "slope"),
    quantity("stuck", "1", "stuck"),
];

/// The values of all quantities, in their order and in SI units.
pub type QuantityValues = [f64; QUANTITIES.len()];

/// Returns the positions of the quantities that a model predicts: channels, then what follows from them.
pub fn predicted_quantities() -> std::ops::Range<usize> {
    0..CHANNELS + DERIVED
}

/// Returns the position of a quantity.
pub fn position_of(name: &str) -> Option<usize> {
    QUANTITIES.iter().position(|quantity| quantity.name == name)
}
