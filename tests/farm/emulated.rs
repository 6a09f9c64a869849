//! Stages on an emulator give the same bytes on any workers, and after any kill of the coordinator.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs;
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::wait::until;
use serde_json::Value;

fn job() -> Job {
    Job::small().in_job("moves = [2, 4]", "stages = \"emulated\"\nbatch = 10")
}

/// Returns the posterior, and what the summary says of the emulator.
fn finished(service: &Service, id: i64) -> (String, Value) {
    service.wait_for(id, "finished");
    let summary = service.result(id, "summary");
    (
        service.posterior_csv(id),
        summary["calibrations"][0]["emulator"].clone(),
    )
}

#[test]
fn emulated_stages_give_the_same_bytes_on_any_worker_and_over_a_restart() {
    let alone = Service::start(&[]);
    let id = alone.submit(&job());
    let _worker = alone.worker("alone", 1);
    let (expected, emulator) = finished(&alone, id);
    assert_eq!(emulator["fell_back"], false, "{emulator}");
    // Four parameters: fifty evaluations for each and two more, and 200 final draws.
    let evaluations = emulator["evaluations"].as_u64().expect("a count");
    assert!((200..500).contains(&evaluations), "{emulator}");
    assert!(
        emulator["effective_share"].as_f64().expect("a share") > 0.6,
        "{emulator}"
    );
    assert!(
        emulator["error_sigma"].as_f64().expect("an error") < 0.1,
        "{emulator}"
    );

    let mut service = Service::start(&["--lease-ms", "500", "--verify-percent", "20"]);
    let id = service.submit(&job());
    let _workers = ["a", "b"].map(|name| service.worker(name, 2));
    for evaluations in [20, 60, 110] {
        until("progress", || {
            let status = service.status(id);
            (status["progress"]["evaluations"].as_u64()? >= evaluations || status["state"] == "finished")
                .then_some(())
        });
        service.crash();
    }
    let (posterior, again) = finished(&service, id);
    same(&posterior, &expected);
    assert_eq!(again, emulator);
}

#[test]
fn a_batch_belongs_to_an_emulator() {
    let folder = tempfile::tempdir().unwrap();
    let path = Job::small()
        .in_job("moves = [2, 4]", "batch = 10")
        .write(folder.path());
    let error = programs::run(programs::coordinator(["check".as_ref(), path.as_os_str()])).refusal();
    assert_contains!(error, "batch = 10 belongs to stages = \"emulated\"");
}
