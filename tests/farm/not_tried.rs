//! Effects that the experiment cannot test are listed, and no other effect is claimed in their place.

use std::fmt::Write as _;
use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::json::items;
use farm_tests::programs::{coordinator, run, worker};
use farm_tests::workspace::text;
use serde_json::Value;

const EXPERIMENT: &str = "runs = \"runs.csv\"\n[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\ngrouser_count = 0\n\
    [soil.s]\n[rig]\nbin_length_m = 1.5\n[noise]\ndrawbar_pull_n = 0.4\ntorque_n_m = 0.05\nsinkage_m = 0.00015\n\
    lateral_force_n = 1.0\n";
const DENSITY: &str = "[soil.s]\ndensity_kg_m3 = 1400.0\n";
const MODEL: &str = "kind = \"quasi_static\"\neffects = [\"bulldozing\"]\n";
const TRUTH: &str = "log10_p_ref = 4.9\nkappa = 0.0\nn = 1.1\nfriction_angle_deg = 30.0\nwheel_radius_m = 0.13\n\
    \"bulldozing.resistance_scale\" = 1.0\n";
const JOB: &str = "experiment = \"experiment.toml\"\n[model]\nkind = \"quasi_static\"\n[priors]\n\
    log10_p_ref = { uniform = [4.0, 5.6] }\nkappa = 0.0\nn = { normal = [1.1, 0.2], bounds = [0.8, 2.0] }\n\
    friction_angle_deg = { normal = [30.0, 1.5], bounds = [11.5, 37.3] }\nwheel_radius_m = { uniform = [0.125, 0.155] }\n\
    [sampler]\nparticles = 300\nseed = 1\n[discovery]\napply = \"ask\"\n";

/// Five slips, three loads and two speeds in soil that the wheel bulldozes; the job beside them.
fn write_bulldozed(folder: &Path) {
    let mut runs =
        "run,wheel,soil,slip,wheel_load_n,sled_speed_m_s,drawbar_pull_n,torque_n_m,sinkage_m,use\n"
            .to_owned();
    for slip in [-0.1, 0.05, 0.2, 0.4, 0.6] {
        for load in [60, 100, 150] {
            for speed in [0.005, 0.02] {
                writeln!(runs, "r{slip}-{load}-{speed},w,s,{slip},{load},{speed},,,,fit").expect("room");
            }
        }
    }
    let file = |name: &str| folder.join(name);
    for (name, content) in [
        (
            "experiment.toml",
            EXPERIMENT.replace("[soil.s]\n", DENSITY).as_str(),
        ),
        ("runs.csv", runs.as_str()),
        ("model.toml", MODEL),
        ("truth.toml", TRUTH),
        ("job.toml", JOB),
    ] {
        std::fs::write(file(name), content).expect("a file");
    }
    let mut simulate = worker(["simulate", "--noise-seed", "3"]);
    simulate.arg(file("experiment.toml"));
    simulate.arg("--model").arg(file("model.toml"));
    simulate.arg("--parameters").arg(file("truth.toml"));
    simulate.arg("--out").arg(file("measured.csv"));
    run(simulate).success();
    std::fs::rename(file("measured.csv"), file("runs.csv")).expect("the runs");
}

/// Returns the search of the job with an experiment.
fn discovery(folder: &Path, experiment: &str, out: &str) -> Value {
    std::fs::write(folder.join("experiment.toml"), experiment).expect("a file");
    let out = folder.join(out);
    let mut command = coordinator(["run", "--local-workers", "2"]);
    command.arg(folder.join("job.toml")).arg("--out").arg(&out);
    run(command).success();
    let summary: Value = serde_json::from_str(&text(&out.join("summary.json"))).expect("JSON");
    assert!(text(&out.join("report.html")).contains("bulldozing"));
    summary["discovery"].clone()
}

/// Effects with a probability above 0.8, and the names of those that were not tried.
fn certain(discovery: &Value) -> (Vec<&str>, Vec<&str>) {
    let list = |key: &str| items(&discovery[key]);
    let probable = list("effects").filter(|e| e["probability"].as_f64() > Some(0.8));
    assert!(list("not_tried").all(|e| e["name"].is_string() && e["why"].is_string()));
    (
        probable.filter_map(|e| e["name"].as_str()).collect(),
        list("not_tried").filter_map(|e| e["name"].as_str()).collect(),
    )
}

/// Effects that need a slip angle, which no run here has.
const SIDEWAYS: [&str; 3] = ["lateral_slip_sinkage", "side_bulldozing", "side_drag"];

#[test]
fn without_a_density_bulldozing_is_said_to_need_it_and_with_it_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write_bulldozed(folder);
    let without = discovery(folder, EXPERIMENT, "without");
    assert_eq!(without["verdict"], "undecided", "{without:#}");
    assert_eq!(
        certain(&without),
        (
            vec!["bulldozing"],
            ["reece_pressure", "bulldozing"]
                .into_iter()
                .chain(SIDEWAYS)
                .collect()
        )
    );
    assert_eq!(without["not_tried"][1]["needs"], "density_kg_m3 under [soil.s]");
    let mut check = coordinator(["check"]);
    check.arg(folder.join("job.toml"));
    let output = run(check).success();
    let line =
        "density_kg_m3 under [soil.s] would add to the candidates of a search: reece_pressure, bulldozing";
    assert_contains!(output, line);
    let with = discovery(folder, &EXPERIMENT.replace("[soil.s]\n", DENSITY), "with");
    assert_eq!(with["verdict"], "named", "{with:#}");
    assert_eq!(certain(&with), (vec!["bulldozing"], SIDEWAYS.to_vec()));
    assert_eq!(with["chosen"], serde_json::json!(["bulldozing"]));
}
