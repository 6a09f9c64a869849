//! Wrong jobs, through `check` and `run`.

use farm_tests::job::Job;

use super::{refusal, refused};

const KAPPA: &str = "kappa = 0.0";
const N: &str = "n = { normal = [1.1, 0.2], bounds = [0.8, 2.0] }";

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
fn a_dotted_name_without_quotes_says_so() {
    refused(
        Job::small().in_job("wheel_radius_m =", "wheel_radius_m.w ="),
        "job.toml line 12: write the name in quotes: \"wheel_radius_m.w\"",
    );
    refused(
        Job::small().in_job(N, "janosi_hanamoto.shear_modulus_m = 0.008"),
        "job.toml line 10: write the name in quotes: \"janosi_hanamoto.shear_modulus_m\"",
    );
    refused(
        Job::small().in_job(N, "noise.sinkage_m = { half_normal = 0.001 }"),
        "job.toml line 10: write the name in quotes: \"noise.sinkage_m\"",
    );
}

#[test]
fn impossible_priors_are_refused() {
    let n = |new: &str| Job::small().in_job(N, new);
    refused(
        n("n = { uniform = [2.0, 0.8] }"),
        "job.toml line 10: n: lower bound 2 is not below upper bound 0.8",
    );
    refused(
        n("n = { normal = [1.1, 0.2], bounds = [2.0, 0.8] }"),
        "job.toml line 10: n: lower bound 2 is not below upper bound 0.8",
    );
    refused(
        n("n = { normal = [1.1, -0.2] }"),
        "job.toml line 10: n: sd -0.2 is not above 0",
    );
    refused(
        n("n = { normal = [1.1, nan] }"),
        "job.toml line 10: n: sd NaN is not a finite number",
    );
    refused(
        n("n = { uniform = [-1.0, 2.0] }"),
        "job.toml line 10: n: [-1, 2] leaves the admissible range [0.01, 10]",
    );
    refused(
        Job::small().in_job("[11.5, 37.3]", "[11.5, 137.3]"),
        "job.toml line 11: friction_angle_deg: bounds [11.5, 137.3] deg leave the admissible range [0, 89] deg",
    );
    refused(
        n("n = { normal = [1.1, 0.2], uniform = [0.8, 2.0] }"),
        "job.toml line 10: n: two distributions: normal and uniform",
    );
    refused(
        n("n = { norml = [1.1, 0.2] }"),
        "job.toml line 10: n: unknown distribution \"norml\"; the nearest known is \"normal\"",
    );
    refused(
        n("n = { normal = [1.1] }"),
        "job.toml line 10: n: normal = [1.1]: two numbers are expected",
    );
    refused(
        n("n = {}"),
        "job.toml line 10: n: no distribution; known are uniform, loguniform, normal, lognormal, half_normal",
    );
    refused(
        n("n = \"wide\""),
        "job.toml line 10: n: a number or a table is expected",
    );
}

#[test]
fn parameters_that_do_not_determine_a_model_are_refused() {
    refused(
        Job::small().in_job("wheel_radius_m =", "wheel_radus_m ="),
        "job.toml line 12: unknown parameter \"wheel_radus_m\"; the nearest known is \"wheel_radius_m\"",
    );
    refused(
        Job::small().in_job(N, ""),
        "job.toml: parameter n has neither a prior nor a fixed value",
    );
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
        "job.toml line 12: unknown wheel \"v\"; known are w",
    );
    refused(
        Job::small().in_job(KAPPA, "kappa = 0.0\n\"noise.torque_n_m\" = { half_normal = 0.2 }"),
        "job.toml: noise.torque_n_m has a prior, but the experiment does not say torque_n_m = \"unknown\" under [noise]",
    );
    let fixed = Job::small()
        .in_job("log10_p_ref = { uniform = [4.0, 5.6] }", "log10_p_ref = 5.0")
        .in_job(N, "n = 1.1")
        .in_job(
            "friction_angle_deg = { normal = [30.0, 5.7], bounds = [11.5, 37.3] }",
            "friction_angle_deg = 30.0",
        )
        .in_job("wheel_radius_m = { uniform = [0.125, 0.155] }", "");
    refused(
        fixed,
        "job.toml: [priors] leaves no parameter free: there is nothing to calibrate",
    );
}

#[test]
fn settings_of_the_sampler_that_cannot_work_are_refused() {
    let small = Job::small;
    refused(
        small().sampler(9, [2, 4], 1),
        "job.toml: [sampler] 9 particles are too few for 4 parameters, which need at least 10",
    );
    refused(
        small().sampler(60, [0, 4], 1),
        "job.toml: [sampler] moves [0, 4] are not 1 <= least <= most <= 10000",
    );
    refused(
        small().sampler(60, [5, 4], 1),
        "job.toml: [sampler] moves [5, 4] are not 1 <= least <= most <= 10000",
    );
    refused(
        small().in_job("\"tmcmc\"", "\"tmcm\""),
        "job.toml: [sampler] unknown algorithm \"tmcm\"; the nearest known is \"tmcmc\"",
    );
    let message = refusal(&small().in_job("seed = 1", "seed = -1"));
    assert!(
        message.starts_with("job.toml line 18: ") && message.contains("-1"),
        "{message}"
    );
    let message = refusal(&small().in_job("particles = 60", "particles = \"many\""));
    assert!(
        message.starts_with("job.toml line 16: ") && message.contains("many"),
        "{message}"
    );
}

#[test]
fn a_discovery_that_means_nothing_is_refused() {
    let section = |text: &str| Job {
        job: format!("{}[discovery]\n{text}\n", Job::small().job),
        ..Job::small()
    };
    refused(
        section("apply = \"aks\""),
        "job.toml: [discovery] unknown value of apply \"aks\"; the nearest known is \"ask\"",
    );
    refused(
        section("max_effects = 11"),
        "job.toml: [discovery] max_effects = 11 must lie in [1, 10]",
    );
}

#[test]
fn error_models_that_mean_nothing_are_refused() {
    let section = |text: &str| Job {
        job: format!("{}[likelihood]\n{text}\n", Job::small().job),
        ..Job::small()
    };
    refused(
        section("kind = \"student\""),
        "job.toml: [likelihood] unknown kind \"student\"; the nearest known is \"student_t\"",
    );
    refused(
        section("degrees_of_freedom = 4"),
        "job.toml: [likelihood] degrees_of_freedom belongs to kind = \"student_t\"",
    );
    refused(
        section("kind = \"student_t\"\ndegrees_of_freedom = 0.5"),
        "job.toml: [likelihood] degrees_of_freedom = 0.5 must be a finite number >= 1",
    );
    for wrong in ["-1.0", "\"some\"", "inf", "true"] {
        refused(
            section(&format!("discrepancy = {wrong}")),
            &format!(
                "job.toml: [likelihood] discrepancy = {wrong} must be a number >= 0, in noise sds, or \"unknown\""
            ),
        );
    }
    let prior = |name: &str| {
        Job::small().in_job(
            "kappa = 0.0",
            &format!("kappa = 0.0\n\"{name}\" = {{ half_normal = 0.1 }}"),
        )
    };
    refused(
        prior("noise.run_scatter"),
        "job.toml: noise.run_scatter has a prior, but the experiment does not say run_scatter = \"unknown\" under [noise]",
    );
    refused(
        prior("noise.plate_noise").in_experiment("[noise]", "[noise]\nplate_noise = \"unknown\""),
        "job.toml: noise.plate_noise has a prior, but nothing that is fitted needs it",
    );
    refused(
        prior("noise.run_scater"),
        "job.toml line 10: unknown noise \"run_scater\"; the nearest known is \"run_scatter\"",
    );
    refused(
        Job::small().in_experiment("[noise]", "[noise]\nrun_scatter = 1.5"),
        "experiment.toml: [noise] run_scatter 1.5 must lie in [0, 1]: it is relative",
    );
}
