//! A user of the farm: submits three jobs again and again, and compares and deletes finished studies.

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::outcome::{Trouble, done, get, members, outcome};
use super::tally::Tally;
use crate::http::Client;
use crate::job::Job;
use crate::service::Service;
use crate::wait::until;

/// The longest time without progress.
const PATIENCE: Duration = Duration::from_secs(300);

/// A job and what it gives undisturbed.
#[derive(Debug)]
struct Reference {
    name: &'static str,
    job: Job,
    outcome: String,
}

impl Reference {
    /// Computes the outcome of a job that nothing disturbs.
    fn new(name: &'static str, job: Job) -> Reference {
        let service = Service::start(&["--local-workers", "2"]);
        let mut reference = Reference {
            name,
            job,
            outcome: String::new(),
        };
        reference.submit(&service.client).expect("the job is accepted");
        reference.outcome = until("the outcome of an undisturbed job", || {
            let studies = service.client.json("/v1/studies");
            outcome(&service.client, &studies[0]).expect("nothing is in the way")
        });
        reference
    }

    /// Submits the job; the number of the study.
    fn submit(&self, client: &Client) -> Result<i64, Trouble> {
        let experiment = done(
            client,
            "POST",
            "/v1/experiments",
            Some(&self.job.experiment_json()),
        )?;
        let new = json!({"experiment": experiment["id"], "toml": self.job.job, "name": self.name});
        let created = done(client, "POST", "/v1/calibrations", Some(&new))?;
        Ok(created["study"].as_i64().unwrap_or_default())
    }
}

/// A user.
#[derive(Debug)]
pub(super) struct User {
    client: Client,
    /// A sampler on a fast model, one with a metamodel on a slow model, and a study that grows by itself.
    references: [Reference; 3],
    /// The numbers of the studies that must be there, with the names of their jobs.
    submitted: BTreeMap<i64, String>,
    deleted: BTreeSet<i64>,
    /// Whether a list has been seen since a backup was put back.
    has_seen: bool,
    /// The calibrations as they were when something last moved.
    seen: String,
    moved: Instant,
}

impl User {
    pub(super) fn new(client: Client) -> User {
        let metamodel = Job::rolling()
            .sampler(40, [2, 4], 5)
            .in_job("moves = [2, 4]", "moves = [2, 4]\nmetamodel_moves = 8");
        User {
            client,
            references: [
                Reference::new("tmcmc", Job::small().sampler(1000, [4, 10], 3)),
                Reference::new("metamodel", metamodel),
                Reference::new("auto", Job::hidden_shear().sampler(50, [1, 2], 1)),
            ],
            submitted: BTreeMap::new(),
            deleted: BTreeSet::new(),
            has_seen: false,
            seen: String::new(),
            moved: Instant::now(),
        }
    }

    /// A backup was put back: what was acknowledged since is gone, and what was deleted may be there again.
    pub(super) fn expect_a_backup(&mut self) {
        self.submitted.clear();
        self.deleted.clear();
        self.has_seen = false;
    }

    /// Whether there is no study any more.
    pub(super) fn is_done(&self) -> bool {
        self.has_seen && self.submitted.is_empty()
    }

    /// Looks after the studies; with `submits`, jobs that are not there are submitted.
    pub(super) fn look(&mut self, tally: &mut Tally, submits: bool) -> Result<(), Trouble> {
        let list = |path| match get(&self.client, path)?.json() {
            Value::Array(list) => Ok(list),
            other => Err(Trouble::Broken(format!("{path}: {other}"))),
        };
        let (studies, calibrations) = (list("/v1/studies")?, list("/v1/calibrations")?);
        self.check_progress(&calibrations, tally)?;
        self.check_acknowledged(&studies, &calibrations)?;
        for calibration in &calibrations {
            self.resume(calibration, tally)?;
        }
        let is_finished = |id: &i64| {
            calibrations
                .iter()
                .any(|c| c["id"] == *id && c["state"] == "finished")
        };
        for study in &studies {
            if members(study).iter().all(is_finished) {
                self.compare(study, tally)?;
            }
        }
        for reference in self.references.iter().filter(|_| submits) {
            if !self.submitted.values().any(|name| name == reference.name) {
                let study = reference.submit(&self.client)?;
                self.submitted.insert(study, reference.name.to_owned());
            }
        }
        Ok(())
    }

    /// Something moves, and no two answers to one evaluation differ.
    fn check_progress(&mut self, calibrations: &[Value], tally: &mut Tally) -> Result<(), Trouble> {
        let line = |c: &Value| format!("{} {} {};", c["id"], c["state"], c["progress"]["evaluations"]);
        let now: String = calibrations.iter().map(line).collect();
        if now != self.seen {
            (self.seen, self.moved) = (now, Instant::now());
        }
        let still = self.moved.elapsed();
        tally.note("s without progress at most", still.as_secs_f64());
        if still > PATIENCE {
            return Err(Trouble::Broken(format!("no progress for {still:?}")));
        }
        let metrics = get(&self.client, "/metrics")?.body;
        let mut lines = metrics.lines();
        let disputes = lines.find_map(|line| line.strip_prefix("grouser_determinism_faults_total "));
        match disputes {
            Some("0") => Ok(()),
            other => Err(Trouble::Broken(format!(
                "answers to one evaluation that differ: {other:?}"
            ))),
        }
    }

    /// Compares what was acknowledged with the lists of the service. A study that was submitted without an answer, or came back with a
    /// backup, counts from now on.
    fn check_acknowledged(&mut self, studies: &[Value], calibrations: &[Value]) -> Result<(), Trouble> {
        // A study has the name of its first calibration.
        let named = studies.iter().filter_map(|study| {
            let first = calibrations
                .iter()
                .find(|c| c["id"] == study["calibrations"][0])?;
            Some((study["id"].as_i64()?, first["name"].as_str()?.to_owned()))
        });
        let there: BTreeMap<i64, String> = named.collect();
        let mut missing = self
            .submitted
            .iter()
            .filter(|(id, name)| there.get(id) != Some(name));
        if let Some((id, name)) = missing.next() {
            let words = format!("study {id} ({name}) was submitted, but there are {there:?}");
            return Err(Trouble::Broken(words));
        }
        if let Some(id) = self.deleted.iter().find(|id| there.contains_key(id)) {
            return Err(Trouble::Broken(format!(
                "study {id} was deleted and is there again"
            )));
        }
        (self.submitted, self.has_seen) = (there, true);
        Ok(())
    }

    /// Resumes a paused calibration, and counts it; none fails, is cancelled, or cannot be replayed.
    fn resume(&self, calibration: &Value, tally: &mut Tally) -> Result<(), Trouble> {
        let message = calibration["message"].as_str().unwrap_or_default();
        match calibration["state"].as_str().unwrap_or_default() {
            "paused" if !message.starts_with("cannot be resumed") => {
                *tally.pauses.entry(message.to_owned()).or_default() += 1;
                let path = format!("/v1/calibrations/{}/resume", calibration["id"]);
                done(&self.client, "POST", &path, Some(&json!({}))).map(drop)
            }
            "paused" | "failed" | "cancelled" => Err(Trouble::Broken(calibration.to_string())),
            _ => Ok(()),
        }
    }

    /// Compares a finished study with what its job gives undisturbed, then deletes it.
    fn compare(&mut self, study: &Value, tally: &mut Tally) -> Result<(), Trouble> {
        let Some(found) = outcome(&self.client, study)? else {
            return Ok(());
        };
        let id = study["id"].as_i64().unwrap_or_default();
        let broken = |words: String| Trouble::Broken(format!("study {id}: {words}"));
        let name = self.submitted.get(&id);
        let reference = self
            .references
            .iter()
            .find(|reference| Some(reference.name) == name.map(String::as_str));
        let reference = reference.ok_or_else(|| broken(format!("nobody submitted {name:?}")))?;
        if found != reference.outcome {
            let mut lines = found.lines().zip(reference.outcome.lines());
            let line = lines.find(|(found, expected)| found != expected);
            return Err(broken(format!(
                "{}, found and expected: {line:?}",
                reference.name
            )));
        }
        *tally.compared.entry(reference.name).or_default() += 1;
        // Without an answer to the deletion the study may be gone.
        self.submitted.remove(&id);
        done(&self.client, "DELETE", &format!("/v1/studies/{id}"), None)?;
        self.deleted.insert(id);
        Ok(())
    }
}
