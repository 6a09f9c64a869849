//! The loop of a worker: exchange, evaluate, resend, renew, give back.
//!
//! New leases are requested while the last ones are still being evaluated, so threads wait only when the sampler does: at
//! the end of a step.

use std::collections::{BTreeMap, BTreeSet};
use std::future::Future;
use std::sync::Arc;
use std::time::{Duration, Instant};

use shared::exchange::{ExchangeRequest, ExchangeResponse, Lease, PROTOCOL_VERSION, WorkResult};
use shared::outcome::{Fault, Outcome};

use super::exchange::{Coordinator, ExchangeError};
use super::limits::Ended;
use super::settings::PullSettings;
use crate::evaluator::{Evaluator, SimulationClock};
use crate::model::{CompiledVariant, VariantCache};

/// The amount of work that a worker holds `[s]`.
const WORK_S: f64 = 1.5;
/// The minimum work for an exchange `[s]`: about the time of an exchange with results on disk.
const MIN_WORK_S: f64 = 5e-3;
/// The longest wait of a long poll `[ms]`.
const WAIT_MS: u64 = 20_000;
/// The longest wait of a long poll with `--once` `[ms]`.
const ONCE_WAIT_MS: u64 = 500;
/// The longest pause without work between two calibrations of a study.
const LULL: Duration = Duration::from_secs(5);
/// The maximum number of runs that a worker holds over all leases, so that their results fit into one message.
const MAX_RUNS: usize = 100_000;
/// The maximum time between two messages with results, even while there is work left.
const FLUSH: Duration = Duration::from_secs(1);
/// The time that a stopping worker waits for running evaluations; those that take longer are returned unfinished.
const GRACE: Duration = Duration::from_secs(3);
/// The maximum time of the last message of a stopping worker.
const FAREWELL: Duration = Duration::from_millis(1500);
/// The time that a stopping worker waits for an answer that may be under way.
const PARTING: Duration = Duration::from_millis(300);
/// Pauses between attempts to reach a coordinator that is away: doubled from the first to the last value.
const BACK_OFF: [Duration; 2] = [Duration::from_millis(100), Duration::from_secs(5)];

/// The interval between two requests for the identity of external models.
const ASK: Duration = Duration::from_secs(5);

/// The state of the farm by the coordinator's last answer.
#[derive(Debug)]
struct LastAnswer {
    remaining: u64,
    /// Calibrations that want workers; `None` before the first answer.
    in_hand: Option<u64>,
    workers: u32,
    lease_ms: u64,
    /// Number of leases that the last successful request brought.
    batch: usize,
    /// The maximum number of runs per evaluation in the last batch.
    runs: usize,
}

/// Why the variant of a hash is missing.
enum Missing {
    /// The variant cannot be fetched now.
    Away,
    /// This worker cannot compute the variant.
    Unusable(String),
}

pub(super) struct Worker<C> {
    coordinator: Arc<C>,
    evaluator: Evaluator,
    clock: Arc<SimulationClock>,
    settings: PullSettings,
    variants: VariantCache,
    /// The time at which external models were last asked for their identity.
    models_asked: Option<Instant>,
    /// Leases without a result so far.
    held: BTreeSet<u64>,
    /// Results that the coordinator has not acknowledged.
    outbox: Vec<WorkResult>,
    /// Leases that this worker cannot serve at present, to be given back.
    returned: Vec<u64>,
    /// Leases that the coordinator must acknowledge as started before they are evaluated.
    announced: Vec<(Lease, Arc<CompiledVariant>)>,
    /// The highest lease number received.
    received: u64,
    last_answer: LastAnswer,
    flushed: Instant,
    renewed: Instant,
    /// The last time it held a lease, or started.
    busy: Instant,
    /// True if the coordinator does not answer.
    away: bool,
}

impl<C: Coordinator> Worker<C> {
    /// Creates a worker without leases.
    pub(super) fn new(
        coordinator: Arc<C>,
        settings: PullSettings,
        evaluator: Evaluator,
        clock: Arc<SimulationClock>,
    ) -> Self {
        Worker {
            coordinator,
            evaluator,
            clock,
            variants: VariantCache::new(settings.models.clone()),
            models_asked: None,
            settings,
            held: BTreeSet::new(),
            outbox: Vec::new(),
            returned: Vec::new(),
            announced: Vec::new(),
            received: 0,
            last_answer: LastAnswer {
                remaining: 0,
                in_hand: None,
                workers: 1,
                lease_ms: WAIT_MS,
                batch: 0,
                runs: 1,
            },
            flushed: Instant::now(),
            renewed: Instant::now(),
            busy: Instant::now(),
            away: false,
        }
    }

    /// Serves until `shutdown` is ready or a limit is reached; [`ExchangeError::Refused`] if the coordinator refuses the worker.
    pub(super) async fn run(mut self, shutdown: impl Future<Output = ()>) -> Result<Ended, ExchangeError> {
        tokio::pin!(shutdown);
        let mut back_off = BACK_OFF[0];
        loop {
            self.collect();
            if let Some(ended) = self.has_ended() {
                return self.stop(ended).await;
            }
            // This future is created in every round, because it depends on the held leases.
            let reached = self.settings.limits.reached(self.idle_since());
            tokio::pin!(reached);
            if !self.is_time_to_exchange() {
                tokio::select! {
                    () = &mut shutdown => return self.stop(Ended::Asked).await,
                    ended = &mut reached => return self.stop(ended).await,
                    () = self.evaluator.woken() => {}
                    // A short lease must be renewed before the flush is due.
                    () = tokio::time::sleep(FLUSH.min(self.renewal_period())) => {}
                }
                continue;
            }
            tokio::select! {
                () = &mut shutdown => return self.stop(Ended::Asked).await,
                ended = &mut reached => return self.stop(ended).await,
                () = self.ask_models() => {}
            }
            let request = self.request();
            let coordinator = self.coordinator.clone();
            let exchange = coordinator.exchange(request);
            tokio::pin!(exchange);
            let answer = loop {
                tokio::select! {
                    () = &mut shutdown => {
                        self.part(exchange).await;
                        return self.stop(Ended::Asked).await;
                    }
                    ended = &mut reached => {
                        self.part(exchange).await;
                        return self.stop(ended).await;
                    }
                    answer = &mut exchange => break answer,
                    // Running evaluations must not be lost because an answer hangs.
                    () = tokio::time::sleep(self.renewal_period()), if !self.held.is_empty() => {
                        self.renew_beside();
                    }
                }
            };
            match answer {
                Ok(response) => {
                    if std::mem::take(&mut self.away) {
                        tracing::info!(worker = self.settings.name, "the coordinator is back");
                    }
                    back_off = BACK_OFF[0];
                    tokio::select! {
                        // The answer has been accepted by now: its leases are held, and `stop` gives them back.
                        () = &mut shutdown => return self.stop(Ended::Asked).await,
                        ended = &mut reached => return self.stop(ended).await,
                        () = self.accept(response) => {}
                    }
                }
                Err((ExchangeError::Away(reason), results)) => {
                    if !std::mem::replace(&mut self.away, true) {
                        tracing::warn!(
                            worker = self.settings.name,
                            reason,
                            "the coordinator is away; trying again"
                        );
                    }
                    self.outbox.splice(0..0, results);
                    tokio::select! {
                        () = &mut shutdown => return self.stop(Ended::Asked).await,
                        ended = &mut reached => return self.stop(ended).await,
                        () = tokio::time::sleep(back_off) => {}
                    }
                    back_off = (back_off * 2).min(BACK_OFF[1]);
                }
                Err((refused, _)) => return Err(refused),
            }
        }
    }

    /// Waits briefly for an answer that is under way when the worker stops, to give its leases back too.
    async fn part(
        &mut self,
        exchange: impl Future<Output = Result<ExchangeResponse, (ExchangeError, Vec<WorkResult>)>>,
    ) {
        match tokio::time::timeout(PARTING, exchange).await {
            Ok(Ok(response)) => {
                self.held.extend(response.leases.iter().map(|l| l.lease));
                self.note_received(&response);
            }
            Ok(Err((_, results))) => self.outbox.extend(results),
            Err(_) => {}
        }
    }

    /// Returns since when the worker has had nothing to do; `None` while it has work. Results that nobody takes do not count
    /// as work: they are computed again elsewhere.
    fn idle_since(&self) -> Option<Instant> {
        (self.held.is_empty() && (self.outbox.is_empty() || self.away)).then_some(self.busy)
    }

    /// Returns why the worker must end now, for the limits other than time.
    fn has_ended(&mut self) -> Option<Ended> {
        if !self.held.is_empty() {
            self.busy = Instant::now();
        }
        let limits = &self.settings.limits;
        let is_idle =
            self.outbox.is_empty() && self.idle_since().is_some_and(|since| since.elapsed() >= LULL);
        if limits.once && is_idle && self.last_answer.in_hand == Some(0) {
            return Some(Ended::NothingLeft);
        }
        limits.is_over_memory().then_some(Ended::Memory)
    }

    /// Asks the external models for their identity from time to time, because one may have been started or replaced.
    async fn ask_models(&mut self) {
        let is_due = self.models_asked.is_none_or(|time| time.elapsed() >= ASK);
        if self.settings.models.is_empty() || !is_due {
            return;
        }
        self.settings.models.refresh().await;
        self.models_asked = Some(Instant::now());
    }

    /// Collects the results of the threads.
    fn collect(&mut self) {
        for result in self.evaluator.take() {
            self.take(result);
        }
    }

    fn take(&mut self, result: WorkResult) {
        self.held.remove(&result.lease);
        self.outbox.push(result);
    }

    /// Returns whether an exchange is due: when half of the last batch is done and there is more to get or enough to send, when
    /// no lease is held, or when results or renewals have waited long enough.
    fn is_time_to_exchange(&self) -> bool {
        let half_done = self.held.len() * 2 <= self.last_answer.batch;
        let much_done = self.outbox.len() as f64 >= self.evaluations_in(MIN_WORK_S);
        self.held.is_empty()
            || (half_done && (self.last_answer.remaining > 0 || much_done))
            || (!self.outbox.is_empty() && self.flushed.elapsed() >= FLUSH)
            || !self.announced.is_empty()
            || self.renewal_due()
    }

    fn renewal_period(&self) -> Duration {
        Duration::from_millis(self.last_answer.lease_ms / 3)
    }

    fn renewal_due(&self) -> bool {
        !self.held.is_empty() && self.renewed.elapsed() >= self.renewal_period()
    }

    /// Returns the number of evaluations that all threads complete in a time `[s]`, as far as known; at least one each.
    fn evaluations_in(&self, seconds: f64) -> f64 {
        let threads = self.settings.threads as f64;
        let mean = self.clock.mean_s();
        mean.map_or(threads, |mean| (seconds * threads / mean.max(1e-9)).max(threads))
    }

    /// Returns the number of evaluations to request: at most 1.5 s of work.
    ///
    /// A single worker takes all that remains; otherwise a worker takes half of its share, so that a slower worker leaves
    /// work to a faster one, but never splits below the amount that is worth an exchange. The same amount is requested from
    /// a round of unknown size.
    fn want(&self) -> u32 {
        let min_count = self.evaluations_in(MIN_WORK_S);
        let share = self.last_answer.remaining as f64 / f64::from(self.last_answer.workers.max(1));
        let share = match (self.last_answer.remaining, self.last_answer.workers) {
            (0, _) => min_count,
            (_, 0 | 1) => share,
            _ => (0.5 * share)
                .max(min_count.min(share))
                .max(self.settings.threads as f64),
        };
        let want = self.evaluations_in(WORK_S).min(share) - self.held.len() as f64;
        let max = (MAX_RUNS / self.last_answer.runs).max(self.settings.threads);
        want.clamp(0.0, max.saturating_sub(self.held.len()) as f64) as u32
    }

    fn request(&mut self) -> ExchangeRequest {
        let renew = self.renewal_due();
        self.flushed = Instant::now();
        if renew {
            self.renewed = Instant::now();
        }
        let idle = self.held.is_empty();
        ExchangeRequest {
            worker: self.settings.name.clone(),
            protocol: PROTOCOL_VERSION,
            model_version: crate::model_version().to_owned(),
            models: self.settings.models.announced(),
            queue_job: self.settings.queue_job.clone(),
            threads: self.settings.threads as u32,
            evaluation_s: self.clock.mean_s(),
            results: std::mem::take(&mut self.outbox),
            holding: if renew {
                self.held.iter().copied().collect()
            } else {
                Vec::new()
            },
            returned: std::mem::take(&mut self.returned),
            started: self.started(),
            received: self.received,
            want: self.want().max(u32::from(idle)),
            // a worker that still holds work asks again by itself
            wait_ms: if idle { self.patience_ms() } else { 0 },
        }
    }

    /// Returns the time that the coordinator may wait for work before it answers an idle worker `[ms]`.
    fn patience_ms(&self) -> u64 {
        match self.settings.limits.once {
            // With `--once` the worker must learn soon that nothing is left.
            true => ONCE_WAIT_MS,
            false => WAIT_MS,
        }
    }

    /// Renews all leases while another exchange waits for its answer. Nothing depends on the answer, so nobody waits for it.
    fn renew_beside(&mut self) {
        let renewal = ExchangeRequest {
            worker: self.settings.name.clone(),
            protocol: PROTOCOL_VERSION,
            model_version: crate::model_version().to_owned(),
            models: self.settings.models.announced(),
            queue_job: self.settings.queue_job.clone(),
            threads: self.settings.threads as u32,
            evaluation_s: self.clock.mean_s(),
            results: Vec::new(),
            holding: self.held.iter().copied().collect(),
            returned: Vec::new(),
            started: self.evaluator.started(),
            // The leases of the answer under way must not count as lost.
            received: u64::MAX,
            want: 0,
            wait_ms: 0,
        };
        self.renewed = Instant::now();
        let (coordinator, period) = (self.coordinator.clone(), self.renewal_period());
        tokio::spawn(async move {
            let _ = tokio::time::timeout(period, coordinator.exchange(renewal)).await;
        });
    }

    /// Returns the leases whose evaluation has begun, or begins after the coordinator's answer.
    fn started(&self) -> Vec<u64> {
        let announced = self.announced.iter().map(|(lease, _)| lease.lease);
        self.evaluator.started().into_iter().chain(announced).collect()
    }

    fn note_received(&mut self, response: &ExchangeResponse) {
        let leases = response.leases.iter().map(|lease| lease.lease);
        self.received = leases.fold(self.received, u64::max);
    }

    /// Processes an answer. It may be dropped at any wait: every lease is then held or returned.
    async fn accept(&mut self, response: ExchangeResponse) {
        self.note_received(&response);
        // The coordinator knows of their start now.
        self.evaluator.start(std::mem::take(&mut self.announced));
        self.last_answer = LastAnswer {
            remaining: response.remaining,
            in_hand: Some(response.in_hand),
            workers: response.workers,
            lease_ms: response.lease_ms,
            batch: response.leases.len() + self.held.len(),
            runs: self.last_answer.runs,
        };
        self.held.extend(response.leases.iter().map(|l| l.lease));
        if let Some(reason) = response.refused.filter(|_| response.leases.is_empty()) {
            tracing::error!(
                worker = self.settings.name,
                reason,
                "no lease of a waiting calibration"
            );
            tokio::time::sleep(BACK_OFF[1]).await;
        }
        let hashes: BTreeSet<String> = response.leases.iter().map(|l| l.variant.clone()).collect();
        // The variants are kept here, because a batch may have more variants than the cache.
        let mut variants = BTreeMap::new();
        for hash in hashes {
            let variant = self.fetch(&hash).await;
            variants.insert(hash, variant);
        }
        self.last_answer.runs = 1;
        let mut batch = Vec::with_capacity(response.leases.len());
        for lease in response.leases {
            match variants.get(&lease.variant) {
                Some(Ok(variant)) => {
                    self.last_answer.runs = self.last_answer.runs.max(variant.runs());
                    if lease.announce {
                        self.announced.push((lease, variant.clone()));
                    } else {
                        batch.push((lease, variant.clone()));
                    }
                }
                Some(Err(Missing::Unusable(reason))) => self.refuse(lease, reason.clone()),
                Some(Err(Missing::Away)) | None => {
                    self.held.remove(&lease.lease);
                    self.returned.push(lease.lease);
                }
            }
        }
        self.evaluator.start(batch);
        if !self.returned.is_empty() {
            tokio::time::sleep(BACK_OFF[0]).await;
        }
    }

    /// Reports a lease whose variant cannot be computed here as a fault of this machine.
    fn refuse(&mut self, lease: Lease, message: String) {
        let Lease {
            lease,
            calibration,
            evaluation,
            seal,
            ..
        } = lease;
        let outcome = Outcome::Fault(Fault { message });
        self.take(WorkResult {
            lease,
            calibration,
            evaluation,
            seal,
            outcome,
            repeated: None,
        });
    }

    /// Gets the compiled variant of a hash, from the cache or the coordinator.
    async fn fetch(&mut self, hash: &str) -> Result<Arc<CompiledVariant>, Missing> {
        if let Some(variant) = self.variants.get(hash) {
            return Ok(variant);
        }
        match self.coordinator.variant(hash).await {
            Ok(Some(variant)) => self
                .variants
                .add(hash, &variant)
                .map_err(|e| Missing::Unusable(e.to_string())),
            Err(ExchangeError::Refused(reason)) => Err(Missing::Unusable(reason)),
            // It is no error if the calibration has ended meanwhile, or if the coordinator is away.
            Ok(None) | Err(ExchangeError::Away(_)) => Err(Missing::Away),
        }
    }

    /// Sends the finished results and gives back all other leases: those that have not begun, and those that take too long.
    async fn stop(mut self, ended: Ended) -> Result<Ended, ExchangeError> {
        if tokio::time::timeout(GRACE, self.evaluator.cancel())
            .await
            .is_err()
        {
            let unfinished = self.evaluator.started().len();
            tracing::info!(
                worker = self.settings.name,
                unfinished,
                "gives back what it has begun"
            );
        }
        self.collect();
        let request = ExchangeRequest {
            returned: self.held.iter().chain(&self.returned).copied().collect(),
            want: 0,
            wait_ms: 0,
            holding: Vec::new(),
            started: Vec::new(),
            ..self.request()
        };
        let (sent, returned) = (request.results.len(), request.returned.len());
        self.settings.models.stop();
        let farewell = tokio::time::timeout(FAREWELL, self.coordinator.exchange(request)).await;
        match farewell {
            Ok(Ok(_)) => tracing::info!(
                worker = self.settings.name,
                why = ended.words(),
                sent,
                returned,
                "stopped"
            ),
            _ => tracing::warn!(
                worker = self.settings.name,
                why = ended.words(),
                "stopped; the coordinator could not be notified"
            ),
        }
        Ok(ended)
    }
}
