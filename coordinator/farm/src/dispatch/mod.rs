//! The thread of the farm. It receives messages one by one, and sends answers and facts.
//!
//! The thread owns all state, so there is no lock. It never computes: the steps of engines are taken by the compute threads, which tell it
//! what they have computed by messages like all others. Requests that wait for work are parked here and served in the order of their
//! arrival.

use std::collections::{BTreeMap, VecDeque};
use std::ops::RangeInclusive;
use std::sync::{Arc, Weak, mpsc};
use std::time::{Duration, Instant};

use shared::api::{CalibrationState, CalibrationStatus, WorkDemand};
use shared::exchange::{ExchangeRequest, ExchangeResponse};
use shared::model::ModelVariant;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::sync::oneshot;

use super::compute::{Compute, Computed, TakeStep, Tell};
use super::control::{Control, ControlError};
use super::farm::Farm;
use super::metrics::FarmMetrics;
use super::pulse::{Heart, Pulse};
use super::worker_record::WorkerRecord;
use crate::calibration::{Calibration, Step};
use record::SealKey;
use record::fact::Fact;

/// Stores facts in order; returns the number of the last fact so far, or `None` after the store has failed.
type FactSink = Box<dyn FnMut(Vec<Fact>) -> Option<u64> + Send>;

/// The interval at which the farm's clock advances.
const TICK: Duration = Duration::from_millis(250);

/// An answer together with the number of the fact that must be stored before it may be given.
pub type Durable<T> = (T, u64);

/// Calibrations to replay from the store, once their facts are stored, because some of their results were dropped.
pub type Rewinds = UnboundedReceiver<Durable<i64>>;
/// The reply channel of a worker's request.
type ExchangeReply = oneshot::Sender<Durable<ExchangeResponse>>;
/// A query of the farm at a time `[ms]`.
type Look = Box<dyn FnOnce(&Farm, u64) + Send>;
/// The result of a user's command.
pub type Controlled = Result<Durable<CalibrationState>, ControlError>;

enum Message {
    Exchange {
        request: ExchangeRequest,
        reply: ExchangeReply,
    },
    Add {
        calibration: Box<Calibration>,
        key: SealKey,
        facts: Vec<Fact>,
        reply: oneshot::Sender<()>,
    },
    Control {
        id: i64,
        control: Control,
        reply: oneshot::Sender<Controlled>,
    },
    RewindFailed {
        id: i64,
        reason: String,
    },
    Computed(Computed),
    Look {
        look: Look,
    },
    Stop,
}

/// A handle on the farm's thread; clones are cheap.
#[derive(Debug, Clone)]
pub struct Dispatcher {
    sender: Arc<mpsc::Sender<Message>>,
    pulse: Pulse,
}

/// The farm's thread has ended: the coordinator is going down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the coordinator is shutting down")]
pub struct Stopped;

impl Dispatcher {
    /// Starts the farm's thread and the compute threads.
    ///
    /// Facts go to `sink`; when the store fails, the thread ends. The owner of the store receives the calibrations to replay from the
    /// returned channel, and returns each by [`Dispatcher::add`].
    ///
    /// # Errors
    /// The operating system refuses a thread.
    pub fn start(
        farm: Farm,
        sink: impl FnMut(Vec<Fact>) -> Option<u64> + Send + 'static,
    ) -> std::io::Result<(Dispatcher, Rewinds)> {
        Self::start_with(farm, Box::new(sink), &(Arc::new(Step::run) as TakeStep))
    }

    /// Starts the threads with a function that takes steps.
    fn start_with(farm: Farm, sink: FactSink, take: &TakeStep) -> std::io::Result<(Dispatcher, Rewinds)> {
        let compute = Compute::start(take)?;
        let (sender, receiver) = mpsc::channel();
        let sender = Arc::new(sender);
        let own = Arc::downgrade(&sender);
        let (rewinds, asked) = unbounded_channel();
        let heart = Heart::begin();
        let pulse = heart.pulse();
        std::thread::Builder::new().name("farm".into()).spawn(move || {
            Thread {
                farm,
                sink,
                compute,
                own,
                rewinds,
                parked: VecDeque::new(),
                parked_until_ms: u64::MAX,
                began: Instant::now(),
            }
            .run(&receiver, &heart);
        })?;
        Ok((Dispatcher { sender, pulse }, asked))
    }

    /// Returns the pulse of the thread.
    pub fn pulse(&self) -> &Pulse {
        &self.pulse
    }

    fn send(&self, message: Message) -> Result<(), Stopped> {
        self.sender.send(message).map_err(|_| Stopped)
    }

    /// Sends a message and waits for its reply.
    async fn reply<T>(&self, message: impl FnOnce(oneshot::Sender<T>) -> Message) -> Result<T, Stopped> {
        let (reply, answer) = oneshot::channel();
        self.send(message(reply))?;
        answer.await.map_err(|_| Stopped)
    }

    /// Sends a worker's exchange, which is parked until there is work or its waiting time is over.
    pub async fn exchange(&self, request: ExchangeRequest) -> Result<Durable<ExchangeResponse>, Stopped> {
        self.reply(|reply| Message::Exchange { request, reply }).await
    }

    /// Adds a calibration, with facts of its replay that may have been lost.
    pub async fn add(&self, calibration: Calibration, key: SealKey, facts: Vec<Fact>) -> Result<(), Stopped> {
        let calibration = Box::new(calibration);
        let add = |reply| Message::Add {
            calibration,
            key,
            facts,
            reply,
        };
        self.reply(add).await
    }

    /// Reports that a requested replay failed.
    pub fn rewind_failed(&self, id: i64, reason: String) -> Result<(), Stopped> {
        self.send(Message::RewindFailed { id, reason })
    }

    /// Sends a user's command on a calibration.
    ///
    /// # Errors
    /// [`Stopped`]; inside, [`ControlError`].
    pub async fn control(&self, id: i64, control: Control) -> Result<Controlled, Stopped> {
        self.reply(|reply| Message::Control { id, control, reply }).await
    }

    /// Returns the status of a calibration in progress; `None` if it is over or does not exist.
    pub async fn status(&self, id: i64) -> Result<Option<CalibrationStatus>, Stopped> {
        self.look(move |farm, now| farm.status(id, now)).await
    }

    /// Returns the status of every calibration in progress with an id in a range, by id.
    pub async fn statuses(
        &self,
        ids: RangeInclusive<i64>,
    ) -> Result<BTreeMap<i64, CalibrationStatus>, Stopped> {
        self.look(move |farm, now| {
            farm.ids()
                .into_iter()
                .filter(|id| ids.contains(id))
                .filter_map(|id| Some((id, farm.status(id, now)?)))
                .collect()
        })
        .await
    }

    /// Returns the known workers.
    pub async fn workers(&self) -> Result<BTreeMap<String, WorkerRecord>, Stopped> {
        self.look(|farm, now| farm.workers(now)).await
    }

    /// Returns the variant of a hash.
    pub async fn variant(&self, hash: String) -> Result<Option<ModelVariant>, Stopped> {
        self.look(move |farm, _| farm.variant(&hash)).await
    }

    /// Returns the amount of work.
    pub async fn demand(&self) -> Result<WorkDemand, Stopped> {
        self.look(|farm, _| farm.demand()).await
    }

    /// Returns numbers for the metrics page.
    pub async fn metrics(&self) -> Result<FarmMetrics, Stopped> {
        self.look(|farm, _| farm.metrics()).await
    }

    async fn look<T: Send + 'static>(
        &self,
        look: impl FnOnce(&Farm, u64) -> T + Send + 'static,
    ) -> Result<T, Stopped> {
        let message = |reply: oneshot::Sender<T>| {
            let look = move |farm: &Farm, now| {
                // If the receiver is gone, nobody needs the answer.
                let _ = reply.send(look(farm, now));
            };
            Message::Look { look: Box::new(look) }
        };
        self.reply(message).await
    }

    /// Ends the farm's thread. Parked workers get no answer and send their requests again.
    pub fn stop(&self) {
        let _ = self.sender.send(Message::Stop);
    }
}

struct Parked {
    /// The worker's request, without the parts that the farm has taken.
    request: ExchangeRequest,
    until_ms: u64,
    reply: ExchangeReply,
}

struct Thread {
    farm: Farm,
    sink: FactSink,
    compute: Compute,
    /// The thread's own address, for the compute threads.
    own: Weak<mpsc::Sender<Message>>,
    rewinds: UnboundedSender<Durable<i64>>,
    parked: VecDeque<Parked>,
    /// The earliest `until_ms` of the parked exchanges `[ms]`.
    parked_until_ms: u64,
    began: Instant,
}

impl Thread {
    fn run(mut self, receiver: &mpsc::Receiver<Message>, heart: &Heart) {
        let mut next_tick = self.began + TICK;
        loop {
            let message = match receiver.recv_timeout(next_tick.saturating_duration_since(Instant::now())) {
                Ok(Message::Stop) | Err(mpsc::RecvTimeoutError::Disconnected) => return,
                Ok(message) => Some(message),
                Err(mpsc::RecvTimeoutError::Timeout) => None,
            };
            heart.step_begins();
            let mut now_ms = self.now_ms();
            if let Some(message) = message {
                self.handle(message, now_ms);
            }
            if Instant::now() >= next_tick {
                // Renewals may have arrived while the machine was busy with others. They count before leases expire.
                while let Ok(message) = receiver.try_recv() {
                    if matches!(message, Message::Stop) {
                        return;
                    }
                    now_ms = self.now_ms();
                    self.handle(message, now_ms);
                }
                next_tick = Instant::now() + TICK;
                self.farm.tick(now_ms);
            }
            if self.flush().is_none() {
                tracing::error!("the store no longer accepts facts; the coordinator stops");
                return;
            }
            self.hand_out_steps();
            self.serve_parked(now_ms);
            heart.rests();
        }
    }

    fn now_ms(&self) -> u64 {
        u64::try_from(self.began.elapsed().as_millis()).unwrap_or(u64::MAX)
    }

    /// Sends the new facts to the store. Returns the number of the last fact.
    fn flush(&mut self) -> Option<u64> {
        let fact = (self.sink)(self.farm.take_facts())?;
        for id in self.farm.take_rewinds() {
            // Without a receiver the coordinator is ending. The next start replays the calibration.
            let _ = self.rewinds.send((id, fact));
        }
        Some(fact)
    }

    /// Gives the compute threads the steps that have become due.
    fn hand_out_steps(&mut self) {
        self.compute.add(self.farm.take_steps());
        let farm = &self.farm;
        self.compute
            .drop_needless(|calibration, number| farm.awaits_step(calibration, number));
        self.compute.hand_out(|| {
            // Without a handle on this thread, it ends.
            let own = self.own.upgrade()?;
            let tell: Tell = Box::new(move |computed| {
                // If the thread has ended, nobody needs the step.
                let _ = own.send(Message::Computed(computed));
            });
            Some(tell)
        });
    }

    fn handle(&mut self, message: Message, now_ms: u64) {
        match message {
            Message::Exchange { request, reply } => self.exchange(request, reply, now_ms),
            Message::Add {
                calibration,
                key,
                facts,
                reply,
            } => {
                self.farm.add(*calibration, key, facts, now_ms);
                let _ = reply.send(());
            }
            Message::Control { id, control, reply } => {
                let result = self.farm.control(id, control, now_ms);
                let Some(fact) = self.flush() else { return };
                let _ = reply.send(result.map(|state| (state, fact)));
            }
            Message::RewindFailed { id, reason } => self.farm.rewind_failed(id, &reason),
            Message::Computed(Computed { thread, result }) => {
                self.compute.rests(thread);
                match result {
                    Ok(stepped) => self.farm.stepped(stepped, now_ms),
                    Err(failed) => self
                        .farm
                        .step_failed(failed.calibration, failed.number, &failed.reason),
                }
            }
            Message::Look { look } => look(&self.farm, now_ms),
            Message::Stop => {}
        }
    }

    fn exchange(&mut self, request: ExchangeRequest, reply: ExchangeReply, now_ms: u64) {
        let question = ExchangeRequest {
            worker: request.worker.clone(),
            model_version: request.model_version.clone(),
            models: request.models.clone(),
            queue_job: request.queue_job.clone(),
            threads: request.threads,
            evaluation_s: request.evaluation_s,
            results: Vec::new(),
            holding: Vec::new(),
            returned: Vec::new(),
            started: Vec::new(),
            ..request
        };
        let until_ms = now_ms + request.wait_ms;
        let response = self.farm.exchange(request, now_ms);
        let Some(fact) = self.flush() else { return };
        let may_wait = question.want > 0 && until_ms > now_ms;
        if response.leases.is_empty() && may_wait && response.refused.is_none() {
            self.parked_until_ms = self.parked_until_ms.min(until_ms);
            self.parked.push_back(Parked {
                request: question,
                until_ms,
                reply,
            });
        } else {
            self.answer(&question.worker, reply, (response, fact), now_ms);
        }
    }

    /// Answers parked requests for which there is work, or whose waiting time is over. There may be thousands: without work, none is
    /// examined before the first has waited long enough.
    fn serve_parked(&mut self, now_ms: u64) {
        if !self.farm.has_work() && now_ms < self.parked_until_ms {
            return;
        }
        self.serve_each(now_ms);
        let until_ms = self.parked.iter().map(|parked| parked.until_ms);
        self.parked_until_ms = until_ms.min().unwrap_or(u64::MAX);
    }

    fn serve_each(&mut self, now_ms: u64) {
        for _ in 0..self.parked.len() {
            let Some(parked) = self.parked.pop_front() else {
                return;
            };
            if parked.reply.is_closed() {
                continue;
            }
            if !self.farm.has_work() && parked.until_ms > now_ms {
                self.parked.push_back(parked);
                continue;
            }
            let response = self.farm.exchange(parked.request.clone(), now_ms);
            if response.leases.is_empty() && parked.until_ms > now_ms && response.refused.is_none() {
                self.parked.push_back(parked);
                continue;
            }
            let Some(fact) = self.flush() else { return };
            self.answer(&parked.request.worker, parked.reply, (response, fact), now_ms);
        }
    }

    /// Sends an answer. If the worker is gone meanwhile, its leases are taken back at once.
    fn answer(&mut self, worker: &str, reply: ExchangeReply, answer: Durable<ExchangeResponse>, now_ms: u64) {
        if let Err((response, _)) = reply.send(answer) {
            for lease in response.leases {
                self.farm.give_back(lease.lease, worker);
            }
            self.farm.tick(now_ms);
        }
    }
}

#[cfg(test)]
mod tests;
