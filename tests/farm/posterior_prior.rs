//! The posterior of bevameter tests as the prior of a wheel's calibration.

use std::fmt::Write;

use farm_tests::assert_contains;
use farm_tests::job::Job;
use farm_tests::programs::{coordinator, run};
use farm_tests::service::Service;
use farm_tests::text::same;

use super::spatial::column;

/// Draws with a stiffness near that of the data, which are strongly correlated with kappa.
fn draws() -> String {
    let mut text = "log_likelihood,log_prior,log10_p_ref,kappa,n,noise.plate_noise\n".to_owned();
    for k in 0..60 {
        let z = |step: usize| ((k * step) % 60) as f64 / 30.0 - 1.0;
        let (p, kappa, n) = (4.56 + 0.05 * z(7), 0.2 * z(7) + 0.05 * z(11), 1.1 + 0.05 * z(17));
        let _ = writeln!(text, "-1,-1,{p},{kappa},{n},0.1");
    }
    text
}

fn job() -> Job {
    Job::small()
        .in_job(
            "log10_p_ref = { uniform = [4.0, 5.6] }\nkappa = 0.0\n",
            "posterior = \"p.csv\"\ntransfer = 2.0\n",
        )
        .in_job("n = { normal = [1.1, 0.2], bounds = [0.8, 2.0] }\n", "")
        .beside("p.csv", draws())
}

#[test]
fn a_posterior_is_a_prior_alone_and_through_the_service() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = job().write(&folder.path().join("job")).display().to_string();
    let check = run(coordinator(["check", &path])).success();
    assert_contains!(
        check,
        "log10_p_ref, kappa, n: jointly normal as 60 draws of p.csv, covariance times 2",
        "correlations: log10_p_ref–kappa 0.9",
        "implied by the draws: k_c "
    );
    let out = folder.path().join("out");
    run(coordinator(["run", &path, "--out", &out.display().to_string()])).success();
    let alone = std::fs::read_to_string(out.join("posterior.csv")).expect("posterior.csv");
    // The wheel does not determine the correlation of kappa and log10_p_ref, so that the posterior keeps that of the prior.
    let (p, kappa) = (column(&alone, "log10_p_ref"), column(&alone, "kappa"));
    let count = p.len() as f64;
    let mean = |x: &[f64]| x.iter().sum::<f64>() / count;
    let product = |a: &[f64], b: &[f64]| {
        let (at, bt) = (mean(a), mean(b));
        a.iter().zip(b).map(|(a, b)| (a - at) * (b - bt)).sum::<f64>()
    };
    let correlation = product(&p, &kappa) / (product(&p, &p) * product(&kappa, &kappa)).sqrt();
    assert!(correlation > 0.4, "{correlation}");

    let service = Service::start(&[]);
    let id = service.submit(&job());
    let _worker = service.worker("a", 2);
    service.wait_for(id, "finished");
    same(&service.posterior_csv(id), &alone);
}
