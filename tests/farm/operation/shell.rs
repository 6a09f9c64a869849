//! Completions and man pages of both programs.

use farm_tests::assert_contains;
use farm_tests::programs::{coordinator, run, worker};

#[test]
fn every_shell_is_given_completions_that_name_the_commands() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let text = run(coordinator(["completions", shell])).success();
        assert_contains!(text, "add-runs", "doctor", "export");
        assert!(run(worker(["completions", shell])).success().contains("simulate"));
    }
}

#[test]
fn every_command_has_a_man_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let name = folder.path().join("man1").display().to_string();
    run(coordinator(["man", &name])).success();
    run(worker(["man", &name])).success();
    let entries = std::fs::read_dir(&name).expect("the folder");
    let names: Vec<String> = entries
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    for page in [
        "coordinator.1",
        "coordinator-export.1",
        "coordinator-token-add.1",
        "worker.1",
        "worker-simulate.1",
    ] {
        assert!(
            names.iter().any(|name| name == page),
            "{page} is not in {names:?}"
        );
    }
    let page = std::fs::read_to_string(format!("{name}/coordinator-export.1")).expect("a page");
    assert_contains!(page, ".TH", "netcdf");
}
