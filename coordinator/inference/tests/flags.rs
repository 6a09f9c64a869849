//! Runs out of equilibrium are flagged.

use crate::problems::{self, Problem};
use inference::{Algorithm, StageMethod, TmcmcSettings};

/// Every run is flagged, or its evidence is within four standard errors (and 0.3 nats for their own error).
fn right_or_flagged(problem: &Problem, settings: TmcmcSettings) -> usize {
    let mut flagged = 0;
    for seed in 1..=4 {
        let sampler = problem.run(TmcmcSettings { seed, ..settings });
        let posterior = sampler.posterior().unwrap();
        let error = posterior.log_evidence - problem.log_evidence;
        flagged += usize::from(!posterior.equilibrated);
        assert!(
            !posterior.equilibrated || error.abs() < 4.0 * posterior.log_evidence_se + 0.3,
            "{} seed {seed}: silently off by {error}, standard error {}",
            problem.name,
            posterior.log_evidence_se
        );
    }
    flagged
}

#[test]
fn bekker_with_known_noise_is_right_or_flagged() {
    right_or_flagged(
        &problems::bekker_known_noise(),
        TmcmcSettings {
            particles: 400,
            ..TmcmcSettings::default()
        },
    );
}

#[test]
fn bekker_with_unknown_noise_is_right_or_flagged() {
    let settings = TmcmcSettings {
        particles: 400,
        ..TmcmcSettings::default()
    };
    assert_eq!(right_or_flagged(&problems::bekker_unknown_noise(), settings), 4);
}

#[test]
fn too_few_moves_are_flagged() {
    let settings = TmcmcSettings {
        stages: StageMethod::Moves,
        particles: 200,
        moves: [1, 1],
        ..TmcmcSettings::default()
    };
    assert_eq!(right_or_flagged(&problems::correlated_gaussian(), settings), 4);
}

#[test]
fn the_original_sampler_is_never_silently_wrong() {
    let settings = TmcmcSettings {
        algorithm: Algorithm::ChingChen2007,
        ..TmcmcSettings::default()
    };
    for problem in [problems::bekker_known_noise(), problems::bekker_unknown_noise()] {
        assert_eq!(right_or_flagged(&problem, settings), 4);
    }
    // Two parameters and four stages are within its reach.
    let posterior = problems::shells().run(settings).posterior().cloned().unwrap();
    assert_eq!(posterior.particles.len(), 1000);
    assert!((posterior.log_evidence - problems::shells().log_evidence).abs() < 0.5);
}

#[test]
fn basis_is_never_silently_wrong() {
    let settings = TmcmcSettings {
        algorithm: Algorithm::Basis,
        ..TmcmcSettings::default()
    };
    for problem in [
        problems::correlated_gaussian(),
        problems::bekker_known_noise(),
        problems::bekker_unknown_noise(),
    ] {
        assert_eq!(right_or_flagged(&problem, settings), 4, "{}", problem.name);
    }
    right_or_flagged(&problems::eggbox(), settings);
    // One step for every particle in each of a few stages.
    let sampler = problems::shells().run(settings);
    let posterior = sampler.posterior().unwrap();
    assert_eq!(posterior.particles.len(), 1000);
    assert!(sampler.stages().iter().all(|stage| stage.steps == 1));
    assert!((posterior.log_evidence - problems::shells().log_evidence).abs() < 0.5);
}
