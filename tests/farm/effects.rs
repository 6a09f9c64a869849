//! Effects through the whole farm: by name, by file, by wheel, and at their neutral values.

use std::path::Path;

use farm_tests::assert_contains;
use farm_tests::job::{GAIN, Job};
use farm_tests::json::{item_count, items, word};
use farm_tests::programs::{Ended, call, coordinator, run, worker};
use farm_tests::service::Service;
use farm_tests::text::same;
use farm_tests::workspace::{data, text};
use serde_json::Value;

fn path(path: &Path) -> String {
    path.display().to_string()
}

/// Runs `worker simulate` in a folder with experiment and runs.
fn simulate(folder: &Path, model: &str, theta: &str) -> Ended {
    let at = |name: &str| path(&folder.join(name));
    std::fs::write(folder.join("model.toml"), model).expect("a file");
    std::fs::write(folder.join("theta.toml"), theta).expect("a file");
    let mut command = worker(["simulate", &at("experiment.toml"), "--model", &at("model.toml")]);
    command.args(["--parameters", &at("theta.toml"), "--out", &at("out.csv")]);
    run(command)
}

#[track_caller]
fn simulated(folder: &Path, model: &str, theta: &str) -> String {
    simulate(folder, model, theta).success();
    text(&folder.join("out.csv"))
}

fn truth() -> String {
    text(&data("nothing-hidden/parameters.toml"))
}

/// Returns the column of a table.
fn column(csv: &str, name: &str) -> Vec<f64> {
    let mut lines = csv.lines().filter(|line| !line.starts_with('#'));
    let header = lines.next().expect("a header");
    let place = header.split(',').position(|h| h == name).expect("the column");
    let cell = |line: &str| line.split(',').nth(place).and_then(|cell| cell.parse().ok());
    lines.map(|line| cell(line).expect("a number")).collect()
}

/// Returns the small job with a tare by name, one with a prior, and the user's gain.
fn job() -> Job {
    Job::small()
        .in_job(
            "shear_velocity_m_s = 0.001",
            "shear_velocity_m_s = 0.001\neffects = [\"torque_gain\"]\neffect_files = [\"gain.toml\"]",
        )
        .in_job(
            "kappa = 0.0",
            "kappa = 0.0\n\"sled_tare.tare_n\" = { normal = [0.0, 2.0] }",
        )
        .beside("gain.toml", GAIN)
}

#[test]
fn local_and_remote_workers_fit_effects_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let (file, out) = (job().write(&folder.path().join("job")), folder.path().join("out"));
    let output = call(
        "coordinator run {} --out {} --local-workers 2 --verbose",
        &[&path(&file), &path(&out)],
    )
    .success();
    assert_contains!(
        output,
        "model quasi_static with sled_tare, torque_gain, my_gain\n"
    );
    let local = text(&out.join("posterior.csv"));
    let header = local.lines().next().unwrap();
    assert_contains!(
        header,
        "sled_tare.tare_n",
        "torque_gain.gain_error",
        "my_gain.gain"
    );
    assert!(!header.contains("shift_n"), "{header}");

    let service = Service::start(&[]);
    let id = service.submit(&job());
    let _worker = service.worker("remote", 2);
    service.wait_for(id, "finished");
    same(&service.posterior_csv(id), &local);

    let summary: Value = serde_json::from_str(&text(&out.join("summary.json"))).unwrap();
    assert_eq!(
        summary["calibrations"][0]["effects"],
        serde_json::json!(["sled_tare", "torque_gain", "my_gain"])
    );
    let version = summary["model_version"].as_str().unwrap();
    let (_, effects) = version.split_once("+effects.").unwrap();
    assert_eq!(version, service.status(id)["model_version"]);
    assert!(effects.len() == 8, "{version}");
    assert!(effects.bytes().all(|b| b.is_ascii_hexdigit()), "{version}");
    let report = text(&out.join("report.html"));
    assert_contains!(report, "my_gain.gain", version);
}

#[test]
fn a_file_of_the_command_line_is_fitted_and_belongs_to_the_job() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let fit = super::point_fit::fit()
        .in_experiment("sinkage_m = 0.0004", "sinkage_m = 0.0004\nlateral_force_n = 1.0")
        .beside("gain.toml", GAIN);
    let file = fit.write(folder.path());
    // The measured pull has a gain of 0.15 and no noise.
    let model = "kind = \"quasi_static\"\neffect_files = [\"gain.toml\"]\n";
    let measured = simulated(
        folder.path(),
        model,
        &format!("{}\n\"my_gain.gain\" = 0.15\n", truth()),
    );
    std::fs::write(at("runs.csv"), measured).unwrap();

    let command = |more: &[&str]| {
        let (file, out) = (path(&file), path(&at("out")));
        let words = ["run", &file, "--out", &out, "--local-workers", "1"];
        run(coordinator(words.iter().chain(more)))
    };
    let gain = path(&at("gain.toml"));
    let first = command(&["--effect-file", &gain]).success();
    let summary: Value = serde_json::from_str(&text(&at("out/summary.json"))).unwrap();
    let found = summary["point_estimates"][0]["parameters"]["my_gain.gain"]
        .as_f64()
        .unwrap();
    let sd = summary["point_estimates"][0]["sd"]["my_gain.gain"]
        .as_f64()
        .unwrap();
    assert!((found - 0.15).abs() < 3.0 * sd && sd < 0.1, "{found} +- {sd}");

    same(&command(&["--effect-file", &gain]).success(), &first);
    for other in [&[][..], &["--effect", "sled_tare", "--effect-file", &gain]] {
        let message = command(other).refusal();
        assert_contains!(message, "the calibration of another job");
    }
    std::fs::write(at("gain.toml"), GAIN.replace("0.2]", "0.3]")).unwrap();
    let message = command(&["--effect-file", &gain]).refusal();
    assert_contains!(
        message,
        "the calibration of another job: the effect file gain.toml has changed since"
    );
}

#[test]
fn a_strength_of_one_wheel_leaves_the_other_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let table = "[wheel.w]\nradius_m = 0.125\nwidth_m = 0.112\ngrouser_count = 0\nrig_radius_m = 0.125\n";
    let small = Job::small();
    let runs = small.runs.lines().take(3).collect::<Vec<_>>().join("\n")
        + "\na,w,s,0.2,60,0.01,0,1,,,,,fit\nb,x,s,0.2,60,0.01,0,1,,,,,fit\n";
    Job { runs, ..small }
        .in_experiment(table, &format!("{table}{}", table.replace("wheel.w", "wheel.x")))
        .write(folder.path());
    let model = "kind = \"quasi_static\"\n";
    let pull = |more: &str| {
        column(
            &simulated(folder.path(), model, &(truth() + more)),
            "drawbar_pull_n",
        )
    };
    let base = pull("");
    let tared = pull("\n\"sled_tare.tare_n.x\" = 3.0\n");
    assert_eq!(tared[0].to_bits(), base[0].to_bits());
    assert!((base[1] - tared[1] - 3.0).abs() < 1e-9, "{base:?} {tared:?}");
}

#[test]
fn at_its_neutral_strength_no_effect_of_the_catalogue_changes_a_byte() {
    let folder = tempfile::tempdir().unwrap();
    let small = Job::small();
    // Drifts need the order of the runs.
    let rows = small.runs.lines().filter(|line| !line.starts_with('#'));
    let runs = rows.enumerate().map(|(i, line)| match i {
        0 => format!("{line},order\n"),
        i => format!("{line},{i}\n"),
    });
    let runs = runs.collect();
    Job { runs, ..small }
        .in_experiment(
            "grouser_count = 0",
            "grouser_count = 12\ngrouser_height_m = 0.009",
        )
        .in_experiment(
            "[soil.s]",
            "[soil.s]\ndensity_kg_m3 = 1400.0\n[rig]\nbin_length_m = 1.5",
        )
        .write(folder.path());
    let model = "kind = \"quasi_static\"\n";
    let base = simulated(folder.path(), model, &truth());
    // This effect needs terrain beside the wheel, which the model does not have.
    let has_form = |effect: &&formula::Effect| effect.name != "buried_side_wall";
    let catalogue: Vec<_> = formula::catalogue::catalogue().iter().filter(has_form).collect();
    for some in catalogue.chunks(10) {
        let strengths = some.iter().flat_map(|effect| {
            let strengths = effect.parameters.iter();
            strengths.filter_map(|p| Some(format!("\"{}.{}\" = {:?}\n", effect.name, p.name, p.neutral?)))
        });
        let theta = format!("{}\n{}", truth(), strengths.collect::<String>());
        same(&simulated(folder.path(), model, &theta), &base);
    }
    // A strength that is not neutral changes the table.
    let theta = format!("{}\n\"sled_tare.tare_n\" = 1e-3\n", truth());
    assert_ne!(simulated(folder.path(), model, &theta), base);
}

#[test]
fn forward_runs_need_a_value_for_every_strength_and_take_shapes_from_the_file() {
    let folder = tempfile::tempdir().unwrap();
    Job::small().beside("gain.toml", GAIN).write(folder.path());
    let model = "kind = \"quasi_static\"\neffects = [\"torque_gain\"]\neffect_files = [\"gain.toml\"]\n";
    let message = simulate(folder.path(), model, &truth()).refusal();
    assert_eq!(
        message,
        format!(
            "{}: torque_gain.gain_error has no value: it is a parameter of effect torque_gain",
            folder.path().join("theta.toml").display()
        )
    );
    let theta = format!(
        "{}\n\"torque_gain.gain_error\" = 0.0\n\"my_gain.gain\" = 0.2\n",
        truth()
    );
    let with = column(&simulated(folder.path(), model, &theta), "drawbar_pull_n");
    let base = column(
        &simulated(folder.path(), "kind = \"quasi_static\"\n", &truth()),
        "drawbar_pull_n",
    );
    for (with, base) in with.iter().zip(&base) {
        assert!((with - 1.2 * base - 0.2 * 0.25).abs() < 1e-6, "{with} {base}");
    }
}

#[test]
fn the_catalogue_is_listed_and_shown() {
    let list = run(coordinator(["effects"])).success();
    assert!(list.lines().count() > 100 && list.lines().all(|l| l.chars().count() <= 100));
    let shown = run(coordinator(["effects", "slip_sinkage"])).success();
    assert_contains!(
        shown,
        "sinkage_exponent = \"n + exponent_per_slip * abs(slip) * cos(slip_angle)\""
    );
    assert!(shown.contains("at exponent_per_slip = 0.3\n"), "{shown}");
    assert!(shown.contains('█'), "{shown}");
    assert_eq!(
        run(coordinator(["effects", "slip_sinkge"])).refusal(),
        "unknown effect \"slip_sinkge\"; the nearest known is \"slip_sinkage\""
    );
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("gain.toml");
    std::fs::write(&file, GAIN).unwrap();
    let shown = run(coordinator(["effects", "--file", &path(&file)])).success();
    assert!(shown.starts_with(GAIN), "{shown}");
    assert!(shown.contains("at gain = 0.2\n"), "{shown}");
    // This command refuses the same files as a job, with the same messages.
    for (old, new, message) in [
        (
            "(1 + gain)",
            "(1 + gian)",
            " line 4, column 37: unknown name \"gian\"; the nearest known is \"gain\"",
        ),
        (
            "\"my_gain\"",
            "\"hard_pan\"",
            " line 1: name \"hard_pan\" belongs to an effect of the catalogue",
        ),
        (
            "\"my_gain\"",
            "\"noise\"",
            " line 1: name \"noise\" has another meaning in a job",
        ),
        (
            "drawbar_pull = ",
            "mechanism = \"rebound\"\ndrawbar_pull = ",
            " line 4: mechanism is reserved for the catalogue: a file has formulas",
        ),
        (
            "[0.0, 0.2]",
            "[0.0, -0.2]",
            " line 5: prior of parameter gain: sd -0.2 is not above 0",
        ),
    ] {
        std::fs::write(&file, GAIN.replace(old, new)).unwrap();
        let shown = run(coordinator(["effects", "--file", &path(&file)])).refusal();
        assert_eq!(shown, format!("{}{message}", file.display()));
        let job = Job::small()
            .in_job(
                "kind = \"quasi_static\"",
                "kind = \"quasi_static\"\neffect_files = [\"gain.toml\"]",
            )
            .beside("gain.toml", GAIN.replace(old, new))
            .write(&folder.path().join("job"));
        assert_eq!(
            run(coordinator(["check", &path(&job)])).refusal(),
            format!("gain.toml{message}")
        );
    }
}

#[test]
fn the_catalogue_is_there_over_rest() {
    let service = Service::start(&[]);
    let list = service.client.json("/v1/effects");
    assert_eq!(item_count(&list), 52);
    let one = service.client.json("/v1/effects/sled_tare");
    let listed = items(&list).find(|e| e["name"] == "sled_tare");
    assert_eq!(Some(&one["effect"]), listed);
    assert!(word(&one["text"]).starts_with("name = \"sled_tare\""));
    let pull = &one["signature"]["strengths"][0]["channels"][0];
    assert_eq!(pull["channel"], "drawbar_pull");
    assert!(
        pull["change"][0].as_f64().is_some_and(|x| (x + 3.0).abs() < 1e-9),
        "{pull}"
    );
    let unknown = service.client.get("/v1/effects/sled_tar");
    assert_eq!(unknown.status, 404);
    assert_eq!(unknown.json()["error"]["type"], "not_found");
}
