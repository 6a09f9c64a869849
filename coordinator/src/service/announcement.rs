//! Posts the pauses and ends of calibrations to web hooks.

use shared::api::CalibrationState;
use tokio::sync::broadcast::error::RecvError;

use super::handle::Service;
use crate::webhook::Announcement;
use store::{StateChange, StoreError};

impl Service {
    /// Posts each pause and end of a calibration to the web hook of its study, until the service ends. The farm does not wait for it.
    pub async fn announce(&self) {
        let mut changes = self.store().writer().state_changes();
        loop {
            match changes.recv().await {
                Ok(change) if change.state == CalibrationState::Paused || change.state.is_final() => {
                    let service = self.clone();
                    tokio::spawn(async move { service.announce_change(change).await });
                }
                Ok(_) => {}
                Err(RecvError::Lagged(changes)) => {
                    tracing::warn!(
                        changes,
                        "changes of state too many at once to be told to web hooks"
                    );
                }
                Err(RecvError::Closed) => return,
            }
        }
    }

    async fn announce_change(&self, change: StateChange) {
        let calibration = change.calibration;
        let hook: Result<_, StoreError> = self.store().reader().webhook(calibration).await;
        let hook = match hook {
            Ok(Some(hook)) => hook,
            Ok(None) => return,
            Err(error) => {
                tracing::error!(calibration, %error, "failed to read the web hook");
                return;
            }
        };
        let announcement = Announcement {
            study: hook.study,
            calibration,
            name: hook.name,
            state: change.state,
            message: change.message,
        };
        match self.webhook_hosts.post(&hook.url, &announcement).await {
            Ok(()) => tracing::info!(calibration, state = change.state.name(), "told its web hook"),
            Err(error) => tracing::warn!(calibration, %error, "its web hook could not be told"),
        }
    }
}
