//! The result of a run.

use super::history::History;
use crate::Averages;

/// The result of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct SpatialRun {
    /// Averages by the protocol, with the diagnostics of the contact.
    pub averages: Averages,
    /// Remaining distance of the averages of the last window to their limit, by the measure of
    /// [`Protocol::Steady`](crate::spatial::Protocol::Steady); above its tolerance if the travel was too short.
    ///
    /// `None` for a fixed duration.
    pub settled_to: Option<f64>,
    /// Mean power that motor and rig put into the soil during the averaged steps `[W]`, ≥ 0 except for rounding.
    pub dissipated_power_w: f64,
    /// Number of trial heights of the hub.
    pub trials: u64,
    /// Sum over all trials of the nodes in contact that were computed.
    pub node_trials: u64,
    /// The history, step by step.
    pub history: History,
}
