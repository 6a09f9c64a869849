//! The value of one more run before a decision: by how much it is expected to lower the least expected loss.

use super::answer::RunValue;
use super::loss_table::{LossTable, OPTION_ERRORS};
use super::scenario::Scenarios;
use crate::draw::{DrawnRun, Draws, ERRORS, WeightedDraw};
use crate::ensemble::Simulated;

/// Smallest effective number of draws after a measurement at which the bias of a value is small beside its standard error.
const MIN_EFFECTIVE: f64 = 10.0;

/// Returns the value of each run that could be made, the most valuable first.
pub(super) fn run_values(
    simulated: &Simulated,
    draws: &Draws<'_>,
    table: &LossTable,
    feasible: &[usize],
    scenarios: &Scenarios,
    run_cost: Option<f64>,
) -> Vec<RunValue> {
    let Some(least) = table.least(feasible) else {
        return Vec::new();
    };
    let measured: Vec<usize> = {
        let calibration = &simulated.models[0].calibration;
        let is_fitted = |c: &usize| calibration.spec.likelihood.data().iter().any(|d| d.channel == *c);
        (0..4).filter(is_fitted).collect()
    };
    let values = scenarios.runs.iter().enumerate().map(|(number, &position)| {
        let errors = OPTION_ERRORS + 1 + number;
        let drawn = draws.of_run(position, errors);
        let of_draw = |draw: &WeightedDraw| {
            let at = draws.all.iter().position(|other| other == draw)?;
            drawn[at].clone()
        };
        let drawn: Vec<Option<DrawnRun>> = table.draws.iter().map(of_draw).collect();
        let gain = expected_gain(table, feasible, &drawn, &measured, least);
        let planned = &simulated.runs[position];
        RunValue {
            run: planned.run.name.clone(),
            wheel: planned.run.wheel.clone(),
            slip: planned.run.slip,
            wheel_load_n: planned.run.wheel_load_n,
            sled_speed_m_s: planned.run.sled_speed_m_s,
            value: gain.value,
            value_se: gain.se,
            effective_draws: gain.effective_draws,
            is_worth_its_cost: run_cost.map(|cost| gain.value > cost),
        }
    });
    let mut values: Vec<RunValue> = values.collect();
    values.sort_by(|a, b| b.value.total_cmp(&a.value));
    values
}

/// Returns what limits the values of runs, in a sentence; `None` if nothing does.
pub(super) fn note(runs: &[RunValue]) -> Option<String> {
    let few = runs.iter().filter(|run| run.effective_draws < MIN_EFFECTIVE);
    let few: Vec<String> = few
        .map(|run| format!("{:.1} of {}", run.effective_draws, run.run))
        .collect();
    (!few.is_empty()).then(|| {
        format!(
            "fewer than {MIN_EFFECTIVE} effective draws are left on average after a measurement ({}): such a run looks worth more than it is",
            few.join(", ")
        )
    })
}

/// What a run is expected to save.
struct Gain {
    value: f64,
    se: f64,
    /// Mean over the measurements of the effective number of draws after it: 1 over the sum of their squared weights.
    effective_draws: f64,
}

/// The state after an outcome of a run: the least expected loss and the effective number of draws.
struct Posterior {
    least: f64,
    effective_draws: f64,
}

impl Posterior {
    /// Chooses the best option again by weights of the draws, whose sum need not be 1.
    fn new(table: &LossTable, feasible: &[usize], weights: &[f64]) -> Posterior {
        // Divided by the greatest, because the squares of small weights are 0.
        let greatest = weights.iter().copied().fold(0.0, f64::max);
        let weights: Vec<f64> = weights.iter().map(|weight| weight / greatest).collect();
        let total: f64 = weights.iter().sum();
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        let expected = feasible.iter().map(|&option| {
            let losses = table.means.iter().zip(&weights);
            losses.map(|(row, weight)| row[option] * weight).sum::<f64>() / total
        });
        Posterior {
            least: expected.fold(f64::INFINITY, f64::min),
            effective_draws: total * total / squares,
        }
    }
}

/// Returns the expected value of sample information of a run, with its standard error.
///
/// `EVSI = min_o E[L_o] - E_y[min_o E[L_o | y]]`: a measurement y is drawn at each draw with its error, the draws are weighted by the
/// density of y, and the best option is chosen again. That the model refuses the run is an outcome too: it leaves the draws that refuse it.
///
/// # Validity
/// The draws stand for the prior of the run exactly. The value has the standard error of their number, and an upward bias where few of them
/// keep a weight after a measurement: the truth is one of them, so that a few draws are told apart too well. Among options whose
/// constraints hold before the run; errors of different channels count as independent normal ones.
///
/// # Source
/// Raiffa and Schlaifer 1961, *Applied Statistical Decision Theory*; weights of draws as in Menzies 2016, Med. Decis. Making 36(3):308,
/// doi:10.1177/0272989X15583495. Checked by `tests::a_run_that_tells_the_draws_apart_is_worth_perfect_information` and
/// `tests::a_refusal_is_worth_nothing_where_the_options_lose_the_same`.
fn expected_gain(
    table: &LossTable,
    feasible: &[usize],
    drawn: &[Option<DrawnRun>],
    measured: &[usize],
    least: f64,
) -> Gain {
    let mut outcomes: Vec<(Posterior, f64)> = Vec::new();
    let mut refused = vec![0.0; drawn.len()];
    for (i, (truth, &weight)) in drawn.iter().zip(&table.weights).enumerate() {
        let Some(truth) = truth else {
            refused[i] = weight;
            continue;
        };
        // The model that was asked for is simulated even if it has no weight.
        if weight <= 0.0 {
            continue;
        }
        for error in 0..ERRORS {
            let measurement = truth.measured(error);
            let logs: Vec<f64> = drawn
                .iter()
                .map(|draw| {
                    draw.as_ref().map_or(f64::NEG_INFINITY, |draw| {
                        log_density(draw, &measurement, measured)
                    })
                })
                .collect();
            let max = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let weights: Vec<f64> = logs
                .iter()
                .zip(&table.weights)
                .map(|(log, weight)| weight * libm::exp(log - max))
                .collect();
            let posterior = Posterior::new(table, feasible, &weights);
            outcomes.push((posterior, weight / ERRORS as f64));
        }
    }
    let of_refused: f64 = refused.iter().sum();
    if of_refused > 0.0 {
        outcomes.push((Posterior::new(table, feasible, &refused), of_refused));
    }
    let mean = |of: fn(&Posterior) -> f64| -> f64 {
        outcomes
            .iter()
            .map(|(posterior, weight)| of(posterior) * weight)
            .sum()
    };
    let after = mean(|posterior| posterior.least);
    let squares: f64 = table.weights.iter().map(|weight| weight * weight).sum();
    let spread: f64 = outcomes
        .iter()
        .map(|(posterior, weight)| (posterior.least - after).powi(2) * weight)
        .sum();
    Gain {
        value: (least - after).max(0.0),
        se: (spread * squares).sqrt(),
        effective_draws: mean(|posterior| posterior.effective_draws),
    }
}

/// Returns the log-density of a measurement at a draw, up to a constant of all draws.
fn log_density(draw: &DrawnRun, measurement: &[f64; 4], measured: &[usize]) -> f64 {
    let of_channel = |&c: &usize| {
        let scale = draw.scales[c].filter(|scale| *scale > 0.0)?;
        let distance = (measurement[c] - draw.values[c]) / scale;
        distance
            .is_finite()
            .then(|| -0.5 * distance * distance - libm::log(scale))
    };
    measured.iter().filter_map(of_channel).sum()
}

#[cfg(test)]
mod tests {
    use super::super::loss_table::tests::table;
    use super::*;

    fn drawn(pull: f64, sd: f64, errors: [f64; ERRORS]) -> Option<DrawnRun> {
        Some(DrawnRun {
            values: [pull, f64::NAN, f64::NAN, f64::NAN],
            errors: errors.map(|error| [sd * error, 0.0, 0.0, 0.0]).to_vec(),
            scales: [Some(sd), None, None, None],
        })
    }

    const ERROR: [f64; ERRORS] = [-1.6, -1.0, -0.7, -0.4, -0.1, 0.1, 0.4, 0.7, 1.0, 1.6];

    #[test]
    fn a_run_that_tells_the_draws_apart_is_worth_perfect_information() {
        let losses = table(&[[0.0, 1.0], [4.0, 1.0]]);
        let least = losses.least(&[0, 1]).unwrap();
        let perfect = losses.perfect_information(&[0, 1]).unwrap();
        let value = |apart: f64| {
            let runs = [drawn(0.0, 1.0, ERROR), drawn(apart, 1.0, ERROR)];
            expected_gain(&losses, &[0, 1], &runs, &[0], least).value
        };
        assert!((value(50.0) - perfect).abs() < 1e-9, "{}", value(50.0));
        // A run with equal predictions says nothing, and others say the more the further apart their predictions are.
        assert!(value(0.0).abs() < 1e-12);
        assert!(value(1.0) < value(2.0) && value(2.0) < perfect);
        let refused = [None, None];
        assert!(expected_gain(&losses, &[0, 1], &refused, &[0], least).value.abs() < 1e-12);
    }

    #[test]
    fn a_refusal_is_worth_nothing_where_the_options_lose_the_same() {
        let runs = [drawn(0.0, 1.0, ERROR), None];
        let value = |losses: &LossTable| {
            let least = losses.least(&[0, 1]).unwrap();
            expected_gain(losses, &[0, 1], &runs, &[0], least).value
        };
        assert!(value(&table(&[[0.0, 0.0], [10.0, 10.0]])).abs() < 1e-12);
        // Whether the model refuses the run tells these draws apart.
        let apart = table(&[[0.0, 1.0], [4.0, 1.0]]);
        assert!((value(&apart) - apart.perfect_information(&[0, 1]).unwrap()).abs() < 1e-12);
    }

    #[test]
    fn few_effective_draws_after_a_measurement_are_noted() {
        let losses = table(&[[0.0, 1.0]; 20]);
        let effective = |sd: f64| {
            let runs: Vec<_> = (0..20).map(|i| drawn(f64::from(i), sd, ERROR)).collect();
            expected_gain(&losses, &[0, 1], &runs, &[0], 0.0).effective_draws
        };
        assert!((effective(1e-3) - 1.0).abs() < 1e-6 && (effective(1e6) - 20.0).abs() < 1e-3);
        let run = |effective_draws: f64| RunValue {
            run: "n1".into(),
            wheel: "w".into(),
            slip: 0.2,
            wheel_load_n: 100.0,
            sled_speed_m_s: 0.02,
            value: 1.0,
            value_se: 0.1,
            effective_draws,
            is_worth_its_cost: None,
        };
        assert_eq!(note(&[run(12.0)]), None);
        let note = note(&[run(12.0), run(3.21)]).unwrap();
        assert!(
            note.starts_with("fewer than 10 effective draws") && note.contains("(3.2 of n1)"),
            "{note}"
        );
    }
}
