//! The first steps of a new user: the end of the first command, as the README prints it, and the way to the page.

use farm_tests::assert_contains;
use farm_tests::http::Client;
use farm_tests::job::Job;
use farm_tests::json::word;
use farm_tests::process::Process;
use farm_tests::programs::{coordinator, run};
use farm_tests::text::same;
use farm_tests::wait::until;
use farm_tests::workspace::{root, text};
use serde_json::Value;

/// Maximum number of lines at the end of a run.
const MOST_ROWS: usize = 15;

/// Lines of a terminal of 80 columns.
fn rows(text: &str) -> usize {
    text.lines()
        .map(|line| line.chars().count().div_ceil(80).max(1))
        .sum()
}

#[test]
fn the_first_command_ends_with_what_the_readme_prints_in_fifteen_lines() {
    let folder = tempfile::tempdir().expect("a folder");
    let job = root().join("examples/hidden-effect/job.toml");
    let mut command = coordinator(["run"]);
    command.arg(job).current_dir(&folder);
    let ended = run(command);
    let (progress, printed) = (ended.stderr.clone(), ended.success());
    let readme = text(&root().join("README.md"));
    let (_, block) = readme.split_once("```text\n").expect("a block");
    let (block, _) = block.split_once("```").expect("its end");
    same(&printed, block);
    assert!(
        rows(&printed) <= MOST_ROWS,
        "{} lines:\n{printed}",
        rows(&printed)
    );
    // The last line of progress is the last line of standard error.
    let last = progress.lines().last().expect("progress");
    assert!(last.contains(" %"), "{progress}");
}

#[test]
fn runs_of_measured_data_and_of_several_models_end_in_fifteen_lines() {
    for job in ["cmu-sand/job.toml", "which-model/job.toml"] {
        let folder = tempfile::tempdir().expect("a folder");
        let job = root().join("examples").join(job);
        let mut command = coordinator(["run"]);
        command.arg(job).current_dir(&folder);
        let ended = run(command);
        let notes = ended.stderr.clone();
        let printed = ended.success();
        assert!(
            rows(&printed) <= MOST_ROWS,
            "{} lines:\n{printed}",
            rows(&printed)
        );
        for label in ["\nwrong:", "\nmissing:", "\nnext:", "\nfiles:", "\npage:"] {
            assert!(printed.contains(label), "{label} in\n{printed}");
        }
        // Notes are broken between words, and not by the terminal.
        let noted = notes.lines().filter(|line| !line.contains(" %"));
        for line in noted {
            assert!(line.chars().count() <= 80, "{line}");
        }
    }
}

#[test]
fn the_command_that_a_run_ends_with_opens_its_study() {
    let folder = tempfile::tempdir().expect("a folder");
    let job = Job::small().write(&folder.path().join("job"));
    let mut command = coordinator(["run", "--out", "my rig/it's"]);
    command.arg(job).current_dir(&folder);
    let printed = run(command).success();
    let last = printed.lines().last().expect("a last line");
    let serve = last.strip_prefix("page:    coordinator ").expect("the command");
    // The shell of the user finds the program on its path.
    let program = coordinator(["--version"]).get_program().to_owned();
    let mut shell = std::process::Command::new("sh");
    shell
        .arg("-c")
        .arg(format!("exec \"$0\" {serve} --listen 127.0.0.1:0"));
    shell.arg(program).current_dir(&folder);
    let log = folder.path().join("serve.log");
    let service = Process::start(shell, &log);
    let address = until("the address to open", || {
        let output = service.log();
        let line = output
            .lines()
            .find_map(|line| line.strip_prefix("open http://"))?;
        Some(line.to_owned())
    });
    let client = Client(address);
    let page = client.get("/");
    assert!(page.status == 200, "{}", page.body);
    assert!(page.body.contains("Grouser"), "{}", page.body);
    assert_eq!(client.json("/v1/studies")[0]["name"], "job");
}

#[test]
fn a_study_that_fails_says_why_and_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    // Soil that is as soft as water carries no wheel.
    let job = Job::small().in_job(
        "log10_p_ref = { uniform = [4.0, 5.6] }",
        "log10_p_ref = { uniform = [1.1, 1.6] }",
    );
    let path = job.write(&folder.path().join("job")).display().to_string();
    let out = folder.path().join("out").display().to_string();
    let refusal = run(coordinator(["run", &path, "--out", &out])).refusal();
    assert_contains!(
        refusal,
        "calibration job failed: all 60 prior draws were rejected by the model: the soil does not carry the load (no_support, ",
        "the soil carries at most",
        "check wheel loads, radius and width"
    );
    let service =
        farm_tests::service::Service::start_on(&format!("sqlite://{out}/grouser.db"), &["--read-only"]);
    let study = service.client.json("/v1/studies/1");
    assert_eq!(study["state"], "failed");
    let reported = word(&study["failure"]["text"]);
    assert!(refusal.starts_with(reported), "{reported}\n{refusal}");
    let listed = until("the list", || {
        let listed = service.client.json("/v1/studies")[0]["failure"].clone();
        (listed != Value::Null).then_some(listed)
    });
    assert_eq!(listed, study["failure"]);
}
