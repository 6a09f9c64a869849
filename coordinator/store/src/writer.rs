//! The task that writes to the store. It commits all waiting writes as one group.
//!
//! Facts are numbered in the order of their arrival. An answer that depends on a fact is held back until the fact is committed, so that
//! acknowledged results are durable.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use shared::file::FileSet;
use tokio::sync::{Notify, broadcast, mpsc, oneshot, watch};

use super::change::{Listeners, StateChange};
use super::effects::{AddedEffect, NewEffect, insert_effect};
use super::error::{StoreError, is_locked};
use super::expired_values::ExpiredValues;
use super::health::StoreHealth;
use super::insert::{
    NewCalibrationRow, NewStudy, StudyIds, insert_calibration, insert_evaluations, insert_experiment,
    insert_study,
};
use super::library::LibraryChange;
use super::results::StudyResults;
use super::server;
use super::sql::{Connection, query};
use record::StudyDetails;
use record::fact::{EvaluationRow, Fact};

/// The largest number of facts in one commit.
const GROUP: usize = 4096;
/// The time for which evaluations are collected before a commit if no answer depends on them, because a commit writes whole pages.
const LINGER: Duration = Duration::from_millis(250);
/// The number of changes of state that are kept for slow listeners; older ones are dropped.
const STATES: usize = 1024;

enum Write {
    Fact(Fact),
    Experiment {
        files: FileSet,
        now_ms: i64,
        reply: oneshot::Sender<i64>,
    },
    Study {
        new: NewStudy,
        reply: oneshot::Sender<StudyIds>,
    },
    Member {
        study: i64,
        experiment: i64,
        row: NewCalibrationRow,
        now_ms: i64,
        reply: oneshot::Sender<i64>,
    },
    Effect {
        new: NewEffect,
        reply: oneshot::Sender<AddedEffect>,
    },
    Library {
        change: LibraryChange,
        reply: oneshot::Sender<()>,
    },
    Results {
        results: StudyResults,
        reply: oneshot::Sender<()>,
    },
    Archive {
        study: i64,
        at_ms: Option<i64>,
        reply: oneshot::Sender<()>,
    },
    Details {
        study: i64,
        details: StudyDetails,
        reply: oneshot::Sender<()>,
    },
    Withdraw {
        calibrations: Vec<i64>,
        at_ms: Option<i64>,
        reply: oneshot::Sender<()>,
    },
    Delete {
        study: i64,
        now_ms: i64,
        reply: oneshot::Sender<bool>,
    },
    Close,
}

/// A handle of the writer; clones are cheap.
#[derive(Debug, Clone)]
pub struct Writer {
    sender: mpsc::UnboundedSender<Write>,
    committed: watch::Receiver<u64>,
    listeners: Listeners,
    health: Arc<StoreHealth>,
    waiting: Arc<Waiting>,
}

/// The number of tasks that wait for a commit.
#[derive(Debug, Default)]
struct Waiting {
    count: AtomicU64,
    arrived: Notify,
}

impl Waiting {
    /// Waits until some task waits for a commit, but no longer than [`LINGER`].
    async fn linger(&self) {
        if self.count.load(Ordering::Acquire) == 0 {
            let _ = tokio::time::timeout(LINGER, self.arrived.notified()).await;
        }
    }

    /// Awaits a future that only a commit completes, and makes the writer commit at once.
    async fn while_urgent<T>(&self, wait: impl Future<Output = T>) -> T {
        self.count.fetch_add(1, Ordering::AcqRel);
        self.arrived.notify_one();
        let _leave = Leave(self);
        wait.await
    }
}

/// A guard that decreases the number of waiting tasks, also when its future is dropped.
struct Leave<'a>(&'a Waiting);

impl Drop for Leave<'_> {
    fn drop(&mut self) {
        self.0.count.fetch_sub(1, Ordering::AcqRel);
    }
}

impl Writer {
    /// Starts the task, which holds `lock` until it ends.
    pub(super) fn start(connection: Connection, lock: Option<std::fs::File>) -> Writer {
        let (sender, receiver) = mpsc::unbounded_channel();
        let (committed_sender, committed) = watch::channel(0);
        let listeners = Listeners::new(STATES);
        let notified = listeners.clone();
        let health = Arc::new(StoreHealth::default());
        let waiting = Arc::new(Waiting::default());
        let (shared, waited_for) = (health.clone(), waiting.clone());
        tokio::spawn(async move {
            let _lock = lock;
            if let Err(error) = run(
                connection,
                receiver,
                &committed_sender,
                &notified,
                &shared,
                &waited_for,
            )
            .await
            {
                tracing::error!(%error, "the store cannot be written");
            }
            // Dropping `committed_sender` notifies every task that waits for a commit.
        });
        Writer {
            sender,
            committed,
            listeners,
            health,
            waiting,
        }
    }

    /// Makes the handle of a store without a writer, which refuses every write.
    pub(super) fn none() -> Writer {
        let (sender, _) = mpsc::unbounded_channel();
        let (_, committed) = watch::channel(0);
        Writer {
            sender,
            committed,
            listeners: Listeners::new(1),
            health: Arc::default(),
            waiting: Arc::default(),
        }
    }

    /// Returns the function by which the farm sends facts in order.
    ///
    /// It returns the number of the last fact, or `None` after the writer has ended. Only one such function may exist for a store, because
    /// it numbers the facts.
    pub fn sink(&self) -> impl FnMut(Vec<Fact>) -> Option<u64> + Send + 'static {
        let (sender, health, waiting) = (self.sender.clone(), self.health.clone(), self.waiting.clone());
        let mut sent = 0;
        move |facts| {
            let is_urgent = facts.iter().any(|fact| !matches!(fact, Fact::Evaluated { .. }));
            for fact in facts {
                sender.send(Write::Fact(fact)).ok()?;
                sent += 1;
            }
            health.sent.store(sent, Ordering::Relaxed);
            if is_urgent {
                waiting.arrived.notify_one();
            }
            Some(sent)
        }
    }

    /// Waits until a fact is durable.
    ///
    /// # Errors
    /// [`StoreError::Stopped`] when the writer has ended before.
    pub async fn durable(&self, fact: u64) -> Result<(), StoreError> {
        let mut committed = self.committed.clone();
        let durable = committed.wait_for(|&c| c >= fact);
        self.waiting
            .while_urgent(durable)
            .await
            .map(|_| ())
            .map_err(|_| StoreError::Stopped)
    }

    /// Waits until the writer has ended. Only a failing store ends it while there are handles.
    pub async fn stopped(&self) {
        let mut committed = self.committed.clone();
        while committed.changed().await.is_ok() {}
    }

    /// Stores all facts that were sent before, then ends the task. If another program holds a lock on the store, waiting facts are dropped;
    /// none of them has been acknowledged.
    pub async fn close(&self) {
        if self.sender.send(Write::Close).is_err() {
            return;
        }
        let locked = async {
            while !self.health.is_locked.load(Ordering::Relaxed) {
                tokio::time::sleep(LINGER).await;
            }
        };
        tokio::select! {
            () = self.waiting.while_urgent(self.stopped()) => {}
            () = locked => {
                let facts = self.backlog();
                tracing::error!(facts, "another program holds a lock on the store: what it has not taken is given up");
            }
        }
    }

    /// Returns the number of facts that wait to be stored.
    pub fn backlog(&self) -> u64 {
        self.health
            .sent
            .load(Ordering::Relaxed)
            .saturating_sub(*self.committed.borrow())
    }

    /// Returns a receiver of later changes of state, each sent after it is stored.
    pub fn state_changes(&self) -> broadcast::Receiver<StateChange> {
        self.listeners.states()
    }

    /// Returns a receiver that is notified after a later change of studies, their members, the states of these, or the doubts about workers
    /// is stored. Several changes may cause one notification.
    pub fn study_changes(&self) -> watch::Receiver<()> {
        self.listeners.studies()
    }

    /// Returns whether the writer has ended, or never existed.
    pub fn has_ended(&self) -> bool {
        self.committed.has_changed().is_err()
    }

    /// Returns the counters of the writer.
    pub fn health(&self) -> &StoreHealth {
        &self.health
    }

    /// Stores an experiment. Returns its id.
    pub async fn add_experiment(&self, files: FileSet, now_ms: i64) -> Result<i64, StoreError> {
        let write = |reply| Write::Experiment { files, now_ms, reply };
        self.committed(write).await
    }

    /// Stores a study with its first calibrations. Returns their ids.
    pub async fn add_study(&self, new: NewStudy) -> Result<StudyIds, StoreError> {
        self.committed(|reply| Write::Study { new, reply }).await
    }

    /// Stores a further calibration of a study, on its experiment or on another one. Returns its id.
    pub async fn add_member(
        &self,
        study: i64,
        experiment: i64,
        row: NewCalibrationRow,
        now_ms: i64,
    ) -> Result<i64, StoreError> {
        let write = |reply| Write::Member {
            study,
            experiment,
            row,
            now_ms,
            reply,
        };
        self.committed(write).await
    }

    /// Stores a version of an effect, unless a version with the same text exists.
    pub async fn add_effect(&self, new: NewEffect) -> Result<AddedEffect, StoreError> {
        self.committed(|reply| Write::Effect { new, reply }).await
    }

    /// Changes the library.
    pub async fn change_library(&self, change: LibraryChange) -> Result<(), StoreError> {
        self.committed(|reply| Write::Library { change, reply }).await
    }

    /// Stores the files of a study and deletes those under other stamps, unless the study has changed since the files were computed.
    pub async fn keep_results(&self, results: StudyResults) -> Result<(), StoreError> {
        self.committed(|reply| Write::Results { results, reply }).await
    }

    /// Archives a study at a time; without a time, restores it.
    pub async fn archive_study(&self, study: i64, at_ms: Option<i64>) -> Result<(), StoreError> {
        self.committed(|reply| Write::Archive { study, at_ms, reply })
            .await
    }

    /// Keeps what people say of a study.
    pub async fn describe_study(&self, study: i64, details: StudyDetails) -> Result<(), StoreError> {
        let write = |reply| Write::Details {
            study,
            details,
            reply,
        };
        self.committed(write).await
    }

    /// Takes calibrations out of their study at a time; without a time, takes them in again.
    pub async fn withdraw(&self, calibrations: Vec<i64>, at_ms: Option<i64>) -> Result<(), StoreError> {
        let write = |reply| Write::Withdraw {
            calibrations,
            at_ms,
            reply,
        };
        self.committed(write).await
    }

    /// Deletes a study with all rows that belong to it alone. It is deleted in parts, so that facts of other studies are stored between
    /// them.
    pub async fn delete_study(&self, study: i64, now_ms: i64) -> Result<(), StoreError> {
        let delete = |reply| Write::Delete { study, now_ms, reply };
        while !self.committed(delete).await? {}
        Ok(())
    }

    /// Sends a write and waits for its reply, which comes after the commit.
    async fn committed<T>(&self, write: impl FnOnce(oneshot::Sender<T>) -> Write) -> Result<T, StoreError> {
        let (reply, answer) = oneshot::channel();
        self.sender.send(write(reply)).map_err(|_| StoreError::Stopped)?;
        let answer = self.waiting.while_urgent(answer).await;
        answer.map_err(|_| StoreError::Stopped)
    }
}

async fn run(
    mut connection: Connection,
    mut receiver: mpsc::UnboundedReceiver<Write>,
    committed: &watch::Sender<u64>,
    listeners: &Listeners,
    health: &StoreHealth,
    waiting: &Waiting,
) -> Result<(), sqlx::Error> {
    let mut group = Vec::with_capacity(GROUP);
    let mut number = 0;
    let mut closing = false;
    let mut expired: VecDeque<ExpiredValues> = VecDeque::new();
    loop {
        match expired.front_mut() {
            Some(values) => {
                if values.drop_part(&mut connection).await? {
                    expired.pop_front();
                }
            }
            None => {
                if closing || next_writes(&mut connection, &mut receiver, &mut group).await? == 0 {
                    break;
                }
                waiting.linger().await;
            }
        }
        while group.len() < GROUP
            && let Ok(write) = receiver.try_recv()
        {
            group.push(write);
        }
        closing |= group.iter().any(|w| matches!(w, Write::Close));
        if group.is_empty() {
            continue;
        }
        let began = std::time::Instant::now();
        let mut replies = Replies::default();
        let is_file = matches!(connection, Connection::Sqlite(_));
        let stored = store_group(&mut connection, group.drain(..), &mut replies, health);
        let facts = if is_file {
            stored.await?
        } else {
            server::in_time(server::GROUP_TIME, stored).await?
        };
        number += facts;
        expired.extend(replies.expired.drain(..));
        replies.send(listeners);
        health.commits.fetch_add(1, Ordering::Relaxed);
        health.facts.fetch_add(facts, Ordering::Relaxed);
        health.busy_us.fetch_add(
            u64::try_from(began.elapsed().as_micros()).unwrap_or(0),
            Ordering::Relaxed,
        );
        committed.send_replace(number);
    }
    connection.close().await
}

/// Waits for writes. Returns their number, which is zero once all handles are dropped. Meanwhile it checks whether a server still holds the
/// connection and its lock: an idle coordinator, too, must end when another one may have taken over.
async fn next_writes(
    connection: &mut Connection,
    receiver: &mut mpsc::UnboundedReceiver<Write>,
    group: &mut Vec<Write>,
) -> Result<usize, sqlx::Error> {
    loop {
        let received = receiver.recv_many(group, GROUP);
        match connection {
            Connection::Sqlite(_) => return Ok(received.await),
            Connection::Postgres(_) => match tokio::time::timeout(server::PROBE, received).await {
                Ok(count) => return Ok(count),
                Err(_) => {
                    server::in_time(server::ANSWER_TIME, query("SELECT 1").execute(&mut *connection)).await?
                }
            },
        };
    }
}

/// Stores writes in one transaction. Returns how many of them are facts.
async fn store_group(
    connection: &mut Connection,
    group: impl Iterator<Item = Write>,
    replies: &mut Replies,
    health: &StoreHealth,
) -> Result<u64, sqlx::Error> {
    let began = std::time::Instant::now();
    loop {
        match connection.begin().await {
            Ok(()) => break,
            Err(error) if is_locked(&error) => health.wait_for_lock(began.elapsed()),
            Err(error) => return Err(error),
        }
    }
    health.is_locked.store(false, Ordering::Relaxed);
    let facts = write_group(connection, group, replies, health).await?;
    connection.commit().await?;
    Ok(facts)
}

/// What follows from a commit: replies, and values that may be dropped.
#[derive(Default)]
struct Replies {
    ids: Vec<(oneshot::Sender<i64>, i64)>,
    studies: Vec<(oneshot::Sender<StudyIds>, StudyIds)>,
    effects: Vec<(oneshot::Sender<AddedEffect>, AddedEffect)>,
    done: Vec<oneshot::Sender<()>>,
    deleted: Vec<(oneshot::Sender<bool>, bool)>,
    expired: Vec<ExpiredValues>,
    states: Vec<StateChange>,
    /// Whether studies, their members or the doubts about workers have changed.
    have_studies_changed: bool,
}

impl Replies {
    fn send(self, listeners: &Listeners) {
        listeners.tell(self.states, self.have_studies_changed);
        // If the receiver of a reply is gone, the row is stored nevertheless.
        for (reply, id) in self.ids {
            let _ = reply.send(id);
        }
        for (reply, ids) in self.studies {
            let _ = reply.send(ids);
        }
        for (reply, effect) in self.effects {
            let _ = reply.send(effect);
        }
        for reply in self.done {
            let _ = reply.send(());
        }
        for (reply, is_gone) in self.deleted {
            let _ = reply.send(is_gone);
        }
    }
}

async fn write_group(
    connection: &mut Connection,
    group: impl Iterator<Item = Write>,
    replies: &mut Replies,
    health: &StoreHealth,
) -> Result<u64, sqlx::Error> {
    let mut facts = 0;
    let mut rows: Vec<(i64, EvaluationRow)> = Vec::new();
    for write in group {
        replies.have_studies_changed |= changes_studies(&write);
        match write {
            Write::Fact(fact) => {
                facts += 1;
                match fact {
                    Fact::Evaluated { calibration, row } => rows.push((calibration, row)),
                    other => {
                        insert_evaluations(connection, &mut rows).await?;
                        replies.states.extend(StateChange::from_fact(&other));
                        replies.expired.extend(ExpiredValues::from_fact(&other));
                        replies.have_studies_changed |=
                            super::facts::write(connection, other, health).await?;
                    }
                }
            }
            Write::Close => {}
            Write::Effect { new, reply } => replies
                .effects
                .push((reply, insert_effect(connection, new).await?)),
            Write::Library { change, reply } => {
                super::library::write(connection, change).await?;
                replies.done.push(reply);
            }
            Write::Results { results, reply } => {
                super::results::write(connection, results).await?;
                replies.done.push(reply);
            }
            Write::Archive { study, at_ms, reply } => {
                super::removal::archive(connection, study, at_ms).await?;
                replies.done.push(reply);
            }
            Write::Details {
                study,
                details,
                reply,
            } => {
                super::details::write_details(connection, study, &details).await?;
                replies.done.push(reply);
            }
            Write::Withdraw {
                calibrations,
                at_ms,
                reply,
            } => {
                super::details::withdraw(connection, &calibrations, at_ms).await?;
                replies.done.push(reply);
            }
            Write::Delete { study, now_ms, reply } => {
                // Facts about its calibrations that arrived before are written first, so that they are deleted too.
                insert_evaluations(connection, &mut rows).await?;
                let is_gone = super::removal::delete_part(connection, study, now_ms).await?;
                replies.deleted.push((reply, is_gone));
            }
            Write::Experiment { files, now_ms, reply } => {
                let id = insert_experiment(connection, files, now_ms).await?;
                replies.ids.push((reply, id));
            }
            Write::Study { new, reply } => replies
                .studies
                .push((reply, insert_study(connection, new).await?)),
            Write::Member {
                study,
                experiment,
                row,
                now_ms,
                reply,
            } => {
                let id = insert_calibration(connection, study, Some(experiment), row, now_ms).await?;
                replies.ids.push((reply, id));
            }
        }
    }
    insert_evaluations(connection, &mut rows).await?;
    Ok(facts)
}

/// Returns whether a write changes which studies there are, or which members they have.
fn changes_studies(write: &Write) -> bool {
    use Write::{Archive, Delete, Member, Study, Withdraw};
    matches!(
        write,
        Study { .. } | Member { .. } | Archive { .. } | Withdraw { .. } | Delete { .. }
    )
}
