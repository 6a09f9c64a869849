//! Who may run which model, and which version of it a calibration is pinned to.

use farm_tests::assert_contains;
use farm_tests::programs;
use farm_tests::service::Service;
use farm_tests::wait::{until, until_true};

use super::{honest, job, program, program_job, short, write_program};

#[test]
fn a_worker_runs_nothing_that_its_operator_has_not_allowed_and_says_so() {
    let service = Service::start(&[]);
    let mark = service.folder().join("started");
    let text = program(&format!("open({:?}, \"w\").close()", mark.display().to_string()));
    write_program(service.folder(), &text);
    let id = service.submit(&program_job());
    let worker = service.worker("worker", 1);
    until_true("a word of the worker", || {
        let log = worker.log();
        log.contains("is of the model wheel.py") && log.contains("--allow-model")
    });
    assert_eq!(service.metric("grouser_leases_given_total"), 0);
    assert!(!mark.exists());
    assert_eq!(service.status(id)["state"], "queued");
}

#[test]
fn another_version_gets_no_lease_and_a_run_refuses_to_go_on_with_it() {
    let server = honest();
    let mut service = Service::start(&["--lease-ms", "1000"]);
    // The calibration is long enough to be interrupted.
    let id = service.submit(&job(&server.url).in_job("particles = 60", "particles = 2000"));
    let worker = service.worker_of("worker", 1, &server.url);
    until("progress", || service.evaluations(id).filter(|done| *done > 20));
    let pinned = service.status(id)["model_version"]
        .as_str()
        .unwrap_or_default()
        .to_owned();
    assert!(pinned.starts_with("umbridge-"), "{pinned}");
    assert!(pinned.ends_with("+version.1"), "{pinned}");
    server.change_version();
    let refusal = "was begun with model version umbridge-";
    until_true("a word of the worker", || worker.log().contains(refusal));
    let done = service.evaluations(id);
    service.crash();
    until_true("a word of the worker", || {
        worker.log().matches(refusal).count() > 1
    });
    // Results of evaluations that the worker still held do not count.
    assert_eq!(service.evaluations(id), done);
}

#[test]
fn a_folder_needs_the_program_that_its_job_names() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write_program(folder.path(), &program(""));
    let job = short(program_job())
        .write(&folder.path().join("job"))
        .display()
        .to_string();
    let out = folder.path().join("out").display().to_string();
    let run = |more: &[&str]| {
        let arguments = ["run", &job, "--out", &out]
            .into_iter()
            .chain(more.iter().copied());
        programs::run(programs::coordinator(arguments))
    };
    let message = run(&[]).refusal();
    assert_contains!(message, "this worker does not run wheel.py");
    let first = run(&["--allow-model", &path]).success();
    assert_eq!(
        run(&["--allow-model", &path]).success().lines().last(),
        first.lines().last()
    );
    let message = run(&["--allow-model", "nowhere.py"]).refusal();
    assert_contains!(message, "--allow-model nowhere.py: no such file");
}
