//! A user of the farm: submits the jobs again and again, and compares and deletes what is finished.

use std::time::Instant;

use serde_json::{Value, json};

use super::acknowledged::Acknowledged;
use super::job::Reference;
use super::outcome::{difference, outcome};
use super::tally::Tally;
use super::trouble::{Trouble, answered, get, post};
use crate::http::Client;

/// A user.
#[derive(Debug)]
pub(super) struct User {
    client: Client,
    references: [Reference; 3],
    pub(super) acknowledged: Acknowledged,
    /// The calibrations as they were when something last moved.
    seen: String,
    moved: Instant,
}

impl User {
    pub(super) fn new(client: Client, references: [Reference; 3]) -> User {
        User {
            client,
            references,
            acknowledged: Acknowledged::default(),
            seen: String::new(),
            moved: Instant::now(),
        }
    }

    /// Looks after the studies; with `submits`, jobs that are not there are submitted.
    pub(super) fn look(&mut self, tally: &mut Tally, submits: bool) -> Result<(), Trouble> {
        let list = |path| Ok::<_, Trouble>(get(&self.client, path)?.json());
        let (studies, calibrations) = (list("/v1/studies")?, list("/v1/calibrations")?);
        let [studies, calibrations] = [studies, calibrations].map(|list| match list {
            Value::Array(list) => list,
            _ => Vec::new(),
        });
        self.note_progress(&calibrations, tally);
        self.acknowledged
            .check(&studies, &calibrations)
            .map_err(Trouble::Broken)?;
        for calibration in &calibrations {
            self.resume(calibration, tally)?;
        }
        let is_finished = |id: &Value| {
            let calibration = calibrations.iter().find(|c| c["id"] == *id);
            calibration.is_some_and(|c| c["state"] == "finished")
        };
        for study in &studies {
            let mut members = study["calibrations"].as_array().into_iter().flatten();
            if members.all(is_finished) {
                self.compare(study, tally)?;
            }
        }
        for Reference { job, .. } in self.references.iter().filter(|_| submits) {
            if !self.acknowledged.has(job.name) {
                self.acknowledged.submitted(job.submit(&self.client)?, job.name);
            }
        }
        Ok(())
    }

    fn note_progress(&mut self, calibrations: &[Value], tally: &mut Tally) {
        let line = |c: &Value| format!("{} {} {};", c["id"], c["state"], c["progress"]["evaluations"]);
        let now: String = calibrations.iter().map(line).collect();
        if now != self.seen {
            self.seen = now;
            self.moved = Instant::now();
        }
        tally.longest_still = tally.longest_still.max(self.moved.elapsed());
    }

    /// Resumes a calibration that has paused, and counts it; none fails, is cancelled, or cannot be replayed.
    fn resume(&self, calibration: &Value, tally: &mut Tally) -> Result<(), Trouble> {
        let id = &calibration["id"];
        let message = calibration["message"].as_str().unwrap_or_default();
        match calibration["state"].as_str().unwrap_or_default() {
            "paused" if !message.starts_with("cannot be resumed") => {
                *tally.pauses.entry(message.to_owned()).or_default() += 1;
                post(&self.client, &format!("/v1/calibrations/{id}/resume"), &json!({}))?;
                Ok(())
            }
            "paused" | "failed" | "cancelled" => Err(Trouble::Broken(calibration.to_string())),
            _ => Ok(()),
        }
    }

    /// Compares a study that is finished with what its job gives undisturbed, then deletes it.
    fn compare(&mut self, study: &Value, tally: &mut Tally) -> Result<(), Trouble> {
        let Some(found) = outcome(&self.client, study)? else {
            return Ok(());
        };
        let id = study["id"].as_i64().unwrap_or_default();
        let broken = |words: String| Trouble::Broken(format!("study {id}: {words}"));
        let name = self.acknowledged.name(id);
        let mut references = self.references.iter();
        let reference = references.find(|reference| Some(reference.job.name) == name);
        let reference = reference.ok_or_else(|| broken(format!("nobody submitted {name:?}")))?;
        if let Some(difference) = difference(&found, &reference.outcome) {
            return Err(broken(format!("{}, {difference}", reference.job.name)));
        }
        *tally.compared.entry(reference.job.name).or_default() += 1;
        self.acknowledged.release(id);
        let path = format!("/v1/studies/{id}");
        let answer = answered(&path, self.client.send("DELETE", &path, None)?)?;
        if answer.status != 200 {
            return Err(broken(format!("not deleted: {}", answer.body)));
        }
        self.acknowledged.deleted(id);
        Ok(())
    }
}
