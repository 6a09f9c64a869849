//! Optima by generations: known ones, bounds, rejections, determinism.

use crate::problems::{self, Problem};
use crate::setup::{lognormal, shuffle, uniform};
use inference::evolution::{CmaEsSettings, Evolution, EvolutionSettings, EvolutionSettingsError, GaSettings};
use inference::point_estimate::{ModeEstimate, StopReason};
use inference::{InferenceFailure, TellError, TellProgress};
use statistics::{LogLikelihood, Marginal, Prior};

const SEEDS: std::ops::RangeInclusive<u64> = 1..=4;

fn genetic(seed: u64) -> EvolutionSettings {
    EvolutionSettings::Ga(GaSettings {
        seed,
        ..GaSettings::default()
    })
}

fn adapting(seed: u64) -> EvolutionSettings {
    EvolutionSettings::CmaEs(CmaEsSettings {
        seed,
        ..CmaEsSettings::default()
    })
}

/// Settings of both strategies, for every seed.
fn all() -> impl Iterator<Item = EvolutionSettings> {
    SEEDS.flat_map(|seed| [genetic(seed), adapting(seed)])
}

/// Runs an evolution to its end, each generation told in an order of its own.
fn run(
    prior: &[Marginal],
    settings: EvolutionSettings,
    score: impl Fn(&[f64]) -> f64,
    order: impl Fn(&mut Vec<usize>, u64),
) -> Evolution {
    let mut evolution = Evolution::new(Prior::new(prior.to_vec()), settings).unwrap();
    while !evolution.round().pending().is_empty() {
        let pending = evolution.round().pending().to_vec();
        let mut indices: Vec<usize> = (0..pending.len()).collect();
        order(&mut indices, evolution.round().number());
        for (count, &k) in indices.iter().enumerate() {
            let value = LogLikelihood::new(score(&pending[k].theta)).unwrap();
            let progress = evolution.tell(k, value).unwrap();
            assert_eq!(progress == TellProgress::Waiting, count + 1 < indices.len());
        }
    }
    evolution
}

fn find(prior: &[Marginal], settings: EvolutionSettings, score: impl Fn(&[f64]) -> f64) -> ModeEstimate {
    run(prior, settings, score, |_, _| ()).estimate().unwrap().clone()
}

/// Every evolution ends within `loss` nats of the optimum, which it does not exceed.
fn check(problem: &Problem, settings: impl Iterator<Item = EvolutionSettings>, loss: f64) {
    for settings in settings {
        let evolution = problem.evolve(settings);
        let estimate = evolution.estimate().unwrap();
        let reached = estimate.log_posterior();
        assert!(
            (problem.optimum - loss..problem.optimum + 1e-6).contains(&reached),
            "{}, {settings:?}: {reached}, not {}",
            problem.name,
            problem.optimum
        );
        let theta = &estimate.theta;
        let at = problem.score(theta).value() + problem.prior().log_density(theta);
        assert!((at - reached).abs() < 1e-9);
        // The genetic algorithm may still be creeping when its generations have passed.
        let settled = estimate.stop == StopReason::Stagnation || matches!(settings, EvolutionSettings::Ga(_));
        assert!(settled, "{} {settings:?}", problem.name);
        assert!(estimate.evaluations <= settings.max_evaluations() as u64);
        assert_eq!(evolution.count().evaluations as u64, estimate.evaluations);
    }
}

#[test]
fn the_mode_of_a_correlated_gaussian_is_found() {
    check(&problems::correlated_gaussian(), all(), 0.1);
}

/// The other mode is 0.128 nats lower.
#[test]
fn the_higher_of_two_modes_is_found() {
    check(&problems::shear_building(), SEEDS.map(adapting), 0.01);
    check(&problems::shear_building(), SEEDS.map(genetic), 0.14);
}

#[test]
fn bekker_s_law_in_good_coordinates_is_fitted() {
    check(&problems::bekker_reparametrised(), all(), 0.1);
}

/// A ridge 1e-5 prior widths thick beside a quarter of the prior that the model refuses.
#[test]
fn literal_moduli_are_fitted_by_covariance_adaptation() {
    check(&problems::bekker_known_noise(), SEEDS.map(adapting), 0.01);
    check(&problems::bekker_unknown_noise(), SEEDS.map(adapting), 0.01);
}

#[test]
fn an_optimum_in_a_corner_is_reached_exactly() {
    // Both bounds pull; the third parameter has its optimum inside, and hangs on the first.
    let prior = [uniform(0.0, 1.0), uniform(-2.0, 3.0), uniform(-1.0, 1.0)];
    let score = |x: &[f64]| {
        let inside = (x[2] - 0.5 * x[0]) / 0.01;
        20.0 * x[0] - 3.0 * x[1] - 0.5 * inside * inside
    };
    for settings in all() {
        let estimate = find(&prior, settings, score);
        assert_eq!(
            estimate.at_bound,
            [true, true, false],
            "{settings:?}: {estimate:?}"
        );
        assert_eq!(estimate.theta[..2], [1.0, -2.0]);
        assert!(
            (estimate.theta[2] - 0.5).abs() < 1e-3,
            "{settings:?}: {estimate:?}"
        );
        assert_eq!((estimate.laplace, estimate.stop), (None, StopReason::Stagnation));
    }
}

/// A lognormal prior's mode is that of its density as declared, exp(mu - s^2), not of ln x.
#[test]
fn the_density_as_declared_counts() {
    let prior = [lognormal(2.0, libm::exp(0.5))];
    for settings in all() {
        let estimate = find(&prior, settings, |_| 0.0);
        assert!(
            (estimate.theta[0] / (2.0 * libm::exp(-0.25)) - 1.0).abs() < 0.02,
            "{estimate:?}"
        );
    }
}

#[test]
fn rejected_individuals_are_counted_and_the_wall_is_explored() {
    // The free optimum lies behind the wall x + y < 1.
    let prior = [uniform(0.0, 1.0), uniform(0.0, 1.0)];
    let score = |x: &[f64]| {
        if x[0] + x[1] > 1.0 {
            return f64::NEG_INFINITY;
        }
        -50.0 * ((x[0] - 0.9) * (x[0] - 0.9) + (x[1] - 0.5) * (x[1] - 0.5))
    };
    for settings in all() {
        let estimate = find(&prior, settings, score);
        assert!(estimate.rejected > 20 && estimate.rejected < estimate.evaluations);
        // At (0.7, 0.3): -50 (0.04 + 0.04).
        assert!(
            (estimate.log_likelihood + 4.0).abs() < 0.1,
            "{settings:?}: {estimate:?}"
        );
    }
}

#[test]
fn a_model_that_rejects_everything_fails_with_half_of_the_budget() {
    for settings in [genetic(1), adapting(1)] {
        let ended = run(&[uniform(0.0, 1.0)], settings, |_| f64::NEG_INFINITY, |_, _| ());
        let Some(InferenceFailure::AllImpossible { draws }) = ended.failure() else {
            panic!("{:?}", ended.failure());
        };
        assert!(ended.estimate().is_none() && ended.round().pending().is_empty());
        let half = settings.max_evaluations() / 2;
        assert!(
            draws <= half && draws > half / 2,
            "{draws} of {}",
            settings.max_evaluations()
        );
        assert_eq!(ended.count().rejected, draws);
    }
}

/// One in a hundred prior draws is possible, and the first generations may hold none.
#[test]
fn a_possible_corner_is_found_by_drawing_again() {
    let prior = [uniform(0.0, 1.0), uniform(0.0, 1.0)];
    let score = |x: &[f64]| {
        if x[0] < 0.1 && x[1] < 0.1 {
            x[0]
        } else {
            f64::NEG_INFINITY
        }
    };
    for settings in all() {
        let estimate = find(&prior, settings, score);
        assert!(estimate.log_likelihood > 0.09, "{settings:?}: {estimate:?}");
    }
}

#[test]
fn the_order_within_a_generation_does_not_matter() {
    let score = |x: &[f64]| {
        if x[0] > 0.9 {
            f64::NEG_INFINITY
        } else {
            -libm::cos(9.0 * x[0]) - x[1] * x[1]
        }
    };
    let prior = [uniform(0.0, 1.0), uniform(-1.0, 3.0)];
    for settings in [genetic(1), adapting(1)] {
        let straight = run(&prior, settings, score, |_, _| ());
        let shuffled = run(&prior, settings, score, |indices, round| {
            shuffle(indices, 3, round)
        });
        assert_eq!(straight.estimate(), shuffled.estimate());
    }
    for [first, second] in [[genetic(1), genetic(2)], [adapting(1), adapting(2)]] {
        assert_ne!(
            find(&prior, first, score).history,
            find(&prior, second, score).history
        );
    }
}

#[test]
fn the_history_rises_to_the_best() {
    for settings in [genetic(1), adapting(1)] {
        let evolution = problems::shear_building().evolve(settings);
        let estimate = evolution.estimate().unwrap();
        let bests: Vec<f64> = estimate.history.iter().map(|g| g.best.unwrap()).collect();
        assert!(bests.is_sorted());
        assert_eq!(bests.last(), Some(&estimate.log_posterior()));
        assert!(
            estimate
                .history
                .iter()
                .all(|g| g.mean.unwrap() <= g.best.unwrap())
        );
        assert_eq!(estimate.history.last().unwrap().evaluations, estimate.evaluations);
        assert_eq!(estimate.history.len() as u64, evolution.round().number());
    }
}

#[test]
fn an_evolution_that_is_cut_short_says_so() {
    let problem = problems::correlated_gaussian();
    let short = EvolutionSettings::Ga(GaSettings {
        generations: 10,
        ..GaSettings::default()
    });
    let estimate = problem.evolve(short).estimate().unwrap().clone();
    assert_eq!(
        (estimate.stop, estimate.history.len()),
        (StopReason::Generations, 10)
    );
    // The elite is not evaluated again.
    assert_eq!(estimate.evaluations, 100 + 9 * 98);
    for max_evaluations in [16, 50, 203] {
        let short = EvolutionSettings::CmaEs(CmaEsSettings {
            max_evaluations,
            ..CmaEsSettings::default()
        });
        let estimate = problem.evolve(short).estimate().unwrap().clone();
        assert_eq!(estimate.stop, StopReason::Budget, "{max_evaluations}");
        assert!(estimate.evaluations <= max_evaluations as u64);
    }
}

#[test]
fn an_evolution_without_restarts_ends_when_it_has_converged() {
    let once = EvolutionSettings::CmaEs(CmaEsSettings {
        restarts: 0,
        ..CmaEsSettings::default()
    });
    let evolution = problems::correlated_gaussian().evolve(once);
    let estimate = evolution.estimate().unwrap();
    assert!(
        estimate.stop == StopReason::Stagnation && estimate.evaluations < 2000,
        "{estimate:?}"
    );
}

#[test]
fn what_nobody_asked_for_is_refused_and_changes_nothing() {
    let mut evolution = Evolution::new(Prior::new(vec![uniform(0.0, 1.0)]), genetic(1)).unwrap();
    let value = LogLikelihood::new(-1.0).unwrap();
    assert_eq!(evolution.tell(7, value), Ok(TellProgress::Waiting));
    assert!(evolution.round().is_told(7) && !evolution.round().is_told(8));
    let (round, particle) = (0, 7);
    assert_eq!(
        evolution.tell(7, value),
        Err(TellError::AlreadyTold { round, particle })
    );
    let particle = 100;
    assert_eq!(
        evolution.tell(100, value),
        Err(TellError::NotPending { round, particle })
    );
    assert_eq!(
        (evolution.round().told(), evolution.round().pending().len()),
        (1, 100)
    );
}

#[test]
fn settings_that_cannot_work_are_refused() {
    assert_eq!(genetic(1).check(0), Err(EvolutionSettingsError::NoParameters));
    assert_eq!(adapting(1).check(0), Err(EvolutionSettingsError::NoParameters));
    let ga = |change: fn(&mut GaSettings)| {
        let mut settings = GaSettings::default();
        change(&mut settings);
        EvolutionSettings::Ga(settings)
    };
    let cma_es = |change: fn(&mut CmaEsSettings)| {
        let mut settings = CmaEsSettings::default();
        change(&mut settings);
        EvolutionSettings::CmaEs(settings)
    };
    for (settings, message) in [
        (ga(|s| s.population = 7), "population = 7 is not from 8 to 100000"),
        (
            ga(|s| s.generations = 1),
            "generations = 1 is not from 2 to 100000",
        ),
        (
            ga(|s| s.elite = 0),
            "elite = 0 is not from 1 to half of the population, 100",
        ),
        (
            ga(|s| s.elite = 51),
            "elite = 51 is not from 1 to half of the population, 100",
        ),
        (
            ga(|s| s.tolerance = f64::NAN),
            "tolerance = NaN is not a finite number above 0",
        ),
        (
            cma_es(|s| s.population = Some(3)),
            "population = 3 is not from 4 to 100000",
        ),
        // Two parameters: 4 + floor(3 ln 2) = 6.
        (
            cma_es(|s| s.max_evaluations = 11),
            "max_evaluations = 11 is not from 12 (two generations) to 1000000",
        ),
        (cma_es(|s| s.restarts = 21), "restarts = 21 is above 20"),
        (
            cma_es(|s| s.tolerance = 0.0),
            "tolerance = 0 is not a finite number above 0",
        ),
    ] {
        assert_eq!(settings.check(2).unwrap_err().to_string(), message);
    }
}
