//! The value of one more run before a decision: by how much it is expected to lower the least expected loss.

use super::answer::RunValue;
use super::loss_table::{LossTable, OPTION_ERRORS};
use super::scenario::Scenarios;
use crate::draw::{DrawnRun, Draws, ERRORS, WeightedDraw};
use crate::ensemble::Simulated;

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
        let [value, value_se] = expected_gain(table, feasible, &drawn, &measured, least);
        let planned = &simulated.runs[position];
        RunValue {
            run: planned.run.name.clone(),
            wheel: planned.run.wheel.clone(),
            slip: planned.run.slip,
            wheel_load_n: planned.run.wheel_load_n,
            sled_speed_m_s: planned.run.sled_speed_m_s,
            value,
            value_se,
            is_worth_its_cost: run_cost.map(|cost| value > cost),
        }
    });
    let mut values: Vec<RunValue> = values.collect();
    values.sort_by(|a, b| b.value.total_cmp(&a.value));
    values
}

/// Returns the expected value of sample information of a run, with its standard error.
///
/// `EVSI = min_o E[L_o] - E_y[min_o E[L_o | y]]`: a measurement y is drawn at each draw with its error, the draws are weighted by the
/// density of y, and the best option is chosen again. The draws stand for the prior of the run exactly, so the only errors are those of
/// their number. Among options whose constraints hold before the run; errors of different channels count as independent normal ones.
///
/// # Source
/// Raiffa and Schlaifer 1961, *Applied Statistical Decision Theory*; weights of draws as in Menzies 2016, Med. Decis. Making 36(3):308,
/// doi:10.1177/0272989X15583495. Checked by `tests::a_run_that_tells_the_draws_apart_is_worth_perfect_information`.
fn expected_gain(
    table: &LossTable,
    feasible: &[usize],
    drawn: &[Option<DrawnRun>],
    measured: &[usize],
    least: f64,
) -> [f64; 2] {
    let mut gains: Vec<(f64, f64)> = Vec::new();
    for (truth, &weight) in drawn.iter().zip(&table.weights) {
        // The model refuses the run at this draw, so that nothing would be learnt by its numbers.
        let Some(truth) = truth else {
            gains.push((least, weight));
            continue;
        };
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
            let total: f64 = weights.iter().sum();
            let expected = feasible.iter().map(|&option| {
                let losses = table.means.iter().zip(&weights);
                losses.map(|(row, weight)| row[option] * weight).sum::<f64>() / total
            });
            gains.push((expected.fold(f64::INFINITY, f64::min), weight / ERRORS as f64));
        }
    }
    let mean: f64 = gains.iter().map(|(loss, weight)| loss * weight).sum();
    let squares: f64 = table.weights.iter().map(|weight| weight * weight).sum();
    let spread: f64 = gains
        .iter()
        .map(|(loss, weight)| (loss - mean).powi(2) * weight)
        .sum();
    [(least - mean).max(0.0), (spread * squares).sqrt()]
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
            expected_gain(&losses, &[0, 1], &runs, &[0], least)[0]
        };
        assert!((value(50.0) - perfect).abs() < 1e-9, "{}", value(50.0));
        // A run with equal predictions says nothing, and others say the more the further apart their predictions are.
        assert!(value(0.0).abs() < 1e-12);
        assert!(value(1.0) < value(2.0) && value(2.0) < perfect);
        let refused = [None, None];
        assert!(expected_gain(&losses, &[0, 1], &refused, &[0], least)[0].abs() < 1e-12);
    }
}
