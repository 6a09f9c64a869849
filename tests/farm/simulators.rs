//! Exports for simulators: lookup tables, the co-simulation unit, files of Project Chrono. `tests/fmu` opens them in other programs.

use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use farm_tests::workspace::text;
use serde_json::Value;

#[test]
fn a_calibration_is_exported_for_simulators() {
    let folder = tempfile::tempdir().expect("a folder");
    let job = Job::small()
        .write(&folder.path().join("job"))
        .display()
        .to_string();
    let out = folder.path().join("out").display().to_string();
    run(coordinator(["run", &job, "--out", &out])).success();
    let file = |name: &str| folder.path().join(name).display().to_string();
    let export = |words: &[&str]| run(coordinator([&["export", "1", "--out", &out], words].concat()));

    // A table has a row for each point of its grid, and the numbers of predict.
    let grid = ["--grid", "slip=0.1:0.5:3", "--grid", "wheel_load_n=60:120:2"];
    let table = file("table.csv");
    export(&[&["--format", "table", "--output", &table][..], &grid].concat()).success();
    let table = text(Path::new(&table));
    let mut lines = table.lines();
    let titles: Vec<&str> = lines.next().expect("titles").split(',').collect();
    assert_eq!(titles[..3], ["slip", "wheel_load_n", "drawbar_pull_n"]);
    assert_eq!(lines.clone().count(), 6);
    let first: Vec<&str> = lines.next().expect("a row").split(',').collect();
    let at = ["--at", "slip=0.1", "--at", "wheel_load_n=60"];
    let predicted = run(coordinator(
        [&["predict", "1", "--out", &out, "--format", "json"][..], &at].concat(),
    ));
    let predicted: Value = serde_json::from_str(&predicted.success()).expect("JSON");
    assert_eq!(
        predicted["runs"][0]["quantities"][0]["mean"].to_string(),
        first[2]
    );
    for (words, reason) in [
        (&["--output", "t.csv"][..], "--grid is missing"),
        (&["--grid", "slip=0:0.5:3"][..], "--output is missing"),
        (
            &["--grid", "slip=0:0.5:3", "--output", "t.mat"][..],
            "must end with .csv or .npz",
        ),
        (
            &[
                "--grid",
                "slip=0:0.5:200",
                "--grid",
                "wheel_load_n=1:9:200",
                "--output",
                "t.csv",
            ][..],
            "40000 must be at most 10000",
        ),
    ] {
        let refused = export(&[&["--format", "table"][..], words].concat()).refusal();
        assert_contains!(refused, reason);
    }

    // The soil of Chrono has the units of Bekker's equation, and the rig the speed of the slip.
    let chrono = folder.path().join("chrono");
    export(&[
        "--format",
        "chrono",
        "--output",
        &chrono.display().to_string(),
        "--at",
        "slip=0.2",
        "--at",
        "sled_speed_m_s=0.02",
    ])
    .success();
    let soil: Value = serde_json::from_str(&text(&chrono.join("soil.json"))).expect("JSON");
    let soil = &soil["Soil Parameters"];
    let friction = soil["Mohr Friction"].as_f64().expect("degrees");
    assert!((15.0..37.0).contains(&friction), "{soil}");
    let pressure = soil["Bekker Kphi"].as_f64().expect("a modulus")
        * 0.01_f64.powf(soil["Bekker n"].as_f64().expect("n"));
    assert!((1e4..4e5).contains(&pressure), "{soil}");
    let draws = text(&chrono.join("draws.csv"));
    assert_contains!(
        draws,
        "Bekker Kphi,Bekker Kc,Bekker n,Mohr Cohesion,Mohr Friction,Janosi Shear"
    );
    assert!(draws.lines().count() > 20);
    let rig = text(&chrono.join("rig.yaml"));
    let speeds: Vec<f64> = rig
        .lines()
        .filter_map(|line| line.trim().strip_prefix("value: ")?.parse().ok())
        .collect();
    // The rim of 0.125 m turns at 0.02 / (1 - 0.2) m/s.
    assert!(speeds.len() == 2 && (speeds[0] - 0.02).abs() < 1e-12, "{rig}");
    assert!((speeds[1] - 0.2).abs() < 1e-12, "{rig}");

    // The unit is an archive with the library that is built beside the program.
    let unit = file("wheel.fmu");
    export(&["--format", "fmu", "--output", &unit]).success();
    let bytes = std::fs::read(&unit).expect("the unit");
    assert!(bytes.starts_with(b"PK"));
    let again = file("again.fmu");
    export(&["--format", "fmu", "--output", &again]).success();
    assert!(
        bytes == std::fs::read(&again).expect("the unit"),
        "the same bytes from the same calibration"
    );
}

#[test]
fn a_service_gives_the_model_with_its_draws() {
    let service = Service::start(&["--local-workers", "2"]);
    let id = service.submit(&Job::small());
    service.wait_for(id, "finished");
    let model = service.result(id, "drawn-model?slip=0.3&wheel_load_n=77");
    assert_eq!(model["variant"]["conditions"][0]["slip"], 0.3);
    assert_eq!(model["variant"]["conditions"][0]["wheel_load_n"], 77.0);
    assert_eq!(model["variant"]["parameters"].as_array().map(Vec::len), Some(4));
    assert!(model["draws"].as_array().is_some_and(|draws| draws.len() > 20));
    assert_eq!(
        model["model_version"].as_str(),
        Some(service.model_version().as_str())
    );
    for (query, status, reason) in [
        ("drawn-model?slip=2", 422, "slip 2 must lie in [-1, 1)"),
        ("drawn-model?wheel=x", 422, "unknown wheel"),
        ("drawn-model?slop=2", 400, "slop"),
    ] {
        let refused = service.part(id, query);
        assert_eq!(refused.status, status, "{}", refused.body);
        assert_contains!(refused.body, reason);
    }
}
