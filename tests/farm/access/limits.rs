//! Limits of what a client may fill: memory, descriptors and lists.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use farm_tests::assert_contains;
use farm_tests::fake_worker::{FakeWorker, evaluated};
use farm_tests::http::Response;
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::programs;
use farm_tests::service::Service;
use farm_tests::workspace::{root, text};
use serde_json::{Value, json};

#[track_caller]
fn refused(response: &Response, status: u16, part: &str) {
    let message = response.json()["error"]["message"]
        .as_str()
        .unwrap_or_default()
        .to_owned();
    assert_eq!(response.status, status, "{message}");
    assert_contains!(message, part);
}

#[test]
fn silent_connections_cost_little_and_half_a_head_is_not_waited_for() {
    let service = Service::start(&[]);
    let connect = || TcpStream::connect(&service.client.0).expect("a connection");
    let before = service.resident_kb();
    let silent: Vec<TcpStream> = (0..400).map(|_| connect()).collect();
    let mut half: Vec<TcpStream> = (0..100).map(|_| connect()).collect();
    for stream in &mut half {
        stream
            .write_all(b"GET /health HTTP/1.1\r\nHost: 127.0.0.1\r\n")
            .expect("half a head");
    }
    assert_eq!(service.client.get("/health").status, 200);
    let grown = service.resident_kb().saturating_sub(before);
    assert!(grown < 20_000, "500 connections take {grown} kB");
    for mut stream in silent.into_iter().take(1).chain(half.into_iter().take(1)) {
        stream
            .set_read_timeout(Some(Duration::from_secs(60)))
            .expect("a time limit");
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).expect("the service hangs up");
        assert!(
            !answer.starts_with(b"HTTP/1.1 200"),
            "{}",
            String::from_utf8_lossy(&answer)
        );
    }
}

#[test]
fn what_a_worker_says_has_a_length_and_what_it_wants_a_number() {
    let service = Service::start(&[]);
    let worker = FakeWorker::new(&service.client, &"w".repeat(20 << 20));
    refused(
        &worker.send(&worker.request()),
        400,
        "worker: 20971520 bytes must be at most 200 bytes",
    );
    assert_eq!(service.client.json("/v1/workers"), json!({}));

    service.submit(&Job::small().sampler(12_000, [2, 4], 1));
    let greedy = FakeWorker::new(&service.client, "greedy");
    let first = greedy.take(u32::MAX);
    assert_eq!(first.len(), 64, "it has answered nothing yet");
    greedy.answer(&first[..1], |lease| evaluated(lease, FIT_RUNS));
    let leases = greedy.take(u32::MAX);
    assert_eq!(leases.len(), 10_000);
    let long = |_: &Value| json!({"fault": {"message": "x".repeat(10_001)}});
    let mut request = greedy.request();
    request["results"] = vec![farm_tests::fake_worker::result(&leases[0], long(&leases[0]))].into();
    refused(
        &greedy.send(&request),
        400,
        "message: 10001 bytes must be at most 10000 bytes",
    );
}

#[test]
fn a_time_that_no_evaluation_takes_is_refused() {
    let service = Service::start(&[]);
    let worker = FakeWorker::new(&service.client, "worker");
    let saying = |evaluation_s: f64| {
        let mut request = worker.request();
        request["evaluation_s"] = evaluation_s.into();
        worker.send(&request)
    };
    for (evaluation_s, text) in [(-1.0, "-1.0"), (1e308, "1e308"), (1_000_001.0, "1000001.0")] {
        refused(
            &saying(evaluation_s),
            400,
            &format!("evaluation_s: {text} s must lie in [0, 1000000] s"),
        );
    }
    assert_eq!(service.client.json("/v1/workers"), json!({}));
    for evaluation_s in [0.0, 1e6] {
        assert_eq!(saying(evaluation_s).status, 200);
    }
    assert_eq!(service.client.json("/v1/work/demand")["evaluation_s"], 1e6);
}

#[test]
fn what_is_too_large_to_work_on_is_refused_at_submission() {
    let service = Service::start(&[]);
    let client = &service.client;
    let toml = format!("# {}\n", "x".repeat(2 << 20));
    let large = client.post("/v1/experiments", &json!({"toml": toml}));
    refused(
        &large,
        422,
        "experiment.toml: 2097155 bytes must be at most 1048576 bytes",
    );

    let mut many = Job::small();
    let row = many.runs.lines().last().expect("a row").to_owned();
    let name = row.split(',').next().expect("a name").to_owned();
    for i in 0..10_000 {
        many.runs += &format!("{}\n", row.replacen(&name, &format!("more{i}"), 1));
    }
    refused(
        &client.post("/v1/experiments", &many.experiment_json()),
        422,
        "the file must have at most 10000 rows",
    );

    let id = client
        .post("/v1/experiments", &Job::small().experiment_json())
        .json()["id"]
        .clone();
    let submit = |job: &Job, name: &str| {
        client.post(
            "/v1/calibrations",
            &json!({"experiment": id, "toml": job.job, "name": name}),
        )
    };
    // The schema and the documents state the same bound.
    let schema = programs::run(programs::coordinator(["schema", "job"])).success();
    let schema: Value = serde_json::from_str(&schema).expect("a schema");
    assert_eq!(
        schema["properties"]["sampler"]["properties"]["particles"]["maximum"],
        100_000
    );
    let document = text(&root().join("docs/job.md"));
    let key = document.lines().find(|line| line.starts_with("| `particles` |"));
    assert!(key.expect("the key").ends_with(" At most 100,000 |"), "{key:?}");
    let crowd = Job::small().sampler(100_001, [2, 4], 1);
    refused(
        &submit(&crowd, "n"),
        422,
        "particles = 100001 must be at most 100000",
    );
    let named = "n".repeat(201);
    refused(
        &submit(&Job::small(), &named),
        422,
        "name: 201 bytes must be at most 200 bytes",
    );
    assert_eq!(client.json("/v1/calibrations"), json!([]));

    let calibration = service.submit(&Job::small());
    let padded = json!({"x": "x".repeat(70_000)});
    let pause = client.post(&format!("/v1/calibrations/{calibration}/pause"), &padded);
    refused(&pause, 413, "the limit of 65536 bytes");
    assert_eq!(service.status(calibration)["state"], "queued");
}

#[test]
fn a_name_that_is_no_text_is_refused_like_any_other() {
    let service = Service::start(&[]);
    for path in [
        "/v1/effects/%ff",
        "/v1/examples/%ff",
        "/v1/work/variants/%ff",
        "/page/%ff",
        "/v1/calibrations/%ff",
    ] {
        let answer = service.client.get(path);
        assert_eq!(answer.header("content-type"), Some("application/json"), "{path}");
        assert_eq!(answer.json()["error"]["type"], "not_found", "{path}");
        assert_eq!(answer.status, 404, "{path}");
    }
}

#[test]
fn a_lease_lasts_a_day_at_most() {
    let longest = u64::MAX.to_string();
    let refusal = programs::run(programs::coordinator(["serve", "--lease-ms", &longest])).refusal();
    assert_eq!(
        refusal,
        format!("--lease-ms {longest} ms must lie in [100, 86400000] ms")
    );
}

#[test]
fn the_log_has_a_line_for_each_turn_of_a_calibration_and_a_list_escapes_its_name() {
    let service = Service::start(&[]);
    let client = &service.client;
    let id = client
        .post("/v1/experiments", &Job::small().experiment_json())
        .json()["id"]
        .clone();
    let new = json!({"experiment": id, "toml": Job::small().job, "name": "red \u{1b}[31m"});
    assert_eq!(client.post("/v1/calibrations", &new).status, 201);
    for verb in ["pause", "resume"] {
        assert_eq!(
            client
                .post(&format!("/v1/calibrations/1/{verb}"), &json!({}))
                .status,
            200
        );
    }
    let list = programs::run(programs::coordinator(["list", "--url", &service.url()])).success();
    assert!(list.contains("red \\u{1b}[31m"), "{list}");
    assert!(!list.contains('\u{1b}'), "{list}");
    let _worker = service.worker("worker", 1);
    service.wait_for(1, "finished");
    let log = service.log();
    assert!(!log.contains('\u{1b}'), "{log}");
    for line in [
        "submitted calibration=1",
        "control=Pause",
        "control=Resume",
        "running calibration=1",
        "finished calibration=1",
    ] {
        let count = log.lines().filter(|l| l.contains(line)).count();
        assert!(count >= 1, "{line}: {count} lines in\n{log}");
    }
    assert_contains!(log, "by=no token");
}
