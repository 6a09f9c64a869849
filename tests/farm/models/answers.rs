//! Models that fail: a rejection if the parameters are the cause, and otherwise a fault.

use std::time::Duration;

use farm_tests::json::{whole, word};
use farm_tests::service::Service;
use farm_tests::umbridge_server::{Reply, UmbridgeServer};
use farm_tests::wait::until;
use serde_json::Value;

use super::{RUNS, answer, honest, job, program, program_job, short, write_program};

/// Returns the rejections by kind and the flags of a finished calibration.
fn finished(service: &Service, id: i64) -> (u64, String) {
    service.wait_for(id, "finished");
    let summary = service.result(id, "summary");
    let rejected = whole(&summary["calibrations"][0]["rejected"]);
    let flags = service.part(id, "flags").body;
    (rejected, flags)
}

/// Calibrates with a server, whose answer differs where the grip is large.
fn with(reply: Reply) -> (Service, i64, UmbridgeServer) {
    let server = UmbridgeServer::start(move |question| match question.parameters[0] > 0.8 {
        true => reply.clone(),
        false => answer(question),
    });
    let service = Service::start(&["--lease-ms", "2000"]);
    let id = service.submit(&job(&server.url));
    (service, id, server)
}

#[test]
fn what_is_no_number_and_what_breaks_down_rejects_the_parameters() {
    let replies = [
        (Reply::Output("[[nan, 1.0, 0.1]]".into()), "not_finite"),
        (Reply::Status(500, "Traceback".into()), "model_error"),
        (Reply::Output("[[null, 1.0, 0.1]]".into()), "not_finite"),
    ];
    for (reply, kind) in replies {
        let (service, id, server) = with(reply);
        let _worker = service.worker_of("worker", 2, &server.url);
        let (rejected, _) = finished(&service, id);
        // The reply affects a quarter of the prior, so that at least some of the first 60 draws are rejected.
        assert!(rejected >= 5, "{kind}: {rejected}");
        let table = service.part(id, "flags").body;
        assert!(!table.contains("not deterministic"), "{table}");
    }
}

#[test]
fn a_run_that_takes_too_long_rejects_the_parameters() {
    // About six of the first 60 draws hang. Each takes half a second, and the time of the probe.
    let server = UmbridgeServer::start(|question| match question.parameters[0] > 0.95 {
        true => Reply::Hang(Duration::from_secs(2)),
        false => answer(question),
    });
    let service = Service::start(&["--lease-ms", "2000"]);
    let id = service.submit(&job(&server.url).in_job("time_s = 20", "time_s = 0.5"));
    let _worker = service.worker_of("worker", 4, &server.url);
    assert!(finished(&service, id).0 >= 1);
}

#[test]
fn what_no_parameters_can_cure_is_a_fault_and_pauses_with_its_reason() {
    let replies: [(Reply, &str); 4] = [
        (Reply::Output("[[1.0, 2.0]]".into()), "must answer 3 outputs"),
        (Reply::Output("\"pull\"".into()), "must answer 3 outputs"),
        (Reply::Status(200, "<html>".into()), "not JSON"),
        (
            Reply::Status(500, "no licence".into()),
            "at the medians of the priors",
        ),
    ];
    for (reply, reason) in replies {
        let server = UmbridgeServer::start(move |_| reply.clone());
        let service = Service::start(&["--lease-ms", "2000"]);
        let id = service.submit(&job(&server.url));
        let _worker = service.worker_of("worker", 1, &server.url);
        let status = until("the pause", || {
            let status = service.status(id);
            assert_ne!(status["state"], "finished", "{status}");
            (status["state"] == "paused").then_some(status)
        });
        let message = word(&status["message"]);
        assert!(message.contains(reason), "{reason}: {message}");
    }
}

#[test]
fn a_program_is_held_to_its_limits() {
    let service = Service::start(&["--lease-ms", "2000"]);
    let limited = short(program_job()).in_job("time_s = 20", "time_s = 0.5\nmemory_mb = 500");
    // Above 0.9 the program and a child process hang; between 0.65 and 0.9 the program takes too much memory.
    let before = "grip = runs[0][\"grip\"]\nif grip > 0.9:\n    os.system(\"sleep 60 & sleep 60\")\n\
        if 0.65 < grip < 0.9:\n    x = bytearray(10**9)";
    let path = write_program(service.folder(), &program(before));
    let id = service.submit(&limited);
    let _worker = service.worker_of("worker", 4, &path);
    let (rejected, _) = finished(&service, id);
    // About four in ten of the first draws exceed the limits, and the medians of the priors do not.
    assert!(rejected >= 5, "{rejected}");
    let mut store = service.database();
    for count in [
        "SELECT count(*) FROM evaluations WHERE rejection LIKE 'time_limit: %takes longer than 3 s'",
        "SELECT count(*) FROM evaluations WHERE rejection LIKE 'model_error: %MemoryError'",
    ] {
        assert!(store.number(count) > 0, "{count}");
    }
}

#[test]
fn a_model_that_answers_in_two_ways_is_said_once_with_the_size_of_it() {
    let server = UmbridgeServer::start(|question| {
        let Reply::Output(_) = answer(question) else {
            return answer(question);
        };
        let mut channels = super::wheel(&question.run, &question.parameters);
        channels[1] += 1e-3 * (question.number % 7) as f64;
        Reply::channels(channels)
    });
    let service = Service::start(&[]);
    let id = service.submit(&job(&server.url));
    let _workers = ["a", "b"].map(|name| service.worker_of(name, 1, &server.url));
    let (_, flags) = finished(&service, id);
    assert_eq!(
        flags.matches("the model is not deterministic").count(),
        1,
        "{flags}"
    );
    assert!(flags.contains("N m of torque"), "{flags}");
    assert!(!flags.contains("N of drawbar pull"), "{flags}");
    assert_eq!(service.metric("grouser_workers_quarantined"), 0);
}

#[test]
fn one_in_twenty_of_the_first_evaluations_is_asked_for_twice_and_equal_answers_are_no_news() {
    let server = honest();
    let service = Service::start(&[]);
    let id = service.submit(&job(&server.url));
    let _worker = service.worker_of("worker", 1, &server.url);
    let (_, flags) = finished(&service, id);
    assert!(!flags.contains("deterministic"), "{flags}");
    let summary: Value = service.result(id, "summary");
    let evaluations = whole(&summary["calibrations"][0]["evaluations"]);
    let requested = server.evaluations() / RUNS;
    // The final draws are further evaluations.
    assert!(
        requested > evaluations + evaluations / 25,
        "{requested} of {evaluations}"
    );
}
