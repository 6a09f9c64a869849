//! The jobs that the farm works on, and what each gives on a quiet one.

use serde_json::json;

use super::outcome::outcome;
use super::trouble::{Trouble, post};
use crate::http::Client;
use crate::job::Job;
use crate::service::Service;
use crate::wait::until;

/// A job under its name.
#[derive(Debug)]
pub(super) struct NamedJob {
    pub(super) name: &'static str,
    job: Job,
}

impl NamedJob {
    /// Submits it; the number of the study.
    pub(super) fn submit(&self, client: &Client) -> Result<i64, Trouble> {
        let experiment = post(client, "/v1/experiments", &self.job.experiment_json())?.json();
        let new = json!({"experiment": experiment["id"], "toml": self.job.job, "name": self.name});
        let created = post(client, "/v1/calibrations", &new)?.json();
        Ok(created["study"].as_i64().unwrap_or_default())
    }
}

/// A job and what it gives undisturbed.
#[derive(Debug)]
pub(super) struct Reference {
    pub(super) job: NamedJob,
    pub(super) outcome: String,
}

/// The three jobs: a sampler on a fast model, one with a metamodel on a slow model, and a study that grows by itself.
pub(super) fn references() -> [Reference; 3] {
    let metamodel = Job::rolling()
        .sampler(40, [2, 4], 5)
        .in_job("moves = [2, 4]", "moves = [2, 4]\nmetamodel_moves = 8");
    [
        ("tmcmc", Job::small().sampler(1000, [4, 10], 3)),
        ("metamodel", metamodel),
        ("auto", Job::hidden_shear().sampler(50, [1, 2], 1)),
    ]
    .map(|(name, job)| {
        let job = NamedJob { name, job };
        let outcome = alone(&job);
        Reference { job, outcome }
    })
}

/// The outcome of a job that nothing disturbs.
fn alone(job: &NamedJob) -> String {
    let service = Service::start(&["--local-workers", "2"]);
    job.submit(&service.client).expect("the job is accepted");
    until("the outcome of an undisturbed job", || {
        let studies = service.client.json("/v1/studies");
        outcome(&service.client, &studies[0]).expect("nothing is in the way")
    })
}
