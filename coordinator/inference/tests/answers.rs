//! Evidence and moments on problems with known answers.

use crate::problems::{self, Problem};
use crate::setup::{correlated_pair, lognormal, sample};
use inference::diagnostics::mean_and_sd;
use inference::{StageMethod, TmcmcSettings};
use statistics::Prior;

const SEEDS: u64 = 4;

/// An upper bound of the draws per independent draw; particles are moved until their ranks decorrelate.
const DRAWS_PER_INDEPENDENT: f64 = 4.0;

/// Number of standard errors allowed.
const K: f64 = 4.0;

/// Means over seeds must agree with the answer within `K` Monte-Carlo errors: the evidence by its own
/// standard error, moments by the number of independent draws.
fn check(problem: &Problem) {
    for stages in [StageMethod::Draws, StageMethod::Moves] {
        check_method(problem, stages);
    }
}

fn check_method(problem: &Problem, stages: StageMethod) {
    let settings = TmcmcSettings {
        stages,
        ..TmcmcSettings::default()
    };
    let columns = problem.mean.len() + usize::from(problem.derived.is_some());
    let (mut error, mut variance) = (0.0, 0.0);
    let (mut shifts, mut ratios) = (vec![0.0; columns], vec![0.0; columns]);
    for seed in 1..=SEEDS {
        let sampler = problem.run(TmcmcSettings { seed, ..settings });
        let posterior = sampler.posterior().unwrap();
        error += (posterior.log_evidence - problem.log_evidence) / SEEDS as f64;
        variance += posterior.log_evidence_se.powi(2) / (SEEDS * SEEDS) as f64;
        assert_eq!(posterior.particles.len(), settings.particles);
        let increments: f64 = sampler
            .stages()
            .iter()
            .map(|stage| stage.log_evidence_increment)
            .sum();
        assert!((increments - posterior.log_evidence).abs() < 1e-9);
        for column in 0..columns {
            let (values, mean, sd): (Vec<f64>, f64, f64) = match problem.derived {
                Some((derive, mean, sd)) if column == problem.mean.len() => (
                    posterior.particles.iter().map(|p| derive(&p.theta)).collect(),
                    mean,
                    sd,
                ),
                _ => {
                    let values = posterior.particles.iter().map(|p| p.theta[column]).collect();
                    (values, problem.mean[column], problem.sd[column])
                }
            };
            let (estimate, spread) = mean_and_sd(&values).unwrap();
            shifts[column] += (estimate - mean) / sd / SEEDS as f64;
            ratios[column] += spread / sd / SEEDS as f64;
        }
    }
    let se = variance.sqrt();
    assert!(
        error.abs() < K * se,
        "{}: log-evidence off by {error}, standard error {se}",
        problem.name
    );
    let draws = SEEDS as f64 * settings.particles as f64 / DRAWS_PER_INDEPENDENT;
    for (column, (shift, ratio)) in shifts.iter().zip(&ratios).enumerate() {
        assert!(
            shift.abs() < K / draws.sqrt(),
            "{}: mean of {column} off by {shift} sd",
            problem.name
        );
        let tolerance = (K / (2.0 * draws).sqrt()).min(0.05);
        assert!(
            (ratio - 1.0).abs() < tolerance,
            "{}: sd ratio of {column} is {ratio}",
            problem.name
        );
    }
}

#[test]
fn correlated_gaussian() {
    check(&problems::correlated_gaussian());
}

#[test]
fn bimodal_shear_building() {
    check(&problems::shear_building());
}

#[test]
fn thin_ridge() {
    check(&problems::thin_ridge());
}

#[test]
fn bekker_in_good_coordinates() {
    check(&problems::bekker_reparametrised());
}

#[test]
fn gaussian_shells() {
    check(&problems::shells());
}

#[test]
fn eggbox() {
    check(&problems::eggbox());
}

/// One parameter, and no symmetry that could hide a sign.
#[test]
fn skew_target() {
    check(&problems::skew());
}

/// Kolmogorov's distance of draws of the skew problem from the posterior under ln L = -rate x, times sqrt(n).
fn kolmogorov(rate: f64) -> f64 {
    let problem = problems::skew();
    let sampler = problem.run(TmcmcSettings {
        particles: 4000,
        ..TmcmcSettings::default()
    });
    let mut draws: Vec<f64> = sampler
        .posterior()
        .unwrap()
        .particles
        .iter()
        .map(|p| p.theta[0])
        .collect();
    draws.sort_by(f64::total_cmp);
    let tail = |z: f64| 0.5 * libm::erfc(z * std::f64::consts::FRAC_1_SQRT_2);
    let count = draws.len() as f64;
    let distance = draws.iter().enumerate().fold(0.0_f64, |worst, (index, x)| {
        let expected = 1.0 - tail(x + rate) / tail(rate);
        worst
            .max((expected - index as f64 / count).abs())
            .max((expected - (index + 1) as f64 / count).abs())
    });
    distance * count.sqrt()
}

#[test]
fn draws_follow_the_exact_posterior() {
    // 1.63 is the 1 % point for independent draws.
    let distance = kolmogorov(3.0);
    assert!(distance < 2.0, "{distance}");
}

/// The twin that must fail: the same check notices a likelihood that is 20 % less steep.
#[test]
fn draws_do_not_follow_a_wrong_posterior() {
    let distance = kolmogorov(2.4);
    assert!(distance > 3.0, "{distance}");
}

/// A lognormal prior is sampled in ln x; conjugate with a likelihood that is normal in ln x.
#[test]
fn the_jacobian_of_log_coordinates_is_accounted_for() {
    let sd = 0.2_f64;
    let prior = Prior::new(vec![lognormal(2.0, 3.0)]);
    let sampler = sample(prior, TmcmcSettings::default(), |theta| {
        let z = libm::log(theta[0]) / sd;
        -0.5 * z * z - libm::log(sd) - 0.5 * libm::log(std::f64::consts::TAU)
    });
    // ln x ~ N(ln 2, s^2), datum 0 with variance v: Z = N(0; ln 2, s^2 + v), mean = ln 2 v / (s^2 + v).
    let (prior_variance, variance) = (3.0_f64.ln().powi(2), sd * sd);
    let total = prior_variance + variance;
    let log_evidence = -0.5 * 2.0_f64.ln().powi(2) / total - 0.5 * (std::f64::consts::TAU * total).ln();
    let posterior = sampler.posterior().unwrap();
    let error = (posterior.log_evidence - log_evidence) / posterior.log_evidence_se;
    assert!(error.abs() < K, "{error}");
    let logs: Vec<f64> = posterior.particles.iter().map(|p| p.theta[0].ln()).collect();
    let (mean, spread) = mean_and_sd(&logs).unwrap();
    let posterior_sd = (prior_variance * variance / total).sqrt();
    assert!((mean - 2.0_f64.ln() * variance / total).abs() < K * posterior_sd / 250.0_f64.sqrt());
    assert!((spread / posterior_sd - 1.0).abs() < K / 500.0_f64.sqrt());
}

/// The standard error within a run agrees with the scatter over seeds.
#[test]
fn reported_standard_error_matches_the_scatter_over_seeds() {
    let problem = problems::shear_building();
    let (mut squares, mut variance) = (0.0, 0.0);
    for seed in 1..=40 {
        let sampler = problem.run(TmcmcSettings {
            seed,
            particles: 200,
            ..TmcmcSettings::default()
        });
        let posterior = sampler.posterior().unwrap();
        squares += (posterior.log_evidence - problem.log_evidence).powi(2);
        variance += posterior.log_evidence_se.powi(2);
    }
    // The rmse of 40 errors has a relative standard error of 11 %.
    let ratio = (squares / variance).sqrt();
    assert!((0.65..1.45).contains(&ratio), "{ratio}");
}

/// A normal prior N(0, R) and one datum d of a + b with sd e: the posterior is normal, the evidence N(d; 0, 2 (1 + rho) + e^2).
#[test]
fn a_correlated_prior_is_updated_as_on_paper() {
    let (rho, datum, sd): (f64, f64, f64) = (0.9, 3.0, 0.5);
    let settings = TmcmcSettings {
        particles: 2000,
        seed: 4,
        ..TmcmcSettings::default()
    };
    let sampler = sample(correlated_pair(rho), settings, |theta| {
        let z = (datum - theta[0] - theta[1]) / sd;
        -0.5 * z * z - 0.5 * libm::log(std::f64::consts::TAU * sd * sd)
    });
    let posterior = sampler.posterior().unwrap();
    // The covariance of each of a and b with their sum is 1 + rho.
    let variance = 2.0 * (1.0 + rho) + sd * sd;
    let mean = (1.0 + rho) * datum / variance;
    let spread = (1.0 - (1.0 + rho) * (1.0 + rho) / variance).sqrt();
    let evidence = -0.5 * datum * datum / variance - 0.5 * libm::log(std::f64::consts::TAU * variance);
    let moments = |f: &dyn Fn(&[f64]) -> f64| {
        let values: Vec<f64> = posterior.particles.iter().map(|p| f(&p.theta)).collect();
        mean_and_sd(&values).unwrap()
    };
    for parameter in [0, 1] {
        let (estimate, sd) = moments(&|theta| theta[parameter]);
        assert!((estimate - mean).abs() < 0.15 * spread, "{estimate} {mean}");
        assert!((sd / spread - 1.0).abs() < 0.1, "{sd} {spread}");
    }
    // The datum holds no information on a - b, whose sd follows from the correlation alone.
    let (_, sd) = moments(&|theta| theta[0] - theta[1]);
    let difference = (2.0 * (1.0 - rho)).sqrt();
    assert!((sd / difference - 1.0).abs() < 0.1, "{sd} {difference}");
    assert!(
        (posterior.log_evidence - evidence).abs() < 0.2,
        "{}",
        posterior.log_evidence
    );
}
