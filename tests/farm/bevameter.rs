//! `worker simulate` on plates and rings, against the closed forms.

use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::json::float;
use farm_tests::programs::{coordinator, run, worker};
use farm_tests::workspace::{root, text};

const EXPERIMENT: &str = r#"plates = "plates.csv"
shear = "shear.csv"
[soil.s]
"#;
const PLATES: &str = "# b in metres
test,plate_radius_m,sinkage_m,pressure_pa
big,0.05,0.01,
small,0.02,0.01,1
small,0.02,0,
";
const SHEAR: &str = "test,normal_stress_pa,shear_displacement_m,shear_stress_pa
r1,20000,0.012,
r1,20000,0,
r2,5000,0.03,
";
const THETA: &str = r#"k_c = 2e4
k_phi = 1e7
n = 1.0
friction_angle_deg = 30.0
cohesion_pa = 500.0
"janosi_hanamoto.shear_modulus_m" = 0.012
"#;

/// Writes the files; the arguments of `worker simulate` up to the tables.
fn command(folder: &Path, experiment: &str) -> std::process::Command {
    for (name, content) in [
        ("experiment.toml", experiment),
        ("plates.csv", PLATES),
        ("shear.csv", SHEAR),
        ("model.toml", "kind = \"quasi_static\"\n"),
        ("theta.toml", THETA),
    ] {
        std::fs::write(folder.join(name), content).expect("a file");
    }
    let path = |name: &str| folder.join(name).display().to_string();
    let mut command = worker(["simulate", &path("experiment.toml")]);
    command.args([
        "--model",
        &path("model.toml"),
        "--parameters",
        &path("theta.toml"),
    ]);
    command
}

/// Returns the cells of each row below a header that must be this.
fn cells(csv: &str, header: &str) -> Vec<Vec<String>> {
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some(header));
    lines
        .map(|line| line.split(',').map(str::to_owned).collect())
        .collect()
}

#[track_caller]
fn close(cell: &str, expected: f64) {
    let got: f64 = cell.parse().expect("a number");
    assert!(
        (got - expected).abs() <= 1e-12 * expected,
        "{got} where {expected} is due"
    );
}

#[test]
fn plates_and_rings_are_predicted_without_a_wheel() {
    let folder = tempfile::tempdir().unwrap();
    let (plates, shear) = (folder.path().join("p.csv"), folder.path().join("s.csv"));
    let mut command = command(folder.path(), EXPERIMENT);
    command.arg("--plates").arg(&plates).arg("--shear").arg(&shear);
    run(command).success();

    let rows = cells(&text(&plates), "test,plate_radius_m,sinkage_m,pressure_pa");
    let conditions: Vec<&[String]> = rows.iter().map(|row| &row[..3]).collect();
    assert_eq!(
        conditions,
        [
            ["big", "0.05", "0.01"],
            ["small", "0.02", "0.01"],
            ["small", "0.02", "0"]
        ]
    );
    // (k_c / b + k_phi) z: 1.04e7 · 0.01 and 1.1e7 · 0.01
    close(&rows[0][3], 104_000.0);
    close(&rows[1][3], 110_000.0);
    close(&rows[2][3], 0.0);

    let rows = cells(
        &text(&shear),
        "test,normal_stress_pa,shear_displacement_m,shear_stress_pa",
    );
    // (c + sigma tan 30°) (1 − exp(−j / K)): 1 − 1/e at j = K, 1 − exp(−2.5) at 2.5 K
    close(&rows[0][3], 12_047.005_383_792_515 * 0.632_120_558_828_557_7);
    close(&rows[1][3], 0.0);
    close(&rows[2][3], 3_386.751_345_948_129 * 0.917_915_001_376_101_3);
}

#[test]
fn one_table_may_be_asked_for_and_its_conditions_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("plates.csv");
    // The predicted file is an experiment's file: writing over the input and going on gives the same.
    let mut first = command(folder.path(), EXPERIMENT);
    first.arg("--plates").arg(&out);
    run(first).success();
    let predicted = text(&out);
    let path = |name: &str| folder.path().join(name).display().to_string();
    let mut again = worker(["simulate", &path("experiment.toml")]);
    again.args([
        "--model",
        &path("model.toml"),
        "--parameters",
        &path("theta.toml"),
    ]);
    again.arg("--plates").arg(&out);
    run(again).success();
    assert_eq!(text(&out), predicted);
}

#[test]
fn effects_that_plates_and_rings_do_not_feel_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = command(folder.path(), EXPERIMENT);
    let more = format!("{THETA}\"sled_tare.tare_n\" = 3.0\n");
    std::fs::write(folder.path().join("theta.toml"), more).unwrap();
    command.arg("--shear").arg(folder.path().join("s.csv"));
    let ended = run(command);
    let notes: Vec<&str> = ended.stderr.lines().collect();
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert_contains!(notes[0], "does not act on plates and rings effect=\"sled_tare\"");
    ended.success();
}

/// Returns the most probable friction angle of the paper's rings and its standard deviation, the rings alone and a flat prior.
fn angle_of_the_papers_rings() -> (f64, f64) {
    let paper = farm_tests::workspace::root().join("examples/paper");
    let experiment: toml::Table = text(&paper.join("bevameter-experiment.toml"))
        .parse()
        .expect("TOML");
    let noise = |key: &str| experiment["noise"][key].as_float().expect("a number");
    let folder = tempfile::tempdir().expect("a folder");
    let write =
        |name: &str, content: &str| std::fs::write(folder.path().join(name), content).expect("a file");
    write("rings.csv", &text(&paper.join("rings.csv")));
    write(
        "experiment.toml",
        &format!(
            "shear = \"rings.csv\"\n[soil.wf34]\n[noise]\nring_scatter = {}\nring_noise = {}\n",
            noise("ring_scatter"),
            noise("ring_noise")
        ),
    );
    write(
        "job.toml",
        r#"experiment = "experiment.toml"
[model]
kind = "quasi_static"
k_c = 0.0
k_phi = 1e7
n = 1.1
[priors]
friction_angle_deg = { uniform = [5.0, 60.0] }
"bevameter.ln_transfer" = 0.0
[sampler]
algorithm = "lm"
"#,
    );
    let path = |name: &str| folder.path().join(name).display().to_string();
    run(coordinator(["run", &path("job.toml"), "--out", &path("out")])).success();
    let summary = text(&folder.path().join("out/summary.json"));
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    let estimate = &summary["point_estimates"][0];
    let number = |key: &str| float(&estimate[key]["friction_angle_deg"]);
    (number("parameters"), number("sd"))
}

#[test]
fn the_papers_rings_alone_give_thirty_degrees_to_one_and_a_half() {
    let (angle, sd) = angle_of_the_papers_rings();
    assert!((angle - 30.0).abs() < 0.02, "{angle}");
    // sd of ln tan(phi) by hand: sqrt(0.12^2 / 4 + 0.03^2 / 12) = 0.0606; times sin(2 phi) / 2 = 0.433: 1.504 deg
    assert!((sd - 1.504).abs() < 0.01, "{sd}");
}

/// With this seed a draw has a noise sd that rounds to zero. It is impossible, as the limit of its likelihood is, and no failure.
#[test]
fn a_draw_without_noise_is_impossible_and_fails_no_calibration() {
    let folder = tempfile::tempdir().expect("a folder");
    let sand = root().join("examples/cmu-sand");
    for name in ["plates.csv", "plates-experiment.toml"] {
        std::fs::copy(sand.join(name), folder.path().join(name)).expect("a copy");
    }
    let job = text(&sand.join("plates.toml")).replace("seed = 1", "seed = 3");
    assert!(job.contains("seed = 3"));
    let path = |name: &str| folder.path().join(name).display().to_string();
    std::fs::write(path("plates.toml"), job).expect("a file");
    run(coordinator(["run", &path("plates.toml"), "--out", &path("out")])).success();
    let summary = text(&folder.path().join("out/summary.json"));
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    let calibration = &summary["calibrations"][0];
    let evidence = float(&calibration["log_evidence"]);
    assert!((evidence - 118.29).abs() < 0.1, "{calibration}");
    assert!(calibration["equilibrated"] == true, "{calibration}");
}
