//! The averages of a run: steady means of the measured channels, and diagnostics of the contact.

/// Steady averages of one run and the diagnostics of the contact behind them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Averages {
    /// Drawbar pull F along the wheel's heading `[N]`; > 0: the wheel pulls.
    pub drawbar_pull_n: f64,
    /// Torque T about the axle `[N m]`; > 0: the motor works.
    pub torque_n_m: f64,
    /// Sinkage z = R − hub height above the undisturbed surface `[m]`.
    pub sinkage_m: f64,
    /// Lateral force across the heading `[N]`; > 0: the soil resists the sideways motion of a positive slip angle.
    pub lateral_force_n: f64,
    /// Effective width 2 A / L of the footprint `[m]`.
    pub b_eff_m: f64,
    /// Length of the contact projected on the ground `[m]`.
    pub contact_length_m: f64,
    /// Residual of the balance: vertical soil force less wheel load `[N]`.
    pub residual_load_n: f64,
    /// Number of points at which the contact was evaluated.
    pub nodes_in_contact: u32,
    /// Simulated travel until the steady state `[m]`; 0 for a quasi-static model.
    pub simulated_travel_m: f64,
}
