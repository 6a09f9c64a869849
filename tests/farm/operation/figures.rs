//! `/metrics`, and the figures of it that the dashboard and the alerts of `deploy/` use.

use std::collections::BTreeSet;

use farm_tests::assert_contains;
use farm_tests::fake_worker::FakeWorker;
use farm_tests::job::Job;
use farm_tests::service::Service;
use farm_tests::workspace::{root, text};
use serde_json::Value;

/// Names of our figures in a text.
fn names(text: &str) -> BTreeSet<&str> {
    let is_of_name = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    text.match_indices("grouser_")
        .map(|(at, _)| text[at..].split(|c| !is_of_name(c)).next().unwrap_or_default())
        .collect()
}

#[test]
fn every_figure_of_the_dashboard_and_of_the_alerts_exists() {
    let service = Service::start(&[]);
    service.client.get("/health");
    let page = service.client.get("/metrics").body;
    let listed: BTreeSet<&str> = page
        .lines()
        .filter(|line| !line.starts_with('#'))
        .filter_map(|line| line.split(['{', ' ']).next())
        .collect();
    for file in ["deploy/grafana.json", "deploy/alerts.yml"] {
        let text = text(&root().join(file));
        let requested = names(&text);
        assert!(requested.len() >= 5, "{file}: {requested:?}");
        for name in requested {
            assert!(
                listed.contains(name),
                "{file} asks for {name}, which is not in\n{page}"
            );
        }
    }
    let dashboard: Value = serde_json::from_str(&text(&root().join("deploy/grafana.json"))).expect("JSON");
    for panel in dashboard["panels"].as_array().expect("panels") {
        assert!(panel["title"].is_string(), "{panel}");
        assert!(panel["targets"][0]["expr"].is_string(), "{panel}");
    }
}

#[test]
fn queue_states_store_and_requests_are_counted() {
    let service = Service::start(&[]);
    service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "worker");
    // With two calibrations, each would have one lease.
    assert_eq!(worker.take(2).len(), 2);
    let second = service.submit(&Job::small());
    service.act(second, "cancel");
    assert_eq!(service.metric("grouser_calibrations{state=\"running\"}"), 1);
    assert_eq!(service.metric("grouser_calibrations{state=\"cancelled\"}"), 1);
    assert_eq!(service.metric("grouser_calibrations{state=\"failed\"}"), 0);
    assert_contains!(service.log(), "cancelled calibration=2");
    assert_eq!(service.metric("grouser_leases_out"), 2);
    assert_eq!(service.metric("grouser_evaluations_queued"), 58);
    assert!(service.metric("grouser_store_bytes") + service.metric("grouser_store_log_bytes") > 10_000);
    assert_eq!(service.metric("grouser_store_locked"), 0);
    for path in [
        "/v1/calibrations/1",
        "/v1/calibrations/2",
        "/nowhere/1",
        "/nowhere/2",
    ] {
        service.client.get(path);
    }
    let labels = "method=\"GET\",route=\"/v1/calibrations/{id}\"";
    assert_eq!(
        service.metric(&format!("grouser_requests_total{{{labels},status=\"200\"}}")),
        2
    );
    assert_eq!(
        service.metric(&format!("grouser_request_seconds_count{{{labels}}}")),
        2
    );
    let nowhere = "grouser_requests_total{method=\"GET\",route=\"none\",status=\"404\"}";
    assert_eq!(service.metric(nowhere), 2);
    let page = service.client.get("/metrics").body;
    assert!(
        !page.contains("nowhere"),
        "paths of strangers are no labels:\n{page}"
    );
}
