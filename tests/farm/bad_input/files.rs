//! Wrong jobs and experiments, through `check` and `run`.

use std::path::Path;

use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run};

/// The message of a job that must be refused, by `check` and by `run` alike; `run` leaves no folder.
#[track_caller]
fn refusal(job: &Job) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    refusal_in(&job.write(folder.path()), folder.path())
}

#[track_caller]
fn refusal_in(path: &Path, folder: &Path) -> String {
    let out = folder.join("out");
    let path = path.display().to_string();
    let checked = run(coordinator(["check", &path])).refusal();
    let ran = run(coordinator(["run", &path, "--out", &out.display().to_string()])).refusal();
    assert_eq!(checked, ran);
    assert!(!out.exists(), "a folder was left behind for: {ran}");
    assert_eq!(ran.lines().count(), 1, "more than one line: {ran}");
    ran.replace(&format!("{}/", folder.display()), "")
}

/// Every case is a change of a good job and the whole message.
#[track_caller]
fn refused(job: Job, message: &str) {
    assert_eq!(refusal(&job), message);
}

const KAPPA: &str = "kappa = 0.0";
const N: &str = "n = { normal = [1.1, 0.2], bounds = [0.8, 2.0] }";
const FIRST_RUN: &str = "r00,w,s,0.05,60.0,0.0095,0,1,8.4839442,2.4143027,0.0055360117,,fit";

#[test]
fn the_job_of_the_gallery_is_good() {
    let folder = tempfile::tempdir().unwrap();
    let path = Job::small().write(folder.path()).display().to_string();
    let text = run(coordinator(["check", &path])).success();
    assert!(text.contains("24 fit runs with 72 measurements, 16 holdout runs"), "{text}");
    for figure in ["expected evaluations", "expected simulations", "expected core hours"] {
        assert!(text.contains(figure), "{text}");
    }
}

#[test]
fn unknown_keys_name_line_and_nearest_known() {
    refused(
        Job::small().in_job("particles = 60", "particels = 60"),
        "job.toml line 16: unknown key \"particels\"; the nearest known is \"particles\"",
    );
    refused(
        Job::small().in_job("[priors]", "[prior]"),
        "job.toml line 7: unknown key \"prior\"; the nearest known is \"priors\"",
    );
    refused(
        Job::small().in_experiment("width_m", "widht_m"),
        "experiment.toml line 6: unknown key \"widht_m\"; the nearest known is \"width_m\"",
    );
    refused(
        Job::small().in_job("shear_velocity_m_s", "shear_velocity"),
        "job.toml: [model] unknown key \"shear_velocity\"; the nearest known is \"shear_velocity_m_s\"",
    );
    refused(
        Job::small().in_runs("sled_speed_m_s", "sled_speed"),
        "runs.csv line 3: unknown column \"sled_speed\"; the nearest known is \"sled_speed_m_s\"",
    );
}

#[test]
fn unit_mistakes_name_value_unit_and_bound() {
    let row = |old: &str, new: &str| Job::small().in_runs(FIRST_RUN, &FIRST_RUN.replace(old, new));
    refused(row("60.0", "-60.0"), "runs.csv line 4: wheel_load_n -60 N must be > 0 N");
    refused(row(",0.05,", ",1,"), "runs.csv line 4: slip 1 must lie in [-1, 1)");
    refused(row(",0.05,", ",-1.2,"), "runs.csv line 4: slip -1.2 must lie in [-1, 1)");
    refused(
        row("0.0055360117", "5.5360117"),
        "runs.csv line 4: sinkage_m 5.5360117 m is more than the wheel's diameter 0.25 m: metres are expected, were these millimetres?",
    );
    refused(row("0.0095", "0"), "runs.csv line 4: sled_speed_m_s 0 m/s must be > 0 m/s");
    refused(row("0.0095,0,", "0.0095,120,"), "runs.csv line 4: slip_angle_deg 120 deg must lie in [-90, 90] deg");
    refused(
        Job::small().in_experiment("radius_m = 0.125\nwidth", "radius_m = -0.125\nwidth"),
        "experiment.toml: [wheel.w] radius_m -0.125 m must be > 0 m",
    );
    refused(
        Job::small().in_experiment("torque_n_m = 0.15", "torque_n_m = 0.0"),
        "experiment.toml: [noise] torque_n_m 0 N m must be > 0 N m",
    );
}

#[test]
fn malformed_rows_name_the_line() {
    let row = |old: &str, new: &str| Job::small().in_runs(FIRST_RUN, &FIRST_RUN.replace(old, new));
    refused(row("8.4839442", "NaN"), "runs.csv line 4: drawbar_pull_n NaN is not a finite number");
    refused(row("8.4839442", "inf"), "runs.csv line 4: drawbar_pull_n inf is not a finite number");
    refused(row("8.4839442", "eight"), "runs.csv line 4: drawbar_pull_n \"eight\" is not a number");
    refused(row("60.0", ""), "runs.csv line 4: wheel_load_n is blank");
    refused(row(",fit", ""), "runs.csv line 4: 12 fields where the header has 13");
    refused(row(",fit", ",both"), "runs.csv line 4: use \"both\" must be fit or holdout");
    refused(row(",w,", ",v,"), "runs.csv line 4: unknown wheel \"v\"; the nearest known is \"w\"");
    refused(row(",1,8", ",0,8"), "runs.csv line 4: pass \"0\" must be a whole number >= 1");
    refused(Job::small().in_runs("\nr01,", "\nr00,"), "runs.csv line 5: run \"r00\" stands twice (first on line 4)");
    refused(
        Job { runs: Job::small().runs.replace("slip,", "").replace(",s,0.05,", ",s,"), ..Job::small() },
        "runs.csv line 3: column \"slip\" is missing",
    );
    refused(
        Job::small().in_runs("torque_n_m,", "drawbar_pull_n,"),
        "runs.csv line 3: column \"drawbar_pull_n\" stands twice",
    );
}

#[test]
fn an_experiment_without_anything_to_fit_is_refused() {
    let header = Job::small().runs.lines().nth(2).map(|line| format!("{line}\n")).unwrap_or_default();
    refused(Job { runs: header, ..Job::small() }, "runs.csv: no test run stands in the file");
    refused(Job { runs: String::new(), ..Job::small() }, "runs.csv line 1: column \"run\" is missing");
    refused(
        Job { runs: Job::small().runs.replace(",fit", ",holdout"), ..Job::small() },
        "experiment.toml: no fit run has a measured channel: there is nothing to fit",
    );
    refused(
        Job { experiment: String::new(), ..Job::small() },
        "experiment.toml: no wheel: add a table [wheel.NAME]",
    );
    refused(
        Job::small().in_experiment("sinkage_m = 0.0004", ""),
        "experiment.toml: [noise] sinkage_m is missing: sinkage_m of run \"r00\" is measured, so its sd in m, \"replicates\" or \"unknown\" must stand there",
    );
}

#[test]
fn impossible_priors_are_refused() {
    let n = |new: &str| Job::small().in_job(N, new);
    refused(n("n = { uniform = [2.0, 0.8] }"), "job.toml line 10: n: lower bound 2 is not below upper bound 0.8");
    refused(
        n("n = { normal = [1.1, 0.2], bounds = [2.0, 0.8] }"),
        "job.toml line 10: n: lower bound 2 is not below upper bound 0.8",
    );
    refused(n("n = { normal = [1.1, -0.2] }"), "job.toml line 10: n: sd -0.2 is not above 0");
    refused(n("n = { normal = [1.1, nan] }"), "job.toml line 10: n: sd NaN is not a finite number");
    refused(
        n("n = { uniform = [-1.0, 2.0] }"),
        "job.toml line 10: n: [-1, 2] 1 leaves the admissible range [0, 10] 1",
    );
    refused(
        Job::small().in_job("[11.5, 37.3]", "[11.5, 137.3]"),
        "job.toml line 11: friction_angle_deg: bounds [11.5, 137.3] deg leave the admissible range [0, 90] deg",
    );
    refused(
        n("n = { normal = [1.1, 0.2], uniform = [0.8, 2.0] }"),
        "job.toml line 10: n: two distributions: normal and uniform",
    );
    refused(
        n("n = { norml = [1.1, 0.2] }"),
        "job.toml line 10: n: unknown distribution \"norml\"; the nearest known is \"normal\"",
    );
    refused(n("n = { normal = [1.1] }"), "job.toml line 10: n: normal = [1.1]: two numbers are expected");
    refused(
        n("n = {}"),
        "job.toml line 10: n: no distribution; known are uniform, loguniform, normal, lognormal, half_normal",
    );
    refused(n("n = \"wide\""), "job.toml line 10: n: a number or a table is expected");
}

#[test]
fn parameters_that_do_not_determine_a_model_are_refused() {
    refused(
        Job::small().in_job("wheel_radius_m =", "wheel_radus_m ="),
        "job.toml line 12: unknown parameter \"wheel_radus_m\"; the nearest known is \"wheel_radius_m\"",
    );
    refused(Job::small().in_job(N, ""), "job.toml: parameter n has neither a prior nor a fixed value");
    refused(
        Job::small().in_job(KAPPA, "k_c = { normal = [0.0, 1000.0] }\nkappa = 0.0"),
        "job.toml: the stiffness is given twice: k_c and k_phi exclude log10_p_ref and kappa",
    );
    refused(
        Job::small().in_job(KAPPA, "k_c = 0.0"),
        "job.toml: the stiffness needs k_c and k_phi, or log10_p_ref and kappa",
    );
    refused(
        Job::small().in_job("shear_velocity_m_s = 0.001", "n = 1.0"),
        "job.toml: parameter n is both fixed and free",
    );
    refused(
        Job::small().in_job("shear_velocity_m_s = 0.001", "kappa = 0.1"),
        "job.toml line 9: kappa is fixed under [model] and stands again under [priors]",
    );
    refused(
        Job::small().in_job("shear_velocity_m_s = 0.001", "shear_velocity_m_s = -0.001"),
        "job.toml: shear_velocity_m_s = -0.001 m/s lies outside [0, inf] m/s",
    );
    refused(
        Job::small().in_job("wheel_radius_m =", "\"wheel_radius_m.v\" ="),
        "job.toml line 12: unknown wheel \"v\"; the nearest known is \"w\"",
    );
    refused(
        Job::small().in_job(KAPPA, "kappa = 0.0\n\"noise.torque_n_m\" = { half_normal = 0.2 }"),
        "job.toml: noise.torque_n_m has a prior, but the experiment does not say torque_n_m = \"unknown\" under [noise]",
    );
    let fixed = Job::small()
        .in_job("log10_p_ref = { uniform = [4.0, 5.6] }", "log10_p_ref = 5.0")
        .in_job(N, "n = 1.1")
        .in_job("friction_angle_deg = { normal = [30.0, 5.7], bounds = [11.5, 37.3] }", "friction_angle_deg = 30.0")
        .in_job("wheel_radius_m = { uniform = [0.125, 0.155] }", "");
    refused(fixed, "job.toml: [priors] leaves no parameter free: there is nothing to calibrate");
}

#[test]
fn settings_of_the_sampler_that_cannot_work_are_refused() {
    let small = Job::small;
    refused(
        small().sampler(9, [2, 4], 1),
        "job.toml: [sampler] 9 particles are too few for 4 parameters, which need at least 10",
    );
    refused(small().sampler(60, [0, 4], 1), "job.toml: [sampler] moves [0, 4] are not 1 <= least <= most");
    refused(small().sampler(60, [5, 4], 1), "job.toml: [sampler] moves [5, 4] are not 1 <= least <= most");
    refused(
        small().in_job("\"tmcmc\"", "\"tmcm\""),
        "job.toml: [sampler] unknown algorithm \"tmcm\"; the nearest known is \"tmcmc\"",
    );
    let message = refusal(&small().in_job("seed = 1", "seed = -1"));
    assert!(message.starts_with("job.toml line 18: ") && message.contains("-1"), "{message}");
    let message = refusal(&small().in_job("particles = 60", "particles = \"many\""));
    assert!(message.starts_with("job.toml line 16: ") && message.contains("many"), "{message}");
}

#[test]
fn what_a_later_version_brings_says_so() {
    let later = |job: Job, what: &str| {
        let message = refusal(&job);
        assert!(message.contains(what) && message.contains("not available in this version"), "{message}");
    };
    let small = Job::small;
    later(small().in_job("\"quasi_static\"", "\"scm\""), "[model] kind = \"scm\"");
    later(small().in_job("[priors]", "effects = [\"bulldozing\"]\n[priors]"), "[model] effects");
    later(small().in_job("[priors]", "effect_files = [\"mine.toml\"]\n[priors]"), "[model] effect_files");
    later(small().in_job("[priors]", "dem_spacing_m = 0.004\n[priors]"), "[model] dem_spacing_m");
    later(
        small().in_job(KAPPA, "kappa = 0.0\n\"janosi_hanamoto.shear_modulus_m\" = { lognormal = [0.008, 2.5] }"),
        "janosi_hanamoto.shear_modulus_m",
    );
    for algorithm in ["basis", "ga", "cma-es", "lm"] {
        later(small().in_job("\"tmcmc\"", &format!("\"{algorithm}\"")), &format!("algorithm = \"{algorithm}\""));
    }
    let section = |text: &str| Job { job: small().job + text, ..small() };
    later(section("[discovery]\napply = \"auto\"\n"), "[discovery] apply = \"auto\"");
    later(section("[discovery]\napply = \"ask\"\n"), "[discovery] apply = \"ask\"");
    later(section("[likelihood]\nkind = \"student_t\"\n"), "[likelihood] kind = \"student_t\"");
    later(section("[likelihood]\ndiscrepancy = \"unknown\"\n"), "[likelihood] discrepancy = \"unknown\"");
    let top = |text: &str| Job { experiment: format!("{text}\n{}", small().experiment), ..small() };
    later(top("plates = \"plates.csv\""), "plates");
    later(top("shear = \"shear.csv\""), "shear");
    later(small().in_experiment("width_m = 0.112", "width_m = 0.112\nmesh = \"wheel.stl\""), "[wheel.w] mesh");
    later(small().in_experiment("[noise]", "[noise]\nrun_scatter = 0.1"), "[noise] run_scatter");
    later(
        Job { runs: small().runs.replace(",use", ",history").replace(",fit", ",a.csv"), ..small() },
        "column \"history\"",
    );
}

#[test]
fn files_that_are_not_there_or_not_text_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = Job::small().write(folder.path());
    let message = |path: &Path| refusal_in(path, folder.path());
    assert!(message(&folder.path().join("jop.toml")).starts_with("jop.toml: No such file"));
    let directory = message(folder.path());
    assert!(directory.contains("directory"), "{directory}");

    let garbage: Vec<u8> = (0..=255).cycle().take(4096).collect();
    for name in ["job.toml", "experiment.toml", "runs.csv"] {
        let text = std::fs::read(folder.path().join(name)).unwrap();
        std::fs::write(folder.path().join(name), &garbage).unwrap();
        let said = message(&path);
        assert!(said.starts_with(name) && said.contains("UTF-8"), "{said}");
        std::fs::remove_file(folder.path().join(name)).unwrap();
        let said = message(&path);
        assert!(said.starts_with(&format!("{name}: No such file")), "{said}");
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let job = Job::small().in_job("experiment = \"experiment.toml\"", "");
    refused(job, "job.toml: experiment = \"experiment.toml\" is missing");
    let broken = refusal(&Job::small().in_job("[priors]", "[priors"));
    assert!(broken.starts_with("job.toml line 7: "), "{broken}");
}
