//! What a service has acknowledged to its user, and must still hold.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value;

/// Studies that were submitted and deleted.
#[derive(Debug, Default)]
pub(super) struct Acknowledged {
    /// Numbers of the studies that must be there, with the names of their jobs.
    submitted: BTreeMap<i64, String>,
    deleted: BTreeSet<i64>,
    /// Whether a list has been seen since a backup was put back.
    has_seen: bool,
}

impl Acknowledged {
    /// A backup has been put back: what was acknowledged since is gone, and what was deleted may be there again.
    pub(super) fn expect_a_backup(&mut self) {
        *self = Acknowledged::default();
    }

    /// Whether there is no study any more.
    pub(super) fn is_empty(&self) -> bool {
        self.has_seen && self.submitted.is_empty()
    }

    /// The name of the job of a study.
    pub(super) fn name(&self, study: i64) -> Option<&str> {
        self.submitted.get(&study).map(String::as_str)
    }

    /// Whether there is a study of a job.
    pub(super) fn has(&self, name: &str) -> bool {
        self.submitted.values().any(|known| known == name)
    }

    /// The submission of a study is acknowledged.
    pub(super) fn submitted(&mut self, study: i64, name: &str) {
        self.submitted.insert(study, name.to_owned());
    }

    /// A deletion has been sent: without an answer the study may be gone.
    pub(super) fn release(&mut self, study: i64) {
        self.submitted.remove(&study);
    }

    /// The deletion of a study is acknowledged.
    pub(super) fn deleted(&mut self, study: i64) {
        self.deleted.insert(study);
    }

    /// Compares with the lists of the service. What was submitted without an answer, or came back with a backup, counts from now on.
    ///
    /// # Errors
    /// What is missing, or there again.
    pub(super) fn check(&mut self, studies: &[Value], calibrations: &[Value]) -> Result<(), String> {
        // A study has the name of its first calibration.
        let name = |study: &Value| {
            let first = &study["calibrations"][0];
            let calibration = calibrations.iter().find(|c| c["id"] == *first)?;
            calibration["name"].as_str().map(str::to_owned)
        };
        let there: BTreeMap<i64, String> = studies
            .iter()
            .filter_map(|study| Some((study["id"].as_i64()?, name(study)?)))
            .collect();
        for (id, name) in &self.submitted {
            if there.get(id) != Some(name) {
                return Err(format!(
                    "study {id} ({name}) was submitted, but there are {there:?}"
                ));
            }
        }
        if let Some(id) = self.deleted.iter().find(|id| there.contains_key(id)) {
            return Err(format!("study {id} was deleted and is there again"));
        }
        self.submitted = there;
        self.has_seen = true;
        Ok(())
    }
}
