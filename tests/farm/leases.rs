//! Leases: what a worker that halts, leaves, lies or poisons costs, and whom.

use std::time::{SystemTime, UNIX_EPOCH};

use farm_tests::fake_worker::{FakeWorker, PROTOCOL, evaluated, result};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::process::{Process, Signal};
use farm_tests::service::{Service, free_address};
use farm_tests::wait::until;
use serde_json::{Value, json};

const REFUSED: &str = "no_support";

fn rejected() -> Value {
    json!({"rejected": {"kind": REFUSED, "condition": 3, "message": "sinkage 0.2 m exceeds the radius 0.1 m"}})
}

fn fault() -> Value {
    json!({"fault": {"message": "the disk is full"}})
}

fn numbers(leases: &[Value], key: &str) -> Vec<u64> {
    leases.iter().map(|lease| lease[key].as_u64().expect("a number")).collect()
}

/// Halts a worker at a moment at which it holds leases; how many.
fn halt_with_leases(service: &Service, worker: &Process) -> u64 {
    until("a worker halted with leases in hand", || {
        worker.signal(Signal::Stop);
        let holds = service.only_worker().and_then(|w| w["holds"].as_u64()).filter(|&holds| holds > 0);
        if holds.is_none() {
            worker.signal(Signal::Continue);
        }
        holds
    })
}

/// Parameter vectors that the model refused, of a calibration that will finish.
fn rejections(service: &Service, id: i64) -> Value {
    service.wait_for(id, "finished");
    service.client.json(&format!("/v1/calibrations/{id}/summary"))["calibrations"][0]["rejected"].clone()
}

#[test]
fn a_halted_worker_loses_its_leases_and_its_late_results_change_nothing() {
    let job = Job::small().sampler(120, [2, 4], 5);
    let undisturbed = Service::start(&["--local-workers", "2"]);
    let expected = undisturbed.submit(&job);
    undisturbed.wait_for(expected, "finished");

    let service = Service::start(&["--lease-ms", "500"]);
    let id = service.submit(&job);
    let mut halted = service.worker("halted", 2);
    let held = halt_with_leases(&service, &halted);
    assert!(service.status(id)["progress"]["evaluations"].as_u64() < Some(5000));
    let _other = service.worker("other", 2);
    service.wait_for(id, "finished");
    assert!(service.metric("grouser_leases_failed_total") >= held);
    let posterior = service.posterior_csv(id);
    assert_eq!(posterior, undisturbed.posterior_csv(expected));

    let before = service.metric("grouser_evaluations_duplicate_total");
    halted.signal(Signal::Continue);
    until("late results acknowledged as duplicates", || {
        (service.metric("grouser_evaluations_duplicate_total") > before).then_some(())
    });
    assert!(halted.is_running());
    assert_eq!(service.status(id)["state"], "finished");
    assert_eq!(service.posterior_csv(id), posterior);
    assert_eq!(service.metric("grouser_determinism_faults_total"), 0);
}

#[test]
fn sigterm_gives_leases_back_at_once() {
    // Leases last a minute: whatever comes back sooner was given back.
    let service = Service::start(&["--lease-ms", "60000"]);
    let id = service.submit(&Job::small().sampler(400, [4, 10], 5));
    let mut worker = service.worker("leaving", 1);
    halt_with_leases(&service, &worker);
    worker.signal(Signal::Terminate);
    worker.signal(Signal::Continue);
    assert!(worker.wait().success(), "{}", worker.log());
    assert_eq!(service.only_worker().unwrap()["holds"], 0);
    assert_eq!(service.metric("grouser_leases_out"), 0);
    assert_eq!(service.metric("grouser_leases_failed_total"), 0);
    assert!(worker.log().contains("stopped"), "{}", worker.log());
    assert_eq!(service.status(id)["state"], "running");
}

#[test]
fn a_poisonous_evaluation_pauses_its_calibration_and_an_innocent_one_is_not_blamed() {
    let service = Service::start(&["--lease-ms", "100"]);
    let version = service.model_version();
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "poisoned").computing(&version);
    let batch = worker.take(2);
    assert_eq!(numbers(&batch, "evaluation"), [0, 1]);
    let theta = batch[0]["theta"].clone();
    // Both leases of the batch are lost once. From then on each goes out alone: 0 kills, 1 does not.
    let mut alone = Vec::new();
    let paused = until("a pause", || {
        let status = service.status(id);
        if status["state"] == "paused" {
            return Some(status);
        }
        let leases = worker.take(50);
        for lease in &leases {
            if lease["evaluation"] != 0 {
                worker.answer(std::slice::from_ref(lease), |l| evaluated(l, FIT_RUNS));
            }
        }
        if leases.iter().any(|l| l["evaluation"] == 0 || l["evaluation"] == 1) {
            alone.push(numbers(&leases, "evaluation"));
        }
        None
    });
    assert!(alone.iter().all(|batch| batch.len() == 1), "a suspect shared its batch: {alone:?}");
    assert_eq!(alone.iter().filter(|batch| batch[0] == 0).count(), 2, "{alone:?}");
    assert_eq!(alone.iter().filter(|batch| batch[0] == 1).count(), 1, "{alone:?}");
    let message = paused["message"].as_str().expect("a reason");
    assert!(message.contains("evaluation 0 at theta = "), "{message}");
    let first = theta[0].as_f64().expect("a number").to_string();
    assert!(message.contains(&first), "{message} lacks {first}");
    assert!(message.contains("failed on 3 attempts") && message.contains("worker poisoned"), "{message}");
    assert!(message.contains("expired after 100 ms"), "{message}");
    assert!(worker.take(50).is_empty(), "a paused calibration leased");

    let resumed = service.client.post(&format!("/v1/calibrations/{id}/resume"), &json!({}));
    assert_eq!((resumed.status, resumed.json()["state"].as_str()), (200, Some("running")));
    assert_eq!(service.status(id)["message"], Value::Null);
    let _cured = service.worker("cured", 2);
    let finished = service.wait_for(id, "finished");
    assert_eq!(finished["message"], Value::Null);
    let undisturbed = Service::start(&["--local-workers", "1"]);
    assert_eq!(rejections(&service, id), rejections(&undisturbed, undisturbed.submit(&Job::small())));
}

#[test]
fn attempts_given_by_resume_outlive_a_restart() {
    let mut service = Service::start(&["--lease-ms", "60000"]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "faulty");
    let fail = |service: &Service, times: u32| {
        for _ in 0..times {
            let leases = worker.take(1);
            assert_eq!(numbers(&leases, "evaluation"), [0], "{}", service.status(id));
            worker.answer(&leases, |_| fault());
        }
        service.status(id)["state"].as_str().unwrap_or_default().to_owned()
    };
    assert_eq!(fail(&service, 2), "running");
    service.kill();
    service.restart();
    assert_eq!(fail(&service, 1), "paused", "attempts before a restart count");
    service.kill();
    service.restart();
    let paused = service.status(id);
    assert_eq!(paused["state"], "paused");
    assert!(paused["message"].as_str().is_some_and(|m| m.contains("the disk is full")), "{paused}");
    assert_eq!(service.client.post(&format!("/v1/calibrations/{id}/resume"), &json!({})).status, 200);
    service.kill();
    service.restart();
    assert_eq!(fail(&service, 2), "running", "a resumed evaluation has three attempts");
    assert_eq!(fail(&service, 1), "paused");
}

#[test]
fn a_fault_is_retried_and_a_rejection_is_not() {
    let service = Service::start(&["--lease-ms", "60000"]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "mixed");
    let leases = worker.take(2);
    let answer = worker.answer(&leases[..1], |_| fault());
    assert_eq!(answer["duplicates"], 1, "a fault is no result");
    worker.answer(&leases[1..], |_| rejected());
    let progress = service.status(id)["progress"].clone();
    assert_eq!((progress["evaluations"].as_u64(), progress["rejected"].as_u64()), (Some(1), Some(1)));
    let again = worker.take(1);
    assert_eq!(numbers(&again, "evaluation"), numbers(&leases[..1], "evaluation"));
    assert_eq!(again[0]["theta"], leases[0]["theta"]);
    assert_ne!(again[0]["lease"], leases[0]["lease"]);
    worker.answer(&again, |l| evaluated(l, FIT_RUNS));
    let progress = service.status(id)["progress"].clone();
    assert_eq!((progress["evaluations"].as_u64(), progress["rejected"].as_u64()), (Some(2), Some(1)));
    assert_eq!(service.metric("grouser_leases_failed_total"), 1);
}

#[test]
fn observables_that_do_not_cover_the_runs_are_a_fault() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "short");
    let leases = worker.take(1);
    worker.answer(&leases, |l| evaluated(l, FIT_RUNS - 1));
    let progress = service.status(id)["progress"].clone();
    assert_eq!((progress["evaluations"].as_u64(), progress["rejected"].as_u64()), (Some(0), Some(0)));
    assert_eq!(service.only_worker().unwrap()["faults"], 1);
    assert_eq!(numbers(&worker.take(1), "evaluation"), numbers(&leases, "evaluation"));
}

#[test]
fn a_result_sent_twice_counts_once() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "twice");
    let leases = worker.take(3);
    assert_eq!(worker.answer(&leases, |l| evaluated(l, FIT_RUNS))["duplicates"], 0);
    assert_eq!(worker.answer(&leases, |l| evaluated(l, FIT_RUNS))["duplicates"], 3);
    assert_eq!(service.status(id)["progress"]["evaluations"], 3);
    assert_eq!(service.metric("grouser_determinism_faults_total"), 0);
    worker.answer(&leases[..1], |_| rejected());
    until("a differing duplicate noticed", || {
        (service.metric("grouser_determinism_faults_total") == 1).then_some(())
    });
    assert!(service.log().contains("two workers differ"), "{}", service.log());
}

#[test]
fn another_protocol_is_refused_with_426() {
    let service = Service::start(&[]);
    service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "old");
    let mut request = worker.request();
    request["protocol"] = (PROTOCOL + 1).into();
    request["want"] = 1.into();
    let response = worker.send(&request);
    assert_eq!(response.status, 426);
    assert_eq!(response.json()["error"]["type"], "protocol_mismatch");
    assert_eq!(response.json()["error"]["message"], "worker old speaks protocol 2, this coordinator 1");
    assert_eq!(service.metric("grouser_leases_given_total"), 0);
}

#[test]
fn a_worker_of_another_model_version_gets_no_lease_and_is_told_why() {
    let mut service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let first = FakeWorker::new(&service.client, "first");
    assert_eq!(first.take(1).len(), 1);
    assert_eq!(service.status(id)["model_version"], "fake-1");
    let other = FakeWorker::new(&service.client, "other").computing("fake-2");
    for restarted in [false, true] {
        if restarted {
            service.kill();
            service.restart();
        }
        let mut request = other.request();
        request["want"] = 5.into();
        request["wait_ms"] = 30_000.into();
        let response = other.exchange(&request);
        assert_eq!(response["leases"], json!([]));
        let told = "calibration 1 was begun with model version fake-1, worker other computes fake-2";
        assert_eq!(response["refused"], told, "restarted: {restarted}");
    }
    assert_eq!(first.take(1).len(), 1);
}

#[test]
fn fencing_tokens_never_repeat_across_restarts() {
    let mut service = Service::start(&[]);
    service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "token");
    let mut tokens = Vec::new();
    for _ in 0..3 {
        tokens.extend(numbers(&worker.take(5), "lease"));
        tokens.extend(numbers(&worker.take(5), "lease"));
        service.kill();
        service.restart();
    }
    assert_eq!(tokens.len(), 30);
    assert!(tokens.windows(2).all(|pair| pair[0] < pair[1]), "{tokens:?}");
}

#[test]
fn a_late_result_from_before_a_restart_counts() {
    let mut service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "patient");
    let leases = worker.take(4);
    service.kill();
    service.restart();
    assert_eq!(worker.answer(&leases, |l| evaluated(l, FIT_RUNS))["duplicates"], 0);
    assert_eq!(service.status(id)["progress"]["evaluations"], 4);
}

#[test]
fn a_result_for_another_store_is_not_taken() {
    let address = free_address();
    let mut first = Service::start_at(address.clone(), &[]);
    first.submit(&Job::small());
    let worker = FakeWorker::new(&first.client, "wanderer");
    let leases = worker.take(2);
    first.kill();
    // Another job, another store, the same port; its first calibration has the same id. Not within one second:
    // nobody changes a store so fast, and the clock's seconds tell stores apart.
    let second_of = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    let now = second_of();
    until("the next second", || (second_of() > now).then_some(()));
    let second = Service::start_at(address, &[]);
    let id = second.submit(&Job::small().sampler(60, [2, 4], 2));
    let answer = worker.answer(&leases, |l| evaluated(l, FIT_RUNS));
    assert_eq!(answer["duplicates"], 2);
    assert_eq!(second.status(id)["progress"]["evaluations"], 0);
}

#[test]
fn a_waiting_worker_is_served_when_work_arrives() {
    let service = Service::start(&[]);
    let worker = FakeWorker::new(&service.client, "waiting");
    let leases = std::thread::scope(|scope| {
        let poll = scope.spawn(|| {
            let mut request = worker.request();
            request["want"] = 4.into();
            request["wait_ms"] = 30_000.into();
            worker.exchange(&request)["leases"].as_array().map(Vec::len)
        });
        until("the waiting worker", || (service.metric("grouser_workers_connected") == 1).then_some(()));
        assert!(!poll.is_finished());
        service.submit(&Job::small());
        poll.join().expect("the poll ends")
    });
    assert_eq!(leases, Some(4));
}

#[test]
fn leases_are_renewed_by_holding_and_returned_without_cost() {
    let service = Service::start(&["--lease-ms", "1000"]);
    service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "holding");
    let leases = worker.take(2);
    let mut request = worker.request();
    request["holding"] = json!([leases[0]["lease"]]);
    // The lease that is not held expires; the other one, renewed all the time, does not.
    until("an expired lease", || {
        worker.exchange(&request);
        (service.metric("grouser_leases_failed_total") > 0).then_some(())
    });
    assert_eq!(service.metric("grouser_leases_out"), 1);
    assert_eq!(result(&leases[0], fault())["lease"], leases[0]["lease"]);
    request["holding"] = json!([]);
    request["returned"] = json!([leases[0]["lease"]]);
    worker.exchange(&request);
    assert_eq!(service.metric("grouser_leases_out"), 0);
    assert_eq!(service.metric("grouser_leases_failed_total"), 1);
}
