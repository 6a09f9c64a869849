//! The outcome of an evaluation: observables, a rejection of the parameters, or a fault of the machine.

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::channel::Channel;

/// The result of simulating every condition of a variant at one parameter vector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[expect(
    clippy::large_enum_variant,
    reason = "nearly every outcome is the large variant: a box would cost an allocation and save nothing"
)]
pub enum Outcome {
    /// The model gave observables.
    Evaluated(Observables),
    /// The model rejects these parameters; the rejection is a property of the parameters, so it is recorded and never
    /// retried.
    Rejected(ParameterRejection),
    /// The machine failed; the evaluation is leased again elsewhere.
    Fault(Fault),
}

/// Averages of every run, one vector per channel and per diagnostic, in the order of the conditions; channels and
/// diagnostics that the variant does not request are empty.
///
/// Numbers are finite: a simulation that yields any other number is a rejection.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Observables {
    /// Drawbar pull `[N]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub drawbar_pull_n: Vec<f64>,
    /// Torque \[N m\].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub torque_n_m: Vec<f64>,
    /// Sinkage `[m]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sinkage_m: Vec<f64>,
    /// Lateral force `[N]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lateral_force_n: Vec<f64>,
    /// Mean effective width `b_eff = 2A/L` of the footprint `[m]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub b_eff_m: Vec<f64>,
    /// Mean contact length `[m]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contact_length_m: Vec<f64>,
    /// Residual of the vertical balance `[N]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub residual_load_n: Vec<f64>,
    /// Nodes, or quadrature points, in contact.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub nodes_in_contact: Vec<u32>,
    /// Simulated travel `[m]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub simulated_travel_m: Vec<f64>,
    /// Remaining relative change of the averages towards their limit when each run of a `steady` protocol ended; empty for
    /// models and protocols that do not wait for averages to settle.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub settled_to: Vec<f64>,
    /// Change of the drawbar pull `[N]` with ln k*, k* the stiffness of the soil. This vector and the next three are empty
    /// unless the variant requests them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub d_drawbar_pull_n: Vec<f64>,
    /// Change of the torque \[N m\] with ln k*.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub d_torque_n_m: Vec<f64>,
    /// Change of the sinkage `[m]` with ln k*.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub d_sinkage_m: Vec<f64>,
    /// Change of the lateral force `[N]` with ln k*.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub d_lateral_force_n: Vec<f64>,
    /// Sinkage at each point of the variant's transients `[m]`, in their order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transient_sinkage_m: Vec<f64>,
    /// Pressure under each plate of the variant `[Pa]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub plate_pressure_pa: Vec<f64>,
    /// Shear stress under each ring of the variant `[Pa]`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shear_stress_pa: Vec<f64>,
    /// Time histories of the runs; empty unless the variant requests them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub histories: Vec<SimulatedHistory>,
}

/// Time histories of a simulated run: means over intervals of 0.1 s from the start, with transients, unfiltered.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct SimulatedHistory {
    /// Drawbar pull `[N]`.
    pub drawbar_pull_n: Vec<f64>,
    /// Torque \[N m\].
    pub torque_n_m: Vec<f64>,
    /// Sinkage `[m]`.
    pub sinkage_m: Vec<f64>,
    /// Lateral force `[N]`.
    pub lateral_force_n: Vec<f64>,
}

impl SimulatedHistory {
    /// Returns the samples of a channel.
    pub fn channel(&self, channel: Channel) -> &[f64] {
        match channel {
            Channel::DrawbarPull => &self.drawbar_pull_n,
            Channel::Torque => &self.torque_n_m,
            Channel::Sinkage => &self.sinkage_m,
            Channel::LateralForce => &self.lateral_force_n,
        }
    }
}

impl Observables {
    /// Allocates vectors for a number of runs.
    pub fn with_capacity(runs: usize) -> Self {
        let room = || Vec::with_capacity(runs);
        Observables {
            drawbar_pull_n: room(),
            torque_n_m: room(),
            sinkage_m: room(),
            lateral_force_n: room(),
            b_eff_m: room(),
            contact_length_m: room(),
            residual_load_n: room(),
            nodes_in_contact: Vec::with_capacity(runs),
            simulated_travel_m: room(),
            ..Observables::default()
        }
    }

    /// Returns the values of a channel, by run.
    pub fn channel(&self, channel: Channel) -> &[f64] {
        match channel {
            Channel::DrawbarPull => &self.drawbar_pull_n,
            Channel::Torque => &self.torque_n_m,
            Channel::Sinkage => &self.sinkage_m,
            Channel::LateralForce => &self.lateral_force_n,
        }
    }

    /// Returns the values of a channel, writable.
    pub fn channel_mut(&mut self, channel: Channel) -> &mut Vec<f64> {
        match channel {
            Channel::DrawbarPull => &mut self.drawbar_pull_n,
            Channel::Torque => &mut self.torque_n_m,
            Channel::Sinkage => &mut self.sinkage_m,
            Channel::LateralForce => &mut self.lateral_force_n,
        }
    }

    /// Returns the change of a channel with ln k*, by run; empty unless the variant requests it.
    pub fn sensitivity(&self, channel: Channel) -> &[f64] {
        match channel {
            Channel::DrawbarPull => &self.d_drawbar_pull_n,
            Channel::Torque => &self.d_torque_n_m,
            Channel::Sinkage => &self.d_sinkage_m,
            Channel::LateralForce => &self.d_lateral_force_n,
        }
    }

    /// Removes the channels outside this list with their changes by ln k*, and the diagnostics of the contact.
    pub fn keep_only(&mut self, channels: &[Channel]) {
        for (channel, values) in [
            (Channel::DrawbarPull, &mut self.drawbar_pull_n),
            (Channel::Torque, &mut self.torque_n_m),
            (Channel::Sinkage, &mut self.sinkage_m),
            (Channel::LateralForce, &mut self.lateral_force_n),
            (Channel::DrawbarPull, &mut self.d_drawbar_pull_n),
            (Channel::Torque, &mut self.d_torque_n_m),
            (Channel::Sinkage, &mut self.d_sinkage_m),
            (Channel::LateralForce, &mut self.d_lateral_force_n),
        ] {
            if !channels.contains(&channel) {
                *values = Vec::new();
            }
        }
        self.b_eff_m = Vec::new();
        self.contact_length_m = Vec::new();
        self.residual_load_n = Vec::new();
        self.nodes_in_contact = Vec::new();
        self.simulated_travel_m = Vec::new();
        self.settled_to = Vec::new();
    }

    /// Computes a 64-bit hash: results with different bits almost certainly differ in it.
    pub fn fingerprint(&self) -> u64 {
        let bits = self.numbers().map(f64::to_bits);
        let counts = self.nodes_in_contact.iter().map(|&n| u64::from(n));
        fnv(bits.chain(counts))
    }

    /// Returns whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.numbers().all(f64::is_finite)
    }

    /// Returns every number except the counts.
    fn numbers(&self) -> impl Iterator<Item = f64> {
        let vectors = [
            &self.drawbar_pull_n,
            &self.torque_n_m,
            &self.sinkage_m,
            &self.lateral_force_n,
            &self.b_eff_m,
            &self.contact_length_m,
            &self.residual_load_n,
            &self.simulated_travel_m,
            &self.settled_to,
            &self.d_drawbar_pull_n,
            &self.d_torque_n_m,
            &self.d_sinkage_m,
            &self.d_lateral_force_n,
            &self.plate_pressure_pa,
            &self.shear_stress_pa,
            &self.transient_sinkage_m,
        ];
        let samples = self
            .histories
            .iter()
            .flat_map(|history| Channel::ALL.map(|c| history.channel(c)));
        let vectors = vectors.into_iter().map(Vec::as_slice);
        vectors.chain(samples).flatten().copied()
    }
}

/// Why the model rejects a parameter vector.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterRejection {
    /// Stable word: `no_support`, `no_convergence`, `not_finite`, `energy_gained`, `protocol`, `formula`,
    /// `invalid_parameter`; for an external model also `model`, `model_error`, `time_limit`.
    pub kind: String,
    /// Position of the rejected condition; plates are counted after the runs, and rings after the plates. A point of a transient has the
    /// position of its run.
    pub condition: u32,
    /// Quantity, value, unit, bound.
    pub message: String,
}

/// A failure of a machine.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Fault {
    /// The machine's message.
    pub message: String,
}

/// Computes FNV-1a with a rotation, over 64-bit words: stable over versions, unlike the standard library's hasher.
fn fnv(words: impl Iterator<Item = u64>) -> u64 {
    words.fold(0xcbf2_9ce4_8422_2325, |hash, word| {
        (hash ^ word).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(29)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_bit_changes_the_fingerprint() {
        let mut observables = Observables {
            sinkage_m: vec![0.1, 0.2, 0.3],
            ..Observables::default()
        };
        let before = observables.fingerprint();
        observables.sinkage_m[1] = f64::from_bits(observables.sinkage_m[1].to_bits() ^ 1);
        assert_ne!(observables.fingerprint(), before);
    }
}
