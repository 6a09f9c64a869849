//! Changes of state, which are told once they are stored.

use record::fact::Fact;
use shared::api::CalibrationState;
use tokio::sync::{broadcast, watch};

/// A change of state that is stored.
#[derive(Debug, Clone)]
pub struct StateChange {
    /// The calibration.
    pub calibration: i64,
    /// Its new state.
    pub state: CalibrationState,
    /// Why paused or failed.
    pub message: Option<String>,
}

impl StateChange {
    /// The change of state that a fact is.
    pub(super) fn of(fact: &Fact) -> Option<StateChange> {
        let Fact::State {
            calibration,
            state,
            message,
            ..
        } = fact
        else {
            return None;
        };
        Some(StateChange {
            calibration: *calibration,
            state: *state,
            message: message.clone(),
        })
    }
}

/// The listeners, which want to know what has been stored.
#[derive(Debug, Clone)]
pub(super) struct Listeners {
    states: broadcast::Sender<StateChange>,
    studies: watch::Sender<()>,
}

impl Listeners {
    /// The number of changes of state that are kept for a slow listener.
    pub(super) fn new(count: usize) -> Self {
        Listeners {
            states: broadcast::Sender::new(count),
            studies: watch::Sender::new(()),
        }
    }

    pub(super) fn states(&self) -> broadcast::Receiver<StateChange> {
        self.states.subscribe()
    }

    pub(super) fn studies(&self) -> watch::Receiver<()> {
        self.studies.subscribe()
    }

    /// Tells the changes of a commit; whether there are other studies or members than before.
    pub(super) fn tell(&self, states: Vec<StateChange>, have_studies_changed: bool) {
        if have_studies_changed || !states.is_empty() {
            self.studies.send_replace(());
        }
        for change in states {
            // Nobody may want to know.
            let _ = self.states.send(change);
        }
    }
}
