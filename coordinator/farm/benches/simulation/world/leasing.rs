//! The checks of the witness on leases: who holds what, and whether it may be given.

use shared::api::CalibrationState;
use shared::exchange::{ExchangeRequest, ExchangeResponse, Lease};
use shared::model::equations_of;

use super::issued::{Issued, Live};
use super::ledger::Ledger;
use super::promise::{Broken, Promise, demand};
use super::witness::Witness;
use record::EvaluationRow;

/// A lease is never slow before this time `[ms]`.
const SLOW_MS: u64 = 1_000;

impl<'a> Witness<'a> {
    /// Ends expired leases, before the facts of the tick are checked.
    pub(crate) fn tick(&mut self, now_ms: u64) {
        self.expired = self
            .live
            .extract_if(.., |_, live| live.until_ms <= now_ms)
            .collect();
        let unstarted = self
            .expired
            .iter()
            .filter(|((.., is_second), live)| !live.started && !is_second);
        for ((id, evaluation, _), _) in unstarted {
            *self.unstarted.entry((*id, *evaluation)).or_default() += 1;
        }
    }

    /// Checks an exchange once its facts are in the ledger.
    pub(crate) fn exchanged(
        &mut self,
        request: &ExchangeRequest,
        response: &ExchangeResponse,
        ledger: &Ledger<'a>,
        now_ms: u64,
    ) -> Result<(), Broken> {
        self.disputed(request, ledger)?;
        self.second_answers(request, ledger);
        for (of, live) in self
            .live
            .iter_mut()
            .filter(|(_, live)| live.worker == request.worker)
        {
            let started = request.started.contains(&live.lease);
            if started || request.holding.contains(&live.lease) {
                live.until_ms = now_ms + self.lease_ms;
            }
            if started {
                live.started = true;
                self.unstarted.remove(&(of.0, of.1));
            }
        }
        self.live.retain(|_, live| {
            let is_lost = live.lease > request.received || request.returned.contains(&live.lease);
            live.worker != request.worker || !is_lost
        });
        response
            .leases
            .iter()
            .try_for_each(|lease| self.leased(request, lease, ledger, now_ms))
    }

    fn leased(
        &mut self,
        request: &ExchangeRequest,
        lease: &Lease,
        ledger: &Ledger<'a>,
        now_ms: u64,
    ) -> Result<(), Broken> {
        if self.is_given_up {
            return Ok(());
        }
        let (number, id, evaluation) = (lease.lease, lease.calibration, lease.evaluation);
        let Some(table) = ledger.table(id) else {
            return Err(Broken::new(
                Promise::Question,
                format!("lease {number} is of no calibration"),
            ));
        };
        let last = self.issued.keys().next_back().copied().unwrap_or_default();
        demand(number > last, Promise::Fence, || {
            format!("lease {number} follows lease {last}")
        })?;
        let answered = table.case.answers.get(&evaluation).filter(|a| {
            let bits = |theta: &[f64]| theta.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            a.variant == lease.variant && bits(&a.theta) == bits(&lease.theta)
        });
        let Some(answered) = answered else {
            let how =
                format!("lease {number} of evaluation {evaluation} of calibration {id} asks something else");
            return Err(Broken::new(Promise::Question, how));
        };
        demand(
            !ledger.quarantine().contains_key(&request.worker),
            Promise::Quarantine,
            || {
                format!(
                    "lease {number} goes to {}, which computes wrongly",
                    request.worker
                )
            },
        )?;
        let row = table.rows.get(&evaluation).map(|(_, row)| row);
        let is_open = |row: &EvaluationRow| {
            let is_open = !table.confirmed.contains_key(&evaluation) || table.disputes.contains(&evaluation);
            self.verifies && row.worker != request.worker && is_open
        };
        demand(row.is_none_or(is_open), Promise::NotAgain, || {
            format!("lease {number} is of evaluation {evaluation}, which has its row")
        })?;
        let first = self.live.get(&(id, evaluation, false));
        let is_slow = |first: &Live| first.worker != request.worker && now_ms >= first.since_ms + SLOW_MS;
        demand(first.is_none_or(is_slow), Promise::OneHolder, || {
            format!("lease {number} is of evaluation {evaluation}, which {first:?} holds")
        })?;
        let is_second = row.is_some() || first.is_some();
        let open = matches!(table.state, CalibrationState::Queued | CalibrationState::Running);
        demand(open, Promise::Open, || {
            format!(
                "lease {number} is of calibration {id}, which is {}",
                table.state.name()
            )
        })?;
        let pinned = table.model_version.as_deref().map(equations_of);
        demand(
            pinned.is_none_or(|pinned| pinned == request.model_version),
            Promise::Version,
            || {
                format!(
                    "lease {number} goes to {}, calibration {id} is pinned to {pinned:?}",
                    request.model_version
                )
            },
        )?;
        let live = Live {
            lease: number,
            worker: request.worker.clone(),
            version: request.model_version.clone(),
            since_ms: now_ms,
            until_ms: now_ms + self.lease_ms,
            started: false,
            is_suspect: lease.announce,
        };
        if let Some(other) = self.live.insert((id, evaluation, is_second), live) {
            let how = format!(
                "lease {number} is of evaluation {evaluation}, which {} holds by {}",
                other.worker, other.lease
            );
            return Err(Broken::new(Promise::OneHolder, how));
        }
        let mut other_leases = self
            .live
            .iter()
            // At the end of a calibration, a second answer that does not come is not waited for.
            .filter(|((.., is_second), live)| !is_second || now_ms < live.since_ms + self.lease_ms)
            .map(|(_, live)| live)
            .filter(|live| live.worker == request.worker && live.lease != number);
        let is_alone = other_leases.all(|live| !lease.announce && !live.is_suspect);
        demand(is_alone, Promise::Alone, || {
            format!(
                "lease {number} makes {} hold a suspect and something else",
                request.worker
            )
        })?;
        let issued = Issued {
            worker: request.worker.clone(),
            lease: lease.clone(),
            case: table.case,
            answered,
            poison: table.case.poison == Some(evaluation),
            version: request.model_version.clone(),
            history: self.history,
        };
        self.issued.insert(number, issued);
        Ok(())
    }

    /// Ends the second leases that are answered, or that failed.
    fn second_answers(&mut self, request: &ExchangeRequest, ledger: &Ledger<'a>) {
        for result in &request.results {
            let (id, evaluation) = (result.calibration, result.evaluation);
            let issued = self.lease_of(result, &request.worker);
            let is_its_own = ledger
                .table(id)
                .is_some_and(|table| issued.is_some_and(|i| i.is_of(table)));
            let second = self.live.get(&(id, evaluation, true));
            if is_its_own
                && second.is_some_and(|live| live.lease == result.lease || live.worker == request.worker)
            {
                self.live.remove(&(id, evaluation, true));
            }
        }
    }
}
