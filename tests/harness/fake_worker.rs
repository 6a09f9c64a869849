//! A worker whose every message is written by a test, over plain HTTP.

use std::sync::atomic::{AtomicU64, Ordering};

use serde_json::{Value, json};

use crate::http::{Client, Response};

/// Version of the protocol of exchanges.
pub const PROTOCOL: u32 = 13;

/// A named worker that sends only the messages of a test.
#[derive(Debug)]
pub struct FakeWorker {
    client: Client,
    name: String,
    model_version: String,
    received: AtomicU64,
}

impl FakeWorker {
    /// Returns a worker of the model version `fake-1` that has sent no message yet.
    pub fn new(client: &Client, name: &str) -> Self {
        FakeWorker {
            client: client.clone(),
            name: name.into(),
            model_version: "fake-1".into(),
            received: AtomicU64::new(0),
        }
    }

    /// Returns the worker with another version of the equations than `fake-1`.
    pub fn computing(self, model_version: &str) -> Self {
        FakeWorker {
            model_version: model_version.into(),
            ..self
        }
    }

    /// Returns an empty exchange.
    pub fn request(&self) -> Value {
        json!({
            "worker": self.name, "protocol": PROTOCOL, "model_version": self.model_version, "threads": 1,
            "results": [], "holding": [], "returned": [], "started": [], "received": self.received.load(Ordering::Relaxed),
            "want": 0, "wait_ms": 0,
        })
    }

    /// Sends an exchange, with any answer.
    pub fn send(&self, request: &Value) -> Response {
        self.client.post("/v1/work/exchange", request)
    }

    /// Sends an exchange that must succeed.
    #[track_caller]
    pub fn exchange(&self, request: &Value) -> Value {
        let response = self.send(request);
        assert_eq!(response.status, 200, "{}", response.body);
        let answer = response.json();
        let leases = answer["leases"].as_array().into_iter().flatten();
        if let Some(last) = leases.filter_map(|lease| lease["lease"].as_u64()).max() {
            self.received.fetch_max(last, Ordering::Relaxed);
        }
        answer
    }

    /// Takes up to this many leases.
    #[track_caller]
    pub fn take(&self, want: u32) -> Vec<Value> {
        let mut request = self.request();
        request["want"] = want.into();
        let answer = self.exchange(&request);
        answer["leases"].as_array().cloned().unwrap_or_default()
    }

    /// Reports that the evaluation of leases has begun.
    #[track_caller]
    pub fn start(&self, leases: &[Value]) {
        let mut request = self.request();
        request["started"] = leases.iter().map(|lease| lease["lease"].clone()).collect();
        self.exchange(&request);
    }

    /// Sends an outcome for each lease; returns the answer of the service.
    #[track_caller]
    pub fn answer(&self, leases: &[Value], outcome: impl Fn(&Value) -> Value) -> Value {
        let mut request = self.request();
        request["results"] = leases.iter().map(|lease| result(lease, outcome(lease))).collect();
        self.exchange(&request)
    }
}

/// Returns a result that answers a lease.
pub fn result(lease: &Value, outcome: Value) -> Value {
    json!({
        "lease": lease["lease"], "calibration": lease["calibration"], "evaluation": lease["evaluation"],
        "seal": lease["seal"], "outcome": outcome,
    })
}

/// Plausible averages of a number of runs, which differ from one parameter vector to the next.
pub fn evaluated(lease: &Value, runs: usize) -> Value {
    let theta = lease["theta"].as_array().cloned().unwrap_or_default();
    let sum: f64 = theta.iter().filter_map(Value::as_f64).sum();
    let vector = |value: f64| vec![value; runs];
    json!({"evaluated": {
        "drawbar_pull_n": vector(20.0 + sum), "torque_n_m": vector(4.0), "sinkage_m": vector(0.006),
        "lateral_force_n": vector(0.0), "b_eff_m": vector(0.03), "contact_length_m": vector(0.05),
        "residual_load_n": vector(0.0), "nodes_in_contact": vec![16; runs], "simulated_travel_m": vector(0.0),
    }})
}

/// Returns the model's rejection of a parameter vector.
pub fn rejected() -> Value {
    json!({"rejected": {"kind": "no_support", "condition": 3, "message": "sinkage 0.2 m exceeds the radius 0.1 m"}})
}
