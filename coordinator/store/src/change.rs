//! Changes of state, and the listeners that are notified of them once they are stored.

use record::fact::Fact;
use shared::api::CalibrationState;
use tokio::sync::{broadcast, watch};

/// A stored change of state.
#[derive(Debug, Clone)]
pub struct StateChange {
    /// Id of the calibration.
    pub calibration: i64,
    /// New state of the calibration.
    pub state: CalibrationState,
    /// The reason of a pause or a failure.
    pub message: Option<String>,
}

impl StateChange {
    /// Returns the change of state that a fact describes; `None` for other facts.
    pub(super) fn from_fact(fact: &Fact) -> Option<StateChange> {
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

/// The listeners that are notified of commits.
#[derive(Debug, Clone)]
pub(super) struct Listeners {
    states: broadcast::Sender<StateChange>,
    studies: watch::Sender<()>,
}

impl Listeners {
    /// Makes listeners. `count` is the number of changes of state that are kept for a slow listener.
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

    /// Notifies the listeners of the changes of a commit. `have_studies_changed` states whether studies, members or results changed.
    pub(super) fn tell(&self, states: Vec<StateChange>, have_studies_changed: bool) {
        if have_studies_changed || !states.is_empty() {
            self.studies.send_replace(());
        }
        for change in states {
            // There may be no listener.
            let _ = self.states.send(change);
        }
    }
}
