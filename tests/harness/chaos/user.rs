//! A user of the farm, who submits three jobs again and again, and compares and deletes finished studies.

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::outcome::{Trouble, get, members, outcome, succeed};
use super::tally::Tally;
use crate::http::Client;
use crate::job::Job;
use crate::service::Service;
use crate::wait::until;

/// The longest time without progress.
const PATIENCE: Duration = Duration::from_secs(300);

/// A job and its outcome without disturbance.
#[derive(Debug)]
struct Reference {
    name: &'static str,
    job: Job,
    outcome: String,
}

impl Reference {
    /// Computes the outcome of a job without disturbance.
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
            outcome(&service.client, &studies[0]).expect("the service answers")
        });
        reference
    }

    /// Submits the job; returns the number of the study.
    fn submit(&self, client: &Client) -> Result<i64, Trouble> {
        let experiment = self.job.experiment_json();
        let experiment = succeed(client, "POST", "/v1/experiments", Some(&experiment))?;
        let new = json!({"experiment": experiment["id"], "toml": self.job.job, "name": self.name});
        let created = succeed(client, "POST", "/v1/calibrations", Some(&new))?;
        Ok(created["study"].as_i64().unwrap_or_default())
    }
}

/// A user.
#[derive(Debug)]
pub(super) struct User {
    client: Client,
    /// A sampler on a fast model, a sampler with an emulator of a slow model, and a study that extends its model automatically.
    references: [Reference; 3],
    /// The numbers of the studies that must exist, with the names of their jobs.
    submitted: BTreeMap<i64, String>,
    deleted: BTreeSet<i64>,
    /// Whether the studies have been listed since a backup was restored.
    has_listed: bool,
    /// The last change of the calibrations: their states and evaluations, and the time.
    progress: (String, Instant),
}

impl User {
    pub(super) fn new(client: Client) -> User {
        User {
            client,
            references: [
                Reference::new("tmcmc", Job::small().sampler(1000, [4, 10], 3)),
                Reference::new("emulated", Job::emulated()),
                Reference::new("auto", Job::hidden_shear().sampler(50, [1, 2], 1)),
            ],
            submitted: BTreeMap::new(),
            deleted: BTreeSet::new(),
            has_listed: false,
            progress: (String::new(), Instant::now()),
        }
    }

    /// Expects the state of a restored backup, which lacks later submissions and may have studies that were deleted later.
    pub(super) fn expect_backup(&mut self) {
        self.submitted.clear();
        self.deleted.clear();
        self.has_listed = false;
    }

    /// Returns whether no study is left.
    pub(super) fn is_done(&self) -> bool {
        self.has_listed && self.submitted.is_empty()
    }

    /// Checks the studies, resumes pauses and compares finished studies; with `submits`, submits each job that has no study.
    pub(super) fn act(&mut self, tally: &mut Tally, submits: bool) -> Result<(), Trouble> {
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
            let mut calibrations = calibrations.iter();
            calibrations.any(|c| c["id"] == *id && c["state"] == "finished")
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

    /// Checks that a calibration has progressed recently, and that no two answers to one evaluation differ.
    fn check_progress(&mut self, calibrations: &[Value], tally: &mut Tally) -> Result<(), Trouble> {
        let line = |c: &Value| format!("{} {} {};", c["id"], c["state"], c["progress"]["evaluations"]);
        let now: String = calibrations.iter().map(line).collect();
        if now != self.progress.0 {
            self.progress = (now, Instant::now());
        }
        let still = self.progress.1.elapsed();
        tally.note("s without progress at most", still.as_secs_f64());
        if still > PATIENCE {
            return Err(Trouble::Broken(format!("no progress for {still:?}")));
        }
        let metrics = get(&self.client, "/metrics")?.body;
        let mut lines = metrics.lines();
        match lines.find_map(|line| line.strip_prefix("grouser_determinism_faults_total ")) {
            Some("0") => Ok(()),
            count => Err(Trouble::Broken(format!(
                "answers to one evaluation that differ: {count:?}"
            ))),
        }
    }

    /// Compares the acknowledged submissions and deletions with the lists of the service. A study whose submission was not answered, or
    /// that a backup restored, counts as submitted from now on.
    fn check_acknowledged(&mut self, studies: &[Value], calibrations: &[Value]) -> Result<(), Trouble> {
        // A study has the name of its first calibration.
        let named = studies.iter().filter_map(|study| {
            let first = calibrations
                .iter()
                .find(|c| c["id"] == study["calibrations"][0])?;
            Some((study["id"].as_i64()?, first["name"].as_str()?.to_owned()))
        });
        let listed: BTreeMap<i64, String> = named.collect();
        let mut submitted = self.submitted.iter();
        if let Some((id, name)) = submitted.find(|(id, name)| listed.get(id) != Some(name)) {
            let message = format!("study {id} ({name}) was submitted, but there are {listed:?}");
            return Err(Trouble::Broken(message));
        }
        if let Some(id) = self.deleted.iter().find(|id| listed.contains_key(id)) {
            return Err(Trouble::Broken(format!(
                "study {id} was deleted and is there again"
            )));
        }
        (self.submitted, self.has_listed) = (listed, true);
        Ok(())
    }

    /// Resumes and counts a paused calibration. Failed, cancelled and unreplayable calibrations break a promise.
    fn resume(&self, calibration: &Value, tally: &mut Tally) -> Result<(), Trouble> {
        let message = calibration["message"].as_str().unwrap_or_default();
        match calibration["state"].as_str().unwrap_or_default() {
            "paused" if !message.starts_with("cannot be resumed") => {
                *tally.pauses.entry(message.to_owned()).or_default() += 1;
                let path = format!("/v1/calibrations/{}/resume", calibration["id"]);
                succeed(&self.client, "POST", &path, Some(&json!({}))).map(drop)
            }
            "paused" | "failed" | "cancelled" => Err(Trouble::Broken(calibration.to_string())),
            _ => Ok(()),
        }
    }

    /// Compares a finished study with the undisturbed outcome of its job, then deletes the study.
    fn compare(&mut self, study: &Value, tally: &mut Tally) -> Result<(), Trouble> {
        let Some(found) = outcome(&self.client, study)? else {
            return Ok(());
        };
        let id = study["id"].as_i64().unwrap_or_default();
        let broken = |message: String| Trouble::Broken(format!("study {id}: {message}"));
        let name = self.submitted.get(&id).map(String::as_str);
        let reference = self
            .references
            .iter()
            .find(|reference| Some(reference.name) == name);
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
        // The deletion may succeed although its answer is lost.
        self.submitted.remove(&id);
        succeed(&self.client, "DELETE", &format!("/v1/studies/{id}"), None)?;
        self.deleted.insert(id);
        Ok(())
    }
}
