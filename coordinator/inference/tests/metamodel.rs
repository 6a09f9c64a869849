//! A metamodel saves evaluations and keeps the posterior.

use crate::setup::{data, standard_normals};
use inference::diagnostics::mean_and_sd;
use inference::{EvaluationResult, PosteriorSample, Sampler, StageMethod, TmcmcSettings};
use statistics::{ErrorSd, Likelihood, LogLikelihood, Metamodel, ModelPair};

const MEASURED: [f64; 2] = [1.2, 0.9];
const NOISE: f64 = 0.25;

/// The fine model, whose evaluations count.
fn fine(theta: &[f64]) -> Vec<f64> {
    let (x, y) = (theta[0], theta[1]);
    vec![x + 0.4 * y * y, libm::exp(0.5 * y) - 0.3 * x * y]
}

/// Biased, of another shape, and without an answer where a tenth of the posterior lies.
fn coarse(theta: &[f64]) -> Option<Vec<f64>> {
    let (x, y) = (theta[0], theta[1]);
    (y < 0.8).then(|| vec![0.7 * x + 0.2, 1.0 + 0.4 * y])
}

fn likelihood() -> Likelihood {
    data(&MEASURED, |_| ErrorSd::Known(NOISE))
}

/// Returns a sampler at its end, the metamodel's moves, and how many of them were accepted.
fn run(settings: TmcmcSettings, coarse: fn(&[f64]) -> Option<Vec<f64>>) -> (Sampler, [u64; 3]) {
    let likelihood = likelihood();
    let mut sampler = Sampler::with_metamodel(standard_normals(2), settings, likelihood.clone()).unwrap();
    let [mut moves, mut subchains, mut found_out] = [0; 3];
    let score = |theta: &[f64]| -> (LogLikelihood, Option<ModelPair>) {
        let fine = fine(theta);
        let log_likelihood = likelihood.log_likelihood(&fine, theta).unwrap();
        (
            log_likelihood,
            coarse(theta).map(|coarse| ModelPair { fine, coarse }),
        )
    };
    while sampler.posterior().is_none() {
        // as it travels
        let text = sampler.metamodel().map(|m| serde_json::to_string(m).unwrap());
        let metamodel: Option<Metamodel> = text.map(|text| serde_json::from_str(&text).unwrap());
        for proposal in sampler.round().pending().to_vec() {
            let answer = match (proposal.subchain, &metamodel) {
                (Some(subchain), Some(metamodel)) => {
                    let end = metamodel.run(&subchain, &proposal.theta, coarse).unwrap();
                    let scored = (end.accepted > 0).then(|| score(&end.theta));
                    moves += u64::from(end.moves);
                    subchains += 1;
                    found_out += u64::from(scored.is_some());
                    EvaluationResult::AtSubchainEnd { end, found: scored }
                }
                _ => {
                    let (log_likelihood, pair) = score(&proposal.theta);
                    EvaluationResult::AtProposal { log_likelihood, pair }
                }
            };
            sampler.tell(proposal.particle, answer).unwrap();
        }
    }
    (sampler, [moves, subchains, found_out])
}

/// Returns the means of x, y, their squares, and ln Z, by sums over a grid.
fn truth() -> ([f64; 4], f64) {
    let (likelihood, prior) = (likelihood(), standard_normals(2));
    let step = 0.02;
    let mut sums = [0.0; 5];
    for i in -250..=250 {
        for j in -250..=250 {
            let theta = [f64::from(i) * step, f64::from(j) * step];
            let log =
                likelihood.log_likelihood(&fine(&theta), &theta).unwrap().value() + prior.log_density(&theta);
            let weight = libm::exp(log) * step * step;
            let [x, y] = theta;
            for (sum, value) in sums.iter_mut().zip([1.0, x, y, x * x, y * y]) {
                *sum += weight * value;
            }
        }
    }
    ([1, 2, 3, 4].map(|k| sums[k] / sums[0]), libm::log(sums[0]))
}

fn moments(posterior: &PosteriorSample) -> [f64; 4] {
    let mean = |value: fn(&[f64]) -> f64| {
        let values: Vec<f64> = posterior.particles.iter().map(|p| value(&p.theta)).collect();
        mean_and_sd(&values).unwrap().0
    };
    [
        mean(|t| t[0]),
        mean(|t| t[1]),
        mean(|t| t[0] * t[0]),
        mean(|t| t[1] * t[1]),
    ]
}

fn settings(seed: u64, metamodel_moves: usize) -> TmcmcSettings {
    TmcmcSettings {
        particles: 500,
        stages: StageMethod::Moves,
        moves: if metamodel_moves > 0 { [4, 30] } else { [10, 60] },
        seed,
        metamodel_moves,
        ..TmcmcSettings::default()
    }
}

#[test]
fn the_posterior_is_that_of_the_fine_model() {
    let (expected, log_evidence) = truth();
    let seeds = 1..=8;
    let runs: Vec<([f64; 4], f64)> = seeds
        .map(|seed| {
            let (sampler, [moves, ..]) = run(settings(seed, 20), coarse);
            let posterior = sampler.posterior().unwrap();
            assert!(posterior.equilibrated, "seed {seed}");
            assert!(moves > 10 * posterior.evaluations / 2, "{moves} moves");
            (moments(posterior), posterior.log_evidence)
        })
        .collect();
    for k in 0..4 {
        let values: Vec<f64> = runs.iter().map(|(m, _)| m[k]).collect();
        let (mean, sd) = mean_and_sd(&values).unwrap();
        let error = sd / (runs.len() as f64).sqrt();
        assert!(
            (mean - expected[k]).abs() < 3.5 * error,
            "moment {k}: {mean} +- {error}, {}",
            expected[k]
        );
        assert!(error < 0.05, "moment {k}: +- {error}");
    }
    let evidences: Vec<f64> = runs.iter().map(|r| r.1).collect();
    let (mean, sd) = mean_and_sd(&evidences).unwrap();
    let error = sd / (runs.len() as f64).sqrt();
    assert!(
        (mean - log_evidence).abs() < 3.5 * error,
        "{mean} +- {error}, {log_evidence}"
    );
}

#[test]
fn fewer_evaluations_are_needed_than_without() {
    let evaluations = |moves| run(settings(1, moves), coarse).0.posterior().unwrap().evaluations;
    let (with, without) = (evaluations(20), evaluations(0));
    assert!(2 * with < without, "{with} with, {without} without");
}

/// Returns the fine model less a quadratic, which a regression can find.
fn quadratic_off(theta: &[f64]) -> Option<Vec<f64>> {
    let (x, y) = (theta[0], theta[1]);
    let off = [0.3 + 0.1 * x - 0.2 * x * y, -0.2 + 0.1 * y * y];
    Some(fine(theta).iter().zip(off).map(|(f, o)| f - o).collect())
}

#[test]
fn a_quadratic_difference_is_found() {
    // a metamodel that is right is never contradicted: only plain steps are refused
    let (sampler, [_, subchains, found_out]) = run(settings(3, 20), quadratic_off);
    let stage = sampler.stages().last().unwrap();
    assert!(stage.acceptance > 0.75 * 0.8, "{}", stage.acceptance);
    assert!(
        found_out > subchains * 95 / 100,
        "{found_out} of {subchains} subchains moved"
    );
}

#[test]
fn subchains_that_never_move_ask_for_nothing() {
    fn never(_: &[f64]) -> Option<Vec<f64>> {
        None
    }
    // without a pair nothing is learnt, and every step is a plain one
    let (sampler, [_, subchains, _]) = run(settings(1, 20), never);
    assert_eq!(subchains, 0);
    assert!(sampler.posterior().is_some());
}

#[test]
fn an_answer_to_another_question_is_refused() {
    let mut sampler = Sampler::with_metamodel(standard_normals(2), settings(1, 5), likelihood()).unwrap();
    let end = statistics::SubchainEnd {
        theta: vec![0.0, 0.0],
        log_gain: 0.0,
        moves: 5,
        accepted: 0,
        scaled: 4,
        scaled_accepted: 0,
    };
    let error = sampler
        .tell(3, EvaluationResult::AtSubchainEnd { end, found: None })
        .unwrap_err();
    assert!(error.to_string().contains("a subchain was told"), "{error}");
}

#[test]
fn the_algorithms_without_steps_take_no_metamodel() {
    let settings = TmcmcSettings {
        algorithm: inference::Algorithm::Basis,
        ..settings(1, 5)
    };
    let error = Sampler::with_metamodel(standard_normals(2), settings, likelihood()).unwrap_err();
    assert!(error.to_string().contains("metamodel_moves 5"), "{error}");
}
