//! A simulated worker: it keeps to the protocol as `worker::pull` does, and breaks down in every way that a process can.

use std::collections::BTreeMap;

use shared::exchange::{ExchangeRequest, ExchangeResponse, Lease, WorkResult};
use shared::outcome::{Fault, Outcome};
use statistics::rng::Stream;

use super::issued::Issued;
use super::request::bare;
use super::weather::{Weather, chance};

/// The time that a worker waits for an answer before it sends the request again `[ms]`.
const PATIENCE_MS: u64 = 1_200;

/// The progress of a worker with a lease.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    /// The lease may be evaluated.
    Waiting,
    /// The coordinator must acknowledge its start before it begins.
    Suspect,
    /// The evaluation has begun.
    Begun,
}

/// An exchange that is not answered yet.
#[derive(Debug)]
struct PendingExchange {
    exchange: u64,
    sent_ms: u64,
    results: Vec<WorkResult>,
    announced: Vec<u64>,
}

/// The next action of a worker.
#[derive(Debug)]
pub(crate) enum Act {
    /// The worker computes or waits.
    Nothing,
    /// The worker sends a request; the number is that of the exchange.
    Send(u64, Box<ExchangeRequest>),
    /// The process ends.
    Die,
}

/// A simulated worker.
#[derive(Debug)]
pub(crate) struct Worker {
    pub(crate) name: String,
    pub(crate) version: &'static str,
    /// The number of evaluations at a time.
    threads: usize,
    /// The largest number of leases that it holds.
    want: usize,
    held: BTreeMap<u64, (Lease, Phase)>,
    outbox: Vec<WorkResult>,
    returned: Vec<u64>,
    received: u64,
    exchanges: u64,
    pending: Option<PendingExchange>,
    /// The time until which it stands still `[ms]`.
    pub(crate) stopped_until_ms: u64,
    /// An acknowledged result, which may be sent again.
    pub(crate) sent: Option<WorkResult>,
}

impl Worker {
    /// Makes the `birth`-th worker of a schedule.
    pub(crate) fn new(birth: u64, version: &'static str, stream: &mut Stream) -> Self {
        let threads = 1 + stream.below(3);
        Worker {
            name: format!("w{birth}"),
            version,
            threads,
            want: threads + stream.below(4),
            held: BTreeMap::new(),
            outbox: Vec::new(),
            returned: Vec::new(),
            received: 0,
            // The numbers of exchanges of two workers never coincide.
            exchanges: birth << 32,
            pending: None,
            stopped_until_ms: 0,
            sent: None,
        }
    }

    /// Computes, and sends an exchange when it is due.
    pub(crate) fn act(
        &mut self,
        issued: &BTreeMap<u64, Issued>,
        weather: &Weather,
        stream: &mut Stream,
        now_ms: u64,
    ) -> Act {
        if now_ms < self.stopped_until_ms {
            return Act::Nothing;
        }
        let mut ended = Vec::new();
        let begun = self
            .held
            .values()
            .filter(|(_, phase)| *phase == Phase::Begun)
            .count();
        let mut idle = self.threads.saturating_sub(begun);
        for (&number, (_, phase)) in &mut self.held {
            let Some(issued) = issued.get(&number) else {
                continue;
            };
            match phase {
                Phase::Waiting if idle > 0 => {
                    idle -= 1;
                    *phase = Phase::Begun;
                }
                Phase::Waiting => {}
                Phase::Suspect => {}
                Phase::Begun if issued.poison && chance(stream, 0.7) => return Act::Die,
                Phase::Begun if issued.poison || chance(stream, weather.fault) => {
                    let message = "simulated".to_owned();
                    let outcome = Outcome::Fault(Fault { message });
                    ended.push(WorkResult {
                        outcome,
                        ..issued.answer()
                    });
                }
                Phase::Begun if chance(stream, weather.slow) => {}
                Phase::Begun => ended.push(issued.answer()),
            }
        }
        for result in ended {
            self.held.remove(&result.lease);
            self.outbox.push(result);
        }
        if chance(stream, weather.returned)
            && let Some((&number, _)) = self.held.iter().find(|(_, (_, phase))| *phase == Phase::Waiting)
        {
            self.held.remove(&number);
            self.returned.push(number);
        }
        if self
            .pending
            .as_ref()
            .is_some_and(|pending| now_ms < pending.sent_ms + PATIENCE_MS)
        {
            return Act::Nothing;
        }
        // Without an answer, the results are sent once more.
        if let Some(pending) = self.pending.take() {
            self.outbox.splice(0..0, pending.results);
        }
        self.exchange(now_ms, chance(stream, weather.unrenewed))
    }

    fn exchange(&mut self, now_ms: u64, renews_nothing: bool) -> Act {
        let of_phase = |phase: Phase| {
            let held = self.held.iter();
            held.filter(move |(_, (_, p))| *p == phase)
                .map(|(&number, _)| number)
        };
        let announced: Vec<u64> = of_phase(Phase::Suspect).collect();
        let started = of_phase(Phase::Begun).chain(announced.iter().copied()).collect();
        let holding = if renews_nothing {
            Vec::new()
        } else {
            self.held.keys().copied().collect()
        };
        self.exchanges += 1;
        let results = std::mem::take(&mut self.outbox);
        let request = ExchangeRequest {
            results: results.clone(),
            holding,
            returned: std::mem::take(&mut self.returned),
            started,
            received: self.received,
            want: self.want.saturating_sub(self.held.len()) as u32,
            wait_ms: if self.held.is_empty() {
                PATIENCE_MS - 100
            } else {
                0
            },
            ..bare(self.name.clone(), self.version)
        };
        self.pending = Some(PendingExchange {
            exchange: self.exchanges,
            sent_ms: now_ms,
            results,
            announced,
        });
        Act::Send(self.exchanges, Box::new(request))
    }

    /// Takes an answer. An answer to an exchange that the worker has given up is ignored, as that of a closed connection.
    pub(crate) fn accept(&mut self, exchange: u64, response: ExchangeResponse) {
        let Some(pending) = self.pending.take_if(|pending| pending.exchange == exchange) else {
            return;
        };
        for number in pending.announced {
            if let Some((_, phase)) = self.held.get_mut(&number) {
                *phase = Phase::Begun;
            }
        }
        self.sent = pending.results.into_iter().next_back().or(self.sent.take());
        for lease in response.leases {
            self.received = self.received.max(lease.lease);
            let phase = if lease.announce {
                Phase::Suspect
            } else {
                Phase::Waiting
            };
            self.held.insert(lease.lease, (lease, phase));
        }
    }
}

/// Returns the same result with another value, if it has a value to change.
pub(crate) fn lie(result: &WorkResult) -> Option<WorkResult> {
    let mut lie = result.clone();
    match &mut lie.outcome {
        Outcome::Evaluated(observables) => observables
            .drawbar_pull_n
            .iter_mut()
            .for_each(|value| *value += 0.5),
        Outcome::Rejected(rejection) => rejection.message.push_str(" otherwise"),
        Outcome::Fault(_) => return None,
    }
    Some(lie)
}
