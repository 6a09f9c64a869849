//! Leases of workers that halt, leave, lie or are killed by an evaluation.

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

use farm_tests::json::{items, whole, word};
use farm_tests::service::Service;
use serde_json::{Value, json};

fn fault() -> Value {
    json!({"fault": {"message": "the disk is full"}})
}

fn numbers(leases: &[Value], key: &str) -> Vec<u64> {
    leases.iter().map(|lease| whole(&lease[key])).collect()
}

/// Returns the texts of the flags of kind `worker` in the summary of a finished calibration.
fn worker_flags(service: &Service, id: i64) -> Vec<String> {
    let summary = service.result(id, "summary");
    let flags = items(&summary["flags"]);
    flags
        .filter(|flag| flag["kind"] == "worker")
        .map(|flag| word(&flag["text"]).to_owned())
        .collect()
}
