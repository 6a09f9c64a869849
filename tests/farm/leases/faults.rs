//! Evaluations that fail: whose fault it is and how often they are tried.

use farm_tests::fake_worker::{FakeWorker, evaluated};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::service::Service;
use farm_tests::wait::until;
use serde_json::{Value, json};

use super::{fault, numbers, rejected};

/// Parameter vectors that the model refused, of a calibration that will finish.
fn rejections(service: &Service, id: i64) -> Value {
    service.wait_for(id, "finished");
    service.client.json(&format!("/v1/calibrations/{id}/summary"))["calibrations"][0]["rejected"].clone()
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
        if leases
            .iter()
            .any(|l| l["evaluation"] == 0 || l["evaluation"] == 1)
        {
            alone.push(numbers(&leases, "evaluation"));
        }
        None
    });
    assert!(
        alone.iter().all(|batch| batch.len() == 1),
        "a suspect shared its batch: {alone:?}"
    );
    assert_eq!(alone.iter().filter(|batch| batch[0] == 0).count(), 2, "{alone:?}");
    assert_eq!(alone.iter().filter(|batch| batch[0] == 1).count(), 1, "{alone:?}");
    let message = paused["message"].as_str().expect("a reason");
    assert!(message.contains("evaluation 0 at theta = "), "{message}");
    let first = theta[0].as_f64().expect("a number").to_string();
    assert!(message.contains(&first), "{message} lacks {first}");
    assert!(
        message.contains("failed on 3 attempts") && message.contains("worker poisoned"),
        "{message}"
    );
    assert!(message.contains("expired after 100 ms"), "{message}");
    assert!(worker.take(50).is_empty(), "a paused calibration leased");

    let resumed = service
        .client
        .post(&format!("/v1/calibrations/{id}/resume"), &json!({}));
    assert_eq!(
        (resumed.status, resumed.json()["state"].as_str()),
        (200, Some("running"))
    );
    assert_eq!(service.status(id)["message"], Value::Null);
    let _cured = service.worker("cured", 2);
    let finished = service.wait_for(id, "finished");
    assert_eq!(finished["message"], Value::Null);
    // Three leases of 0 and one of 1 were lost; both are draws from the prior.
    let diagnostics = service.client.json(&format!("/v1/calibrations/{id}/diagnostics"));
    let found = &diagnostics["rejections"];
    let lost = &found["faults"]["the lease expired after 100 ms without renewal"];
    assert!(lost.as_u64() >= Some(4), "{found}");
    let bins = found["parameters"][0]["bins"].as_array().expect("bins").iter();
    let of_prior: u64 = bins.filter_map(|bin| bin["faults"].as_u64()).sum();
    assert!(of_prior >= 4, "{found}");
    let undisturbed = Service::start(&["--local-workers", "1"]);
    assert_eq!(
        rejections(&service, id),
        rejections(&undisturbed, undisturbed.submit(&Job::small()))
    );
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
        service.status(id)["state"]
            .as_str()
            .unwrap_or_default()
            .to_owned()
    };
    assert_eq!(fail(&service, 2), "running");
    service.kill();
    service.restart();
    assert_eq!(fail(&service, 1), "paused", "attempts before a restart count");
    service.kill();
    service.restart();
    let paused = service.status(id);
    assert_eq!(paused["state"], "paused");
    assert!(
        paused["message"]
            .as_str()
            .is_some_and(|m| m.contains("the disk is full")),
        "{paused}"
    );
    assert_eq!(
        service
            .client
            .post(&format!("/v1/calibrations/{id}/resume"), &json!({}))
            .status,
        200
    );
    service.kill();
    service.restart();
    assert_eq!(
        fail(&service, 2),
        "running",
        "a resumed evaluation has three attempts"
    );
    assert_eq!(fail(&service, 1), "paused");
}

#[test]
fn a_fault_is_retried_and_a_rejection_is_not() {
    let service = Service::start(&["--lease-ms", "60000"]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "mixed");
    let leases = worker.take(2);
    let answer = worker.answer(&leases[..1], |_| fault());
    assert_eq!(answer["duplicates"], 0, "a fault is no duplicate");
    worker.answer(&leases[1..], |_| rejected());
    let progress = service.status(id)["progress"].clone();
    assert_eq!(
        (progress["evaluations"].as_u64(), progress["rejected"].as_u64()),
        (Some(1), Some(1))
    );
    let again = worker.take(1);
    assert_eq!(numbers(&again, "evaluation"), numbers(&leases[..1], "evaluation"));
    assert_eq!(again[0]["theta"], leases[0]["theta"]);
    assert_ne!(again[0]["lease"], leases[0]["lease"]);
    worker.answer(&again, |l| evaluated(l, FIT_RUNS));
    let progress = service.status(id)["progress"].clone();
    assert_eq!(
        (progress["evaluations"].as_u64(), progress["rejected"].as_u64()),
        (Some(2), Some(1))
    );
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
    assert_eq!(
        (progress["evaluations"].as_u64(), progress["rejected"].as_u64()),
        (Some(0), Some(0))
    );
    assert_eq!(service.only_worker().unwrap()["faults"], 1);
    assert_eq!(
        numbers(&worker.take(1), "evaluation"),
        numbers(&leases, "evaluation")
    );
}
