//! Emulated sampling of problems with known evidence.

use inference::{EmulatedSampler, TmcmcSettings};
use statistics::likelihood::discrepancy_levels;
use statistics::rng::Stream;
use statistics::{
    CommonError, CommonErrorSize, Datum, Discrepancy, Distribution, ErrorLaw, ErrorSd, Likelihood, Marginal,
    Prior,
};

use crate::output_problems::{self, OutputProblem};

fn start(problem: &OutputProblem, seed: u64) -> EmulatedSampler {
    let settings = TmcmcSettings {
        seed,
        ..TmcmcSettings::default()
    };
    let (prior, likelihood) = (problem.prior.clone(), problem.likelihood.clone());
    EmulatedSampler::new(prior, likelihood, settings, problem.model_parameters).unwrap()
}

/// Tells the outputs of a round, with `reversed` from its end.
fn tell_round(problem: &OutputProblem, sampler: &mut EmulatedSampler, reversed: bool) {
    let mut pending = sampler.round().pending().to_vec();
    if reversed {
        pending.reverse();
    }
    for proposal in pending {
        let outputs = (problem.outputs)(&proposal.theta);
        sampler.tell(proposal.particle, outputs.as_deref()).unwrap();
    }
}

/// Runs a sampler to its end.
fn run(problem: &OutputProblem, seed: u64, reversed: bool) -> EmulatedSampler {
    let mut sampler = start(problem, seed);
    while !sampler.round().pending().is_empty() {
        tell_round(problem, &mut sampler, reversed);
    }
    sampler
}

/// Runs three seeds: none falls back, evaluations and evidence keep within these bounds.
fn check(problem: &OutputProblem, max_evaluations: u64, max_error: f64) {
    for seed in 1..=3 {
        let sampler = run(problem, seed, false);
        let posterior = sampler.posterior().unwrap();
        assert!(!sampler.record().fell_back, "{} seed {seed}", problem.name);
        let error = posterior.log_evidence - problem.log_evidence;
        assert!(error.abs() < max_error, "{} seed {seed}: {error}", problem.name);
        assert!(
            posterior.evaluations <= max_evaluations,
            "{} seed {seed}: {} evaluations",
            problem.name,
            posterior.evaluations
        );
    }
}

#[test]
fn smooth_problems_take_hundreds_of_evaluations() {
    check(&output_problems::correlated_gaussian(), 350, 0.02);
    check(&output_problems::bekker_reparametrised(), 320, 0.02);
}

#[test]
fn two_modes_and_a_thin_ridge_are_emulated() {
    check(&output_problems::shear_building(), 320, 0.05);
    check(&output_problems::thin_ridge(), 340, 0.03);
}

/// A ring has no single frame, so an emulator may be given up.
#[test]
fn shells_are_found_whole_or_left_to_draws_of_the_model() {
    let problem = output_problems::shells();
    let mut emulated = 0;
    for seed in 1..=3 {
        let sampler = run(&problem, seed, false);
        let error = sampler.posterior().unwrap().log_evidence - problem.log_evidence;
        assert!(error.abs() < 0.12, "seed {seed}: {error}");
        emulated += u32::from(!sampler.record().fell_back);
    }
    assert!(emulated >= 2, "{emulated}");
}

#[test]
fn moments_are_those_of_the_posterior() {
    let problem = output_problems::correlated_gaussian();
    let sampler = run(&problem, 1, false);
    let particles = &sampler.posterior().unwrap().particles;
    let values: Vec<f64> = particles.iter().map(|particle| particle.theta[3]).collect();
    let (mean, sd) = inference::diagnostics::mean_and_sd(&values).unwrap();
    // 3.0 +- 1.0 by 190 effective draws.
    assert!((mean - 3.0).abs() < 0.25, "{mean}");
    assert!((sd - 1.0).abs() < 0.2, "{sd}");
}

#[test]
fn the_order_within_a_round_does_not_matter() {
    let problem = output_problems::shear_building();
    let [forward, backward] = [false, true].map(|reversed| run(&problem, 1, reversed));
    assert_eq!(forward.posterior(), backward.posterior());
    assert_eq!(forward.record(), backward.record());
    assert_eq!(forward.stages(), backward.stages());
}

#[test]
fn the_final_draws_belong_to_the_last_stage() {
    let problem = output_problems::shear_building();
    let mut sampler = start(&problem, 1);
    let mut last = 0;
    while !sampler.round().pending().is_empty() {
        let progress = sampler.progress();
        assert!(progress.stage >= last, "{progress:?} after stage {last}");
        last = progress.stage;
        tell_round(&problem, &mut sampler, false);
    }
    assert!(last > 1, "{last}");
    assert_eq!(last, sampler.stages().len());
    assert_eq!(sampler.progress().stage, last);
}

/// The literal moduli of Bekker's law lie on a ridge beside the border of what the model accepts.
#[test]
fn literal_moduli_are_right_or_left_to_draws_of_the_model() {
    for problem in [
        output_problems::bekker_known_noise(),
        output_problems::bekker_unknown_noise(),
    ] {
        let mut sampler = start(&problem, 1);
        while !sampler.round().pending().is_empty() && !sampler.record().fell_back {
            tell_round(&problem, &mut sampler, false);
        }
        let is_right = sampler
            .posterior()
            .is_some_and(|posterior| (posterior.log_evidence - problem.log_evidence).abs() < 0.1);
        assert!(sampler.record().fell_back || is_right, "{}", problem.name);
    }
}

#[test]
fn an_eggbox_is_left_to_draws_of_the_model() {
    let problem = output_problems::eggbox();
    let sampler = run(&problem, 1, false);
    assert!(sampler.record().fell_back);
    let posterior = sampler.posterior().unwrap();
    assert!((posterior.log_evidence - problem.log_evidence).abs() < 0.1);
}

/// A line through 20 data of noise 1, with jumps.
fn jumping_line(theta: &[f64], scatter: f64) -> Vec<f64> {
    let bits = theta
        .iter()
        .fold(1_u64, |hash, x| hash.wrapping_mul(31).wrapping_add(x.to_bits()));
    let jumps = Stream::new(bits, 0, 0, 0).normals(20);
    let line = |i: usize| theta[0] + theta[1] * abscissa(i);
    (0..20).map(|i| line(i) + scatter * jumps[i]).collect()
}

fn abscissa(i: usize) -> f64 {
    i as f64 / 10.0 - 0.95
}

/// The problem of a line with jumps.
///
/// # Arguments
/// - `miss`: the data lie above and below 1 in turn, by this \[noise sds\].
/// - `bound`: the prior of both parameters is uniform between this and its negative.
fn jumping_problem(outputs: fn(&[f64]) -> Option<Vec<f64>>, miss: f64, bound: f64) -> OutputProblem {
    let uniform = Distribution::Uniform {
        lower: -bound,
        upper: bound,
    };
    let datum = |run: usize| Datum {
        run,
        channel: 0,
        value: 1.0 + if run.is_multiple_of(2) { miss } else { -miss },
        sd: ErrorSd::Known(1.0),
    };
    OutputProblem {
        name: "rough",
        prior: Prior::new(vec![Marginal::new(uniform, None).unwrap(); 2]),
        likelihood: Likelihood::new((0..20).map(datum).collect()).unwrap(),
        model_parameters: 2,
        outputs,
        log_evidence: 0.0,
    }
}

/// Returns the log-evidence of the line without jumps for [`jumping_problem`], with independent normal errors.
///
/// # Arguments
/// - `miss`, `bound`: as of [`jumping_problem`]. `variance`: that of an error.
fn line_log_evidence(miss: f64, bound: f64, variance: f64) -> f64 {
    let squares: f64 = (0..20).map(|i| abscissa(i) * abscissa(i)).sum();
    // The alternation is orthogonal to the constant; its projection on the slope is taken out.
    let alternation = |i: usize| if i.is_multiple_of(2) { miss } else { -miss };
    let slope = (0..20).map(|i| alternation(i) * abscissa(i)).sum::<f64>() / squares;
    let residuals = 20.0 * miss * miss - slope * slope * squares;
    let two_pi = 2.0 * std::f64::consts::PI;
    -0.5 * residuals / variance
        - 9.0 * (two_pi * variance).ln()
        - 0.5 * (20.0 * squares).ln()
        - 2.0 * (2.0 * bound).ln()
}

/// A line with jumps of the size of the noise: the scatter is measured and becomes part of the error model.
#[test]
fn the_scatter_of_a_rough_model_is_measured() {
    const SCATTER: f64 = 0.5;
    let problem = jumping_problem(|theta| Some(jumping_line(theta, SCATTER)), 0.0, 5.0);
    let sampler = run(&problem, 1, false);
    let record = sampler.record();

    assert!(!record.fell_back);
    assert!(
        (record.numerical_noise[0] / SCATTER - 1.0).abs() < 0.3,
        "{record:?}"
    );
}

/// A line that misses its data by 12 noise sds, with jumps of a twentieth of one: they scatter the log-likelihood by 2.7 nats. The
/// evidence is that of the line without jumps, in closed form.
#[test]
fn scatter_below_the_noise_is_felt_where_the_model_misses_its_data() {
    const SCATTER: f64 = 0.05;
    const MISS: f64 = 12.0;
    let problem = jumping_problem(|theta| Some(jumping_line(theta, SCATTER)), MISS, 5.0);
    let sampler = run(&problem, 1, false);
    let record = sampler.record();
    assert!(!record.fell_back);
    let sd = record.numerical_noise[0];
    assert!((sd / SCATTER - 1.0).abs() < 0.3, "{record:?}");

    let expected = line_log_evidence(MISS, 5.0, 1.0 + sd * sd);
    let posterior = sampler.posterior().unwrap();
    let error = posterior.log_evidence - expected;
    assert!(error.abs() < 0.2, "{error} ± {}", posterior.log_evidence_se);
}

/// A line that misses its data by 20 noise sds, with jumps of half of one, beside a discrepancy that takes up the misfit: the jumps move the
/// log-likelihood by far less than 20 noise sds would let them. The evidence is that of the line without jumps, in closed form at each size
/// of the discrepancy.
#[test]
fn a_model_that_misses_its_data_is_emulated_with_a_discrepancy() {
    const SCATTER: f64 = 0.5;
    const MISS: f64 = 20.0;
    const BOUND: f64 = 60.0;
    let mut problem = jumping_problem(|theta| Some(jumping_line(theta, SCATTER)), MISS, BOUND);
    let common = (0..20).map(|datum| CommonError {
        data: vec![datum],
        size: CommonErrorSize::Discrepancy { group: 0 },
    });
    let data = problem.likelihood.data().to_vec();
    let unknown = vec![Discrepancy::Unknown];
    problem.likelihood =
        Likelihood::with_common(data, ErrorLaw::Gaussian, common.collect(), unknown).unwrap();
    let sampler = run(&problem, 1, false);
    let record = sampler.record();
    assert!(!record.fell_back);
    let posterior = sampler.posterior().unwrap();
    assert!(posterior.evaluations <= 400, "{}", posterior.evaluations);

    let noise_variance = 1.0 + record.numerical_noise.first().map_or(0.0, |sd| sd * sd);
    let levels = discrepancy_levels();
    let mean: f64 = levels
        .iter()
        .map(|m| libm::exp(line_log_evidence(MISS, BOUND, noise_variance * (1.0 + m * m))))
        .sum::<f64>()
        / levels.len() as f64;
    let error = posterior.log_evidence - libm::log(mean);
    assert!(error.abs() < 0.2, "{error} ± {}", posterior.log_evidence_se);
}

/// A quarter of the prior is rejected, beside the posterior.
#[test]
fn rejections_are_part_of_the_prior() {
    let problem = {
        let mut problem = output_problems::correlated_gaussian();
        // The half of the posterior with x3 < 3 is rejected.
        problem.outputs = |x| (x[3] > 3.0).then(|| crate::problems::whitened(x));
        problem
    };
    let sampler = run(&problem, 2, false);
    let posterior = sampler.posterior().unwrap();
    assert!(!sampler.record().fell_back);
    let error = posterior.log_evidence - (problem.log_evidence - std::f64::consts::LN_2);
    assert!(error.abs() < 4.0 * posterior.log_evidence_se + 0.02, "{error}");
    assert!(posterior.particles.iter().all(|particle| particle.theta[3] > 3.0));
}
