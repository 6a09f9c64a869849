//! Decisions between options: expected losses by the posterior, what decides, and what one more run is worth.
//!
//! # Layout
//! - here: [`decision_runs`] and [`decide`]. `answer`: what is answered.
//! - `scenario`: the planned runs of options and further runs. `loss_table`: losses of each option at each draw.
//! - `attribution`: what the difference of two options comes from. `information`: the value of one more run.

mod answer;
mod attribution;
mod information;
mod loss_table;
mod scenario;

use job::Decision;

use crate::beyond::beyond;
use crate::draw::Draws;
use crate::ensemble::Simulated;
use crate::error::PredictionError;
use crate::prediction::notes;
use crate::spread::{interval, probability};
pub use answer::{ConstraintProbability, DecidedBy, DecisionAnswer, OptionLoss, ParameterShare, RunValue};
use attribution::decided_by;
use information::run_values;
use loss_table::LossTable;
pub use scenario::{Scenarios, decision_runs};

/// Compares the options of a decision by their expected losses.
///
/// The loss of an option is that of one new run: at each draw of each model, with errors as a new measurement has them (noise, scatter of
/// the soil, discrepancy). All options have the same errors, as if they ran on the same soil on the same day. The best option has the least expected loss of those whose constraints hold with their probabilities.
///
/// # Source
/// De Groot 1970, *Optimal Statistical Decisions*. Checked by the tests of `loss_table`, `attribution` and `information`.
///
/// # Errors
/// [`PredictionError::Request`] if a loss has no value.
pub fn decide(
    simulated: &Simulated,
    decision: &Decision,
    scenarios: &Scenarios,
) -> Result<DecisionAnswer, PredictionError> {
    let draws = Draws::new(simulated);
    let table = LossTable::new(simulated, &draws, decision, scenarios)?;
    let options: Vec<OptionLoss> = (0..decision.options.len())
        .map(|option| {
            let beyond = beyond_at(simulated, &scenarios.options[option], table.slip[option]);
            option_loss(decision, &table, option, beyond)
        })
        .collect();
    let feasible: Vec<usize> = (0..options.len())
        .filter(|&option| options[option].is_feasible)
        .collect();
    let mut ranked = feasible.clone();
    ranked.sort_by(|&a, &b| options[a].expected_loss.total_cmp(&options[b].expected_loss));
    let (best, second) = (ranked.first().copied(), ranked.get(1).copied());
    let name = |option: usize| decision.options[option].name.clone();
    let pair = best.zip(second);
    let difference = pair.map(|(best, second)| table.difference(second, best));
    let at_mode = feasible
        .iter()
        .copied()
        .filter(|&option| table.at_mode[option].is_finite())
        .min_by(|&a, &b| table.at_mode[a].total_cmp(&table.at_mode[b]));
    let mut notes = notes(simulated);
    if table.left_out > 0 {
        notes.push(format!(
            "{} of {} draws, with {:.1} % of the weight, count in no loss, because the model refuses a run there or a loss has no value",
            table.left_out,
            draws.all.len(),
            100.0 * table.left_out_share
        ));
    }
    let perfect = table.perfect_information(&feasible);
    let runs = run_values(simulated, &draws, &table, &feasible, scenarios, decision.run_cost);
    notes.extend(information::note(&runs));
    Ok(DecisionAnswer {
        calibration: simulated.models[0].calibration.row.id,
        draws: simulated.draws,
        models: simulated.weights.clone(),
        best: best.map(name),
        second: second.map(name),
        margin: difference.as_ref().map(|difference| difference.mean),
        margin_se: difference.as_ref().map(|difference| difference.se),
        probability_best: best.and_then(|best| {
            let is_best = |row: &Vec<f64>| feasible.iter().all(|&other| row[best] <= row[other]);
            probability(
                table
                    .means
                    .iter()
                    .zip(&table.weights)
                    .map(|(row, w)| (is_best(row), *w)),
            )
        }),
        best_at_mode: at_mode.map(name),
        decided_by: pair.and_then(|(best, second)| decided_by(simulated, &table, second, best)),
        perfect_information: perfect,
        run_cost: decision.run_cost,
        runs,
        options,
        notes,
    })
}

/// Returns what lies outside the fitted range of an option's run: at its mean slip, or at the last of its slips where it is always stuck.
fn beyond_at(simulated: &Simulated, runs: &[usize], slip: Option<f64>) -> Vec<String> {
    let Some(last) = runs.last().map(|&run| &simulated.runs[run]) else {
        return Vec::new();
    };
    let planned = last.at_slip(slip.unwrap_or(last.run.slip));
    beyond(&simulated.models[0].calibration.spec.experiment, &planned)
}

fn option_loss(decision: &Decision, table: &LossTable, option: usize, beyond: Vec<String>) -> OptionLoss {
    let stated = &decision.options[option];
    let constraints: Vec<ConstraintProbability> = decision
        .constraints
        .iter()
        .zip(&table.holds[option])
        .filter(|_| stated.condition.is_some())
        .map(|(constraint, &probability)| ConstraintProbability {
            statement: constraint.statement.text.clone(),
            probability,
            needed: constraint.probability,
        })
        .collect();
    let losses = table.losses_of(option);
    let expected = table.expected(option);
    OptionLoss {
        name: stated.name.clone(),
        expected_loss: expected.mean,
        expected_loss_se: expected.se,
        interval: interval(&losses).unwrap_or([expected.mean; 2]),
        loss_at_mode: Some(table.at_mode[option]).filter(|loss| loss.is_finite()),
        stuck: table.stuck[option],
        slip: table.slip[option],
        beyond,
        is_feasible: constraints.iter().all(|c| c.probability >= c.needed),
        constraints,
    }
}
