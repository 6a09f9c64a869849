//! The result of a run.

use super::history::History;
use crate::Averages;

/// The result of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialRun {
    /// Averages by the protocol, with the diagnostics of the contact.
    pub averages: Averages,
    /// What the averages of the last window still had to go, by the measure of [`Protocol::Steady`](crate::spatial::Protocol::Steady); above its
    /// tolerance where the travel did not suffice. `None` for a fixed duration.
    pub settled_to: Option<f64>,
    /// Mean power that motor and rig put into the soil while averaging `[W]`, ≥ 0 but for rounding.
    pub dissipated_power_w: f64,
    /// Heights of the hub that were tried, and nodes in contact over all of them.
    pub trials: u64,
    /// Sum over all trials of the nodes in contact that were computed.
    pub node_trials: u64,
    /// Step by step.
    pub history: History,
}
