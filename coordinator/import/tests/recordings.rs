//! Runs cut from one long recording.

use std::fmt::Write;

use super::{complaints, converted};

/// Returns two runs of 4 s at 10 Hz with a pause between; the pull settles after 1 s.
fn recording() -> String {
    let mut text = "t [ms];marker;slip [%];load [N];v [mm/s];pull [N];rpm\n".to_owned();
    let mut t_ms = 5000;
    for (marker, slip, pull) in [("A", 20, 30.0), ("0", 0, 0.0), ("B", 40, 50.0)] {
        for k in 0..40 {
            let start = if k < 10 { 7.0 } else { 0.0 };
            let _ = writeln!(text, "{t_ms};{marker};{slip};100;8;{};3", pull + start);
            t_ms += 100;
        }
    }
    text
}

const MAP: &str = r#"
[recording]
time = "t [ms]"
time_unit = "ms"
marker = "marker"
between = ["0"]
window_s = [1, 3.9]

[columns]
wheel = { value = "w" }
soil = { value = "s" }
slip = { column = "slip [%]" }
wheel_load_n = { column = "load [N]" }
sled_speed_m_s = { column = "v [mm/s]" }
drawbar_pull_n = { column = "pull [N]" }
"#;

#[test]
fn a_window_of_each_run_is_averaged() {
    let result = converted("log.csv", recording().as_bytes(), MAP);
    assert_eq!(result.complaints, []);
    assert_eq!(
        result.runs.as_deref(),
        Some(
            "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n\nA,w,s,0.2,100,0.008,30\nB,w,s,0.4,100,0.008,50\n"
        )
    );
    assert_eq!(
        result.remarks[0],
        "40 of 120 rows lie between runs and are left out"
    );
}

#[test]
fn histories_are_those_that_the_program_reads() {
    let map = MAP.replace("between", "histories = true\nbetween");
    let result = converted("log.csv", recording().as_bytes(), &map);
    let runs = result.runs.unwrap();
    assert_eq!(
        runs,
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,history\nA,w,s,0.2,100,0.008,runs-A.csv\nB,w,s,0.4,100,0.008,runs-B.csv\n"
    );
    assert!(result.histories["runs-B.csv"].starts_with("t_s,drawbar_pull_n\n0.1,57\n0.2,57\n"));
    let mut files = result.histories.clone();
    files.insert("runs.csv".into(), runs);
    let toml = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.1\n[soil.s]\n[noise]\ndrawbar_pull_n = 1.0\n[protocol]\nmeasured_transient_s = 1.0\nlowpass_hz = 0.0\n";
    let read = shared::experiment::Experiment::parse(
        "experiment.toml",
        &shared::file::FileSet {
            toml: toml.into(),
            files,
        },
    )
    .unwrap();
    let pull = read.runs[1].measured[0].unwrap();
    assert!((pull - 50.0).abs() < 1e-9, "{pull}");
}

#[test]
fn a_marker_that_counts_on_and_off_numbers_the_runs() {
    let text = recording().replace(";A;", ";1;").replace(";B;", ";1;");
    let result = converted("log.csv", text.as_bytes(), MAP);
    assert!(result.runs.unwrap().contains("\n1-2,w,s,0.4,"));
    assert_eq!(
        result.remarks[1],
        "the marker \"1\" comes 2 times: its runs are named 1-1 to 1-2"
    );
}

#[test]
fn what_is_wrong_with_a_recording_has_its_line() {
    let map = MAP
        .replace("between", "histories = true\nbetween")
        .replace("3.9]", "4.5]");
    let text = recording().replace("13200;B;40;100;8;57", "13200;B;40;100;8;");
    let messages = complaints("log.csv", text.as_bytes(), &map).join("\n");
    for part in [
        "log.csv line 2: run \"A\" lasts 3.900000 s, and window_s ends at 4.5 s",
        "log.csv line 84, column \"pull [N]\": drawbar pull is blank within a run",
    ] {
        assert!(messages.contains(part), "{part} in\n{messages}");
    }
    let messages = complaints(
        "log.csv",
        recording().as_bytes(),
        &MAP.replace("\"marker\"", "\"Marke\""),
    );
    assert!(
        messages[0].ends_with("no column has the title \"Marke\"; did you mean \"marker\""),
        "{messages:?}"
    );
}
