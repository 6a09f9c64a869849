//! The choice of the leases that a worker is given.

use std::collections::{BTreeMap, BTreeSet};

use shared::api::CalibrationState;
use shared::exchange::Lease;
use shared::model::equations_of;

use super::farm::{Entry, Farm};
use super::seal::{LeaseTerms, seal};
use super::share::deal;
use super::voting;
use super::work_result::model_version;
use crate::calibration::Calibration;
use crate::lease::{Claimant, NewClaim};

/// The largest number of leases of a worker that has answered nothing yet, unless it has more threads.
const UNPROVEN_LEASES: usize = 64;
/// The largest number of threads for which a worker that has answered nothing yet gets leases.
const UNPROVEN_THREADS: usize = 1_024;

/// A calibration that may lease to a worker.
#[derive(Debug, Clone, Copy)]
struct Turn {
    id: i64,
    /// Whether it leases evaluations that a second worker computes as well.
    is_second: bool,
    /// The largest number of leases.
    max_leases: usize,
}

impl Farm {
    /// Returns the calibrations that may lease to a worker that holds `holds` leases, in order: those with suspects if the worker holds
    /// nothing, then second answers, then the oldest. Each gets its share first, then the rest.
    fn turns(&self, want: usize, holds: usize) -> Vec<Turn> {
        let waits = |e: &&Entry| e.calibration.is_open() && e.calibration.queue.unleased() > 0;
        let waiting: Vec<&Calibration> = self
            .calibrations
            .values()
            .filter(waits)
            .map(|e| &e.calibration)
            .collect();
        let queues: Vec<(usize, usize)> = waiting
            .iter()
            .map(|c| (c.queue.leased(), c.queue.unleased()))
            .collect();
        let ids = waiting.iter().map(|c| c.identity.id);
        let first = |(id, max_leases)| Turn {
            id,
            is_second: false,
            max_leases,
        };
        let mut turns: Vec<Turn> = ids.clone().zip(deal(&queues, want)).map(first).collect();
        let mut suspected = 0;
        if holds == 0 {
            let is_suspected = |turn: &Turn| self.calibrations[&turn.id].calibration.queue.suspects() > 0;
            turns.sort_by_key(|turn| !is_suspected(turn));
            suspected = turns.iter().filter(|turn| is_suspected(turn)).count();
            // A suspect needs a worker without leases, however many leases of its calibration are out.
            if let Some(turn) = turns.first_mut().filter(|_| suspected > 0) {
                turn.max_leases = turn.max_leases.max(1);
            }
        }
        let asks_twice =
            |e: &&Entry| e.calibration.is_open() && e.calibration.witness.second.queue.unleased() > 0;
        let twice = self.calibrations.values().filter(asks_twice).map(|e| Turn {
            id: e.calibration.identity.id,
            is_second: true,
            max_leases: want,
        });
        turns.splice(suspected..suspected, twice);
        turns.extend(ids.map(|id| first((id, want))));
        turns
    }

    /// Leases up to `want` evaluations. Returns the leases, and the reason if a calibration refuses the worker.
    pub(super) fn lease(&mut self, worker: &str, want: usize, now_ms: u64) -> (Vec<Lease>, Option<String>) {
        let mut leases = Vec::new();
        let mut refused = None;
        let expires_ms = now_ms + self.lease_ms;
        let mut holds = self.held_by(worker);
        let want = want.min(self.max_leases(worker).saturating_sub(holds));
        let holds_suspect = |e: &Entry| {
            let second = &e.calibration.witness.second.queue;
            e.calibration.queue.holds_suspect(worker) || second.holds_suspect(worker)
        };
        if want == 0 || (holds > 0 && self.calibrations.values().any(holds_suspect)) {
            return (leases, refused);
        }
        for turn in self.turns(want, holds) {
            let version = match self.version_for(worker, turn.id, now_ms) {
                Ok(version) => version,
                Err(reason) => {
                    refused = Some(reason);
                    continue;
                }
            };
            let voting = self.rule.voting.clone();
            let claimant = Claimant {
                worker,
                voter: voting.voter(worker),
                holds,
                now_ms,
                expires_ms,
            };
            let max_leases = turn.max_leases.min(want - leases.len());
            let claims = self.claim(turn, claimant, max_leases, &version);
            holds += claims.len();
            let has_suspect = claims.iter().any(|claim| claim.suspect);
            let entry = &self.calibrations[&turn.id];
            leases.extend(
                claims
                    .into_iter()
                    .map(|claim| sealed(entry, turn, worker, &version, claim)),
            );
            if has_suspect {
                break;
            }
        }
        if let (Some(record), Some(last)) = (self.workers.get_mut(worker), leases.last()) {
            record.given = last.lease;
        }
        (leases, refused)
    }

    /// Returns the largest number of leases that a worker may hold. One that has answered nothing may never answer.
    fn max_leases(&self, worker: &str) -> usize {
        let record = self.workers.get(worker).filter(|record| record.completed == 0);
        let threads = record.map(|record| record.threads as usize);
        threads.map_or(usize::MAX, |threads| {
            threads.clamp(UNPROVEN_LEASES, UNPROVEN_THREADS)
        })
    }

    /// Returns the version of the equations that more voters compute than the version of a worker, if there is one, among the workers
    /// that have been heard of since a time.
    fn outvoting(&self, version: &str, calibration: &Calibration, since_ms: u64) -> Option<String> {
        let mut voters: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for (name, record) in &self.workers {
            if record.last_seen_ms >= since_ms
                && let Some(version) = record.equations_for(calibration)
                && self.quarantined(name).is_none()
            {
                let of_version = voters.entry(equations_of(version)).or_default();
                of_version.insert(self.rule.voting.voter(name));
            }
        }
        let votes = voters.get(equations_of(version)).map_or(0, BTreeSet::len);
        let stronger = voters.into_iter().filter(|(_, voters)| voters.len() > votes);
        stronger
            .max_by_key(|(_, voters)| voters.len())
            .map(|(version, _)| version.to_owned())
    }

    /// Returns the version of the model that a worker computes a calibration with.
    ///
    /// # Errors
    /// The reason why the worker cannot compute it.
    fn version_for(&self, worker: &str, id: i64, now_ms: u64) -> Result<String, String> {
        let calibration = &self.calibrations[&id].calibration;
        let record = self.workers.get(worker);
        let Some(version) = record.and_then(|record| record.equations_for(calibration)) else {
            let external = calibration.spec.model.external.as_ref();
            let model = external.map(|model| model.source.name()).unwrap_or_default();
            return Err(format!(
                "calibration {id} is of the model {model}, which worker {worker} does not run: its operator allows it by --allow-model, and it must answer"
            ));
        };
        // The files of effects are sent with the variant, so a worker need not have them.
        let pinned = calibration.model_version.as_deref().map(equations_of);
        if pinned.is_none()
            && let Some(outvoting) =
                self.outvoting(version, calibration, now_ms.saturating_sub(self.lease_ms))
        {
            return Err(format!(
                "most workers compute calibration {id} with model version {outvoting}, worker {worker} with {version}"
            ));
        }
        match pinned.filter(|pinned| *pinned != equations_of(version)) {
            None => Ok(version.to_owned()),
            Some(pinned) => Err(format!(
                "calibration {id} was begun with model version {pinned}, worker {worker} computes {version}"
            )),
        }
    }

    /// Claims evaluations of a calibration for a worker.
    fn claim(&mut self, turn: Turn, claimant: Claimant, max_leases: usize, version: &str) -> Vec<NewClaim> {
        let Some(entry) = self.calibrations.get_mut(&turn.id) else {
            return Vec::new();
        };
        let calibration = &mut entry.calibration;
        let external = calibration.spec.model.external.as_ref().map(|m| m.source.name());
        let (workers, quarantine, voting) = (&self.workers, &self.quarantine, &self.rule.voting);
        let has_other = |failed: &[String]| {
            workers.iter().any(|(name, other)| {
                let stated = other.equations_of_model(external.as_deref());
                let is_able = stated.map(equations_of) == Some(equations_of(version));
                let has_failed = failed.iter().any(|one| one == name || one == voting.voter(name));
                is_able && !has_failed && voting::quarantined(quarantine, name).is_none()
            })
        };
        let queue = match turn.is_second {
            true => &mut calibration.witness.second.queue,
            false => &mut calibration.queue,
        };
        let lease_numbers = &mut self.lease_numbers;
        let claims = queue.claim(claimant, max_leases, has_other, || lease_numbers.next_number());
        self.counters.leased += claims.len() as u64;
        if !claims.is_empty() && calibration.state == CalibrationState::Queued {
            calibration.change_state(CalibrationState::Running, None, &mut self.facts);
        }
        claims
    }
}

/// Makes the lease of a claim, with its seal.
fn sealed(entry: &Entry, turn: Turn, worker: &str, version: &str, claim: NewClaim) -> Lease {
    let calibration = &entry.calibration;
    let (lease, evaluation) = (claim.lease, claim.evaluation);
    let question = match turn.is_second {
        true => calibration.witness.second.question(evaluation),
        false => calibration.question(evaluation),
    };
    let question = question.expect("a claimed evaluation is asked for at present");
    let terms = LeaseTerms {
        lease,
        worker,
        calibration: turn.id,
        evaluation,
        model_version: &model_version(calibration, version),
    };
    Lease {
        lease,
        calibration: turn.id,
        evaluation,
        seal: seal(entry.key, terms, question),
        variant: question.variant.to_owned(),
        theta: question.theta.to_vec(),
        announce: claim.suspect,
    }
}
