//! When there is something to do about studies: told by the store's writer, or by time where another program writes.

use std::time::Duration;

use tokio::sync::watch;

use super::handle::Service;

/// The shortest time between two looks at the studies.
const LOOK: Duration = Duration::from_millis(500);

/// The changes of studies since somebody began to listen.
#[derive(Debug)]
pub(super) struct StudyChanges {
    /// Absent where another program writes the store, which tells nobody.
    told: Option<watch::Receiver<()>>,
    has_looked: bool,
}

impl Service {
    /// Begins to listen.
    pub(super) fn study_changes(&self) -> StudyChanges {
        let told = (!self.store().is_read_only()).then(|| self.store().writer().study_changes());
        StudyChanges {
            told,
            has_looked: false,
        }
    }
}

impl StudyChanges {
    /// Ready when it is time to look at the studies: at first, and whenever one may have changed since the last look.
    pub(super) async fn next(&mut self) {
        if std::mem::replace(&mut self.has_looked, true) {
            tokio::time::sleep(LOOK).await;
            if let Some(told) = &mut self.told {
                // The other end lives as long as the service.
                let _ = told.changed().await;
            }
        }
    }

    /// Has the studies looked at again soon: there is more to do, or they could not be read.
    pub(super) fn look_again(&mut self) {
        if let Some(told) = &mut self.told {
            told.mark_changed();
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
            told: Some(writer.subscribe()),
            has_looked: false,
        };
        // What changes before the first look is read by it, or by another one; it is never missed.
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
            told: None,
            has_looked: false,
        };
        for _ in 0..3 {
            assert!(is_due(&mut changes).await);
        }
    }
}
