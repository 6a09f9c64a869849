//! Failing evaluations: who is blamed, and how often an evaluation is tried.

use farm_tests::assert_contains;
use farm_tests::fake_worker::{FakeWorker, evaluated, rejected};
use farm_tests::job::{FIT_RUNS, Job};
use farm_tests::json::word;
use farm_tests::programs::call;
use farm_tests::service::Service;
use farm_tests::wait::{until, until_true};
use serde_json::Value;

use super::{fault, numbers};

#[test]
fn a_poisonous_evaluation_is_given_up_and_an_innocent_one_is_not_blamed() {
    let mut service = Service::start(&["--lease-ms", "300"]);
    let version = service.model_version();
    // A round of 60 may give up one.
    let id = service.submit(&Job::small().sampler(60, [2, 4], 1));
    let victims: Vec<FakeWorker> = (0..4)
        .map(|k| FakeWorker::new(&service.client, &format!("victim-{k}")).computing(&version))
        .collect();
    // The first worker stops with three leases, two of which it has begun.
    let batch = victims[0].take(3);
    assert!(batch.iter().all(|lease| lease["announce"] == false));
    victims[0].start(&batch[..2]);
    failed(&service, 3);
    // From then on each suspect is leased alone: evaluation 0 kills its workers, and the others do not.
    let mut lost = 3;
    for victim in &victims[1..3] {
        until("the poisonous one", || {
            let leases = victim.take(50);
            let poisonous = leases.iter().any(|lease| lease["evaluation"] == 0);
            if poisonous {
                assert_eq!(leases.len(), 1, "{leases:?}");
                assert_eq!(leases[0]["announce"], true, "{leases:?}");
                victim.start(&leases);
            } else {
                victim.answer(&leases, |l| evaluated(l, FIT_RUNS));
            }
            poisonous.then_some(())
        });
        lost += 1;
        failed(&service, lost);
    }
    let status = service.status(id);
    assert_eq!(status["state"], "running");
    assert_eq!(status["message"], Value::Null);
    // A second lost evaluation is more than this round allows. Leases that never began are not counted as attempts.
    let second = poison(&service, &victims, lost);
    let paused = until("a pause", || {
        Some(service.status(id)).filter(|s| s["state"] == "paused")
    });
    let message = word(&paused["message"]);
    assert_contains!(
        message,
        &format!("evaluation {second} at theta = "),
        "failed on 3 attempts",
        "expired after 300 ms",
        "resume --skip-faults counts it as rejected"
    );
    assert!(victims[3].take(50).is_empty(), "a paused calibration leased");
    service.crash();
    let reported = call("coordinator resume 1 --skip-faults --url {}", &[&service.url()]).success();
    assert_contains!(reported, "calibration 1 is running");
    service.crash();
    // A late answer to an evaluation that was given up is not a dispute.
    let late = victims[0].answer(&batch[..1], |l| evaluated(l, FIT_RUNS));
    assert_eq!(late["duplicates"], 1);
    let _cured = service.worker("cured", 2);
    service.wait_for(id, "finished");
    assert_eq!(service.metric("grouser_determinism_faults_total"), 0);
    let summary = service.result(id, "summary");
    let flags = summary["flags"].as_array().expect("flags");
    let flag = flags.iter().find(|flag| flag["kind"] == "worker");
    let text = flag.and_then(|flag| flag["text"].as_str()).expect("a flag");
    assert_contains!(text, "2 evaluations failed on every worker that tried them");
    let found = service.result(id, "diagnostics");
    assert!(
        found["rejections"]["faults"]["the lease expired after 300 ms without renewal"].as_u64() >= Some(6)
    );
}

/// Waits until this many leases have failed or expired.
fn failed(service: &Service, count: u64) {
    until_true(&format!("{count} lost leases"), || {
        service.metric("grouser_leases_failed_total") >= count
    });
}

/// Lets the next evaluation kill three workers; returns its number.
fn poison(service: &Service, victims: &[FakeWorker], mut lost: u64) -> u64 {
    let mut target: Option<Value> = None;
    for victim in victims.iter().cycle().skip(1).take(3) {
        until("the second poisonous one", || {
            let leases = victim.take(1);
            let lease = leases.first()?;
            if *target.get_or_insert_with(|| lease["evaluation"].clone()) == lease["evaluation"] {
                victim.start(&leases);
                return Some(());
            }
            victim.answer(&leases, |l| evaluated(l, FIT_RUNS));
            None
        });
        lost += 1;
        failed(service, lost);
    }
    target
        .and_then(|evaluation| evaluation.as_u64())
        .expect("an evaluation")
}

#[test]
fn answers_lost_on_the_way_cost_no_attempt_and_no_time() {
    let service = Service::start(&["--lease-ms", "60000"]);
    let id = service.submit(&Job::small());
    let worker = FakeWorker::new(&service.client, "unlucky");
    let mut lost = 0;
    for exchange in 0..30 {
        let mut request = worker.request();
        request["want"] = 4.into();
        if exchange % 3 == 0 {
            // The request is executed, but its answer is ignored as if it were lost.
            let answer = worker.send(&request).json();
            lost += answer["leases"].as_array().map_or(0, Vec::len) as u64;
        } else {
            let leases = worker.take(4);
            assert!(
                leases.iter().all(|lease| lease["announce"] == false),
                "no suspects: {leases:?}"
            );
            assert_eq!(
                worker.answer(&leases, |l| evaluated(l, FIT_RUNS))["duplicates"],
                0
            );
        }
    }
    assert!(lost >= 20, "{lost}");
    assert_eq!(service.metric("grouser_leases_lost_total"), lost);
    assert_eq!(service.metric("grouser_leases_failed_total"), 0);
    assert_eq!(service.metric("grouser_leases_out"), 0);
    assert_eq!(service.status(id)["state"], "running");
}

#[test]
fn a_worker_that_dies_before_it_begins_costs_no_attempt() {
    let service = Service::start(&["--lease-ms", "100"]);
    let id = service.submit(&Job::small());
    for round in 1..=5 {
        let worker = FakeWorker::new(&service.client, &format!("gone-{round}"));
        assert_eq!(numbers(&worker.take(1), "evaluation"), [0]);
        failed(&service, round);
    }
    let status = service.status(id);
    assert_eq!(status["state"], "running");
    assert_eq!(status["message"], Value::Null);
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
    service.crash();
    assert_eq!(fail(&service, 1), "paused", "attempts before a restart count");
    service.crash();
    let paused = service.status(id);
    assert_eq!(paused["state"], "paused");
    assert!(
        paused["message"]
            .as_str()
            .is_some_and(|m| m.contains("the disk is full")),
        "{paused}"
    );
    assert_eq!(service.act(id, "resume").status, 200);
    service.crash();
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
    assert_eq!(progress["evaluations"].as_u64(), Some(1));
    assert_eq!(progress["rejected"].as_u64(), Some(1));
    let again = worker.take(1);
    assert_eq!(numbers(&again, "evaluation"), numbers(&leases[..1], "evaluation"));
    assert_eq!(again[0]["theta"], leases[0]["theta"]);
    assert_ne!(again[0]["lease"], leases[0]["lease"]);
    worker.answer(&again, |l| evaluated(l, FIT_RUNS));
    let progress = service.status(id)["progress"].clone();
    assert_eq!(progress["evaluations"].as_u64(), Some(2));
    assert_eq!(progress["rejected"].as_u64(), Some(1));
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
    assert_eq!(progress["evaluations"].as_u64(), Some(0));
    assert_eq!(progress["rejected"].as_u64(), Some(0));
    assert_eq!(service.only_worker().unwrap()["faults"], 1);
    assert_eq!(
        numbers(&worker.take(1), "evaluation"),
        numbers(&leases, "evaluation")
    );
}
