//! Published rigs in the form of docs/exchange.md: each is read, cited and called digitised, and an effect that it shows is named.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::float;
use farm_tests::programs::{coordinator, run, study};
use farm_tests::workspace::{root, text};

const JOBS: [&str; 4] = [
    "ding-2011/job.toml",
    "kls-1/job.toml",
    "kls-1/by-hand.toml",
    "rashid-1/job.toml",
];

fn rashid() -> Job {
    Job::example("other-rigs/rashid-1")
}

#[test]
fn each_rig_passes_check_which_cites_it_and_says_that_it_is_digitised() {
    for job in JOBS {
        let path = root().join("examples/other-rigs").join(job);
        let printed = run(coordinator(["check".as_ref(), path.as_os_str()])).success();
        // A line is broken between words.
        let printed: Vec<&str> = printed.split_whitespace().collect();
        let printed = printed.join(" ");
        assert_contains!(
            printed,
            "data: ",
            "doi:10.",
            "digitised, not as recorded by the rig",
            "doubt: "
        );
    }
}

#[test]
fn the_digging_of_a_wheel_is_named_from_five_digitised_points() {
    let (printed, summary) = study(&rashid());
    let campaign = &summary["campaign"];
    assert_eq!(campaign["doi"], "10.1007/s11214-025-01164-8");
    assert_eq!(campaign["digitised"], true);
    assert_contains!(printed, "digitised, not as recorded by the rig");
    let head = |word: &str| {
        printed
            .lines()
            .any(|line| line.starts_with("run ") && line.contains(word))
    };
    assert!(head(" digitised ") && !head(" measured "), "{printed}");
    let ledger = summary["calibrations"].as_array().expect("a ledger");
    let effects: Vec<_> = ledger.iter().map(|line| &line["effects"]).collect();
    assert_eq!(
        effects,
        [&serde_json::json!([]), &serde_json::json!(["slip_digging"])]
    );
    let sinkage = |line: usize| float(&ledger[line]["error"]["fit"]["sinkage"]["rmse"]);
    assert!(sinkage(0) > 0.004 && sinkage(1) < 0.001, "{ledger:?}");
}

#[test]
fn rows_that_the_rig_recorded_are_not_called_digitised() {
    let job = rashid()
        .in_experiment("digitised = true", "digitised = false")
        .in_job("apply = \"auto\"", "apply = \"off\"");
    let (printed, summary) = study(&job);
    assert_eq!(summary["campaign"]["digitised"], false);
    assert!(printed.contains("source: figures 5 and 6"), "{printed}");
    assert!(!printed.contains("digitised"), "{printed}");
}

#[test]
fn the_template_of_the_document_passes_check() {
    let document = text(&root().join("docs/exchange.md"));
    let block = |opening: &str| {
        let (_, rest) = document.split_once(&format!("\n{opening}")).expect("a block");
        let (block, _) = rest.split_once("\n```").expect("its end");
        format!("{opening}{block}\n").replacen("```text\n", "", 1)
    };
    let job = Job {
        experiment: block("runs = \"runs.csv\""),
        runs: block("```text\nrun,"),
        job: block("experiment = \"experiment.toml\""),
        attached: Vec::new(),
    };
    let folder = tempfile::tempdir().expect("a folder");
    let path = job.write(folder.path());
    let printed = run(coordinator(["check".as_ref(), path.as_os_str()])).success();
    assert!(
        printed.starts_with("data:    Drawbar pull, torque and sinkage"),
        "{printed}"
    );
    assert_contains!(printed, "\n6 fit runs with 18 measurements");
}
