//! The messages between worker and coordinator: one long-polled exchange, and the fetch of a variant.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use statistics::{Subchain, SubchainEnd};
use utoipa::ToSchema;

use crate::channel::Channel;
use crate::outcome::{Observables, Outcome};

/// Version of these messages; a coordinator answers any other version with 426.
pub const PROTOCOL_VERSION: u32 = 11;

/// `POST /v1/work/exchange`: results of finished leases, and how many more are wanted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ExchangeRequest {
    /// Name of the worker process, fresh at every start.
    pub worker: String,
    /// [`PROTOCOL_VERSION`] of the worker.
    pub protocol: u32,
    /// Version of the equations that the worker computes.
    pub model_version: String,
    /// The models that are not ours that the worker runs: the version of each by its name, see
    /// [`ExternalSource::name`](crate::model::ExternalSource::name).
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub models: BTreeMap<String, String>,
    /// The job of a queue that started the worker, as in `slurm 1234_5`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub queue_job: Option<String>,
    /// Threads that simulate.
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
    /// Leases whose evaluation has begun and has no result yet; renewed too. Only of these does a loss count as a failed attempt.
    pub started: Vec<u64>,
    /// The highest lease number that has reached this worker, 0 before the first: what was given to it above was lost on the way.
    /// `u64::MAX` while another answer is under way.
    pub received: u64,
    /// Most leases that the worker takes now.
    pub want: u32,
    /// How long the coordinator may wait for work before it answers `[ms]`.
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
    /// The seal of the lease, as it came.
    pub seal: String,
    /// Where the subchain of the lease ended, if it asked for one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(value_type = Option<Object>)]
    pub end: Option<SubchainEnd>,
    /// The outcome; of a subchain, at its end. Absent where none of its moves was accepted, so that there was nothing to evaluate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outcome: Option<Outcome>,
    /// How far a second answer of the same worker differs from the outcome, where a model that is not ours was asked twice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeated: Option<RepeatedAnswer>,
}

/// How far two answers of a model to one question differ: the largest difference over the runs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct RepeatedAnswer {
    /// Of the drawbar pull `[N]`.
    pub drawbar_pull_n: f64,
    /// Of the torque \[N m\].
    pub torque_n_m: f64,
    /// Of the sinkage `[m]`.
    pub sinkage_m: f64,
    /// Of the lateral force `[N]`.
    pub lateral_force_n: f64,
    /// Whether the model refused the second time.
    pub is_refused: bool,
}

impl RepeatedAnswer {
    /// Compares two answers of the same shape.
    pub fn new(first: &Observables, second: &Observables) -> Self {
        let of = |channel: Channel| {
            let pairs = first.channel(channel).iter().zip(second.channel(channel));
            pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        RepeatedAnswer {
            drawbar_pull_n: of(Channel::DrawbarPull),
            torque_n_m: of(Channel::Torque),
            sinkage_m: of(Channel::Sinkage),
            lateral_force_n: of(Channel::LateralForce),
            is_refused: false,
        }
    }

    /// The model refused the second time.
    pub fn refused() -> Self {
        RepeatedAnswer {
            is_refused: true,
            ..RepeatedAnswer::default()
        }
    }

    /// The difference of a channel.
    pub fn channel(&self, channel: Channel) -> f64 {
        match channel {
            Channel::DrawbarPull => self.drawbar_pull_n,
            Channel::Torque => self.torque_n_m,
            Channel::Sinkage => self.sinkage_m,
            Channel::LateralForce => self.lateral_force_n,
        }
    }

    /// Whether the answers differ.
    pub fn differs(&self) -> bool {
        self.is_refused || Channel::ALL.iter().any(|&channel| self.channel(channel) > 0.0)
    }

    /// Whether every difference is a finite number, not below 0.
    pub fn is_valid(&self) -> bool {
        Channel::ALL.iter().all(|&channel| {
            let difference = self.channel(channel);
            difference.is_finite() && difference >= 0.0
        })
    }
}

/// The answer: results are durable, and here is more work.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ExchangeResponse {
    /// New leases, at most as many as wanted.
    pub leases: Vec<Lease>,
    /// How long a lease lasts without renewal `[ms]`.
    pub lease_ms: u64,
    /// Evaluations not yet leased in the active calibrations; bounds the next `want`.
    pub remaining: u64,
    /// Calibrations that are neither over nor paused.
    pub in_hand: u64,
    /// Workers active recently; bounds the next `want`.
    pub workers: u32,
    /// Results that changed nothing: late duplicates, of a calibration that ended, or refused for their seal.
    pub duplicates: u32,
    /// Why the worker got no lease although a calibration is waiting, if so.
    pub refused: Option<String>,
}

/// A time-limited claim on one evaluation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Lease {
    /// Fencing token: grows with every lease, across restarts too.
    pub lease: u64,
    /// The calibration.
    pub calibration: i64,
    /// The evaluation within the calibration.
    pub evaluation: u64,
    /// Proves what was asked of whom; a result without it is refused. Nothing that a worker need understand.
    pub seal: String,
    /// Hash of the variant to evaluate; `GET /v1/work/variants/HASH`.
    pub variant: String,
    /// Parameter vector in the variant's order; of a subchain, the whole one that the sampler has, noise included.
    pub theta: Vec<f64>,
    /// Whether the lease is to be reported as started, and that answered, before its evaluation begins: it was lost before.
    pub announce: bool,
    /// The moves to take from there by the variant's metamodel, before the model is evaluated at their end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(value_type = Option<Object>)]
    pub subchain: Option<Subchain>,
}
