//! Published rigs in the form of docs/exchange.md: each is read, cited and called digitised, and an effect that it shows leads.

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::json::float;
use farm_tests::programs::{coordinator, run, study};
use farm_tests::workspace::{root, text};
use serde_json::Value;

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
fn the_digging_of_a_wheel_leads_without_a_name_on_five_digitised_points() {
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
    let discovery = &summary["discovery"];
    assert_eq!(discovery["verdict"], "undecided");
    let effects = discovery["effects"].as_array().expect("explanations");
    let digging = effects.iter().find(|effect| effect["name"] == "slip_digging");
    let probability = float(&digging.expect("the digging")["probability"]);
    assert!((0.8..0.9).contains(&probability), "{probability}");
    let digging = rashid().in_job(
        "kind = \"quasi_static\"",
        "kind = \"quasi_static\"\neffects = [\"slip_digging\"]",
    );
    let sinkage = |summary: &Value| float(&summary["calibrations"][0]["error"]["fit"]["sinkage"]["rmse"]);
    let (_, with_digging) = study(&digging);
    assert!(sinkage(&summary) > 0.004 && sinkage(&with_digging) < 0.001);
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
