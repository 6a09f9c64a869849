//! Tells when there is something to do about studies: when the store's writer says so, or every half second where another program writes.

use std::time::Duration;

use tokio::sync::watch;

use super::handle::Service;

/// The shortest time between two looks at the studies.
const LOOK: Duration = Duration::from_millis(500);

/// The changes of studies since the first call.
#[derive(Debug)]
pub(super) struct StudyChanges {
    /// Absent where another program writes the store: SQLite and PostgreSQL tell a reader of no commit.
    notices: Option<watch::Receiver<()>>,
    has_looked: bool,
}

impl Service {
    /// Begins to listen.
    pub(super) fn study_changes(&self) -> StudyChanges {
        let notices = (!self.store().is_read_only()).then(|| self.store().writer().study_changes());
        StudyChanges {
            notices,
            has_looked: false,
        }
    }
}

impl StudyChanges {
    /// Ready when it is time to look at the studies: at first, and whenever one may have changed since the last look.
    pub(super) async fn next(&mut self) {
        if std::mem::replace(&mut self.has_looked, true) {
            tokio::time::sleep(LOOK).await;
            if let Some(notices) = &mut self.notices {
                // The other end lives as long as the service.
                let _ = notices.changed().await;
            }
        }
    }

    /// Makes the next look due soon: there is more to do, or the studies could not be read.
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

    /// Whether a look is due, once the shortest time between two has passed.
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
        // A change before the first look is seen by this look or by the next one.
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
