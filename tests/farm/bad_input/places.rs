//! Stores, folders, ports and URLs that cannot be used.

use std::net::TcpListener;
use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{Ended, call, coordinator, line, run, worker};
use farm_tests::service::{Service, free_address};
use farm_tests::workspace::data;

fn serve(store: &str) -> Ended {
    call(
        "coordinator serve --listen {} --store {}",
        &[&free_address(), &store],
    )
}

fn text(path: &Path) -> String {
    path.display().to_string()
}

#[test]
fn a_store_that_is_not_sqlite_is_refused_and_untouched() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("notes.txt");
    let notes = "These are notes, not a database. ".repeat(100);
    std::fs::write(&store, &notes).unwrap();
    let message = serve(&format!("sqlite://{}", store.display())).refusal();
    assert!(
        message == format!("store {}: the file is not an SQLite database", store.display()),
        "{message}"
    );
    assert_eq!(std::fs::read_to_string(&store).unwrap(), notes);
    assert_eq!(
        std::fs::read_dir(folder.path()).unwrap().count(),
        1,
        "something lies beside the notes"
    );
    for verb in ["list", "status", "export"] {
        let out = folder.path().join("folder");
        std::fs::create_dir_all(&out).unwrap();
        std::fs::copy(&store, out.join("grouser.db")).unwrap();
        let message = run(coordinator([verb, "--out", &text(&out)])).refusal();
        assert_contains!(message, "grouser.db", "not an SQLite database");
    }
}

#[test]
fn a_store_in_a_place_that_cannot_be_written_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing").join("grouser.db");
    let message = serve(&format!("sqlite://{}", missing.display())).refusal();
    assert_contains!(message, &text(&missing), "No such file");
    assert!(!missing.parent().unwrap().exists());

    let directory = folder.path().join("directory");
    std::fs::create_dir(&directory).unwrap();
    let message = serve(&format!("sqlite://{}", directory.display())).refusal();
    assert_eq!(message, format!("store {}: this is no file", directory.display()));

    let file = folder.path().join("file");
    std::fs::write(&file, "not a folder").unwrap();
    let job = text(&Job::small().write(&folder.path().join("job")));
    let message = run(coordinator(["run", &job, "--out", &text(&file)])).refusal();
    assert_contains!(message, &format!("--out {}", file.display()));
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "not a folder");
}

#[test]
fn a_second_coordinator_on_a_store_is_turned_away() {
    let service = Service::start(&[]);
    let id = service.submit(&Job::small());
    let message = serve(&format!("sqlite://{}", service.store().display())).refusal();
    assert_contains!(
        message,
        "another coordinator is using this file",
        text(&service.store())
    );
    assert_eq!(service.status(id)["state"], "queued");
}

#[test]
fn a_port_in_use_is_named_and_nothing_is_written() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = taken.local_addr().unwrap().to_string();
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("grouser.db");
    let served = line(
        "coordinator serve --listen {} --store {}",
        &[&address, &format!("sqlite://{}", store.display())],
    );
    let message = run(served).refusal();
    assert!(message.starts_with(&format!("--listen {address}: ")), "{message}");
    assert!(message.contains("in use"), "{message}");
    assert!(!store.exists());

    let job = text(&Job::small().write(&folder.path().join("job")));
    let out = folder.path().join("out");
    let message = call(
        "coordinator run {} --listen {} --out {}",
        &[&job, &address, &text(&out)],
    )
    .refusal();
    assert!(message.starts_with(&format!("--listen {address}: ")), "{message}");
    assert!(!out.exists());
}

#[test]
fn a_url_that_leads_nowhere_is_named() {
    let nobody = format!("http://{}", free_address());
    let message = run(coordinator(["list", "--url", &nobody])).refusal();
    assert_contains!(message, format!("no answer from {nobody}"));
    for (url, what) in [
        ("not a url", "not a url"),
        ("ftp://127.0.0.1:7070", "scheme ftp is not http"),
    ] {
        let message = run(coordinator(["status", "1", "--url", url])).refusal();
        assert_contains!(message, what);
        let message = run(worker(["--coordinator", url])).refusal();
        assert_contains!(message, what);
    }
}

#[test]
fn an_address_of_something_else_is_told_from_a_coordinator() {
    let service = Service::start(&[]);
    let elsewhere = format!("{}/elsewhere", service.url());
    let message = run(worker(["--coordinator", &elsewhere])).refusal();
    assert_contains!(message, "is not a Grouser coordinator", &elsewhere);
}

#[test]
fn a_calibration_that_is_not_there_or_not_ready_is_named() {
    let service = Service::start(&[]);
    let verb = |words: &[&str]| run(coordinator(words.iter().chain(&["--url", &service.url()]))).refusal();
    assert_eq!(verb(&["status"]), "there is no calibration");
    let id = service.submit(&Job::small());
    assert_eq!(verb(&["status", "77"]), "there is no calibration 77");
    assert_eq!(verb(&["cancel", "77"]), "there is no calibration 77");
    for words in [
        ["compare", "1"],
        ["diagnose", "1"],
        ["report", "1"],
        ["export", "1"],
    ] {
        assert_eq!(
            verb(&words),
            "calibration 1 is queued; results are available when it is finished"
        );
    }
    assert_eq!(
        verb(&["resume", "1"]),
        "calibration 1 is queued; it cannot be resumed"
    );
    service.submit(&Job::small());
    assert_eq!(verb(&["status"]), "there are 2 calibrations: name one by its id");
    assert_eq!(service.status(id)["state"], "queued");
    let folder = tempfile::tempdir().unwrap();
    let message = run(coordinator(["status", "--out", &text(folder.path())])).refusal();
    assert_contains!(message, "grouser.db", "no such file");
}

#[test]
fn a_job_that_is_refused_is_not_half_submitted() {
    let service = Service::start(&[]);
    let folder = tempfile::tempdir().unwrap();
    let path = text(&Job::small().sampler(9, [2, 4], 1).write(folder.path()));
    let message = run(coordinator(["submit", &path, "--url", &service.url()])).refusal();
    assert_contains!(message, "9 particles are too few");
    // The refused job has stored no experiment, so that the next one is the first.
    let created = service
        .client
        .post("/v1/experiments", &Job::small().experiment_json());
    assert_eq!(created.json()["id"], 1);
}

#[test]
fn output_that_nobody_reads_any_more_is_no_panic() {
    let folder = tempfile::tempdir().unwrap();
    let job = text(&Job::small().write(&folder.path().join("job")));
    let out = text(&folder.path().join("out"));
    run(coordinator(["run", &job, "--out", &out, "--local-workers", "1"])).success();
    for words in [vec!["export", "--format", "json"], vec!["compare"], vec!["list"]] {
        let mut command = coordinator(words.iter().copied().chain(["--out", &out]));
        command
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped());
        let mut child = command.spawn().unwrap();
        drop(child.stdout.take());
        let ended = child.wait_with_output().unwrap();
        let output = String::from_utf8_lossy(&ended.stderr);
        assert!(!output.contains("panicked"), "{words:?}: {output}");
    }
}

/// `worker simulate` on the data with one of its files replaced.
fn simulate(model: &str, parameters: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str, content: &str| {
        std::fs::write(folder.path().join(name), content).expect("a file");
        text(&folder.path().join(name))
    };
    let (model, parameters) = (file("model.toml", model), file("theta.toml", parameters));
    let out = folder.path().join("runs.csv");
    let mut command = worker(["simulate", &text(&data("nothing-hidden/experiment.toml"))]);
    command.args([
        "--model",
        &model,
        "--parameters",
        &parameters,
        "--out",
        &text(&out),
    ]);
    let message = run(command).refusal();
    assert!(!out.exists(), "{message}");
    message.replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn forward_runs_refuse_wrong_models_and_parameters() {
    let model = "kind = \"quasi_static\"\n";
    let theta = farm_tests::workspace::text(&data("nothing-hidden/parameters.toml"));
    let without = |name: &str| {
        let lines = theta.lines().filter(|line| !line.starts_with(name));
        lines.map(|line| format!("{line}\n")).collect::<String>()
    };
    assert_eq!(
        simulate("", &theta),
        "model.toml: kind is missing: one of \"quasi_static\", \"scm\", \"wong_reece\", \"rft\", \"command\", \"umbridge\""
    );
    assert_eq!(
        simulate("kind = \"quasi-static\"\n", &theta),
        "model.toml: unknown kind \"quasi-static\"; the nearest known is \"quasi_static\""
    );
    assert_eq!(
        simulate("kind = \"quasi_static\"\ndem_spacing_m = 0.004\n", &theta),
        "model.toml: dem_spacing_m: quasi_static has no terrain of nodes; use kind = \"scm\""
    );
    assert_eq!(
        simulate("kind = \"quasi_static\"\nflow_fraction = 0.5\n", &theta),
        "theta.toml: flow_fraction: quasi_static has no terrain that deforms; use kind = \"scm\""
    );
    assert_eq!(
        simulate("kind = \"scm\"\ntravel_step_m = -1\n", &theta),
        "model.toml: travel_step_m -1 m must be > 0 m"
    );
    assert_eq!(
        simulate(model, &without("n =")),
        "theta.toml: parameter n has neither a prior nor a fixed value"
    );
    assert_eq!(
        simulate(model, &without("k_c")),
        "theta.toml: the stiffness needs k_c and k_phi, or log10_p_ref and kappa"
    );
    let with = |line: &str| format!("{}{line}\n", without("n ="));
    assert_eq!(
        simulate(model, &with("n = -1.0")),
        "theta.toml: n = -1 lies outside [0.01, 10]"
    );
    assert_eq!(
        simulate(model, &(theta.clone() + "kapa = 1.0\n")),
        "theta.toml: unknown parameter \"kapa\"; the nearest known is \"kappa\""
    );
    let output = simulate(model, &with("n = \"one\""));
    assert!(output.starts_with("theta.toml line 8: "), "{output}");
    // The model rejects soil that cannot carry the wheel, and the message names the run.
    let soft = without("k_phi") + "k_phi = 1.0\n";
    let output = simulate(model, &soft);
    assert!(
        output.starts_with("run r00: the model rejects these parameters: "),
        "{output}"
    );
}

#[test]
fn noise_of_an_unknown_sd_and_histories_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let job = Job::small().in_experiment("torque_n_m = 0.15", "torque_n_m = \"unknown\"");
    job.write(folder.path());
    let simulate = |more: &[&str]| {
        let mut command = worker(["simulate", &text(&folder.path().join("experiment.toml"))]);
        command.args(["--model", &text(&data("nothing-hidden/model.toml"))]);
        command.args(["--parameters", &text(&data("nothing-hidden/parameters.toml"))]);
        command.arg("--out").arg(folder.path().join("out.csv")).args(more);
        run(command).refusal()
    };
    let message = simulate(&["--noise-seed", "1"]);
    assert_contains!(
        message,
        "experiment.toml: --noise-seed needs a number for [noise] torque_n_m"
    );
    let message = simulate(&["--histories", &text(folder.path())]);
    assert_contains!(message, "--histories: quasi_static has only a steady state");
    assert!(!folder.path().join("out.csv").exists());
}

#[test]
fn settings_in_the_environment_do_not_forbid_other_choices() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = coordinator(["list", "--out", &text(folder.path())]);
    command.env("GROUSER_URL", "http://127.0.0.1:7070");
    let message = run(command).refusal();
    assert_contains!(message, "grouser.db", "no such file");
    // The two options exclude each other on the command line.
    let message = call(
        "coordinator list --out {} --url http://127.0.0.1:7070",
        &[&text(folder.path())],
    )
    .refusal();
    assert_contains!(message, "--out", "--url");
}

#[test]
fn a_coordinator_in_the_environment_does_not_forbid_forward_runs() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = worker(["simulate", &text(&data("nothing-hidden/experiment.toml"))]);
    command.args(["--model", &text(&data("nothing-hidden/model.toml"))]);
    command.args(["--parameters", &text(&data("nothing-hidden/parameters.toml"))]);
    command.arg("--out").arg(folder.path().join("out.csv"));
    command.env("GROUSER_COORDINATOR", "http://127.0.0.1:7070");
    run(command).success();
}
