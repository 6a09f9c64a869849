//! Pace and remaining time of a calibration.

use std::collections::VecDeque;

use shared::api::{CalibrationStatus, Progress};

use crate::calibration::Calibration;
use crate::finished_share::finished_share;

/// The time over which the pace is averaged `[ms]`.
const WINDOW_MS: u64 = 10_000;

/// The recent speed of simulations.
#[derive(Debug)]
pub(super) struct Pace {
    /// Pairs (time, simulations by then), a few for each second; never empty.
    marks: VecDeque<(u64, u64)>,
    /// Mean duration of leases that ended in a result, with more weight on recent ones `[ms]`.
    mean_lease_ms: Option<u64>,
}

/// The inverse of the weight of a new duration in the mean.
const LEASE_MEMORY: u64 = 16;

impl Pace {
    pub(super) fn new(simulations: u64, now_ms: u64) -> Self {
        Pace {
            marks: VecDeque::from([(now_ms, simulations)]),
            mean_lease_ms: None,
        }
    }

    /// Records the number of completed simulations at a time.
    pub(super) fn count(&mut self, simulations: u64, now_ms: u64) {
        if self.marks.back().is_none_or(|&(at, _)| now_ms >= at + 250) {
            self.marks.push_back((now_ms, simulations));
        }
        while self.marks.len() > 2 && self.marks[1].0 + WINDOW_MS < now_ms {
            self.marks.pop_front();
        }
    }

    /// Records the duration of a lease `[ms]`.
    pub(super) fn count_lease(&mut self, age_ms: u64) {
        let mean_ms = self.mean_lease_ms.unwrap_or(age_ms);
        self.mean_lease_ms = Some((mean_ms * (LEASE_MEMORY - 1) + age_ms).div_ceil(LEASE_MEMORY));
    }

    /// Returns the mean duration of leases `[ms]`; `None` before the first result.
    pub(super) fn mean_lease_ms(&self) -> Option<u64> {
        self.mean_lease_ms
    }

    fn per_second(&self, simulations: u64, now_ms: u64) -> f64 {
        let (since, before) = self.marks[0];
        let seconds = now_ms.saturating_sub(since).max(1) as f64 / 1000.0;
        simulations.saturating_sub(before) as f64 / seconds
    }
}

/// Returns the status of a calibration.
pub(super) fn status(
    calibration: &Calibration,
    pace: &Pace,
    is_rewinding: bool,
    now_ms: u64,
) -> CalibrationStatus {
    let identity = &calibration.identity;
    let queue = &calibration.queue;
    let per_second = pace.per_second(calibration.cost.simulations, now_ms);
    let position = calibration.engine().position();
    let evaluations = calibration.cost.evaluations;
    let step_done = (queue.len() - queue.unleased() - queue.leased()) as u64;
    let step_size = queue.len() as u64;
    CalibrationStatus {
        id: identity.id,
        name: identity.name.clone(),
        study: identity.study,
        experiment: identity.experiment,
        state: calibration.state,
        message: calibration.message.clone().or_else(|| match is_rewinding {
            true => {
                Some("results of a worker that computes wrongly were dropped; the rest is replayed".into())
            }
            false => waits(calibration),
        }),
        model_kind: Some(calibration.spec.model.kind.name().to_owned()),
        model_version: calibration.model_version.clone(),
        progress: Some(Progress {
            algorithm: calibration.spec.algorithm.name().to_owned(),
            position,
            evaluations,
            rejected: calibration.cost.rejected,
            step_done,
            step_size,
            share: finished_share(position, evaluations, step_done, step_size),
            search: calibration.engine().search(),
            evaluations_per_s: per_second,
            remaining_s: remaining_s(calibration, per_second),
        }),
    }
}

/// Returns what a calibration waits for that has nothing left to evaluate.
fn waits(calibration: &Calibration) -> Option<String> {
    let waiting = calibration.witness.second.waiting();
    let message = || format!("all is evaluated; {waiting} answers wait for that of a second worker");
    calibration.is_concluded().then(message)
}

/// Returns a rough estimate of the time to go.
fn remaining_s(calibration: &Calibration, per_second: f64) -> Option<f64> {
    let left = evaluations_left(calibration)?;
    (per_second > 0.0).then_some(left / per_second)
}

/// Estimates the number of evaluations that are left: exponents grow by about a constant factor in each stage, so the number of stages
/// follows from the growth so far, and each is assumed to cost the mean of the earlier stages. Returns `None` before the second stage.
pub(super) fn evaluations_left(calibration: &Calibration) -> Option<f64> {
    let exponents: Vec<f64> = calibration
        .engine()
        .exponents()
        .into_iter()
        .filter(|&b| b > 0.0)
        .collect();
    let (&first, &last) = (exponents.first()?, exponents.last()?);
    if exponents.len() < 2 {
        return None;
    }
    let growth = (last / first).ln() / (exponents.len() - 1) as f64;
    let stages_to_go = (1.0 / last).ln() / growth.max(1e-3);
    let cost = calibration.cost.evaluations as f64 / exponents.len() as f64;
    Some(stages_to_go * cost)
}
