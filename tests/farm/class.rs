//! A campaign whose runs cannot distinguish two effects: the printed conclusion before and after one of them is added.

use farm_tests::assert_contains;
use farm_tests::json::word;
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use farm_tests::wait::until;
use farm_tests::workspace::{root, text};
use serde_json::Value;

const RIVAL: &str = "slip_softened_pressure (P 0.46) in place of slip_sinkage cannot be excluded";
const RUN: &str = "slip 0.80 under 280 N at 5.80 mm/s";

/// Returns a text without its line breaks.
fn joined(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn the_rival_of_an_added_effect_and_the_run_that_decides_are_said_until_it_is_decided() {
    let folder = tempfile::tempdir().expect("a folder");
    let job = root()
        .join("tests/data/one-of-a-class/job.toml")
        .display()
        .to_string();
    let out = folder.path().join("out").display().to_string();
    let go = |words: &[&str]| run(coordinator(words.iter().copied().chain(["--out", &out]))).success();
    let before = joined(&go(&["run", &job]));
    assert_contains!(
        before,
        "missing: one of slip_sinkage (0.54), slip_softened_pressure (0.46) is missing",
        "coordinator add-runs 1 new-runs.csv"
    );
    let after = joined(&go(&["extend", "1", "--effect", "slip_sinkage"]));
    assert_contains!(
        after,
        "missing: slip_sinkage (P 0.54) is added: held-out error from 1.5 to 1.1 times the noise",
        RIVAL,
        "next: run the wheel at slip 0.80 under 280 N at 5.80 mm/s, which tells",
        "coordinator add-runs 1 new-runs.csv"
    );
    assert!(!after.contains("by hand"), "{after}");
    let report = text(&folder.path().join("out/report.html"));
    assert!(report.contains(RIVAL) && report.contains(RUN));
    let service = Service::start_on(&format!("sqlite://{out}/grouser.db"), &["--read-only"]);
    let listed = until("the verdict in the list", || {
        let verdict = service.client.json("/v1/studies")[0]["verdict"].clone();
        (verdict != Value::Null).then_some(verdict)
    });
    for verdict in [listed, service.client.json("/v1/studies/1")["verdict"].clone()] {
        assert_eq!(verdict["verdict"], "nothing_detectable", "of the extended model");
        for key in ["open", "text"] {
            let reported = word(&verdict[key]);
            assert!(
                reported.contains(RIVAL) && reported.contains(RUN),
                "{key}: {reported}"
            );
        }
    }
}
