//! The conditions to simulate: runs of the rig, points before they are steady, readings of plates and rings.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::experiment::TestRun;

/// The properties of a run that the simulation needs; measurements stay with the coordinator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct RunCondition {
    /// Name of the wheel in [`ModelVariant::wheels`](super::ModelVariant::wheels).
    pub wheel: String,
    /// Slip by the rig's radius, in [-1, 1).
    pub slip: f64,
    /// Vertical load `[N]`.
    pub wheel_load_n: f64,
    /// Sled speed along travel `[m/s]`.
    pub sled_speed_m_s: f64,
    /// From wheel heading to travel `[deg]`.
    pub slip_angle_deg: f64,
    /// Number of passes; the last one is averaged.
    pub pass: u32,
    /// Angle of repose of the run's soil `[deg]`, for a model with sliding soil; absent: the model's default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repose_angle_deg: Option<f64>,
    /// Density of the run's soil `[kg/m^3]`; absent if no effect uses it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density_kg_m3: Option<f64>,
    /// Position of the run in the series of the campaign, −0.5 the first, 0.5 the last; absent if no effect uses it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub order: Option<f64>,
}

impl RunCondition {
    /// Returns the condition of a run, without the properties that only some models and effects use.
    pub(super) fn new(run: &TestRun) -> Self {
        RunCondition {
            repose_angle_deg: None,
            density_kg_m3: None,
            order: None,
            wheel: run.wheel.clone(),
            slip: run.slip,
            wheel_load_n: run.wheel_load_n,
            sled_speed_m_s: run.sled_speed_m_s,
            slip_angle_deg: run.slip_angle_deg,
            pass: run.pass,
        }
    }
}

/// Points of travel at which the sinkage of a run is predicted before it is steady; their measurements stay with the coordinator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct TransientCondition {
    /// Position of the run in [`ModelVariant::conditions`](super::ModelVariant::conditions).
    pub run: usize,
    /// Sinkage where the slip of the run begins `[m]`.
    pub start_sinkage_m: f64,
    /// Steady sinkage to which the wheel settles `[m]`; that of the model if it is not stated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steady_sinkage_m: Option<f64>,
    /// Travel of the sled since the beginning of the slip at each point `[m]`, ascending.
    pub travel_m: Vec<f64>,
}

/// A plate in the soil; its measurement stays with the coordinator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct PlateCondition {
    /// Radius of the round plate `[m]`.
    pub plate_radius_m: f64,
    /// Sinkage `[m]`.
    pub sinkage_m: f64,
}

/// A ring on the soil; its measurement stays with the coordinator.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct RingCondition {
    /// Normal stress under the ring `[Pa]`.
    pub normal_stress_pa: f64,
    /// Displacement at the ring's mean radius `[m]`.
    pub shear_displacement_m: f64,
}
