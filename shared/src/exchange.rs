//! The messages between worker and coordinator: one long-polled exchange, and the fetch of a variant.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::channel::Channel;
use crate::outcome::{Observables, Outcome};

/// Version of these messages; a coordinator answers any other version with 426.
pub const PROTOCOL_VERSION: u32 = 13;

/// `POST /v1/work/exchange`: the results of finished leases, and the number of leases wanted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ExchangeRequest {
    /// Name of the worker process, fresh at every start.
    pub worker: String,
    /// [`PROTOCOL_VERSION`] of the worker.
    pub protocol: u32,
    /// Version of the equations that the worker computes.
    pub model_version: String,
    /// The versions of the external models that the worker runs, by [`ExternalSource::name`](crate::model::ExternalSource::name).
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub models: BTreeMap<String, String>,
    /// The queue's job that started the worker, such as `slurm 1234_5`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub queue_job: Option<String>,
    /// Number of threads that simulate.
    pub threads: u32,
    /// Mean time of its evaluations so far `[s]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub evaluation_s: Option<f64>,
    /// Results, in any order. Acknowledged by the response; resent until then.
    pub results: Vec<WorkResult>,
    /// Leases still held, renewed by this message.
    pub holding: Vec<u64>,
    /// Leases given back unevaluated.
    pub returned: Vec<u64>,
    /// Leases whose evaluation has begun and has no result yet; renewed too. Only the loss of a started lease counts as a
    /// failed attempt.
    pub started: Vec<u64>,
    /// The highest lease number that this worker has received, 0 before the first: leases given to it above this number were
    /// lost on the way. `u64::MAX` while another answer is under way.
    pub received: u64,
    /// The maximum number of leases that the worker takes now.
    pub want: u32,
    /// The time that the coordinator may wait for work before it answers `[ms]`.
    pub wait_ms: u64,
}

/// An outcome with the lease it answers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct WorkResult {
    /// The lease; no lease number is ever given out twice.
    pub lease: u64,
    /// The calibration, so that a result outlives the lease it was computed under.
    pub calibration: i64,
    /// The evaluation within the calibration.
    pub evaluation: u64,
    /// The seal of the lease, as the worker received it.
    pub seal: String,
    /// The outcome.
    pub outcome: Outcome,
    /// Difference between the outcome and a second answer of the same worker, if an external model was asked twice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeated: Option<RepeatedAnswer>,
}

/// The difference between two answers of a model to one question: the largest absolute difference over the runs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct RepeatedAnswer {
    /// Difference of the drawbar pull `[N]`.
    pub drawbar_pull_n: f64,
    /// Difference of the torque \[N m\].
    pub torque_n_m: f64,
    /// Difference of the sinkage `[m]`.
    pub sinkage_m: f64,
    /// Difference of the lateral force `[N]`.
    pub lateral_force_n: f64,
    /// True if the model refused the second time.
    pub is_refused: bool,
}

impl RepeatedAnswer {
    /// Compares two answers of the same shape.
    pub fn new(first: &Observables, second: &Observables) -> Self {
        let difference = |channel: Channel| {
            let pairs = first.channel(channel).iter().zip(second.channel(channel));
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        RepeatedAnswer {
            drawbar_pull_n: difference(Channel::DrawbarPull),
            torque_n_m: difference(Channel::Torque),
            sinkage_m: difference(Channel::Sinkage),
            lateral_force_n: difference(Channel::LateralForce),
            is_refused: false,
        }
    }

    /// Records that the model refused the second time.
    pub fn refused() -> Self {
        RepeatedAnswer {
            is_refused: true,
            ..RepeatedAnswer::default()
        }
    }

    /// Returns the difference of a channel.
    pub fn channel(&self, channel: Channel) -> f64 {
        match channel {
            Channel::DrawbarPull => self.drawbar_pull_n,
            Channel::Torque => self.torque_n_m,
            Channel::Sinkage => self.sinkage_m,
            Channel::LateralForce => self.lateral_force_n,
        }
    }

    /// Returns whether the answers differ.
    pub fn differs(&self) -> bool {
        self.is_refused || Channel::ALL.iter().any(|&channel| self.channel(channel) > 0.0)
    }

    /// Returns whether every difference is a finite number, not below 0.
    pub fn is_valid(&self) -> bool {
        Channel::ALL.iter().all(|&channel| {
            let difference = self.channel(channel);
            difference.is_finite() && difference >= 0.0
        })
    }
}

/// The answer: results are durable, and more work is given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ExchangeResponse {
    /// New leases, at most as many as wanted.
    pub leases: Vec<Lease>,
    /// The time that a lease lasts without renewal `[ms]`.
    pub lease_ms: u64,
    /// Evaluations not yet leased in the active calibrations; bounds the next `want`.
    pub remaining: u64,
    /// Calibrations that are neither over nor paused.
    pub in_hand: u64,
    /// Workers active recently; bounds the next `want`.
    pub workers: u32,
    /// Number of results without effect: late duplicates, results of an ended calibration, or results refused for their seal.
    pub duplicates: u32,
    /// The reason why the worker got no lease although a calibration is waiting.
    pub refused: Option<String>,
}

/// A time-limited claim on one evaluation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Lease {
    /// Fencing token: grows with every lease, across restarts too.
    pub lease: u64,
    /// Number of the calibration.
    pub calibration: i64,
    /// The evaluation within the calibration.
    pub evaluation: u64,
    /// Proves which evaluation was leased to which worker; a result without it is refused. A worker returns it unread.
    pub seal: String,
    /// Hash of the variant to evaluate; `GET /v1/work/variants/HASH`.
    pub variant: String,
    /// Parameter vector in the variant's order.
    pub theta: Vec<f64>,
    /// True if the worker must report the lease as started and wait for the answer before it evaluates, because the
    /// evaluation was lost before.
    pub announce: bool,
}
