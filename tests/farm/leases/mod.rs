//! Leases: what a worker that halts, leaves, lies or poisons costs, and whom.

mod busy;
mod disputed;
mod durable;
mod faults;
mod limits;
mod lost;
mod restored;
mod tokens;
mod verification;
mod workers;

use farm_tests::service::Service;
use serde_json::{Value, json};

fn fault() -> Value {
    json!({"fault": {"message": "the disk is full"}})
}

fn numbers(leases: &[Value], key: &str) -> Vec<u64> {
    leases
        .iter()
        .map(|lease| lease[key].as_u64().expect("a number"))
        .collect()
}

/// The texts of the flags of kind `worker` in the summary of a finished calibration.
fn worker_flags(service: &Service, id: i64) -> Vec<String> {
    let summary = service.client.json(&format!("/v1/calibrations/{id}/summary"));
    let flags = summary["flags"].as_array().expect("flags").iter();
    flags
        .filter(|flag| flag["kind"] == "worker")
        .map(|flag| flag["text"].as_str().expect("a text").to_owned())
        .collect()
}
