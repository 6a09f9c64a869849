//! The values that a likelihood uses from the observables.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::channel::Channel;
use crate::outcome::Observables;

/// One predicted value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PredictedValue {
    /// The average of a channel, in its unit.
    Average {
        /// The channel.
        #[schema(value_type = String)]
        channel: Channel,
        /// Position of the run.
        run: usize,
    },
    /// The change of a channel with ln k*, k* the stiffness of the soil.
    Sensitivity {
        /// The channel.
        #[schema(value_type = String)]
        channel: Channel,
        /// Position of the run.
        run: usize,
    },
    /// The change of a channel with the logarithm of the soil's shear strength, at a fixed sinkage: the torque changes in
    /// proportion, and the drawbar pull by the torque over the wheel's radius.
    ///
    /// Neglected are the slightly larger share of the load on shear, and the inclination of the shear stress; the sinkage
    /// does not change.
    Strength {
        /// Drawbar pull, torque or lateral force.
        #[schema(value_type = String)]
        channel: Channel,
        /// Position of the run.
        run: usize,
        /// Radius of the wheel `[m]`.
        radius_m: f64,
    },
    /// The sinkage at a point of a transient `[m]`.
    TransientSinkage {
        /// Position of the point.
        point: usize,
    },
    /// ln of the pressure under a plate `[ln Pa]`.
    LnPlatePressure {
        /// Position of the reading.
        reading: usize,
    },
    /// ln of the shear stress under a ring `[ln Pa]`.
    LnShearStress {
        /// Position of the reading.
        reading: usize,
    },
}

impl PredictedValue {
    /// Returns the wheel's channel that it is computed from; `None` for a point of a transient, a plate or a ring.
    pub fn channel(self) -> Option<Channel> {
        match self {
            PredictedValue::Average { channel, .. } | PredictedValue::Sensitivity { channel, .. } => {
                Some(channel)
            }
            PredictedValue::Strength {
                channel: Channel::DrawbarPull,
                ..
            } => Some(Channel::Torque),
            PredictedValue::Strength { channel, .. } => Some(channel),
            PredictedValue::TransientSinkage { .. }
            | PredictedValue::LnPlatePressure { .. }
            | PredictedValue::LnShearStress { .. } => None,
        }
    }

    /// Returns the value in `observables`, which must cover the variant of this prediction.
    pub fn select(self, observables: &Observables) -> f64 {
        match self {
            PredictedValue::Average { channel, run } => observables.channel(channel)[run],
            PredictedValue::Sensitivity { channel, run } => observables.sensitivity(channel)[run],
            PredictedValue::Strength {
                channel: Channel::DrawbarPull,
                run,
                radius_m,
            } => observables.torque_n_m[run] / radius_m,
            PredictedValue::Strength { channel, run, .. } => observables.channel(channel)[run],
            PredictedValue::TransientSinkage { point } => observables.transient_sinkage_m[point],
            PredictedValue::LnPlatePressure { reading } => libm::log(observables.plate_pressure_pa[reading]),
            PredictedValue::LnShearStress { reading } => libm::log(observables.shear_stress_pa[reading]),
        }
    }
}
