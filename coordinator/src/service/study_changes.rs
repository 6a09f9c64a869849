//! Notifications of changes of studies: from the store's writer, or every half second if another program writes the store.

use std::time::Duration;

use tokio::sync::watch;

use super::handle::Service;

/// The shortest time between two notifications.
const LOOK: Duration = Duration::from_millis(500);

/// A receiver of notifications of changes of studies.
#[derive(Debug)]
pub(super) struct StudyChanges {
    /// The notifications of the writer; `None` if another program writes the store, because SQLite and PostgreSQL notify a reader of no
    /// commit.
    notices: Option<watch::Receiver<()>>,
    has_looked: bool,
}

impl Service {
    /// Subscribes to the changes of studies.
    pub(super) fn study_changes(&self) -> StudyChanges {
        let notices = (!self.store().is_read_only()).then(|| self.store().writer().study_changes());
        StudyChanges {
            notices,
            has_looked: false,
        }
    }
}

impl StudyChanges {
    /// Waits until a study may have changed since the last call. The first call returns at once.
    pub(super) async fn next(&mut self) {
        if std::mem::replace(&mut self.has_looked, true) {
            tokio::time::sleep(LOOK).await;
            if let Some(notices) = &mut self.notices {
                // The sender exists as long as the service.
                let _ = notices.changed().await;
            }
        }
    }

    /// Makes the next call return soon, because there is more to do, or the studies could not be read.
    pub(super) fn look_again(&mut self) {
        if let Some(notices) = &mut self.notices {
            notices.mark_changed();
        }
    }
}

#[cfg(test)]
mod tests {
    use futures::FutureExt;

    use super::*;

    /// Returns whether a notification arrives once the shortest time between two has passed.
    async fn is_due(changes: &mut StudyChanges) -> bool {
        tokio::time::timeout(3 * LOOK, changes.next()).await.is_ok()
    }

    #[tokio::test]
    async fn studies_are_looked_at_first_after_each_change_and_else_not() {
        let writer = watch::Sender::new(());
        let mut changes = StudyChanges {
            notices: Some(writer.subscribe()),
            has_looked: false,
        };
        // A change before the first call may be seen by the first or the second one.
        writer.send_replace(());
        assert!(changes.next().now_or_never().is_some());
        assert!(is_due(&mut changes).await);
        assert!(!is_due(&mut changes).await, "nothing has changed");
        writer.send_replace(());
        writer.send_replace(());
        assert!(is_due(&mut changes).await);
        assert!(!is_due(&mut changes).await, "both changes were seen by one look");
        changes.look_again();
        assert!(is_due(&mut changes).await);
    }

    #[tokio::test]
    async fn a_store_that_another_program_writes_is_looked_at_again_and_again() {
        let mut changes = StudyChanges {
            notices: None,
            has_looked: false,
        };
        for _ in 0..3 {
            assert!(is_due(&mut changes).await);
        }
    }
}
