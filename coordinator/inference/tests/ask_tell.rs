//! The ask/tell protocol: order, refusals, impossible likelihoods, rounds without proposals.

use crate::problems;
use crate::setup::{shuffle, uniform};
use inference::{
    Algorithm, InferenceFailure, Sampler, StageMethod, TellError, TellProgress, TmcmcSettings,
    TmcmcSettingsError,
};
use statistics::{LogLikelihood, Prior};

fn small() -> TmcmcSettings {
    TmcmcSettings {
        particles: 60,
        moves: [3, 8],
        ..TmcmcSettings::default()
    }
}

fn unit_prior(dimension: usize) -> Prior {
    Prior::new(vec![uniform(0.0, 1.0); dimension])
}

/// Runs to the end, telling each round in an order of its own.
fn run(prior: Prior, settings: TmcmcSettings, score: impl Fn(&[f64]) -> f64, seed: u64) -> Sampler {
    let mut sampler = Sampler::new(prior, settings).unwrap();
    loop {
        let mut proposals = sampler.round().pending().to_vec();
        if seed > 0 {
            shuffle(&mut proposals, seed, sampler.round().number());
        }
        let mut progress = TellProgress::Waiting;
        for proposal in proposals {
            assert_eq!(progress, TellProgress::Waiting);
            progress = sampler
                .tell(
                    proposal.particle,
                    LogLikelihood::new(score(&proposal.theta)).unwrap(),
                )
                .unwrap();
        }
        match progress {
            TellProgress::NextRound | TellProgress::StageFinished => {
                assert!(!sampler.round().pending().is_empty())
            }
            TellProgress::Finished | TellProgress::Failed(_) => return sampler,
            TellProgress::Waiting => panic!("a completed round left the sampler waiting"),
        }
    }
}

#[test]
fn the_order_of_tells_is_irrelevant() {
    let problem = problems::shear_building();
    for algorithm in [Algorithm::Tmcmc, Algorithm::ChingChen2007, Algorithm::Basis] {
        let settings = TmcmcSettings { algorithm, ..small() };
        let score = |theta: &[f64]| problem.score(theta).value();
        let [straight, shuffled] = [0, 99].map(|seed| run(problem.prior(), settings, score, seed));
        let bits = |sampler: &Sampler| {
            let posterior = sampler.posterior().unwrap();
            let mut bits: Vec<u64> = posterior
                .particles
                .iter()
                .flat_map(|p| &p.theta)
                .map(|x| x.to_bits())
                .collect();
            bits.push(posterior.log_evidence.to_bits());
            bits.push(posterior.log_evidence_se.to_bits());
            bits
        };
        assert_eq!(bits(&straight), bits(&shuffled));
        assert_eq!(straight.stages(), shuffled.stages());
    }
}

#[test]
fn the_seed_matters() {
    let problem = problems::shear_building();
    let run = |seed| {
        problem
            .run(TmcmcSettings { seed, ..small() })
            .posterior()
            .unwrap()
            .log_evidence
    };
    assert!((run(1) - run(2)).abs() > 0.0);
}

#[test]
fn pending_holds_still_and_refuses_what_it_did_not_ask() {
    let mut sampler = Sampler::new(unit_prior(2), small()).unwrap();
    let before = sampler.round().pending().to_vec();
    let value = LogLikelihood::new(-1.0).unwrap();
    assert_eq!(sampler.tell(7, value), Ok(TellProgress::Waiting));
    assert_eq!(sampler.round().pending(), before);
    assert!(sampler.round().is_told(7) && !sampler.round().is_told(8));
    assert_eq!((sampler.round().told(), sampler.round().pending().len()), (1, 60));
    assert_eq!(
        sampler.tell(7, value),
        Err(TellError::AlreadyTold {
            round: 0,
            particle: 7
        })
    );
    assert_eq!(
        sampler.tell(60, value),
        Err(TellError::NotPending {
            round: 0,
            particle: 60
        })
    );
}

#[test]
fn a_prior_may_be_mostly_impossible() {
    // L = 1 on the tenth x < 0.1, impossible elsewhere: Z = 0.1 and the posterior is uniform on it.
    let settings = TmcmcSettings {
        particles: 1000,
        ..TmcmcSettings::default()
    };
    let score = |theta: &[f64]| if theta[0] < 0.1 { 0.0 } else { f64::NEG_INFINITY };
    for stages in [StageMethod::Draws, StageMethod::Moves] {
        let sampler = run(unit_prior(2), TmcmcSettings { stages, ..settings }, score, 0);
        let posterior = sampler.posterior().unwrap();
        let (error, se) = (posterior.log_evidence - 0.1_f64.ln(), posterior.log_evidence_se);
        assert!(error.abs() < 4.0 * se, "{error}, {se}");
        match stages {
            // The stage draws from its mixture, nearly always inside, so the acceptance of the prior does not count.
            StageMethod::Draws | StageMethod::Emulated => assert!(se < 0.02, "{se}"),
            // sqrt((1 - f) / (f n)) at f = 0.1, n = 1000; the stage itself is exact.
            StageMethod::Moves => assert!((se - 0.095).abs() < 0.015, "{se}"),
        }
        assert!(
            posterior
                .particles
                .iter()
                .all(|p| p.theta[0] < 0.1 && p.log_likelihood.value().abs() < 1e-300)
        );
        assert!(posterior.rejected > 800 && posterior.rejected < posterior.evaluations);
        let first: Vec<f64> = posterior.particles.iter().map(|p| p.theta[0]).collect();
        let (mean, sd) = inference::diagnostics::mean_and_sd(&first).unwrap();
        assert!(
            (mean - 0.05).abs() < 0.008 && (sd / 0.1 - 12.0_f64.sqrt().recip()).abs() < 0.04,
            "{mean} {sd}"
        );
    }
}

#[test]
fn a_model_that_rejects_everything_is_reported() {
    let sampler = run(unit_prior(2), small(), |_| f64::NEG_INFINITY, 0);
    let failure = sampler.failure().unwrap();
    assert_eq!(failure, InferenceFailure::AllImpossible { draws: 60 });
    assert_eq!(
        failure.to_string(),
        "all 60 prior draws were rejected by the model"
    );
    assert!(sampler.round().pending().is_empty() && sampler.posterior().is_none());
    let few = run(
        unit_prior(3),
        small(),
        |theta| if theta[0] < 0.05 { 0.0 } else { f64::NEG_INFINITY },
        0,
    );
    assert!(matches!(
        few.failure(),
        Some(InferenceFailure::TooFewPossible {
            draws: 60,
            needed: 5,
            ..
        })
    ));
}

#[test]
fn log_likelihoods_too_far_apart_are_reported() {
    let sampler = run(unit_prior(1), small(), |theta| -1e300 * theta[0], 0);
    assert!(sampler.failure().is_some() || sampler.posterior().is_some());
}

/// In a corner of ten dimensions nearly every proposal of a small population leaves the prior.
#[test]
fn rounds_without_proposals_inside_the_prior_advance_by_themselves() {
    let settings = TmcmcSettings {
        particles: 22,
        moves: [1, 3],
        ..TmcmcSettings::default()
    };
    let sampler = run(
        unit_prior(10),
        settings,
        |theta| -2000.0 * theta.iter().sum::<f64>(),
        0,
    );
    let posterior = sampler.posterior().unwrap();
    assert!(sampler.round().number() > 10 && posterior.particles.len() == 22);
}

#[test]
fn a_flat_likelihood_gives_back_the_prior() {
    for (stages, max_se) in [(StageMethod::Draws, 0.1), (StageMethod::Moves, 1e-9)] {
        let sampler = run(unit_prior(1), TmcmcSettings { stages, ..small() }, |_| -3.0, 0);
        let posterior = sampler.posterior().unwrap();
        assert_eq!(sampler.stages().len(), 1);
        let (error, se) = ((posterior.log_evidence + 3.0).abs(), posterior.log_evidence_se);
        assert!(se < max_se && error <= (4.0 * se).max(1e-12), "{error}, {se}");
        assert!(posterior.equilibrated);
    }
}

#[test]
fn settings_that_cannot_work_are_refused() {
    let refuse = |dimension, settings| {
        Sampler::new(unit_prior(dimension), settings)
            .map(drop)
            .unwrap_err()
    };
    assert_eq!(refuse(0, small()), TmcmcSettingsError::NoParameters);
    let few = TmcmcSettings {
        particles: 11,
        ..small()
    };
    assert_eq!(
        refuse(5, few).to_string(),
        "11 particles are too few for 5 parameters, which need at least 12"
    );
    let moves = TmcmcSettings {
        moves: [5, 4],
        ..small()
    };
    assert_eq!(
        refuse(1, moves).to_string(),
        "moves [5, 4] are not 1 <= least <= most <= 10000"
    );
    let target = TmcmcSettings {
        target_cov: f64::NAN,
        ..small()
    };
    assert!(matches!(refuse(1, target), TmcmcSettingsError::TargetCov { .. }));
}
