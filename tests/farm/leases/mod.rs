//! Leases: what a worker that halts, leaves, lies or poisons costs, and whom.

mod busy;
mod disputed;
mod durable;
mod faults;
mod lost;
mod restored;
mod tokens;
mod workers;

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
